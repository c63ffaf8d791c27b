"""From a rate and a preload to a spring that can be bought: wire sizes, index, space, stress."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from fdvv.errors import ModelError
from fdvv.mechanism._coil import Coil, cN_PER_N
from fdvv.mechanism._material import WIRES, WIRE_SIZES_mm, coil_tolerance_mm, wire_tolerance_mm

LEAST_ACTIVE, MOST_ACTIVE = 3.0, 40.0
LEAST_INDEX, MOST_INDEX = 4.0, 20.0
MEAN_STEP_mm, COIL_STEP, LENGTH_STEP_mm = 0.1, 0.05, 0.05


@dataclass(frozen=True)
class Envelope:
    """Space for the spring in a key.

    Attributes
    ----------
    outer_mm, inner_mm : of the round space and of the post in it; assumed, as in keys of the MX kind.
    built_mm : length under the resting cap, longest; assumed.
    longest_mm : unloaded.
    """

    outer_mm: float = 4.8
    inner_mm: float = 2.8
    built_mm: float = 9.5
    longest_mm: float = 24.0

    def __post_init__(self) -> None:
        if not 0 < self.inner_mm < self.outer_mm or not 0 < self.built_mm <= self.longest_mm:
            raise ModelError(f"an envelope needs inner < outer and built <= longest, got {self}")


def choose_coil(
    preload_cN: float, rate_cN_mm: float, travel_mm: float, envelope: Envelope, material: str = "steel"
) -> Coil:
    """Choose the spring whose force varies least with wire and coil, among those that fit and hold.

    preload_cN : force at rest. rate_cN_mm : stiffness. travel_mm : of the slider. material : one of WIRES.
    Raises ModelError that says what stands in the way if there is none.
    """
    if not (rate_cN_mm > 0 and preload_cN >= 0):
        raise ModelError(
            f"a spring needs a rate above 0 and no negative preload, the curve asks for "
            f"{rate_cN_mm:.1f} cN/mm and {preload_cN:.1f} cN"
        )
    refused: list[str] = []
    fit = [
        coil
        for coil in _candidates(preload_cN, rate_cN_mm, envelope, material)
        if _holds(coil, travel_mm, envelope, refused)
    ]
    if not fit:
        why = max(set(refused), key=refused.count) if refused else "no wire has enough coils or few enough"
        raise ModelError(
            f"no spring of {rate_cN_mm:.1f} cN/mm and {preload_cN:.1f} cN fits {envelope.outer_mm:g} mm by "
            f"{envelope.built_mm:g} mm: {why}"
        )
    return min(fit, key=_spread)


def _candidates(preload_cN: float, rate_cN_mm: float, envelope: Envelope, material: str) -> Iterator[Coil]:
    shear = WIRES[material].shear_MPa
    for wire in WIRE_SIZES_mm:
        for mean in np.arange(envelope.inner_mm + wire + 0.1, envelope.outer_mm - wire, MEAN_STEP_mm):
            mean_mm = round(float(mean), 2)
            active = cN_PER_N * shear * wire**4 / (8.0 * mean_mm**3 * rate_cN_mm)
            active = round(round(active / COIL_STEP) * COIL_STEP, 4)
            index = mean_mm / wire
            if LEAST_ACTIVE <= active <= MOST_ACTIVE and LEAST_INDEX <= index <= MOST_INDEX:
                rate = cN_PER_N * shear * wire**4 / (8.0 * mean_mm**3 * active)
                free = envelope.built_mm + preload_cN / rate
                free = round(round(free / LENGTH_STEP_mm) * LENGTH_STEP_mm, 4)
                yield Coil(wire, mean_mm, active, free, envelope.built_mm, material)


def _holds(coil: Coil, travel_mm: float, envelope: Envelope, refused: list[str]) -> bool:
    """Tell whether it fits and bears its load; why not is appended."""
    if coil.free_mm > envelope.longest_mm:
        refused.append(f"it would be longer than {envelope.longest_mm:g} mm unloaded")
    elif coil.solid_mm + coil.clearance_mm > coil.built_mm - travel_mm:
        refused.append("its coils would touch before the bottom")
    elif coil.stress_ratio(travel_mm) > 1.0:
        refused.append("its wire would be stressed beyond what is permissible")
    else:
        return True
    return False


def _spread(coil: Coil) -> float:
    """Give the relative spread of its rate from wire and coil diameter."""
    wire = 4.0 * wire_tolerance_mm(coil.wire_mm) / coil.wire_mm
    return float(np.hypot(wire, 3.0 * coil_tolerance_mm(coil.mean_mm, coil.index) / coil.mean_mm))
