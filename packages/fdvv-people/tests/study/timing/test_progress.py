"""Who is due: training, a week, and the words that call people back."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from fdvv_people.study.admin.progress import study_progress
from fdvv_people.study.timing.participant import TimingParticipant
from fdvv_people.study.timing.plan import DAY_s
from tests.support.timing import Clock, do_all, do_step, frozen


def seen(one: TimingParticipant, clock: Clock) -> Any:
    return study_progress(one.study, clock())[0]


def test_a_person_is_in_training_waits_is_due_overdue_and_done(tmp_path: Path) -> None:
    clock = Clock()
    one, code = TimingParticipant.enrol(frozen(tmp_path / "study"), clock=clock)
    do_step(one, one.step(), clock)
    assert seen(one, clock).phase == "training"
    list(do_all(one, clock, until="wait"))
    one.close()
    waiting = seen(one, clock)
    assert (waiting.phase, waiting.done, waiting.trials, waiting.rounds) == ("waiting", 4, 12, 12)
    assert waiting.reminder == f"P01, come from {waiting.due_at[:10]} on."
    clock.now_s += 7 * DAY_s
    assert seen(one, clock).phase == "due"
    clock.now_s += 8 * DAY_s
    assert seen(one, clock).phase == "overdue"
    with TimingParticipant.resume(one.study, one.person, code, clock=clock) as again:
        while again.step().kind == "place":
            do_step(again, again.step(), clock)
        again.begin(again.step().number, "page")
        found = seen(again, clock)
        assert (found.phase, found.reminder) == ("validation", "")
        list(do_all(again, clock))
    assert seen(one, clock).phase == "done"
