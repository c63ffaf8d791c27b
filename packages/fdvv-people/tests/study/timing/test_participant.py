"""A timing session from the first page to the last: what is due, what counts, what is hidden, who is due."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from fdvv.errors import ModelError
from fdvv.model.model import FDVVModel
from fdvv_people.study.admin.progress import study_progress
from fdvv_people.study.files.chained_log import read_chained
from fdvv_people.study.timing.events import RoundKept
from fdvv_people.study.timing.participant import TimingParticipant
from fdvv_people.study.timing.plan import DAY_s
from fdvv_people.study.timing.state import TimingState
from tests.support.studies import PASSPHRASE
from tests.support.timing import SMALL, TIMING, Clock, do_all, do_step, frozen, late_s, press

TAPPING = SMALL.split("[[conditions]]")[0].replace('levels = ["easy", "hard"]', 'task = "tapping"\ntap_s = 3')
TAPPING = (
    TAPPING.split("[training]")[0]
    + """
[[conditions]]
name = "red"
kind = "button"
button = "mx-red"
[[conditions]]
name = "fast"
kind = "program"
button = "fast-tapping"
"""
)


def begun(tmp_path: Path, text: str = SMALL) -> tuple[TimingParticipant, str, Clock]:
    clock = Clock()
    participant, code = TimingParticipant.enrol(frozen(tmp_path / "study", text), clock=clock)
    return participant, code, clock


def test_a_whole_session_trains_waits_a_week_and_validates(tmp_path: Path) -> None:
    one, code, clock = begun(tmp_path)
    with one:
        steps = list(do_all(one, clock, until="wait"))
        assert [step.kind for step in steps] == ["page", *["trial"] * 4]
        assert [step.trial.level for step in steps[1:]] == ["easy", "easy", "hard", "hard"]
        wait = one.step()
        assert wait.kind == "wait"
        assert wait.due_at.startswith("2026-")
    again = TimingParticipant.resume(one.study, one.person, code, clock=clock)
    with again:
        assert again.step().kind == "wait"
        clock.now_s += 6.9 * DAY_s
        assert again.step().kind == "wait"
        with pytest.raises(ModelError, match="not ready"):
            again.begin(4, "page")
        clock.now_s += 0.2 * DAY_s
        steps = list(do_all(again, clock))
        assert [step.kind for step in steps].count("place") == 2
        assert [step.at for step in steps if step.kind == "trial"] == list(range(1, 9))
        assert again.step().kind == "done"
        assert again.step().progress == 1.0
    assert one.study.person(one.person).state == "finished"
    assert one.study.verify(passphrase=PASSPHRASE) == ()


def test_a_score_is_the_mean_of_what_was_kept(tmp_path: Path) -> None:
    one, _, clock = begun(tmp_path)
    with one:
        list(do_all(one, clock, until="wait"))
        found = one.state.scores[1]["asynchrony_ms"].value
    assert found == pytest.approx(1e3 * sum(late_s(1, round_) for round_ in (1, 2, 3)) / 3, abs=1e-6)


def test_a_trial_that_was_broken_off_goes_on_at_its_next_round(tmp_path: Path) -> None:
    one, code, clock = begun(tmp_path)
    do_step(one, one.step(), clock)
    one.begin(0, "page")
    press(one, 0, 1)
    design = one.state.designs[0].design
    one.close()
    with TimingParticipant.resume(one.study, one.person, code, clock=clock) as again:
        assert (again.step().kept, again.step().rounds) == (1, 3)
        trial = again.begin(0, "page")
        assert (trial.kept, trial.attempt) == (1, 2)
        assert again.state.designs[0].design == design
        press(again, 0, 2)
        press(again, 0, 3)
        assert again.state.scores[0]["asynchrony_ms"].value == pytest.approx(1.2, abs=1e-6)


def test_taps_before_a_break_do_not_count(tmp_path: Path) -> None:
    one, code, clock = begun(tmp_path, TAPPING)
    one.begin(0, "page")
    one.keep(0, None, (0.1, 0.2), TIMING)
    one.close()
    with TimingParticipant.resume(one.study, one.person, code, clock=clock) as again:
        assert again.begin(0, "page").kept == 0
        for second in range(3):
            found = again.keep(0, None, tuple(second + 0.125 * i for i in range(8)), TIMING)
        assert found.finished
        assert again.state.scores[0]["rate_Hz"].value == pytest.approx(8.0)
        # they are on record all the same
        assert len(again.state.rounds[0]) == 4


def test_a_design_is_on_the_disk_before_anybody_presses_it(tmp_path: Path) -> None:
    one, _, clock = begun(tmp_path)
    do_step(one, one.step(), clock)
    trial = one.begin(0, "page")
    assert isinstance(trial.button, FDVVModel)
    path = one.study.folder / "people" / one.person / "session.jsonl"
    words = [next(iter(record)) for record in read_chained(path).records]
    assert words == ["began", "page", "designed", "begun"]
    one.close()


def test_every_press_is_in_the_log_with_its_latencies(tmp_path: Path) -> None:
    one, _, clock = begun(tmp_path)
    do_step(one, one.step(), clock)
    one.begin(0, "page")
    press(one, 0, 1)
    path = one.study.folder / "people" / one.person / "session.jsonl"
    kept = TimingState.event_of(read_chained(path).records[-1])
    assert isinstance(kept, RoundKept)
    assert kept.timing == TIMING
    assert kept.activations_s == (10.0 + late_s(0, 1),)
    one.close()


def test_a_design_that_no_rig_can_hold_is_avoided_and_a_button_is_missing(tmp_path: Path) -> None:
    one, _, clock = begun(tmp_path)
    with one:
        do_step(one, one.step(), clock)
        one.begin(0, "device")
        assert one.fail(0, "too stiff").number == 1
        assert one.state.failed == {0: "too stiff"}
        list(do_all(one, clock, until="wait"))
        clock.now_s += 8 * DAY_s
        while (step := one.step()).kind == "place":
            do_step(one, step, clock)
        one.begin(step.number, "device")
        one.fail(step.number, "too stiff")
        assert one.state.skipped == {step.number}
        # why is for the key holder alone
        path = one.study.folder / "people" / one.person
        assert "stiff" not in path.joinpath("sealed.jsonl").read_text()
        assert path.joinpath("session.jsonl").read_text().count("too stiff") == 1


def test_a_device_that_goes_away_costs_no_kept_round(tmp_path: Path) -> None:
    one, _, clock = begun(tmp_path)
    with one:
        do_step(one, one.step(), clock)
        one.begin(0, "device")
        press(one, 0, 1)
        assert one.interrupt("unplugged").kept == 1
        with pytest.raises(ModelError, match="not under way"):
            press(one, 0, 2)
        assert one.begin(0, "device").kept == 1


def test_nobody_but_the_key_holder_learns_what_a_code_hides(tmp_path: Path) -> None:
    one, _, clock = begun(tmp_path)
    with one:
        list(do_all(one, clock))
    said = b"".join(path.read_bytes() for path in (one.study.folder / "people").rglob("*") if path.is_file())
    assert b"table" in said
    assert not any(name in said for name in (b"optimised", b"MX Red", b"mx-red"))


def test_a_round_that_is_not_the_next_one_is_refused(tmp_path: Path) -> None:
    one, _, clock = begun(tmp_path)
    with one:
        with pytest.raises(ModelError):
            one.begin(0, "page")
        do_step(one, one.step(), clock)
        with pytest.raises(ModelError):
            one.begin(1, "page")
        with pytest.raises(ModelError):
            press(one, 0, 1)


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
