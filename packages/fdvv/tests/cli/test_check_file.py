"""The check of every kind of file that fdvv writes: whole ones, damaged ones, and what is none."""

from __future__ import annotations

import json
import shutil
from collections.abc import Callable
from importlib import resources
from pathlib import Path

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from fdvv.button.export_file import export_button
from fdvv.cli.check_file import check_file
from fdvv.compensation.identification.rig_file import save_rig
from fdvv.compensation.identification.rig_model import RigModel
from fdvv.device.recording import Recorder
from fdvv.errors import InputError
from fdvv.model.file import load_builtin, save_model
from fdvv.model.jnd_file import save_jnds
from fdvv.program.compile import compile_program
from fdvv.program.file import save_program
from fdvv.program.library import load_shipped
from fdvv.recording.log import RecordingLog
from fdvv.rendering.actuation_file import save_actuation
from fdvv.rendering.session import MANIFEST
from fdvv.rendering.session_log import PRESSES
from fdvv.testing.conformance import plain_surface
from fdvv.testing.scripted import ScriptedDevice
from tests.recording.files import motive
from tests.recording.takes import ABOUT, take
from tests.support.damage import DAMAGES, Damage
from tests.support.jnds import as_literature, record_of
from tests.support.sessions import Hand, learn


def model(folder: Path) -> Path:
    save_model(load_builtin("mx-clear"), folder / "a.fdvv.json")
    return folder / "a.fdvv.json"


def program(folder: Path) -> Path:
    save_program(load_shipped("fast-tapping"), folder / "a.fdvv-program.json")
    return folder / "a.fdvv-program.json"


def image(folder: Path) -> Path:
    (folder / "a.fdvv-image").write_bytes(compile_program(load_shipped("fast-tapping")).image)
    return folder / "a.fdvv-image"


def rig(folder: Path) -> Path:
    save_rig(RigModel(), folder / "a.rig.json")
    return folder / "a.rig.json"


def jnds(folder: Path) -> Path:
    save_jnds(record_of(as_literature("force")), folder / "jnds.json")
    return folder / "jnds.json"


def device(folder: Path) -> Path:
    with Recorder(ScriptedDevice(), folder / "a.fdvv-session") as recorder:
        recorder.upload(plain_surface(), 4.0)
        recorder.press(80.0)
        recorder.press(80.0)
    return folder / "a.fdvv-session"


def recording(folder: Path) -> Path:
    with RecordingLog(folder / "a.recording.jsonl", ABOUT) as log:
        log.add(take(1))
        log.add(take(2))
    return folder / "a.recording.jsonl"


def log(folder: Path) -> Path:
    (folder / "a.csv").write_text(motive())
    return folder / "a.csv"


OLD = Path(__file__).parents[4] / "tests" / "files" / "old"


def curves(folder: Path) -> Path:
    export_button("mx-blue", "csv", "a.csv").save(folder / "a.csv")
    return folder / "a.csv"


def trials(folder: Path) -> Path:
    return Path(shutil.copy(OLD / "optimize" / "trials.jsonl", folder / "trials.jsonl"))


MAKERS: dict[str, tuple[Callable[[Path], Path], dict[str, object]]] = {
    "an FDVV model": (model, {"name": "mx-clear", "version": 1}),
    "a program": (program, {"version": 1}),
    "a program's image": (image, {"states": len(load_shipped("fast-tapping").states)}),
    "a known rig": (rig, {"version": 1, "presses": 0}),
    "JNDs of a study": (jnds, {"version": 1, "force_floor_cN": 30.0}),
    "a recording of a device": (device, {"device": "scripted", "uploads": 1, "presses": 2}),
    "a recording": (recording, {"name": "mx-clear", "takes": 2}),
    "a log (motive-1.23)": (log, {"takes": 1}),
    "force curves (plain-csv)": (curves, {"presses": 1, "releases": 1}),
    "the trials of an optimisation": (trials, {"comparisons": 0}),
}


def session(folder: Path) -> Path:
    learn(Hand(), folder / "s")
    return folder / "s"


@pytest.mark.parametrize("kind", MAKERS)
def test_a_whole_file_is_known_by_what_stands_in_it(tmp_path: Path, kind: str) -> None:
    make, facts = MAKERS[kind]
    path = make(tmp_path)
    renamed = path.rename(tmp_path / "renamed")
    found = check_file(renamed)
    assert (found.kind, found.status, found.problems) == (kind, 0, ())
    assert {name: found.facts[name] for name in facts} == facts
    json.dumps(found.to_dict())


