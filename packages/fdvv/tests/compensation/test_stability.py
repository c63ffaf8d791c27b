"""What a sampled loop bears, against a plain simulation in small steps and against closed forms."""

from __future__ import annotations

import numpy as np
import pytest

from fdvv.compensation.feasibility.limits import RigLimits
from fdvv.compensation.feasibility.stability import (
    NominalFinger,
    SampledLoop,
    grain_limit_N_m,
    passive_limit_N_m,
    spectral_radius,
    stability,
    steepest,
    step_limit_cN,
    stiffness_limit_N_m,
)
from fdvv.compensation.identification.rig_model import RigModel
from fdvv.errors import ModelError
from fdvv.protocol.tables import Settings
from fdvv.units import FloatArray
from tests.support.loop import LinearLoop, bare_loop
from tests.support.rig_truth import rig_truth

TICK_s = 2.5e-4
RIG = RigModel((0.9, 0.05, -0.01), 7e-4, 4e-4, 5e-4, 3.0, 2.4, 3.0, 15.0, 25.0)
LIMITS = RigLimits.of_settings(Settings())
FINE = 25
"""Steps of the plain simulation per tick."""


def swing_mm(loop: SampledLoop, stiffness_N_m: FloatArray, ticks: int) -> FloatArray:
    """Release caps 1 mm from rest, one per stiffness, by plain Euler steps; return places at each tick."""
    dt, hand = loop.tick_s / FINE, loop.finger
    x, seen, finger = (np.full(stiffness_N_m.size, 1.0) for _ in range(3))
    v, finger_v, arm = (np.zeros(stiffness_N_m.size) for _ in range(3))
    coil = stiffness_N_m * 1e-3
    queue = [coil] * (1 + round(loop.compute_s / dt))
    places, drive = [], coil
    for step in range(ticks * FINE):
        if step % FINE == 0:
            drive = stiffness_N_m * 1e-3 * seen
            places.append(x)
        queue.append(drive)
        push = np.zeros_like(x)
        if hand:
            pulp = hand.pad_N_m(loop.held_cN)
            push = 1e-3 * (1 - hand.relaxing_ratio) * pulp * (finger - x) + arm
            pull = -1e-3 * hand.stiffness_N_m * finger - 1e-3 * hand.damping_N_s_m * finger_v - push
            arm = arm + dt * (1e-3 * hand.relaxing_ratio * pulp * (finger_v - v) - arm / hand.relax_s)
            finger_v = finger_v + 1e3 * dt * pull / hand.mass_kg
            finger = finger + dt * finger_v
        coil = coil + dt / loop.lag_s * (queue.pop(0) + 1e-3 * loop.braking_N_s_m * v - coil)
        v = v + 1e3 * dt * (push - coil - 1e-3 * loop.viscous_N_s_m * v) / loop.mass_kg
        x = x + dt * v
        seen = seen + dt / loop.seen_lag_s * (x - seen)
    return np.array(places)


@pytest.mark.parametrize("finger", [None, NominalFinger()])
@pytest.mark.parametrize("compute_s", [0.0, 1e-4, 6e-4])
def test_the_onset_lies_within_a_twentieth_of_a_plain_simulation(
    finger: NominalFinger | None, compute_s: float
) -> None:
    loop = SampledLoop(0.025, 0.6, 2.4, 4e-4, 5e-4, compute_s, TICK_s, finger, 60.0)
    limit = stiffness_limit_N_m(loop)
    places = swing_mm(loop, limit * np.array([0.95, 1.05]), 1200)
    early, late = (np.ptp(part, axis=0) for part in (places[300:600], places[900:]))
    assert late[0] < early[0]
    assert late[1] > early[1]


@pytest.mark.parametrize("tick_s", [1e-3, TICK_s])
def test_the_onset_without_a_finger_is_that_of_the_twins_own_matrices(tick_s: float) -> None:
    rig = bare_loop(tick_s)
    found = stiffness_limit_N_m(SampledLoop.of_rig(rig_truth(rig), tick_s, 1.0))
    assert found == pytest.approx(LinearLoop(rig).limit_N_m(), rel=0.05)


def test_the_largest_eigenvalue_is_one_at_the_onset_and_grows_with_stiffness() -> None:
    loop = SampledLoop.of_rig(RIG, TICK_s, 2.0, NominalFinger(), 60.0)
    limit = stiffness_limit_N_m(loop)
    assert spectral_radius(loop, limit) == pytest.approx(1.0, abs=1e-6)
    assert spectral_radius(loop, 0.8 * limit) < 1 < spectral_radius(loop, 1.2 * limit)


def test_a_delay_of_one_tick_is_the_next_reading_and_not_a_jump() -> None:
    """The bookkeeping of pending commands changes at a whole tick; the onset must not."""
    around = [
        stiffness_limit_N_m(SampledLoop(0.025, 0.6, 2.4, 4e-4, 5e-4, compute_s, TICK_s))
        for compute_s in (TICK_s * (1 - 1e-4), TICK_s * (1 + 1e-4))
    ]
    assert around[0] == pytest.approx(around[1], rel=1e-3)


