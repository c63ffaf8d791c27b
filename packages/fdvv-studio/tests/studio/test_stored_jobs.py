"""A project from somebody else: its jobs run nothing that a page could not order, and write inside it."""

from __future__ import annotations

import json
import os
from collections.abc import Callable
from pathlib import Path
from typing import Any

import msgspec
import pytest

from fdvv.errors import FdvvError, InputError
from fdvv.model.file import load_builtin, save_model
from fdvv.rendering.settings import ProbeSettings
from fdvv_studio.studio.contract import error_line
from fdvv_studio.studio.jobs.events import QuestionAnswered
from fdvv_studio.studio.jobs.file import RESULT_FOLDERS, JobFolder, JobRecord, publish, utc_now
from fdvv_studio.studio.jobs.jobs import Jobs
from fdvv_studio.studio.jobs.orders import CaptureOrder, Order, ProbeOrder
from fdvv_studio.studio.jobs.process import run_work
from fdvv_studio.studio.jobs.work import Work
from fdvv_studio.studio.studio import Studio
from tests.studio.jobs import DEVICES, learning, tuning

Mutate = Callable[[dict[str, Any]], None]
ORDER = ProbeOrder("builtin:mx-clear", "clear", settings=ProbeSettings(velocities_mm_s=(100.0,), presses=1))
RIG_FILE = "from pathlib import Path\nPath(__file__).with_name('it ran').touch()\n"


@pytest.fixture
def project(tmp_path: Path) -> Path:
    """A project with one job that was stopped, and a rig's file that leaves a mark where it is run."""
    store(tmp_path / "project", ORDER)
    (tmp_path / "project" / "rig.py").write_text(RIG_FILE)
    return tmp_path / "project"


@pytest.fixture
def started(monkeypatch: pytest.MonkeyPatch) -> list[Path]:
    """The folders of the jobs for which a process was started; none is."""
    folders: list[Path] = []
    monkeypatch.setattr("fdvv_studio.studio.jobs.jobs.JobStart", lambda folder, *_: folders.append(folder))
    return folders


def store(project: Path, order: Order, **record: Any) -> JobFolder:
    folder = JobFolder(project / "jobs" / "0001")
    folder.path.mkdir(parents=True)
    save_model(load_builtin("mx-clear"), folder.button)
    stored = JobRecord("fdvv-job", 2, order, "a job", True, utc_now(), state="cancelled", run=1)
    folder.save(msgspec.structs.replace(stored, **record))
    return folder


def mutate(project: Path, change: Mutate) -> None:
    path = project / "jobs" / "0001" / "job.json"
    content = json.loads(path.read_text())
    change(content)
    path.write_text(json.dumps(content))


def tree(path: Path) -> dict[str, bytes | None]:
    """Return a file, or a folder and everything below it, links as they are."""
    return {
        str(found): found.read_bytes() if found.is_file() and not found.is_symlink() else None
        for found in (path, *path.rglob("*"))
    }


def refusal_of_resume(project: Path) -> str:
    """Return the line with which a studio refuses to resume the only job."""
    with pytest.raises(FdvvError) as refused:
        Studio(project).part(Jobs).resume("0001", DEVICES)
    line = error_line(refused.value)
    assert "\n" not in line
    assert len(line) < 400
    assert str(project) not in line
    return line


def refusal_of_work(project: Path) -> str:
    """Return the line with which a worker ends that is started by hand in the folder of the only job."""
    end = run_work(Work(JobFolder(project / "jobs" / "0001"), 1, lambda _event: None, lambda _number: ""))
    assert end.state == "failed"
    return end.line


def of_order(**changed: Any) -> Mutate:
    return lambda content: content["order"].update(changed)


def of_settings(**changed: Any) -> Mutate:
    return lambda content: content["order"]["settings"].update(changed)


def of_record(**changed: Any) -> Mutate:
    return lambda content: content.update(changed)


