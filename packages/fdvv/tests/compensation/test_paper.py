"""The law of one curve against the theory of learning laws."""

from collections.abc import Callable
from itertools import pairwise
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fdvv.compensation.paper import PaperLaw
from fdvv.compensation.tables import CurveState, GainSchedule, bump_kept_ratio, grid_mm
from fdvv.errors import ModelError
from fdvv.model.file import load_builtin
from fdvv.units import FloatArray

GRID = grid_mm(4.0, 0.05)
TARGET = load_builtin("mx-clear").force_cN(GRID, 50.0, "press")
LIMIT = 440.0


def plain(gain: float, **changes: object) -> PaperLaw:
    """Make eq. 2 with a constant gain and nothing else."""
    bare = {"gain": GainSchedule.constant(gain), "start": "target", "smoothing_mm": 0.0}
    return PaperLaw.literal(**{**bare, **changes})


def run(law: PaperLaw, plant: Callable[[FloatArray], FloatArray], presses: int) -> list[CurveState]:
    """Press a plant and return the state after each press."""
    states = [law.init(TARGET, GRID, LIMIT)]
    for _ in range(presses):
        states.append(law.step(plant(states[-1].command_cN), states[-1])[1])
    return states


@pytest.mark.parametrize(("plant_gain", "gain"), [(1.0, 0.3), (0.8, 0.5), (1.3, 0.6), (0.5, 1.5)])
def test_the_error_shrinks_by_one_less_plant_gain_times_learning_gain(plant_gain: float, gain: float) -> None:
    states = run(plain(gain, rounds=1, presses_per_round=20), lambda u: plant_gain * u + 12.0, 12)
    sizes = [np.abs(TARGET - plant_gain * s.command_cN - 12.0) for s in states]
    for before, after in pairwise(sizes):
        np.testing.assert_allclose(after, abs(1 - plant_gain * gain) * before, atol=1e-9)


@settings(max_examples=25)
@given(st.floats(0.4, 1.6), st.floats(-60, 60), st.floats(0.2, 1.0))
def test_the_law_converges_on_any_gain_and_offset_within_its_bound(
    plant_gain: float, offset: float, gain: float
) -> None:
    state = run(plain(gain, rounds=1, presses_per_round=400), lambda u: plant_gain * u + offset, 399)[-1]
    # 1 - g gain lies within 0.92 at worst: 0.92^399 of at most 160 cN
    assert np.abs(TARGET - plant_gain * state.command_cN - offset).max() < 1e-9


def test_noise_leaves_the_variance_that_theory_predicts() -> None:
    sigma, gain, plant_gain = 2.0, 0.4, 0.9
    random = np.random.default_rng(7)
    law = plain(gain, rounds=1, presses_per_round=10_000)
    states = run(law, lambda u: plant_gain * u + sigma * random.standard_normal(u.size), 1500)
    learned = np.stack([TARGET - plant_gain * s.command_cN for s in states[100:]])
    loop = gain * plant_gain
    predicted = sigma**2 * loop / (2 - loop)
    # (1400 presses x 81 bins) with a correlation of (1 - loop)^2 per press: 1 % standard error
    assert learned.var() == pytest.approx(predicted, rel=0.04)


def test_the_table_kept_is_never_worse_than_the_first_one_it_measured() -> None:
    random = np.random.default_rng(3)
    law = plain(1.9, rounds=1, presses_per_round=12)
    state = run(law, lambda u: 1.2 * u + 5 * random.standard_normal(u.size), 12)[-1]
    assert state.rounds[0].error_cN == min(state.errors_cN) == state.errors_cN[0]
    np.testing.assert_array_equal(law.done(state).command_cN, TARGET)


def test_a_round_keeps_its_best_command_and_the_table_is_their_mean() -> None:
    law = plain(0.3, rounds=2, presses_per_round=5)
    state = run(law, lambda u: u + 10.0, 10)[-1]
    assert law.is_finished(state)
    best = TARGET - 10.0 * (1 - 0.7**4)
    for kept in state.rounds:
        np.testing.assert_allclose(kept.command_cN, best)
        assert kept.max_error_cN == pytest.approx(10.0 * 0.7**4)
    np.testing.assert_allclose(law.done(state).command_cN, best)


