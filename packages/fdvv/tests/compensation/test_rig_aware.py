"""The method keeps the protocol on presses of a plant in closed form, and changes no state it was given."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from fdvv.compensation.identification.identify import identify
from fdvv.compensation.identification.rig_file import LearnedRig
from fdvv.compensation.identification.rig_model import RigModel
from fdvv.compensation.method import CompensationJob, PressCount, Trial, Tuning
from fdvv.compensation.presses import HOME_mm
from fdvv.compensation.rig_aware import LOOSE_SPEED_TOLERANCE_ratio, RigAware, RigState
from fdvv.compensation.rig_learning import LIFT_cN, PressError, command_cN, least_command_cN
from fdvv.errors import ModelError
from fdvv.model.file import load_builtin
from fdvv.model.surface import ForceSurface
from tests.compensation._plant import Plant, TRAVEL_mm, keep_rows, known_of

MODEL = load_builtin("mx-clear")
SPEEDS_mm_s = np.array([50.0, 100.0, 200.0])
TARGET = ForceSurface.of_model(MODEL, SPEEDS_mm_s)
JOB = CompensationJob(TARGET, TRAVEL_mm, 440.0)
PLANT = Plant(position_noise_mm=0.003, force_noise_cN=0.3, half_play_cN=0.5)
METHOD = RigAware(rounds=2)


def learned_on(known: RigModel, rows_cN: float = 0.0) -> LearnedRig:
    rows = np.full(TARGET.press_cN.shape, rows_cN)
    residual = ForceSurface(TARGET.displacement_mm, SPEEDS_mm_s, rows, -rows)
    return LearnedRig(known, residual, TRAVEL_mm, np.full((2, 3), 2.0))


def pressed(method: RigAware, state: RigState, seed: int) -> RigState:
    trial = method.trial(state)
    assert trial is not None
    return method.step(PLANT.press(trial.velocity_mm_s, seed), state)


@pytest.fixture(scope="module")
def states() -> list[RigState]:
    """Return the state after every press of a whole job."""
    found = [METHOD.init(JOB)]
    while METHOD.trial(found[-1]) is not None:
        found.append(pressed(METHOD, found[-1], len(found)))
    return found


def test_a_job_takes_four_presses_and_the_rounds_at_every_speed(states: list[RigState]) -> None:
    trials = [trial for state in states if (trial := METHOD.trial(state))]
    assert [t.velocity_mm_s for t in trials] == [50, 100, 200, 50, *[50, 100, 200] * 2]
    assert [t.pace_ratio for t in trials] == [float("inf")] * 4 + [LOOSE_SPEED_TOLERANCE_ratio] * 6
    assert [t.tuning == Tuning(paced=True) for t in trials] == [True] * 4 + [False] * 6
    assert len(states) == 11


def test_the_count_is_that_of_the_presses_throughout(states: list[RigState]) -> None:
    for made, state in enumerate(states):
        assert METHOD.count(state) == PressCount(made, 10, (4, 3, 3))


def test_done_works_at_any_time_and_is_complete_at_the_end_alone(states: list[RigState]) -> None:
    outcomes = [METHOD.done(state) for state in states]
    assert [o.complete for o in outcomes] == [False] * 10 + [True]
    assert [o.presses for o in outcomes] == list(range(11))
    for outcome in outcomes:
        assert outcome.surface.press_cN.shape == TARGET.press_cN.shape
        assert np.abs(outcome.surface.press_cN).max() <= 440.0
        assert outcome.sentence
    assert [len(o.curves) for o in outcomes] == [0] * 4 + [6] * 7
    assert outcomes[-1].tuning.bandwidth_Hz == METHOD.bandwidth_Hz


def test_every_press_is_explained(states: list[RigState]) -> None:
    texts = [METHOD.explain(state) for state in states]
    assert texts[:3] == ["", "1 of 4 identification presses", "2 of 4 identification presses"]
    assert "from 4 presses" in texts[4]
    assert all(text.startswith("mean error ") and "tables moved by up to" in text for text in texts[5:])
    assert not any("\n" in text for text in texts)


def test_a_state_is_never_changed_and_a_step_repeats_itself(states: list[RigState]) -> None:
    for made in (3, 6):
        before, tables = states[made], states[made].tables
        rows = tables[0].rows_cN.copy() if tables else None
        again = pressed(METHOD, before, made + 1)
        assert again.message == states[made + 1].message
        assert tables is before.tables
        if rows is not None and tables is not None:
            np.testing.assert_array_equal(tables[0].rows_cN, rows)


def test_the_rig_is_that_of_identification_from_the_same_presses(states: list[RigState]) -> None:
    speeds = [50.0, 100.0, 200.0, 50.0]
    assert states[4].rig == identify([PLANT.press(v, k + 1) for k, v in enumerate(speeds)], TRAVEL_mm)
    assert states[-1].rig is states[4].rig


def test_a_memory_gives_tables_without_a_press() -> None:
    known = known_of(PLANT)
    method = RigAware(rounds=0, learned_rig=learned_on(known, 3.0))
    state = method.init(JOB)
    assert method.trial(state) is None
    assert method.count(state) == PressCount(0, 0, (0, 0, 0))
    outcome = method.done(state)
    assert outcome.complete
    beyond = TARGET.displacement_mm > HOME_mm
    for table, target, more in (
        (outcome.surface.press_cN, TARGET.press_cN, 3.0),
        (outcome.surface.release_cN, TARGET.release_cN, -3.0),
    ):
        learned_cN = command_cN(known, TARGET.displacement_mm, target) + more
        expected_cN = np.maximum(learned_cN, least_command_cN(known, TARGET.displacement_mm, 440.0))
        np.testing.assert_allclose(table[:, beyond], expected_cN[:, beyond])
    assert [c.mean_error_cN for c in outcome.curves] == [2.0] * 6
    with_presses = replace(method, rounds=1)
    assert with_presses.count(with_presses.init(JOB)) == PressCount(0, 3, (1, 1, 1))


def test_an_edited_button_moves_the_tables_by_the_edit_over_the_gain() -> None:
    known = known_of(PLANT)
    method = RigAware(rounds=0, learned_rig=learned_on(known, 3.0))
    bump = 10.0 * np.exp(-(((TARGET.displacement_mm - 2.0) / 0.3) ** 2))
    edited = replace(JOB, target=replace(TARGET, press_cN=TARGET.press_cN + bump))
    before, after = (method.done(method.init(job)).surface for job in (JOB, edited))
    moved, more = after.press_cN - before.press_cN, bump / known.gain_at(TARGET.displacement_mm)
    np.testing.assert_allclose(moved, np.tile(more, (3, 1)), atol=1e-9)
    np.testing.assert_array_equal(after.release_cN, before.release_cN)


def test_the_cap_is_held_up_at_home_and_the_limit_is_kept() -> None:
    known = known_of(PLANT)
    method = RigAware(rounds=0, learned_rig=learned_on(known, -300.0))
    surface = method.done(method.init(JOB)).surface
    home = TARGET.displacement_mm <= HOME_mm
    lift = (LIFT_cN + known.weight_cN) / known.gain_at(TARGET.displacement_mm[home])
    np.testing.assert_allclose(surface.press_cN[:, home], np.tile(lift, (3, 1)))
    low = replace(JOB, force_limit_cN=90.0)
    bounded = method.done(method.init(low)).surface
    assert np.abs(bounded.press_cN).max() <= 90.0
    assert bounded.release_cN.max() == 90.0


def test_in_a_slow_stroke_the_table_takes_off_the_friction_that_the_controller_does_not() -> None:
    known = known_of(PLANT)
    method = RigAware(rounds=0, learned_rig=learned_on(known))
    job = replace(JOB, target=ForceSurface.of_model(MODEL, [5.0, 20.0]))
    surface, grid = method.done(method.init(job)).surface, TARGET.displacement_mm
    beyond, part = grid > HOME_mm, np.array([[0.5], [0.0]])
    for table, force, sign in (
        (surface.press_cN, job.target.press_cN, 1.0),
        (surface.release_cN, job.target.release_cN, -1.0),
    ):
        rub = command_cN(known, grid, force) - table
        np.testing.assert_allclose(
            (rub * known.gain_at(grid))[:, beyond],
            np.broadcast_to(sign * part * known.friction_cN, rub[:, beyond].shape),
            atol=1e-9,
        )


def test_what_was_taught_begins_the_next_job(states: list[RigState]) -> None:
    memory = METHOD.rig_after(states[-1])
    end = METHOD.done(states[-1])
    again = RigAware(rounds=0, learned_rig=memory)
    np.testing.assert_allclose(again.done(again.init(JOB)).surface.press_cN, end.surface.press_cN)
    expected = [c.mean_error_cN for c in again.done(again.init(JOB)).curves]
    assert expected == pytest.approx([c.mean_error_cN for c in end.curves])
    with pytest.raises(ModelError, match="not identified yet"):
        METHOD.rig_after(states[2])


def test_after_a_press_that_went_astray_the_best_row_is_given_and_remembered() -> None:
    method = RigAware(learned_rig=learned_on(known_of(PLANT)))
    start = method.init(JOB)
    count = TARGET.displacement_mm.size
    good, bad = (
        PressError(2.0, 1.0, 4.0, np.full(count, 7.0)),
        PressError(9.0, 6.0, 20.0, np.full(count, -50.0)),
    )
    state = replace(start, errors=(((good, good), (bad, good)), ((good, good),), ()))
    plain, kept = method.done(start).surface, method.done(state).surface
    beyond = TARGET.displacement_mm > HOME_mm
    np.testing.assert_allclose((kept.press_cN - plain.press_cN)[0, beyond], 7.0)
    np.testing.assert_array_equal(kept.press_cN[1:], plain.press_cN[1:])
    np.testing.assert_array_equal(kept.release_cN, plain.release_cN)
    np.testing.assert_array_equal(method.rig_after(state).residual.press_cN[0], 7.0)
    assert method.done(state).curves[0].mean_error_cN == 1.0


TELL_NOTHING: dict[str, Any] = {
    "too few ticks": lambda press: keep_rows(press, slice(0, 30)),
    "not finite": lambda press: replace(press, sensed_cN=np.full(press.t_s.size, np.nan)),
    "no command": lambda press: replace(press, commanded_cN=None),
}


@pytest.mark.parametrize("spoilt", TELL_NOTHING.values(), ids=TELL_NOTHING)
def test_a_press_that_tells_nothing_is_refused_in_one_line_and_changes_nothing(spoilt: Any) -> None:
    method = RigAware(learned_rig=learned_on(known_of(PLANT)))
    state = method.init(JOB)
    with pytest.raises(ModelError) as caught:
        method.step(spoilt(PLANT.press(50.0)), state)
    assert "\n" not in str(caught.value)
    assert method.trial(state) is not None


def test_more_presses_are_asked_for_while_a_rig_cannot_be_known_and_the_last_is_refused() -> None:
    method, state = RigAware(identification_presses=2, max_identification_presses=4), RigAware().init(JOB)
    still = PLANT.press(50.0)
    assert still.sensed_mm is not None
    still = replace(still, sensed_mm=np.zeros(still.t_s.size))
    for made in (1, 2, 3):
        state = method.step(still, state)
        assert method.count(state).made == made
        assert isinstance(method.trial(state), Trial)
    assert "one more press is needed" in method.explain(state)
    with pytest.raises(ModelError, match="cannot be identified"):
        method.step(still, state)


def test_a_press_far_off_its_pace_tells_the_rig_but_not_the_tables() -> None:
    def met(requested_mm_s: float) -> RigState:
        method, job = (
            RigAware(identification_presses=2),
            replace(JOB, target=ForceSurface.of_model(MODEL, [requested_mm_s])),
        )
        state = method.init(job)
        for seed in (1, 2):
            state = method.step(PLANT.press(150.0, seed), state)
        return state

    on, off = met(150.0), met(50.0)
    assert on.rig == off.rig
    assert np.abs(on.rig_and_tables[1][0].rows_cN).max() > 0.5
    np.testing.assert_array_equal(off.rig_and_tables[1][0].rows_cN, 0.0)


@pytest.mark.parametrize(
    "wrong",
    [
        {"rounds": -1},
        {"identification_presses": 0},
        {"identification_presses": 5, "max_identification_presses": 4},
        {"bandwidth_Hz": 0.0},
        {"bin_mm": 0.0},
    ],
)
def test_settings_without_sense_are_refused(wrong: dict[str, Any]) -> None:
    with pytest.raises(ModelError):
        RigAware(**wrong)
