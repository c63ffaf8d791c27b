"""Long work as a process of its own: events, stop, resume, answers, one device at a time."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time
from collections.abc import Iterator
from pathlib import Path
from typing import TypeGuard

import pytest

from fdvv.bench.settings import CaptureSettings
from fdvv.errors import InputError
from fdvv.model.file import load_model
from fdvv.rendering.actuation_file import load_actuation
from fdvv_studio.studio.jobs.events import JobOutcome, PressEvent, QuestionAnswered, QuestionAsked
from fdvv_studio.studio.jobs.file import JOB, JobResult
from fdvv_studio.studio.jobs.jobs import BROKEN_OFF, Jobs
from fdvv_studio.studio.jobs.orders import CaptureOrder, CompensateOrder
from fdvv_studio.studio.jobs.process import PATIENCE_s as LETTING_GO_s
from fdvv_studio.studio.jobs.time_left import remaining_s
from fdvv_studio.studio.studio import Studio
from tests.studio.jobs import DEVICES, PRESSES, Follower, PATIENCE_s, learning, long_learning, tuning


@pytest.fixture
def studio(tmp_path: Path) -> Iterator[Studio]:
    """A studio with an empty project, closed at the end."""
    studio = Studio(tmp_path / "project")
    yield studio
    studio.close()


@pytest.fixture
def jobs(studio: Studio) -> Jobs:
    return studio.part(Jobs)


def pressed(event: object) -> TypeGuard[PressEvent]:
    """Whether this is a press that is learned from."""
    return isinstance(event, PressEvent) and event.stage == "compensate"


def begin(jobs: Jobs, order: CompensateOrder) -> Follower:
    return Follower(jobs, jobs.start(order, DEVICES).job)


def test_work_tells_every_press_and_leaves_its_results_in_the_project(studio: Studio, jobs: Jobs) -> None:
    row = jobs.start(learning(), DEVICES)
    assert row.button == "builtin:mx-clear"
    assert row.left_s == pytest.approx(remaining_s(learning(), "", 0.0, 0.0), abs=0.5)
    follower = Follower(jobs, row.job)
    row = follower.over()
    assert (row.state, row.line, row.simulated) == ("done", "", True)
    assert (row.stage, row.left_s) == ("probe", None)
    presses = [event for event in follower.events if isinstance(event, PressEvent)]
    # one press without compensation, one with it; this rig has no exciter
    learned_in = len(presses) - 2
    assert [p.stage for p in presses] == ["baseline", *["compensate"] * learned_in, "probe"]
    assert [(p.done, p.total) for p in presses[1:-1]] == [(i + 1, learned_in) for i in range(learned_in)]
    assert follower.numbers == list(range(row.events))
    assert set(row.results) == {
        JobResult("actuation", "clear"),
        JobResult("measured", "clear"),
        JobResult("rig", "twin-recommended"),
    }
    learned = load_actuation(studio.project / "actuations" / "clear.actuation.json")
    outcome = next(e for e in follower.events if isinstance(e, JobOutcome) and e.stage == "compensate")
    kept = [round(error, 3) for error in learned.outcome.curves[0].error_cN]
    assert kept == list(outcome.curves[0].error_cN)
    # a page that comes back, to this studio or to the next one, gets the events from its number on
    assert Follower(jobs, "0001", 3).events == follower.events[3:]
    studio.close()
    again = Studio(studio.project)
    late = Follower(again.part(Jobs), "0001", 3)
    assert (late.numbers[0], late.events) == (3, follower.events[3:])
    again.close()


@pytest.fixture
def _in_the_background() -> Iterator[None]:
    """Ignore Ctrl-C, as what a shell starts in the background does."""
    before = signal.signal(signal.SIGINT, signal.SIG_IGN)
    yield
    signal.signal(signal.SIGINT, before)


@pytest.mark.usefixtures("_in_the_background")
def test_work_that_is_stopped_goes_on_where_it_stopped(jobs: Jobs) -> None:
    follower = begin(jobs, long_learning())
    follower.wait(pressed)
    with pytest.raises(InputError, match="twin is used by job 1, Compensate mx-clear on twin"):
        jobs.start(tuning(), DEVICES)
    assert [row.job for row in jobs.rows()] == ["0001"]
    asked_s = time.monotonic()
    jobs.cancel("0001")
    row = follower.over()
    # by itself, not by force
    assert time.monotonic() - asked_s < LETTING_GO_s
    assert (row.state, row.resumable) == ("cancelled", True)
    made = row.done
    assert 0 < made < PRESSES
    jobs.resume("0001", DEVICES)
    row = follower.over()
    assert (row.state, follower.learned_from) == ("done", PRESSES)
    used = [event.done for event in follower.events if pressed(event) and not event.skipped]
    # no press is made twice; one that was on file when it stopped may not have been reported
    assert used == sorted(set(used))
    assert set(range(1, PRESSES + 1)) - set(used) <= {made + 1}


@pytest.mark.clock
@pytest.mark.slow
def test_work_stops_by_itself_where_no_process_can_be_sent_ctrl_c(
    jobs: Jobs, monkeypatch: pytest.MonkeyPatch
) -> None:
    follower = begin(jobs, long_learning())
    follower.wait(pressed)
    asked_s = time.monotonic()
    with monkeypatch.context() as windows:
        windows.setattr("sys.platform", "win32")
        jobs.cancel("0001")
    row = follower.over()
    assert time.monotonic() - asked_s < LETTING_GO_s
    assert (row.state, row.resumable) == ("cancelled", True)
    assert 0 < row.done < PRESSES


def test_work_that_fails_says_why_and_a_damaged_job_hinders_no_other(tmp_path: Path) -> None:
    folder = tmp_path / "jobs" / "0007"
    folder.mkdir(parents=True)
    (folder / JOB).write_text("{")
    jobs = Studio(tmp_path).part(Jobs)
    assert jobs.rows() == ()
    row = begin(jobs, learning(device="host", rig="voltage")).over()
    assert (row.job, row.state) == ("0008", "failed")
    assert "no force sensor" in row.line
    assert "\n" not in row.line


def test_questions_are_answered_once_each_and_the_best_becomes_a_button(studio: Studio, jobs: Jobs) -> None:
    follower = Follower(jobs, jobs.start(tuning(), DEVICES).job)
    for number in (1, 2):
        question = follower.wait(lambda e, n=number: isinstance(e, QuestionAsked) and e.number == n)  # type: ignore[misc]
        assert jobs.job("0001").row.state == "needs you"
        with pytest.raises(InputError, match="does not wait"):
            jobs.answer("0001", number + 1, "first")
        with pytest.raises(InputError, match="cannot be 'best'"):
            jobs.answer("0001", number, "best")
        jobs.answer("0001", number, "first")
        assert isinstance(question, QuestionAsked)
        assert len(question.waves) == 2
    row = follower.over()
    assert (row.state, row.results) == ("done", (JobResult("button", "clear tuned"),))
    assert [e.answer for e in follower.events if isinstance(e, QuestionAnswered)] == ["first", "first"]
    assert studio.catalog.model("own:clear tuned").vibrations


@pytest.mark.slow
def test_a_process_that_is_killed_loses_nothing_that_was_reported(jobs: Jobs) -> None:
    follower = begin(jobs, long_learning())
    follower.wait(pressed)
    start = jobs.job("0001").start
    assert start
    os.kill(start.pid, signal.SIGKILL)
    row = follower.over()
    assert (row.state, row.resumable) == ("failed", True)
    assert "status -9" in row.line
    made = row.done
    jobs.resume("0001", DEVICES)
    row = follower.over()
    assert (row.state, follower.learned_from) == ("done", PRESSES)
    assert made > 0


SERVER = """
import sys, time
from pathlib import Path
from fdvv_studio.studio.studio import Studio
from fdvv_studio.studio.jobs.jobs import Jobs
from tests.studio.jobs import DEVICES, PATIENCE_s, PRESSES, Follower, learning, long_learning, tuning
jobs = Studio(Path(sys.argv[1])).part(Jobs)
follower = Follower(jobs, jobs.start(long_learning(), DEVICES).job)
follower.wait(lambda event: type(event).__name__ == "PressEvent")
print(jobs.job("0001").start.pid, flush=True)
time.sleep(60)
"""


@pytest.mark.slow
def test_work_of_a_studio_that_was_killed_is_found_and_gone_on_with(tmp_path: Path) -> None:
    root = Path(__file__).resolve().parents[4]
    server = subprocess.Popen(
        [sys.executable, "-c", SERVER, str(tmp_path)], stdout=subprocess.PIPE, text=True, cwd=root
    )
    assert server.stdout
    child = int(server.stdout.readline())
    server.kill()
    server.wait()
    server.stdout.close()
    until_s = time.monotonic() + PATIENCE_s
    while Path(f"/proc/{child}").exists():
        assert time.monotonic() < until_s, "the work goes on without its studio"
        time.sleep(0.02)
    studio = Studio(tmp_path)
    jobs = studio.part(Jobs)
    row = jobs.job("0001").row
    assert (row.state, row.line, row.resumable) == ("cancelled", BROKEN_OFF, True)
    follower = Follower(jobs, jobs.resume("0001", DEVICES).job)
    assert (follower.over().state, follower.learned_from) == ("done", PRESSES)
    studio.close()


@pytest.mark.slow
def test_a_capture_becomes_a_button_of_the_persons_own(studio: Studio, jobs: Jobs) -> None:
    order = CaptureOrder("my clear", settings=CaptureSettings(paces_mm_s=(50.0, 100.0), presses=3))
    row = Follower(jobs, jobs.start(order, DEVICES).job).over()
    assert row.state == "done", row.line
    model = studio.catalog.model("own:my clear")
    assert model.provenance.simulated
    assert {curve.velocity_mm_s for curve in model.curves} >= {50.0, 100.0}
    assert load_model(studio.project / "buttons" / "my clear.fdvv.json") == model
    again = Follower(jobs, jobs.start(order, DEVICES).job).over()
    assert {result.name for result in again.results} == {"my clear 2"}
