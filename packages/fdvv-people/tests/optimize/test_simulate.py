"""Simulated people press the twin: what a task gets of a design. Simulated."""

from __future__ import annotations

from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace

import numpy as np
import pytest

from fdvv.errors import ModelError
from fdvv.model.curve import ForceCurve, Stroke
from fdvv.model.file import load_builtin
from fdvv.model.model import FDVVModel
from fdvv.program.library import load_shipped
from fdvv.program.surface import flat as flat_surface
from fdvv_people.optimize.people.press_simulator import PressSimulator, refusal_of
from fdvv_people.optimize.people.simulate import score_design, simulate_task
from fdvv_people.optimize.people.user import SimulatedUser
from fdvv_people.task.accuracy import Accuracy
from fdvv_people.task.pointing import LOST_ms, TemporalPointing
from fdvv_people.task.tapping import RapidTapping

EASY = TemporalPointing("easy")
EXACT = replace(EASY, quantised=False)
BROWN = load_builtin("mx-brown")
STILL = SimulatedUser(
    clock_ratio=1e-9,
    motor_ms=0.0,
    percept_ms=0.0,
    rest_spread_cN=0.0,
    pace_spread_ratio=0.0,
    push_spread_ratio=0.0,
    adaptation_ratio=0.0,
    stiffness_spread_ratio=0.0,
)


def flat(force_cN: float, actuation_mm: float = 2.0) -> FDVVModel:
    """Return a button of constant force."""
    knots, points = np.array([0.0, 0.0, 4.0, 4.0]), np.array([force_cN, force_cN])
    curves = tuple(ForceCurve(stroke, None, 1, knots, points) for stroke in Stroke)
    return FDVVModel("flat", 4.0, curves, actuation_mm, actuation_mm - 0.2)


def late_ms(model: FDVVModel, user: SimulatedUser = STILL, seed: int = 0) -> list[float]:
    found = [EXACT.asynchrony_ms(press) for press in simulate_task(EXACT, model, user, seed)]
    assert None not in found
    return [late for late in found if late is not None]


def test_the_same_arguments_give_the_same_presses_and_another_seed_others() -> None:
    user = SimulatedUser()
    first = simulate_task(EASY, BROWN, user, 3)
    assert simulate_task(EASY, BROWN, user, 3) == first
    assert simulate_task(EASY, BROWN, user, 4) != first
    assert simulate_task(EASY, BROWN, replace(user, number=1), 3) != first


def test_threads_do_not_disturb_each_other() -> None:
    user = SimulatedUser()
    alone = [simulate_task(EASY, BROWN, user, seed) for seed in range(4)]
    with ThreadPoolExecutor(2) as pool:
        assert list(pool.map(lambda seed: simulate_task(EASY, BROWN, user, seed), range(4))) == alone


def test_a_deeper_actuation_closes_later_by_the_time_the_finger_takes() -> None:
    """Identity: twenty presses on one force are one motion, so only the way between the points can differ."""
    shallow, deep = late_ms(flat(50.0, 1.0)), late_ms(flat(50.0, 3.0))
    press = PressSimulator(flat(50.0), STILL).press(np.random.default_rng([0, 0]))
    assert press is not None
    at = [np.argmax(press.ticks.displacement_mm >= mm) for mm in (1.0, 3.0)]
    way_ms = 1e3 * (press.t_s[at[1]] - press.t_s[at[0]])
    assert np.mean(deep) - np.mean(shallow) == pytest.approx(way_ms, abs=3.0)


def test_what_a_person_cannot_notice_is_added_to_every_press() -> None:
    base, late = late_ms(BROWN), late_ms(BROWN, replace(STILL, bias_ms=STILL.bias_ms + 20))
    assert np.subtract(late, base) == pytest.approx(np.full(20, 20.0))


def test_one_who_adapts_brings_the_felt_event_to_the_aim() -> None:
    """Oracle: a still person's felt error shrinks by (1 - gain) per press; the key then leads the event."""
    user = replace(STILL, adaptation_ratio=0.5, bias_ms=0.0)
    late = np.array(late_ms(BROWN, user))
    steps = late - late[-1]
    assert steps[1] == pytest.approx(0.5 * steps[0], abs=4.0)
    assert abs(late[-1] - late[-5:].mean()) < 4.0
    assert late[-1] < late[0] - 20


def test_a_button_too_heavy_for_the_finger_is_missed_every_time() -> None:
    weak = replace(SimulatedUser(), push_cN=1.0, pace_mm_s=60.0)
    presses = simulate_task(EASY, flat(400.0, 3.9), weak, 0)
    assert all(not press.activations_s for press in presses)
    assert score_design(EASY, flat(400.0, 3.9), weak, 0)["asynchrony_ms"].value == LOST_ms


def test_a_heavy_resting_finger_triggers_a_light_button_before_the_bullet_comes() -> None:
    heavy = replace(SimulatedUser(), rest_cN=60.0)
    presses = simulate_task(EASY, flat(15.0, 0.6), heavy, 0)
    lost = [EASY.asynchrony_ms(press) is None for press in presses]
    assert np.mean(lost) > 0.9
    assert (
        np.mean([EASY.asynchrony_ms(p) is None for p in simulate_task(EASY, flat(80.0, 0.6), heavy, 0)]) < 0.2
    )


