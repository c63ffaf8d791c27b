"""A whole job, and tables between its speeds."""

from dataclasses import replace

import numpy as np
import pytest

from fdvv.compensation.method import CompensationJob, PressCount
from fdvv.compensation.paper import PaperLaw
from fdvv.compensation.per_curve import PerCurve
from fdvv.compensation.tables import GainSchedule
from fdvv.errors import ModelError
from fdvv.model.file import load_builtin
from fdvv.model.press import Press
from fdvv.model.surface import ForceSurface

MODEL = load_builtin("mx-clear")
LAW = PaperLaw.literal(rounds=1, presses_per_round=2, start="target", gain=GainSchedule.constant(0.5))


def job(speeds: tuple[float, ...] = (50.0, 100.0)) -> CompensationJob:
    return CompensationJob(ForceSurface.of_model(MODEL, speeds), MODEL.travel_mm, 440.0)


def press(speed: float = 50.0, depth_mm: float = 4.0, force_cN: float = 0.0) -> Press:
    """Make a press at constant speed, with one force throughout."""
    t = np.arange(0.0, 2 * depth_mm / speed + 0.02, 0.0005)
    down = depth_mm / speed
    x = np.interp(t, [0, down, down + 0.02, 2 * down + 0.02], [0, depth_mm, depth_mm, 0])
    return Press(t, x, np.full(t.size, force_cN), speed)


def test_speeds_take_turns_on_the_whole_surface() -> None:
    method = PerCurve(LAW)
    state, asked = method.init(job()), []
    while (trial := method.trial(state)) is not None:
        asked.append(trial.velocity_mm_s)
        assert trial.surface.velocity_mm_s.size == 2
        state = method.step(press(trial.velocity_mm_s), state)
    assert asked == [50.0, 100.0, 50.0, 100.0]
    assert method.count(state) == PressCount(made=4, total=4, wanted=(2, 2))


def test_one_row_at_a_time_finishes_a_speed_before_the_next() -> None:
    method = PerCurve(LAW, whole_surface=False)
    state, asked = method.init(job()), []
    while (trial := method.trial(state)) is not None:
        asked.append(trial.velocity_mm_s)
        assert trial.surface.velocity_mm_s.tolist() == [trial.velocity_mm_s]
        state = method.step(press(trial.velocity_mm_s), state)
    assert asked == [50.0, 50.0, 100.0, 100.0]


def test_one_press_teaches_both_strokes_of_its_speed_and_no_other() -> None:
    method = PerCurve(LAW)
    before = method.init(job())
    after = method.step(press(50.0), before)
    assert [len(c.errors_cN) for pair in after.pairs for c in pair] == [1, 1, 0, 0]
    for old, new in zip(before.pairs[0], after.pairs[0], strict=True):
        learned = (new.grid_mm > 0.2) & (new.grid_mm < 3.8)
        np.testing.assert_allclose((new.command_cN - old.command_cN)[learned], 0.5 * old.target_cN[learned])


def test_nothing_is_learned_between_the_guard_and_the_stop() -> None:
    method = PerCurve(LAW)
    before = method.init(job())
    after = method.step(press(50.0), before)
    for old, new in zip(before.pairs[0], after.pairs[0], strict=True):
        guarded = (old.grid_mm > 3.93) | (old.grid_mm < 0.07)
        np.testing.assert_array_equal(new.command_cN[guarded], old.command_cN[guarded])


def test_a_release_without_samples_teaches_nothing_and_is_the_reason() -> None:
    t = np.arange(0.0, 0.2, 0.001)
    stuck = Press(t, np.minimum(50 * t, 4.0), np.zeros(t.size), 50.0)
    with pytest.raises(ModelError, match="no sample of the release"):
        PerCurve(LAW).step(stuck, PerCurve(LAW).init(job()))


def test_a_job_that_is_not_finished_says_how_far_it_came() -> None:
    method = PerCurve(LAW)
    outcome = method.done(method.step(press(50.0), method.init(job())))
    assert not outcome.complete
    assert outcome.sentence == "stopped after 1 presses"


def test_the_changes_of_a_press_are_explained_in_numbers_and_the_end_of_a_round_in_words() -> None:
    method = PerCurve(replace(LAW, rounds=2))
    state = method.init(job((50.0,)))
    assert method.explain(state) == ""
    after = method.step(press(), state)
    moved = [
        np.abs(new.command_cN - old.command_cN).max()
        for new, old in zip(after.pairs[0], state.pairs[0], strict=True)
    ]
    message = f"moved the press by up to {moved[0]:.1f} cN, the release by up to {moved[1]:.1f} cN"
    assert method.explain(after) == message
    after = method.step(press(), after)
    assert method.explain(after) == "round 1 of 2 is over; the next round begins"
    for _ in range(2):
        after = method.step(press(), after)
    assert method.explain(after) == "round 2 of 2 is over; the tables are averaged"


def test_a_finished_job_takes_no_press() -> None:
    method = PerCurve(LAW)
    state = method.init(job((50.0,)))
    for _ in range(2):
        state = method.step(press(), state)
    with pytest.raises(ModelError, match="finished"):
        method.step(press(), state)