def test_an_actuation_and_the_session_it_came_of_are_whole(tmp_path: Path) -> None:
    save_actuation(learn(Hand(), tmp_path / "s"), tmp_path / "a.actuation.json")
    found = check_file(tmp_path / "a.actuation.json")
    assert (found.kind, found.status, found.facts["name"]) == ("an actuation", 0, "mx-clear")
    folder = check_file(tmp_path / "s")
    assert (folder.kind, folder.status, folder.notes) == ("a session", 0, ())
    assert (folder.facts["presses"], folder.facts["presses_used"], folder.facts["runs"]) == (8, 8, 1)
    for name in (PRESSES, MANIFEST, "receipt.json"):
        assert check_file(tmp_path / "s" / name).facts == folder.facts


def test_the_log_of_a_study_is_whole_until_a_line_is_changed(tmp_path: Path) -> None:
    for name in ("study.jsonl", "study.head"):
        shutil.copy(OLD / "study-sealed" / name, tmp_path / name)
    path = tmp_path / "study.jsonl"
    found = check_file(path)
    assert (found.kind, found.status) == ("a chained log of a study", 0)
    assert found.facts["records"] > 1
    lines = path.read_bytes().splitlines(keepends=True)
    path.write_bytes(b"".join(lines[:-1]))
    assert check_file(path).status == 1


def test_bare_numbers_are_a_log_of_the_rate_that_is_given(tmp_path: Path) -> None:
    (tmp_path / "hammer.txt").write_text("\n".join(str(100 + i) for i in range(50)) + "\n")
    assert check_file(tmp_path / "hammer.txt", 2000.0).facts["streams"][0]["rate_Hz"] == pytest.approx(2000)


def test_every_built_in_button_is_whole() -> None:
    folder = resources.files("fdvv.model") / "builtin"
    paths = [Path(str(entry)) for entry in folder.iterdir() if entry.name.endswith(".fdvv.json")]
    assert paths
    assert {check_file(path).status for path in paths} == {0}


def test_a_session_that_was_cut_or_is_not_finished_says_so(tmp_path: Path) -> None:
    folder = session(tmp_path)
    (folder / "receipt.json").unlink()
    found = check_file(folder)
    assert (found.status, found.notes) == (0, ("not finished: there is no receipt yet",))
    presses = folder / PRESSES
    presses.write_bytes(presses.read_bytes()[:-7])
    found = check_file(folder)
    assert (found.status, found.facts["presses"]) == (1, 7)
    assert "presses kept: 7; run the session's command again" in str(found.problems[0])


def test_a_damaged_session_names_its_file_and_line(tmp_path: Path) -> None:
    folder = session(tmp_path)
    presses = folder / PRESSES
    presses.write_bytes(presses.read_bytes().replace(b"100.0", b"101.0", 1))
    found = check_file(folder)
    assert found.status == 2
    assert f"{presses}, line" in str(found.problems[0])


def test_a_recorded_device_with_a_spoilt_press_names_the_record(tmp_path: Path) -> None:
    path = device(tmp_path)
    lines = path.read_text().split("\n")
    lines[2] = lines[2].replace("<f8:", "<f8:!", 1)
    path.write_text("\n".join(lines)[:-1])
    found = check_file(path)
    assert found.status == 1
    assert [problem.place for problem in found.problems] == ["record 2 of the last session", "end of file"]


NONE = {
    "prose": b"Dear Sir or Madam,\n",
    "a list": b"[1, 2]\n",
    "nothing known": b'{"format": "something-else"}',
}


@pytest.mark.parametrize("what", NONE)
def test_what_is_no_file_of_fdvv_is_refused(tmp_path: Path, what: str) -> None:
    (tmp_path / "a").write_bytes(NONE[what])
    with pytest.raises(InputError, match="is nothing that fdvv writes or reads"):
        check_file(tmp_path / "a")


@pytest.mark.parametrize("kind", MAKERS)
@given(damages=st.lists(DAMAGES, min_size=1, max_size=3))
@settings(
    max_examples=12,
    deadline=None,
    derandomize=True,
    suppress_health_check=[HealthCheck.function_scoped_fixture],
)
def test_a_mutilated_file_gets_a_verdict_or_one_line(
    tmp_path: Path, kind: str, damages: list[Damage]
) -> None:
    source = tmp_path / "whole"
    source.mkdir(exist_ok=True)
    made = next(source.iterdir(), None) or MAKERS[kind][0](source)
    data = made.read_bytes()
    for damage in damages:
        data = damage(data)
    path = tmp_path / made.name
    path.write_bytes(data)
    report = verdict(path)
    assert report
    assert all("\n" not in line for line in report)


def verdict(path: Path) -> list[str]:
    """Return the result of the check: its kind and problems, or the refusal."""
    try:
        found = check_file(path)
    except InputError as error:
        return [str(error)]
    json.dumps(found.to_dict())
    return [found.kind, *map(str, found.problems)]