def test_a_design_that_the_firmware_cannot_hold_is_lost_with_the_reason() -> None:
    heavy = flat(900.0)
    assert "900" in refusal_of(heavy)
    assert refusal_of(BROWN) == ""
    assert score_design(EASY, heavy, SimulatedUser(), 0)["asynchrony_ms"].value == LOST_ms


def test_effort_grows_with_the_buttons_force() -> None:
    light, heavy = (
        np.mean([press.effort_N_s or 0.0 for press in simulate_task(EASY, flat(force), STILL, 0)])
        for force in (30.0, 120.0)
    )
    assert heavy > 1.5 * light


@pytest.mark.parametrize("rig", ["paper", "light"])
def test_a_task_is_played_on_rigs_of_real_parts_too(rig: str) -> None:
    score = score_design(EASY, BROWN, SimulatedUser(), 0, rig=rig)["asynchrony_ms"]
    assert 10 < score.value < 150


def test_a_shallow_key_is_tapped_faster_than_a_deep_one() -> None:
    shallow, deep = (
        np.mean(
            [
                score_design(RapidTapping(), flat(50.0, mm), SimulatedUser(), s)["rate_Hz"].value
                for s in (0, 1)
            ]
        )
        for mm in (0.8, 3.5)
    )
    assert shallow > 1.1 * deep


def test_taps_follow_each_other_on_one_clock() -> None:
    presses = simulate_task(RapidTapping(), BROWN, SimulatedUser(), 0)
    keys = [key for press in presses for key in press.activations_s]
    assert len(keys) > 15
    assert (np.diff(keys) > 0.05).all()


def test_a_program_of_the_button_is_tapped_as_its_model_is() -> None:
    """The program `button` is the MX Red with weak forces raised; below its key they are the model's."""
    taps = [
        np.concatenate([press.activations_s for press in simulate_task(RapidTapping(), button, STILL, 3)])
        for button in (load_shipped("button"), load_builtin("mx-red"))
    ]
    assert taps[0] == pytest.approx(taps[1], abs=2e-3)


def test_fast_tapping_is_tapped_faster_than_its_base_by_the_same_hand() -> None:
    fast, base = (
        score_design(RapidTapping(), button, SimulatedUser(), 0)["rate_Hz"].value
        for button in (load_shipped("fast-tapping"), load_builtin("mx-red"))
    )
    assert fast > 1.2 * base


def test_no_more_strokes_are_made_than_a_finger_can() -> None:
    """Of strokes, not keys: each round is one, and the last key's round tells how long they took."""
    task, slow = RapidTapping(60), replace(SimulatedUser(), strokes_Hz=4.0)
    rounds = simulate_task(task, load_shipped("rapid-trigger"), slow, 0)
    keys = [press.activations_s[0] for press in rounds]
    assert (len(keys) - 1) / (keys[-1] - keys[0]) == pytest.approx(4.0, rel=0.05)


def test_a_limit_that_nobody_reaches_changes_no_tap() -> None:
    alone = simulate_task(RapidTapping(), BROWN, SimulatedUser(), 0)
    assert simulate_task(RapidTapping(), BROWN, replace(SimulatedUser(), strokes_Hz=1e3), 0) == alone


def test_programs_are_tapped_and_nothing_else() -> None:
    with pytest.raises(ModelError, match="only tap programs"):
        simulate_task(EASY, load_shipped("fast-tapping"), SimulatedUser(), 0)


def test_a_program_that_is_refused_is_not_tapped() -> None:
    button = load_shipped("button")
    sticks = replace(button, surfaces=tuple(flat_surface(one.name, -20.0) for one in button.surfaces))
    assert "may not lift the cap" in refusal_of(sticks)
    assert all(
        press.activations_s == () for press in simulate_task(RapidTapping(), sticks, SimulatedUser(), 0)
    )


def test_a_twitching_finger_triggers_a_light_key_more_often_than_a_heavy_one() -> None:
    task = Accuracy(rounds=40, also=("false_ratio",))
    heavy_hand = replace(SimulatedUser(), rest_cN=20.0)
    light, heavy = (
        score_design(task, flat(force, 0.8), heavy_hand, 0)["false_ratio"].value for force in (20.0, 90.0)
    )
    assert light > heavy + 0.2
    assert heavy < 0.1


@pytest.mark.parametrize("task", [RapidTapping(), Accuracy()])
def test_every_task_of_a_design_that_cannot_be_held_has_an_outcome(task: RapidTapping | Accuracy) -> None:
    presses = simulate_task(task, flat(900.0), SimulatedUser(), 0)
    assert len(presses) == task.rounds
    assert set(task.scores(presses)) == {one.name for one in task.objectives}


def test_fatigue_and_practice_show_in_the_presses_made_before() -> None:
    tired = replace(SimulatedUser(), fatigue_ratio=0.5)
    assert simulate_task(EASY, BROWN, tired, 0, presses_before=600) != simulate_task(EASY, BROWN, tired, 0)
    assert simulate_task(EASY, BROWN, SimulatedUser(), 0, presses_before=600) == simulate_task(
        EASY, BROWN, SimulatedUser(), 0
    )