def test_a_round_from_the_average_goes_on_where_the_last_one_ended() -> None:
    law = plain(0.3, rounds=2, presses_per_round=5, start="average")
    state = run(law, lambda u: u + 10.0, 5)[-1]
    np.testing.assert_allclose(state.command_cN, TARGET - 10.0 * (1 - 0.7**4))


def test_a_random_start_is_one_level_that_the_seed_repeats() -> None:
    first, again, other = (plain(0.3, start="random", seed=s).init(TARGET, GRID, LIMIT) for s in (1, 1, 2))
    assert np.ptp(first.command_cN) == 0
    np.testing.assert_array_equal(first.command_cN, again.command_cN)
    assert first.command_cN[0] != other.command_cN[0]


def test_commands_stay_within_the_limit() -> None:
    law = plain(1.0, rounds=1, presses_per_round=50)
    state = law.init(TARGET, GRID, 60.0)
    for _ in range(20):
        _, state = law.step(np.full(GRID.size, -500.0), state)
    assert np.abs(state.command_cN).max() == 60.0


def test_bins_that_were_not_visited_learn_nothing_in_the_literal_law() -> None:
    law = plain(0.5)
    state = law.init(TARGET, GRID, LIMIT)
    rendered = np.where((GRID > 1) & (GRID < 3), TARGET - 10, np.nan)
    command, _ = law.step(rendered, state)
    change = command - state.command_cN
    np.testing.assert_allclose(change[np.isfinite(rendered)], 5.0)
    np.testing.assert_array_equal(change[np.isnan(rendered)], 0.0)


def test_held_ends_carry_the_correction_of_the_nearest_visited_bin() -> None:
    law = plain(0.5, hold_ends=True)
    rendered = np.where((GRID > 1) & (GRID < 3), TARGET - 10 * GRID, np.nan)
    state = law.init(TARGET, GRID, LIMIT)
    change = law.step(rendered, state)[0] - state.command_cN
    np.testing.assert_allclose(change[0], 0.5 * 10 * 1.05)
    np.testing.assert_allclose(change[-1], 0.5 * 10 * 2.95)


def test_the_cap_is_held_up_at_home_and_only_there() -> None:
    law = plain(1.0, hold_cN=50.0, rounds=1, presses_per_round=9)
    command, _ = law.step(np.full(GRID.size, 300.0), law.init(TARGET, GRID, LIMIT))
    np.testing.assert_array_equal(command[:3], 50.0)
    assert (command[3:] < 0).all()


def test_the_filter_leaves_the_target_itself_alone() -> None:
    law = plain(0.5, filter_mm=0.3, rounds=1, presses_per_round=9)
    command, _ = law.step(TARGET - 4.0, law.init(TARGET, GRID, LIMIT))
    np.testing.assert_allclose(command, TARGET + 2.0)


def test_a_curve_that_was_never_pressed_is_the_target_and_says_so() -> None:
    learned = plain(0.3).done(plain(0.3).init(TARGET, GRID, LIMIT))
    np.testing.assert_array_equal(learned.command_cN, TARGET)
    assert "no press" in learned.sentence


def test_the_sentence_tells_what_smoothing_leaves_of_the_bump() -> None:
    law = plain(0.3, smoothing_mm=0.06, rounds=1, presses_per_round=1)
    state = run(law, lambda u: u, 1)[-1]
    kept = bump_kept_ratio(GRID, TARGET, 0.06)
    assert f"sigma 0.06 mm (keeps {kept:.0%} of the target's bump)" in law.done(state).sentence


@pytest.mark.parametrize(
    "wrong",
    [
        {"alpha": 1.2},
        {"bin_mm": 0.0},
        {"rounds": 0},
        {"smoothing_mm": -1.0},
        {"hold_cN": -1.0},
        {"start": "nowhere"},
    ],
)
def test_settings_that_make_no_sense_are_refused(wrong: dict[str, Any]) -> None:
    with pytest.raises(ModelError):
        PaperLaw(**wrong)
