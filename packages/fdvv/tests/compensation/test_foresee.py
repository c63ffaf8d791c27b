"""The change of motion against the equation it states, solved by SciPy."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from fdvv.compensation.rig_learning import FingerJoint, predict_change
from fdvv.compensation.stroke_samples import StrokeSample
from fdvv.units import FloatArray

GRID_mm = np.linspace(0.0, 4.0, 81)
FINGER = FingerJoint()


def stroke(
    excess_cN: FloatArray, target_cN: FloatArray, tick_s: float, speed_mm_s: float = 100.0
) -> StrokeSample:
    """Go down evenly, feeling the target and an excess, (n,)."""
    x = 0.1 + speed_mm_s * tick_s * np.arange(excess_cN.size, dtype=np.float64)
    v, a = np.full(x.size, speed_mm_s), np.zeros(x.size)
    rendered = np.interp(x, GRID_mm, target_cN) + excess_cN
    return StrokeSample(x, v, a, rendered, np.zeros(x.size), tick_s, speed_mm_s)


def solved(one: StrokeSample, target_cN: FloatArray, finger: FingerJoint) -> FloatArray:
    """Solve m q'' + b q' + k q = rendered - target(x + q), in SI; return (q, q', q'') in mm, mm/s, m/s2."""
    t = one.tick_s * np.arange(1, one.rendered_cN.size + 1)
    mass, damping, stiffness = 1e-3 * finger.mass_g, finger.damping_N_s_m, finger.stiffness_N_m

    def slope(at_s: float, state: FloatArray) -> list[float]:
        x_mm, rendered = np.interp(at_s, t, one.displacement_mm), np.interp(at_s, t, one.rendered_cN)
        excess_N = 0.01 * (rendered - np.interp(x_mm + 1e3 * state[0], GRID_mm, target_cN))
        return [state[1], (excess_N - damping * state[1] - stiffness * state[0]) / mass]

    found = solve_ivp(slope, (0.0, t[-1]), [0.0, 0.0], t_eval=t, rtol=1e-8, atol=1e-10, max_step=one.tick_s)
    bent = np.array([slope(at, state)[1] for at, state in zip(t, found.y.T, strict=True)])
    return np.array([1e3 * found.y[0], 1e3 * found.y[1], bent])


def wave(count: int, tick_s: float) -> FloatArray:
    return np.asarray(15.0 * np.sin(2 * np.pi * 30.0 * tick_s * np.arange(count)))


FINGERS = [FINGER, FingerJoint(4.0, 2.0, 300.0), FingerJoint(16.0, 0.0, 1200.0)]


@pytest.mark.parametrize("finger", FINGERS, ids=["nominal", "light", "heavy, undamped"])
@pytest.mark.parametrize("slope_cN_mm", [0.0, 10.0, -30.0])
def test_it_solves_the_equation_it_states(finger: FingerJoint, slope_cN_mm: float) -> None:
    target, tick_s = 60.0 + slope_cN_mm * GRID_mm, 2.5e-5
    one = stroke(wave(1400, tick_s), target, tick_s)
    for mine, true in zip(
        predict_change(one, target, GRID_mm, finger), solved(one, target, finger), strict=True
    ):
        assert np.abs(mine - true).max() < 0.03 * np.abs(true).max()


def test_a_board_s_tick_is_fine_enough() -> None:
    target = 60.0 + 5.0 * GRID_mm
    for tick_s in (2.5e-4, 1e-3):
        one = stroke(wave(round(0.035 / tick_s), tick_s), target, tick_s)
        true = solved(one, target, FINGER)
        q = predict_change(one, target, GRID_mm, FINGER)[0]
        assert np.abs(q - true[0]).max() < 0.1 * np.abs(true[0]).max()


def test_over_a_bump_it_stays_close_though_the_slope_is_taken_where_the_stroke_was() -> None:
    target, tick_s = 60.0 + 15.0 * np.exp(-(((GRID_mm - 1.5) / 0.4) ** 2)), 2.5e-5
    one = stroke(wave(1400, tick_s), target, tick_s)
    true = solved(one, target, FINGER)
    q = predict_change(one, target, GRID_mm, FINGER)[0]
    assert np.abs(q - true[0]).max() < 0.15 * np.abs(true[0]).max()


def test_nothing_changes_where_the_target_was_felt() -> None:
    target = 60.0 + 15.0 * np.sin(3.0 * GRID_mm)
    for change in predict_change(stroke(np.zeros(140), target, 2.5e-4), target, GRID_mm, FINGER):
        np.testing.assert_allclose(change, 0.0, atol=1e-9)


@pytest.mark.parametrize("slope_cN_mm", [0.0, 20.0])
def test_a_constant_excess_ends_at_what_the_springs_give(slope_cN_mm: float) -> None:
    target = 60.0 + slope_cN_mm * GRID_mm
    slow = stroke(np.full(3000, 12.0), target, 2.5e-4, 5.0)
    q, dv, da = (change[-1] for change in predict_change(slow, target, GRID_mm, FINGER))
    assert q == pytest.approx(12.0 / (60.0 + slope_cN_mm), rel=1e-3)
    assert (dv, da) == pytest.approx((0.0, 0.0), abs=1e-3)
