"""Choice of the force loop's gains from an identified plant: the least error left within the margins.

The search begins at gains that are scaled by the plant's mass and age, and moves all six of them together.
"""

from __future__ import annotations

from dataclasses import astuple, replace
from functools import lru_cache

import numpy as np

from fdvv.compensation.force_loop.stability import (
    LARGEST_PEAK,
    COUNTED_quantile,
    FingerBank,
    LoopController,
    LoopPlant,
)
from fdvv.errors import ModelError
from fdvv.units import FloatArray

FINGER_kg = 0.008
"""Mass of a finger: a light cap is not lighter than what holds it."""
BACK_OFF_ratio = 0.85
FARTHEST, FARTHEST_UP = 3.4, np.array([3.4, 3.4, 3.4, 3.4, 0.7, 3.4])
"""From the start, as a logarithm: a gain of a million behind a low pass of a millihertz is an integral. More
damping than twice the start's pays in the margins of a perfect velocity; that of the estimate has noise."""
ROUNDS = 40
CALLS = 160


def scaled_start(plant: LoopPlant) -> LoopController:
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

    bank, start = FingerBank(plant), np.log(astuple(scaled_start(plant)))

    def controller_of(logs: FloatArray) -> LoopController:
        return LoopController(*np.exp(np.clip(logs, start - FARTHEST, start + FARTHEST_UP)).tolist())

    def cost(logs: FloatArray) -> float:
        controller = controller_of(logs)
        excess = _excess(bank, controller)
        left = float(np.sqrt(np.mean(bank.left(controller) ** 2)))
        return left + (0.5 + 2 * excess if excess > 0 else 0.0)

    found = minimize(
        cost, start, method="Nelder-Mead", options={"maxfev": CALLS, "initial_simplex": _simplex(start)}
    )
    return _within_margins(bank, controller_of(found.x))


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