def test_a_heavy_cap_without_lag_swings_where_passivity_ends() -> None:
    """With little stiffness per mass the delay is all phase there is: K = b / (T/2 + t_d)."""
    heavy = RigModel((1.0, 0.0, 0.0), 3e-4, 1e-5, 1e-5, drag_N_s_m=5.0, mass_g=5000.0)
    onset = stiffness_limit_N_m(SampledLoop.of_rig(heavy, TICK_s, 0.0))
    assert onset == pytest.approx(passive_limit_N_m(heavy, TICK_s, 0.0), rel=0.005)


def test_without_delay_the_passive_limit_is_that_of_colgate_and_brown() -> None:
    ideal = RigModel(delay_s=0.5 * TICK_s, drag_N_s_m=4.0)
    assert passive_limit_N_m(ideal, TICK_s, 0.0) == pytest.approx(2 * 4.0 / TICK_s)


def test_the_grain_is_bounded_by_friction_and_by_drag() -> None:
    limits = RigLimits.of_settings(Settings())
    rough = RigModel(drag_N_s_m=50.0, friction_cN=3.0)
    assert grain_limit_N_m(rough, limits, 0.0) == pytest.approx(2 * 0.03 / (1e-3 * limits.grain_mm))
    smooth = RigModel(drag_N_s_m=0.5, friction_cN=300.0)
    assert grain_limit_N_m(smooth, limits, 0.0) == pytest.approx(2 * 0.5 / limits.tick_s)


def test_a_step_is_quiet_while_both_rests_lie_within_the_reversal_distance() -> None:
    finger = NominalFinger()
    limit = step_limit_cN(finger, 60.0, 300.0, 0.1, 4.0)
    apart_mm = (limit - 2 * 4.0) / (0.1 * (finger.static_N_m(60.0) + 300.0))
    assert apart_mm == pytest.approx(0.1)


def test_the_steepest_places_of_a_ramp_up_and_down_are_found_with_their_slopes() -> None:
    x = np.linspace(0.0, 4.0, 401)
    force = np.interp(x, [0.0, 1.0, 1.4, 2.0, 4.0], [10.0, 50.0, 90.0, 30.0, 50.0])
    slope = steepest(x, force)
    assert (slope.rise_cN_mm, slope.fall_cN_mm) == pytest.approx((100.0, 100.0))
    assert 1.0 < slope.rise_mm < 1.4 < slope.fall_mm < 2.0
    assert slope.rise_cN == pytest.approx(50.0 + 100.0 * (slope.rise_mm - 1.0))


def test_the_stop_at_either_end_carries_what_is_steep_there() -> None:
    x = np.linspace(0.0, 4.0, 401)
    force = np.interp(x, [0.0, 0.05, 3.95, 4.0], [0.0, 50.0, 60.0, 200.0])
    assert steepest(x, force).rise_cN_mm == pytest.approx(10.0 / 3.9, rel=1e-6)


def flank(rise_cN_mm: float) -> tuple[FloatArray, FloatArray]:
    """A rise of a fifth of a millimetre from 60 cN."""
    x = np.linspace(0.0, 4.0, 401)
    return x, 60.0 + rise_cN_mm * np.clip(x - 2.0, 0.0, 0.2)


def test_what_holds_weakens_as_the_curve_gets_steeper() -> None:
    sticky = RigModel(RIG.gain, 7e-4, 4e-4, 5e-4, 3.0, 2.4, 30.0, 15.0, 25.0)
    first = stability(sticky, LIMITS, *flank(20.0))
    bounds = [first.passive_cN_mm, first.alone_cN_mm, first.finger_cN_mm]
    assert bounds == sorted(bounds)
    steep = (0.9 * bounds[0], 0.5 * (bounds[0] + bounds[1]), 1.1 * bounds[1], 1.4 * bounds[2], 3000.0)
    holds = [stability(sticky, LIMITS, *flank(rise)).holds for rise in steep]
    assert holds == [
        "passive for every finger",
        "stable even alone",
        "stable with a finger on it",
        "may buzz",
        "buzzes",
    ]


def test_a_step_between_the_strokes_is_judged_only_where_both_are_given() -> None:
    x, force = flank(20.0)
    assert stability(RIG, LIMITS, x, force).step_cN == 0.0
    both = stability(RIG, LIMITS, x, force, force + 80.0)
    assert both.step_cN == pytest.approx(80.0)
    assert both.holds == "may buzz"


def test_a_rig_without_mass_and_a_curve_without_length_are_refused() -> None:
    with pytest.raises(ModelError, match="identify it again"):
        SampledLoop.of_rig(RigModel(), TICK_s, 0.0)
    with pytest.raises(ModelError, match="too short"):
        steepest(np.array([0.0, 0.05, 0.1]), np.zeros(3))
