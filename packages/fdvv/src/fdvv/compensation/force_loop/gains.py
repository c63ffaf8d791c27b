"""The constants of the force loop on an identified rig: its inverse, an estimator, and a controller."""

from __future__ import annotations

import math

import numpy as np

from fdvv.compensation.force_loop.constants import OWN_VALUES, FRICTION_m
from fdvv.compensation.force_loop.design import design_controller
from fdvv.compensation.force_loop.stability import LoopController, LoopPlant
from fdvv.compensation.identification.rig_model import RigModel
from fdvv.protocol.tables import CellSpec, ForceLoopGains
from fdvv.units import FloatArray, N_from_cN, m_from_mm

LEAST_kg = 2e-3
LEAST_s = 1e-5
CONTACT_s = 1e-3
LEAK_1_s = 2.0

# Of the estimator: force noise per tick, and the walk of the force that the model does not know.
FORCE_NOISE_N, STOP_NOISE_N = 0.05, 0.5
WALK_N_s = 0.2
LEAST_NOISE_m = 1e-6
FINE = 16
"""Places between two values of the own force."""


def plant_of_rig(rig: RigModel, cell: CellSpec) -> LoopPlant:
    """Return what the loop acts on: an identified rig with its cell."""
    return LoopPlant(
        mass_kg=max(LEAST_kg, 1e-3 * rig.mass_g - cell.plate_kg),
        plate_kg=cell.plate_kg,
        drag_N_s_m=max(0.0, rig.drag_N_s_m),
        cell_N_m=cell.stiffness_N_m,
        cell_N_s_m=cell.damping_N_s_m,
        coil_s=max(LEAST_s, rig.electric_lag_s),
        cell_s=cell.filter_s,
        delay_s=max(0.0, rig.delay_s - rig.electric_lag_s),
    )


def force_loop_gains(
    rig: RigModel, cell: CellSpec, tick_s: float, controller: LoopController | None = None
) -> ForceLoopGains:
    """Return the constants of the loop on this rig, with gains chosen for it unless a controller is given.

    Raises ModelError if no gain is stable.
    """
    plant = plant_of_rig(rig, cell)
    controller = controller or design_controller(plant)
    # the sensed position is older than the force of the cell by this
    late_s = max(0.0, rig.position_lag_s - cell.filter_s)
    noise_m = max(LEAST_NOISE_m, float(m_from_mm(rig.position_noise_mm)))
    lead_s = plant.age_s
    voltage = rig.back_emf_N_s_m > 0.5 * rig.drag_N_s_m
    c0, c1, c2 = rig.gain
    own_cN, own_per_m = own_force(rig)
    # what accelerates is the force at the finger, in front of the plate
    moving_kg = plant.mass_kg + plant.plate_kg
    return ForceLoopGains(
        tick_s=tick_s,
        compute_ratio=min(1.0, max(0.0, plant.delay_s / tick_s - 0.5)),
        mass_kg=moving_kg,
        plate_kg=plant.plate_kg,
        drag_N_s_m=max(0.0, rig.drag_N_s_m - rig.back_emf_N_s_m),
        brake_N_s_m=rig.back_emf_N_s_m,
        friction_N=float(N_from_cN(max(0.0, rig.friction_cN))),
        friction_m=FRICTION_m,
        own_N=tuple(N_from_cN(own_cN).tolist()),
        own_per_m=own_per_m,
        gain=c0,
        gain_1_m=1e3 * c1,
        gain_1_m2=1e6 * c2,
        coil_rate=rate(tick_s, plant.coil_s),
        cell_rate=rate(tick_s, plant.cell_s),
        position_rate=rate(tick_s, late_s),
        free_gains=tuple(estimator_gains(tick_s, late_s, moving_kg, noise_m, FORCE_NOISE_N).tolist()),
        stop_gains=tuple(estimator_gains(tick_s, late_s, moving_kg, noise_m, STOP_NOISE_N).tolist()),
        lead_s=lead_s,
        velocity_lead_s=lead_s - plant.coil_s if voltage else lead_s,
        proportional=controller.proportional,
        derivative_s=controller.derivative_s,
        lowpass_rate=rate(tick_s, 1 / (2 * math.pi * controller.lowpass_Hz)),
        integral_1_s=controller.integral_1_s,
        leak=LEAK_1_s * tick_s,
        damping_N_s_m=controller.damping_N_s_m,
        highpass_rate=rate(tick_s, 1 / (2 * math.pi * controller.highpass_Hz)),
        contact_rate=rate(tick_s, CONTACT_s),
    )


def own_force(rig: RigModel) -> tuple[FloatArray, float]:
    """Return the rig's own force at OWN_VALUES even steps, (OWN_VALUES,), and the steps per metre.

    Of all forces that are linear between them it is the one nearest to the rig's, in squares.
    """
    fine_mm = rig.own_step_mm * max(1, len(rig.own_cN) - 1)
    at = np.linspace(0.0, OWN_VALUES - 1.0, FINE * (OWN_VALUES - 1) + 1)
    hats = np.maximum(0.0, 1.0 - np.abs(at[:, np.newaxis] - np.arange(OWN_VALUES)))
    force = rig.own_at(at * fine_mm / (OWN_VALUES - 1))
    nearest = np.asarray(np.linalg.lstsq(hats, force, rcond=None)[0], dtype=np.float64)
    return nearest, 1e3 * (OWN_VALUES - 1) / fine_mm


def rate(tick_s: float, lag_s: float) -> float:
    """Return the part of its input that a first-order lag takes over in a tick."""
    return -math.expm1(-tick_s / lag_s) if lag_s > 0 else 1.0


def estimator_gains(
    tick_s: float, late_s: float, mass_kg: float, noise_m: float, force_noise_N: float
) -> FloatArray:
    """Return the steady Kalman gains of position, velocity, unknown force and lagging position, (4,).

    late_s : lag of the position's reading. noise_m : of a reading. force_noise_N : of the known force, per
    tick.
    """
    from scipy.linalg import solve_discrete_are

    late = rate(tick_s, late_s)
    step = np.array([0.5 * tick_s**2 / mass_kg, tick_s / mass_kg, 0.0, 0.0])
    motion = np.array(
        [[1, tick_s, step[0], 0], [0, 1, step[1], 0], [0, 0, 1, 0], [late, 0, 0, 1 - late]], dtype=float
    )
    walk = np.outer(step, step) * force_noise_N**2 + np.diag([1e-16, 0, WALK_N_s**2 * tick_s, 1e-16])
    reads = np.array([[0.0, 0.0, 0.0, 1.0]])
    spread = solve_discrete_are(motion.T, reads.T, walk, np.array([[noise_m**2]]))
    return np.asarray(spread @ reads.T / (reads @ spread @ reads.T + noise_m**2)).ravel()
