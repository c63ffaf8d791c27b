"""The constants of the force loop on an identified rig: its inverse, an estimator, and a controller.

The search for a controller's gains begins at some that are scaled by the plant's mass and age, and moves all
six of them together.
"""

from __future__ import annotations

import math
from dataclasses import astuple, replace
from functools import lru_cache

import numpy as np

from fdvv.compensation.force_loop.constants import OWN_VALUES, FRICTION_m
from fdvv.compensation.force_loop.stability import (
    LARGEST_PEAK,
    COUNTED_quantile,
    FingerBank,
    LoopController,
    LoopPlant,
)
from fdvv.compensation.identification.rig_model import RigModel
from fdvv.errors import ModelError
from fdvv.protocol.tables import CellSpec, ForceLoopGains
from fdvv.units import FloatArray, N_from_cN, m_from_mm

LEAST_kg = 2e-3  # assumed: a third of the 6 g in light.toml; above 0, as left() divides by it
LEAST_s = 1e-5  # half the least of the prior (RANGES: 2e-5); above 0, as the initial gains divide by it
CONTACT_s = 1e-3  # assumed: ten ticks of 10 kHz, so that noise of the cell does not switch the correction
LEAK_1_s = 2.0  # half a second, the pole of LoopController.on_force; assumed

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


FINGER_kg = 0.008
"""Mass of a finger: a light cap is not lighter than what holds it."""
BACK_OFF_ratio = 0.85
FARTHEST, FARTHEST_UP = 3.4, np.array([3.4, 3.4, 3.4, 3.4, 0.7, 3.4])
"""From the start, as a logarithm: a gain of a million behind a low pass of a millihertz is an integral. More
damping than twice the start's pays in the margins of a perfect velocity; that of the estimate has noise."""
ROUNDS = 40  # 0.85^40 leaves 0.15 % of the gains: no stable gain then
CALLS = 160  # assumed; a design of six gains then takes 2 to 6 s (docs: force-loop.md)


def initial_controller(plant: LoopPlant) -> LoopController:
    """Return gains for a plant of this mass and age: 20 g and 0.17 ms bear 7.9, 2.8 ms, 3.7 kHz."""
    mass, age = (plant.mass_kg + FINGER_kg) / 0.028, plant.age_s / 1.7e-4
    return LoopController(7.9 * mass / age, 2.8e-3 * mass, 3700.0 / age, 0.4, 16.0 * mass / age, 200.0 / age)


@lru_cache(maxsize=8)  # a session that is resumed designs for the same plant again
def design_controller(plant: LoopPlant) -> LoopController:
    """Return the gains that leave the least error from 10 to 100 Hz, with margins over the bank of fingers.

    The peak sensitivity is at most LARGEST_PEAK over all but 3 % of fingers, cells and slopes, and none of
    them is unstable. Raises ModelError if no gain is small enough.
    """
    from scipy.optimize import minimize

    bank, start = FingerBank(plant), np.log(astuple(initial_controller(plant)))

    def controller_of(logs: FloatArray) -> LoopController:
        return LoopController(*np.exp(np.clip(logs, start - FARTHEST, start + FARTHEST_UP)).tolist())

    def cost(logs: FloatArray) -> float:
        controller = controller_of(logs)
        excess = _excess(bank, controller)
        left = float(np.sqrt(np.mean(bank.residual_ratio(controller) ** 2)))
        return left + (0.5 + 2 * excess if excess > 0 else 0.0)

    result = minimize(
        cost, start, method="Nelder-Mead", options={"maxfev": CALLS, "initial_simplex": _simplex(start)}
    )
    return _within_margins(bank, controller_of(result.x))


def _simplex(start: FloatArray) -> FloatArray:
    return np.vstack([start, start + 0.35 * np.eye(start.size)])


def _excess(bank: FingerBank, controller: LoopController) -> float:
    """Return by how much the counted peak exceeds its bound, as a logarithm; at most 5."""
    peaks = np.minimum(bank.peaks(controller), 200.0)
    unstable = float((peaks >= 200.0).mean())
    return float(np.log(np.quantile(peaks, COUNTED_quantile) / LARGEST_PEAK)) + unstable


def _within_margins(bank: FingerBank, controller: LoopController) -> LoopController:
    """Lower the gains until the margins hold and no finger of the bank makes the loop unstable."""
    for _ in range(ROUNDS):
        if np.isfinite(bank.peaks(controller)).all() and _excess(bank, controller) <= 0:
            return controller
        lowered = ("proportional", "derivative_s", "integral_1_s", "damping_N_s_m")
        controller = replace(controller, **{n: BACK_OFF_ratio * getattr(controller, n) for n in lowered})
    raise ModelError(
        f"no gain of the force loop is stable on a rig with {1e3 * bank.plant.age_s:.2g} ms of delay; "
        "render by tables"
    )
