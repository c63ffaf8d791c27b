"""A cylindrical compression spring: rate, stress, solid length, buckling (EN 13906-1)."""

from __future__ import annotations

import math
from dataclasses import dataclass

from fdvv.errors import ModelError
from fdvv.mechanism._material import WIRES, Wire

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
        """Give the torsion in the wire at a travel, with Wahl's factor for the bent wire."""
        c = self.index
        wahl = (4.0 * c - 1.0) / (4.0 * c - 4.0) + 0.615 / c
        force_N = (self.preload_cN + self.rate_cN_mm * travel_mm) / cN_PER_N
        return wahl * 8.0 * force_N * self.mean_mm / (math.pi * self.wire_mm**3)

    def stress_ratio(self, travel_mm: float) -> float:
        """Give that stress over the permissible one."""
        limit = self.wire.torsion_ratio * self.wire.tensile_MPa(self.wire_mm)
        return self.stress_MPa(travel_mm) / limit

    def buckles_mm(self) -> float | None:
        """Give the deflection at which it buckles between flat ends, unguided; None if it never does."""
        ratio = self.wire.shear_MPa / self.wire.young_MPa
        slender = math.pi * self.mean_mm / (0.5 * self.free_mm)
        inside = 1.0 - (1.0 - ratio) / (0.5 + ratio) * slender**2
        if inside < 0:
            return None
        return self.free_mm * 0.5 / (1.0 - ratio) * (1.0 - math.sqrt(inside))