HOSTILE: list[tuple[Mutate, str]] = [
    (of_order(device="rig:rig.py:X"), "device: there is no 'rig:rig.py:X' in the studio"),
    (of_order(device="replay:/etc/passwd"), "device: there is no"),
    (of_order(device="serial:"), "device: there is no"),
    (of_order(device="twin\n"), "device: there is no"),
    (of_order(device=""), "device: there is no"),
    (of_order(device=["twin"]), "$.order.device"),
    (of_order(name="../../../escaped"), "name: cannot be '../../../escaped'"),
    (of_order(name="/tmp/escaped"), "name: cannot be"),
    (of_order(name="a\0b"), "name: cannot be"),
    (of_order(name="a" * 100_000), "name: cannot be"),
    (of_order(name=None), "$.order.name"),
    (of_order(button="own:../../secret"), "none of this name"),
    (of_order(button="b" * 100_000), "none of this name"),
    (of_order(actuation="../measured/x"), "none of this name"),
    (of_order(rig="../../secret"), "there is no '../../secret'"),
    (of_settings(seed=10**40), "$.order.settings"),
    (of_settings(seed=True), "$.order.settings.seed"),
    (of_settings(presses=10**9), "$.order.settings.presses"),
    (of_settings(velocities_mm_s=[100.0] * 50_000), "$.order.settings.velocities_mm_s"),
    (of_settings(velocities_mm_s=[50.0, 50.0]), "velocities_mm_s must differ"),
    (of_settings(velocities_mm_s=[1e300]), "$.order.settings.velocities_mm_s"),
    (of_settings(velocities_mm_s=100.0), "$.order.settings.velocities_mm_s"),
    (of_settings(pace_ratio=-1.0), "$.order.settings.pace_ratio"),
    (of_order(settings="all"), "$.order.settings"),
    (of_order(type="shell"), "$.order.type"),
    (of_order(run="rm"), "$.order"),
    (of_record(order="rig:rig.py:X"), "$.order"),
    (of_record(run=10**40), "run: cannot be"),
    (of_record(done=-1), "done: cannot be"),
    (of_record(results=[{"kind": "shell", "name": "x"}]), "$.results"),
    (of_record(title="a" * 2_000_000), "larger than 1 MB"),
]


@pytest.mark.parametrize(("change", "said"), HOSTILE, ids=[said[:60] for _, said in HOSTILE])
def test_what_could_not_be_ordered_is_no_more_resumed(
    change: Mutate, said: str, project: Path, started: list[Path]
) -> None:
    mutate(project, change)
    before = tree(project.parent)
    line = refusal_of_resume(project)
    assert said in line
    assert line.startswith("jobs/0001/job.json, ")
    assert refusal_of_work(project) == line
    assert started == []
    assert tree(project.parent) == before


@pytest.mark.parametrize("order", [learning(), tuning(), CaptureOrder("x")], ids=lambda o: type(o).__name__)
@pytest.mark.parametrize(("change", "said"), [HOSTILE[0], HOSTILE[6]], ids=["device", "name"])
def test_no_kind_of_work_is_an_exception(
    order: Order, change: Mutate, said: str, tmp_path: Path, started: list[Path]
) -> None:
    store(tmp_path / "project", order)
    mutate(tmp_path / "project", change)
    assert said in refusal_of_resume(tmp_path / "project")
    assert said in refusal_of_work(tmp_path / "project")
    assert started == []


def test_a_device_of_a_file_is_left_to_a_command_that_is_typed(project: Path) -> None:
    device = f"rig:{project / 'rig.py'}:X"
    mutate(project, of_order(device=device))
    remedy = "only a command that you type runs a device's file: fdvv probe --device SPEC"
    assert refusal_of_work(project).endswith(remedy)
    with pytest.raises(InputError, match=remedy):
        Studio(project).part(Jobs).resume("0001", DEVICES)
    with pytest.raises(InputError, match=remedy):
        Studio(project).part(Jobs).start(msgspec.structs.replace(ORDER, device=device), DEVICES)
    assert not (project / "it ran").exists()


@pytest.mark.parametrize("state", ["cancelled", "failed", "running", "needs you", "waiting"])
def test_a_job_that_is_refused_is_listed_with_the_reason_and_left_as_it_is(state: str, project: Path) -> None:
    mutate(project, of_order(device="rig:rig.py:X"))
    mutate(project, of_record(state=state, done=10**40, total=1))
    before = tree(project.parent)
    (row,) = Studio(project).part(Jobs).rows()
    assert (row.state, row.resumable, row.left_s) == ("failed", False, None)
    assert row.line.startswith("jobs/0001/job.json, device: there is no 'rig:rig.py:X'")
    assert tree(project.parent) == before


def test_a_job_that_is_done_stays_so(project: Path) -> None:
    mutate(project, of_order(name="a/b"))
    mutate(project, of_record(state="done"))
    jobs = Studio(project).part(Jobs)
    (row,) = jobs.rows()
    assert (row.state, row.line, row.resumable) == ("done", "", False)
    with pytest.raises(InputError, match="name: cannot be"):
        jobs.resume("0001", DEVICES)


