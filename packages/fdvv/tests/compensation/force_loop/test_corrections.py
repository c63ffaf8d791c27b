"""What a stroke on a closed loop teaches its target."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from fdvv.compensation.force_loop.gains import design_controller
from fdvv.compensation.force_loop.response import LoopResponse, StrokeCorrection
from fdvv.compensation.force_loop.stability import LoopPlant
from fdvv.errors import ModelError
from fdvv.units import FloatArray

PLANT = LoopPlant(0.012, 4e-4, 0.5, 5e5, 20.0, 5e-5, 4e-5, 8e-5)
GRID_mm: FloatArray = np.arange(81, dtype=np.float64) * 0.05
TICK_s = 1e-4


def stroke(target_cN: FloatArray, speed_mm_s: float = 100.0, downward: bool = True) -> StrokeCorrection:
    response = LoopResponse(PLANT, design_controller(PLANT))
    return StrokeCorrection(GRID_mm, target_cN, speed_mm_s, downward, 4.0, response, TICK_s)


def motion(speed_mm_s: float = 100.0) -> FloatArray:
    return np.arange(0.0, 4.0, speed_mm_s * TICK_s)


def bump() -> FloatArray:
    return np.asarray(40.0 + 20.0 * np.exp(-(((GRID_mm - 1.5) / 0.2) ** 2)) + 5.0 * GRID_mm)


def test_a_stroke_on_its_target_teaches_nothing() -> None:
    x, row = motion(), np.zeros(GRID_mm.size)
    one = stroke(bump())
    force = np.interp(x, GRID_mm, bump())
    assert one.step_cN(x, force) == pytest.approx(0.0, abs=1e-9)
    assert one.press_error(x, force, row).max_cN < 1.5  # a bin is as wide as the bump is curved


def test_an_even_error_is_corrected_by_its_size_where_the_loop_holds_the_force() -> None:
    x = motion()
    one = stroke(bump())
    step = one.step_cN(x, np.interp(x, GRID_mm, bump()) - 3.0)
    low_mm, high_mm = one.holding_range_mm
    assert step[(GRID_mm > 0.6) & (GRID_mm < 3.6)] == pytest.approx(3.0, abs=0.4)
    assert np.abs(step[(GRID_mm < low_mm - 0.2) | (GRID_mm > high_mm + 0.2)]).max(initial=0.0) < 0.1


def test_a_wild_stroke_is_learned_in_steps() -> None:
    x = motion()
    assert np.abs(stroke(bump()).step_cN(x, np.full(x.size, -200.0))).max() == 15.0


def test_at_higher_speed_the_loop_holds_the_force_later() -> None:
    assert stroke(bump(), 200.0).holding_range_mm[0] > stroke(bump(), 50.0).holding_range_mm[0]


def test_a_stroke_that_was_not_recorded_is_refused() -> None:
    with pytest.raises(ModelError, match="not recorded"):
        stroke(bump()).press_error(np.zeros(3), np.zeros(3), np.zeros(GRID_mm.size))


@pytest.mark.parametrize("downward", [True, False])
def test_nothing_is_foreseen_for_an_even_force(downward: bool) -> None:
    assert stroke(np.full(GRID_mm.size, 50.0), 200.0, downward).foreseen_cN() == pytest.approx(0.0, abs=1e-9)


def test_the_faster_the_stroke_the_more_is_foreseen_at_a_bump() -> None:
    sizes = [np.abs(stroke(bump(), speed).foreseen_cN()).max() for speed in (25.0, 50.0, 100.0, 200.0)]
    assert sizes == sorted(sizes)
    assert sizes[0] < 1.0 < sizes[-1]


@pytest.mark.parametrize("downward", [True, False])
def test_a_hand_that_speeds_up_and_slows_down_needs_less_force_where_it_pushes_the_cap_on(
    downward: bool,
) -> None:
    """The cap is hurried downward in the upper half of a press, and slowed down there in a release."""
    needed = stroke(bump(), 200.0, downward).hand_cN()
    upper, lower = needed[(GRID_mm > 0.5) & (GRID_mm < 1.5)], needed[(GRID_mm > 3.0) & (GRID_mm < 3.7)]
    assert upper.max() < -0.5
    assert lower.min() > 0.5


def test_what_the_cap_itself_needs_grows_with_the_square_of_speed_and_less_with_a_tighter_loop() -> None:
    slow, fast = (stroke(bump(), v).hand_cN()[10:74] for v in (100.0, 200.0))
    assert np.abs(fast).mean() == pytest.approx(4.0 * np.abs(slow).mean(), rel=0.3)
    open_loop = replace(design_controller(PLANT), proportional=0.0, derivative_s=0.0, integral_1_s=0.0)
    bare = replace(stroke(bump(), 200.0), response=LoopResponse(PLANT, replace(open_loop, damping_N_s_m=0.0)))
    acceleration = bare.response.residual_N(np.full(300, 10.0), TICK_s)[200]
    assert acceleration == pytest.approx(10.0 * (PLANT.mass_kg + PLANT.plate_kg), rel=0.05)
    assert np.abs(fast).max() < 0.5 * np.abs(1e2 * acceleration)
