"""From what is known of a rig to what its controller is told, and to the first tables."""

from __future__ import annotations

import numpy as np

from fdvv.compensate._felt import Pass
from fdvv.compensate._known_rig import DRAG_cN, KnownRig, cN_PER_g_m_s2
from fdvv.compensate._tuning import Tuning
from fdvv.units import FloatArray

LIFT_cN = 50.0
"""Least force in the first 0.1 mm: a table of displacement cannot tell a resting cap from a moving one."""

TYPICAL_m_s2, TYPICAL_mm_s = 14.0, 200.0
"""Mean size of the acceleration of a stroke, which grows with the square of speed; on the twin, simulated."""

SPREAD_mm_s = (0.0, 50.0, 100.0, 150.0, 200.0, 300.0)
SPREAD_m_s2 = (0.3, 1.0, 1.3, 3.0, 3.5, 7.0)
"""By how much acceleration differs between presses at one place and asked speed; on the twin, simulated."""

PACE_ratio = 0.03
"""What is left of the spread of speed where the controller itself takes off drag."""


def tuning_of(known: KnownRig, travel_mm: float, bandwidth_Hz: float, friction_mm_s: float) -> Tuning:
    """Tell the controller how far to look ahead and what to push against, at the gain of mid travel."""
    middle = np.array([0.5 * travel_mm])
    gain = float(known.gain_at(middle)[0])
    brake_lead_s = known.position_lag_s + known.delay_s - known.electric_lag_s
    return Tuning(
        bandwidth_Hz,
        brake_lead_s + known.electric_lag_s,
        brake_lead_s,
        max(0.0, float(known.drag_at(middle)[0])) / gain,
        max(0.0, known.friction_cN) / gain,
        friction_mm_s,
        paced=True,
    )


def added_cN(tuning: Tuning, velocity_mm_s: FloatArray) -> FloatArray:
    """Give what the controller takes off its table at a speed, positive downward."""
    rub = tuning.friction_cN * np.clip(velocity_mm_s / tuning.friction_mm_s, -1.0, 1.0)
    return np.asarray(DRAG_cN * tuning.drag_N_s_m * velocity_mm_s + rub)


def command_cN(known: KnownRig, grid_mm: FloatArray, target_cN: FloatArray) -> FloatArray:
    """Give the table that holds the target in a rig at rest, the shape of target_cN."""
    return np.asarray((target_cN + known.weight_cN) / known.gain_at(grid_mm))


def wanted_cN(
    known: KnownRig,
    tuning: Tuning,
    stroke: Pass,
    change: tuple[FloatArray, FloatArray, FloatArray],
    target: tuple[FloatArray, FloatArray],
) -> tuple[FloatArray, FloatArray]:
    """Give where (mm) the table should have been higher, and by how much (cN) than command_cN(), (n,) each.

    change : of place, speed and acceleration that the right force brings (foresee). target : grid and force.

    The force that the rig makes by itself is taken as it was felt, plus what the change adds to it; what the
    coil must then give is divided by its gain, without what the controller adds. Behind the coil's lag both
    its braking and what is pushed against it are late alike.
    """
    q, dv, da = change
    x = stroke.displacement_mm + q
    late_v = stroke.velocity_mm_s + dv - 1000.0 * known.electric_lag_s * (stroke.acceleration_m_s2 + da)
    gain = known.gain_at(x)
    viscous = DRAG_cN * (known.drag_N_s_m - known.back_emf_N_s_m)
    own = stroke.own_cN + viscous * dv + cN_PER_g_m_s2 * known.mass_g * da
    braking = DRAG_cN * known.back_emf_N_s_m * gain**2 * late_v
    felt = np.interp(x, *target)
    table = (felt - own - braking) / gain + added_cN(tuning, late_v)
    return x, table - command_cN(known, x, felt)


def unrepeatable_cN(known: KnownRig, speed_mm_s: float) -> float:
    """Give by how much two presses at one asked speed differ in what they need of a table, rms."""
    inertia = cN_PER_g_m_s2 * known.mass_g * float(np.interp(speed_mm_s, SPREAD_mm_s, SPREAD_m_s2))
    drag = DRAG_cN * known.drag_N_s_m * PACE_ratio * speed_mm_s
    return float(np.sqrt(known.residual_cN**2 + inertia**2 + drag**2 + 1.0))


def inertia_cN(known: KnownRig, speeds_mm_s: FloatArray) -> FloatArray:
    """Give the size of inertia at speeds, (s,)."""
    return np.asarray(cN_PER_g_m_s2 * known.mass_g * TYPICAL_m_s2 * (speeds_mm_s / TYPICAL_mm_s) ** 2)
