"""People whose best buttons differ: what is drawn, and what it does to their presses."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from fdvv.errors import InputError
from fdvv.model.file import load_builtin
from fdvv_people.optimize.paper_space import paper_design_like, paper_model
from fdvv_people.optimize.people.groups import DIVERSE, GROUPS, TAPPERS, group_named
from fdvv_people.optimize.people.press_simulator import PressSimulator
from fdvv_people.optimize.people.simulate import simulate_task
from fdvv_people.optimize.people.user import SimulatedUser, UserSettings, draw_user, draw_users
from fdvv_people.optimize.population.plan import PopulationPlan, grid_designs
from fdvv_people.optimize.run.player import about_player, player_of
from fdvv_people.optimize.run.setup import OptimizeSetup
from fdvv_people.task.pointing import TemporalPointing

TASK = TemporalPointing("easy", quantised=False)
RED = load_builtin("mx-red")
STILL = replace(DIVERSE.middle, clock_ratio=1e-9, motor_ms=0.0, percept_ms=0.0, block_ms=0.0)


def late_ms(user: SimulatedUser, depth_mm: float | None = None, seed: int = 0) -> float:
    """Return how late a person is on average, on an MX Red or one that closes elsewhere."""
    model = RED
    if depth_mm is not None:
        model = paper_model({**paper_design_like(RED), "actuation_mm": depth_mm})
    presses = simulate_task(TASK, model, user, seed)
    return float(np.mean([late for press in presses if (late := TASK.asynchrony_ms(press)) is not None]))


def test_the_groups_have_names_and_others_are_refused() -> None:
    assert group_named("paper") == UserSettings()
    assert set(GROUPS) == {"paper", "diverse"}
    with pytest.raises(InputError, match="use one of paper, diverse"):
        group_named("everybody")


def test_tappers_are_the_paper_s_people_with_a_limit() -> None:
    tappers = draw_users(40, 3, TAPPERS)
    assert [replace(one, strokes_Hz=0.0) for one in tappers] == list(draw_users(40, 3))
    assert all(5.0 < one.strokes_Hz < 7.1 for one in tappers)


def test_a_population_is_drawn_of_its_group_and_tries_only_buttons_if_asked_to() -> None:
    plan = PopulationPlan(group="diverse", buttons=True, shifts={"pace_mm_s": 2.0})
    assert plan.user(3).pace_mm_s == pytest.approx(2 * draw_users(4, 0, DIVERSE)[3].pace_mm_s)
    assert {one.name for one in plan.space.constraints} == {"closing force", "snap"}
    assert PopulationPlan().space.constraints == ()
    assert all(plan.space.broken(design) == () for design in grid_designs(True, 20))


def test_a_run_keeps_the_group_of_its_player_and_an_older_one_has_the_paper_s() -> None:
    setup = OptimizeSetup(level="easy", about=about_player(7, "ideal", 20, "diverse"))
    assert player_of(setup).user == draw_user(0, 7, DIVERSE)
    older = OptimizeSetup(level="easy", about={"player": {"person": 7, "rig": "ideal", "presses": 20}})
    assert player_of(older).user == draw_user(0, 7)


def test_the_middle_person_is_as_early_on_a_usual_key_as_people_who_tap() -> None:
    """By 48 ms at this period (Baath and Madison 2012); the paper's people are late."""
    assert late_ms(STILL) == pytest.approx(-48.0, abs=15.0)
    assert late_ms(replace(SimulatedUser(), motor_ms=0.0)) > 50.0


def test_a_deeper_stroke_takes_longer_without_isochrony_and_as_long_with_it() -> None:
    deep = paper_model({**paper_design_like(RED), "actuation_mm": 2.0})
    ideal = replace(STILL, pace_spread_ratio=0.0, stiffness_spread_ratio=0.0)
    draws = {
        (ratio, model.name): PressSimulator(model, replace(ideal, isochrony_ratio=ratio)).draw(
            np.random.default_rng(0)
        )
        for ratio in (0.0, 1.0)
        for model in (RED, deep)
    }
    assert draws[1.0, RED.name].press_s == pytest.approx(draws[1.0, deep.name].press_s)
    lengths = [draw.end_m - draw.start_m for draw in (draws[0.0, RED.name], draws[0.0, deep.name])]
    times = [draws[0.0, model.name].press_s for model in (RED, deep)]
    assert times[1] / times[0] == pytest.approx(lengths[1] / lengths[0], rel=0.05)


def test_who_presses_late_wants_a_shallow_contact_and_who_presses_early_a_deep_one() -> None:
    late, early = replace(STILL, bias_ms=60.0), replace(STILL, bias_ms=-60.0)
    assert abs(late_ms(late, 0.6)) < abs(late_ms(late, 5.0))
    assert abs(late_ms(early, 0.6)) > abs(late_ms(early, 5.0))


def test_a_block_shifts_all_presses_of_a_score_alike() -> None:
    plain = np.array([late_ms(STILL, seed=seed) for seed in range(12)])
    shifted = np.array([late_ms(replace(STILL, block_ms=40.0), seed=seed) for seed in range(12)])
    assert 15.0 < np.std(shifted - plain) < 80.0
    presses = simulate_task(TASK, RED, replace(STILL, block_ms=40.0), 3)
    within = [TASK.asynchrony_ms(press) for press in presses]
    assert np.std(np.array(within, dtype=np.float64)) < 20.0


def test_drawn_people_differ_in_what_they_rely_on_and_keep_to_what_is_possible() -> None:
    people = draw_users(200, 3, DIVERSE)
    rely = np.log([[user.snap_cN, user.impact_mm_s, user.vibration_m_s2] for user in people])
    assert rely.std(axis=0) == pytest.approx([0.7] * 3, rel=0.15)
    assert np.abs(np.corrcoef(rely.T) - np.eye(3)).max() < 0.25
    assert all(0 < user.adaptation_ratio <= 1 for user in people)


def test_a_shaky_hand_presses_less_evenly() -> None:
    steady, shaky = (replace(STILL, effort_noise_ratio=ratio) for ratio in (0.0, 0.3))
    spreads = [
        np.std(
            [press.activations_s[0] - (press.target_s or 0.0) for press in simulate_task(TASK, RED, user, 5)]
        )
        for user in (steady, shaky)
    ]
    assert spreads[0] < spreads[1]