def test_a_device_that_is_not_there_is_asked_for(project: Path, started: list[Path]) -> None:
    mutate(project, of_order(device="serial:/dev/none"))
    line = "device: there is no 'serial:/dev/none'; connect it and resume, or begin the work anew"
    (row,) = Studio(project).part(Jobs).rows()
    assert (row.state, row.resumable) == ("cancelled", True)
    assert refusal_of_resume(project) == line
    assert refusal_of_work(project) == line
    assert started == []


def test_the_file_is_checked_again_as_it_is_resumed(project: Path, started: list[Path]) -> None:
    jobs = Studio(project).part(Jobs)
    mutate(project, of_order(device="rig:rig.py:X"))
    with pytest.raises(InputError, match=r"there is no 'rig:rig\.py:X'"):
        jobs.resume("0001", DEVICES)
    mutate(project, of_order(device="host"))
    jobs.resume("0001", DEVICES)
    assert [folder.name for folder in started] == ["0001"]
    with pytest.raises(InputError, match="host is used by job 1"):
        jobs.start(msgspec.structs.replace(ORDER, device="host"), DEVICES)


def replace_by_link(path: Path, outside: Path) -> None:
    """Move a file or folder out of the project, and leave a link to it; what is not there is made outside."""
    if path.exists():
        path.rename(outside)
    elif path.suffix:
        outside.write_text("theirs")
    else:
        outside.mkdir()
    path.symlink_to(outside, target_is_directory=outside.is_dir())


IN_JOB = ("job.json", "events.jsonl", "errors.txt", "button.fdvv.json", "session", "result.measured.json")
RESULTS = [place.folder for place in RESULT_FOLDERS.values()]


@pytest.mark.parametrize("state", ["cancelled", "running"])
@pytest.mark.parametrize("place", ["jobs/0001", *(f"jobs/0001/{name}" for name in IN_JOB), *RESULTS])
def test_a_link_in_the_place_of_a_file_or_folder_is_not_followed(
    place: str, state: str, project: Path, started: list[Path]
) -> None:
    mutate(project, of_record(state=state))
    outside = project.parent / "outside"
    replace_by_link(project / place, outside)
    before = tree(outside)
    assert refusal_of_resume(project).startswith(f"{place}: is a link, or no file; ")
    with pytest.raises(InputError, match="is a link"):
        publish(project, JobFolder(project / "jobs" / "0001"), ORDER)
    assert started == []
    assert tree(outside) == before


def test_work_is_begun_in_no_folder_of_somebody_else(project: Path, started: list[Path]) -> None:
    mutate(project, of_record(state="running"))
    replace_by_link(project / "jobs", project.parent / "outside")
    before = tree(project.parent)
    jobs = Studio(project).part(Jobs)
    assert jobs.rows() == ()
    with pytest.raises(InputError, match="jobs: is a link, or no file"):
        jobs.start(ORDER, DEVICES)
    assert "jobs: is a link" in refusal_of_work(project)
    assert started == []
    assert tree(project.parent) == before


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="this system has no pipes in folders")
@pytest.mark.parametrize("name", ["job.json", "events.jsonl"])
def test_a_pipe_keeps_nobody_waiting(name: str, project: Path) -> None:
    path = project / "jobs" / "0001" / name
    path.unlink(missing_ok=True)
    os.mkfifo(path)
    assert f"jobs/0001/{name}: is a link, or no file" in refusal_of_resume(project)


def test_events_beyond_all_measure_are_not_read(project: Path) -> None:
    mutate(project, of_record(state="running"))
    with (project / "jobs" / "0001" / "events.jsonl").open("wb") as stream:
        stream.truncate(10**12)
    assert "0001/events.jsonl: larger than 500 MB" in refusal_of_resume(project)


def test_events_that_count_too_far_leave_the_time_finite(project: Path, started: list[Path]) -> None:
    mutate(project, of_record(state="running"))
    journal = JobFolder(project / "jobs" / "0001").open_journal()
    answered = QuestionAnswered(10**400, 1, 100.0, "first", ())
    journal.write({"event": {"type": "answered", **msgspec.to_builtins(answered)}})
    journal.close()
    jobs = Studio(project).part(Jobs)
    assert (jobs.job("0001").row.done, jobs.job("0001").row.left_s) == (10**400, None)
    with pytest.raises(InputError, match="done: cannot be 1000"):
        jobs.resume("0001", DEVICES)
    assert started == []


def test_a_folder_of_a_huge_number_leaves_room_for_the_next_job(project: Path, started: list[Path]) -> None:
    (project / "jobs" / ("9" * 250)).mkdir()
    assert Studio(project).part(Jobs).start(ORDER, DEVICES).job == "0002"
    assert [folder.name for folder in started] == ["0002"]
