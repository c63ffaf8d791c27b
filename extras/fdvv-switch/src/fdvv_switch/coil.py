"""A cylindrical compression spring: rate, stress, solid length, buckling (EN 13906-1)."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from fdvv.errors import ModelError
from fdvv.force_text import force_text
from fdvv_switch.material import WIRES, Wire, WIRE_SIZES_mm, coil_tolerance_mm, wire_tolerance_mm

cN_PER_N = 100.0

END_COILS = 2.0
"""Closed coils that do not move."""


@dataclass(frozen=True)
class Coil:
    """A compression spring of round wire, ends closed and ground, built in at a length.

    Attributes
    ----------
    wire_mm, mean_mm : diameter of the wire, and of the coil from wire centre to wire centre.
    active : coils that move.
    free_mm : its length unloaded.
    built_mm : its length under the resting cap.
    material : a name of WIRES.
    shear_ratio : this lot's shear modulus over the nominal one.
    """

    wire_mm: float
    mean_mm: float
    active: float
    free_mm: float
    built_mm: float
    material: str = "steel"
    shear_ratio: float = 1.0

    def __post_init__(self) -> None:
        if self.material not in WIRES:
            raise ModelError(f"wire is one of {', '.join(WIRES)}, got {self.material!r}")
        sizes = (self.wire_mm, self.mean_mm, self.active, self.free_mm, self.built_mm, self.shear_ratio)
        if not all(math.isfinite(v) and v > 0 for v in sizes):
            raise ModelError(f"every size of a coil must be above 0, got {sizes}")

    @property
    def wire(self) -> Wire:
        """Get what it is made of."""
        return WIRES[self.material]

    @property
    def index(self) -> float:
        """Get the spring index, mean over wire diameter."""
        return self.mean_mm / self.wire_mm

    @property
    def rate_cN_mm(self) -> float:
        """Get the rate, G d^4 / (8 D^3 n)."""
        shear = self.shear_ratio * self.wire.shear_MPa
        return cN_PER_N * shear * self.wire_mm**4 / (8.0 * self.mean_mm**3 * self.active)

    @property
    def preload_cN(self) -> float:
        """Get the force under the resting cap."""
        return self.rate_cN_mm * (self.free_mm - self.built_mm)

    @property
    def solid_mm(self) -> float:
        """Get the length with all coils touching."""
        return (self.active + END_COILS) * self.wire_mm

    @property
    def clearance_mm(self) -> float:
        """Get what must be left between the coils at the bottom, EN 13906-1, cold coiled."""
        return self.active * (0.0015 * self.mean_mm**2 / self.wire_mm + 0.1 * self.wire_mm)

    def stress_MPa(self, travel_mm: float) -> float:
        """Return the torsion in the wire at a travel, with Wahl's factor for the bent wire."""
        c = self.index
        wahl = (4.0 * c - 1.0) / (4.0 * c - 4.0) + 0.615 / c
        force_N = (self.preload_cN + self.rate_cN_mm * travel_mm) / cN_PER_N
        return wahl * 8.0 * force_N * self.mean_mm / (math.pi * self.wire_mm**3)

    def stress_ratio(self, travel_mm: float) -> float:
        """Return that stress over the permissible one."""
        limit = self.wire.torsion_ratio * self.wire.tensile_MPa(self.wire_mm)
        return self.stress_MPa(travel_mm) / limit

    def buckles_mm(self) -> float | None:
        """Return the deflection at which it buckles between flat ends, unguided; None if it never does."""
        ratio = self.wire.shear_MPa / self.wire.young_MPa
        slender = math.pi * self.mean_mm / (0.5 * self.free_mm)
        inside = 1.0 - (1.0 - ratio) / (0.5 + ratio) * slender**2
        if inside < 0:
            return None
        return self.free_mm * 0.5 / (1.0 - ratio) * (1.0 - math.sqrt(inside))


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
            "a spring needs a rate above 0 and no negative preload, the curve asks for "
            f"{force_text(rate_cN_mm, '.1f', per='/mm')} and {force_text(preload_cN, '.1f')}"
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
            f"no spring of {force_text(rate_cN_mm, '.1f', per='/mm')} and {force_text(preload_cN, '.1f')} "
            f"fits {envelope.outer_mm:g} mm by "
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
    wire = 4.0 * wire_tolerance_mm(coil.wire_mm) / coil.wire_mm
    return float(np.hypot(wire, 3.0 * coil_tolerance_mm(coil.mean_mm, coil.index) / coil.mean_mm))
