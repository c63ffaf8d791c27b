"""What springs, leaves and domes are made of: stiffness, strength, sizes that are sold, and their tolerances.

Numbers of standards are cited; what is called "catalogue" is a round value that makers print, "assumed" has
no source. A design is no better than these: ask the maker for the certificate of the coil or compound.
"""

from __future__ import annotations

from dataclasses import dataclass

from fdvv.errors import ModelError


@dataclass(frozen=True)
class Wire:
    """Spring wire.

    Attributes
    ----------
    shear_MPa, young_MPa : moduli.
    strength_MPa : diameter (mm) up to which the least tensile strength holds, and that strength.
    torsion_ratio : part of the tensile strength that torsion may reach at rest.
    source : of all of it.
    """

    name: str
    shear_MPa: float
    young_MPa: float
    strength_MPa: tuple[tuple[float, float], ...]
    torsion_ratio: float
    source: str

    def tensile_MPa(self, wire_mm: float) -> float:
        """Return the least tensile strength of a diameter."""
        for most_mm, strength in self.strength_MPa:
            if wire_mm <= most_mm + 1e-9:
                return strength
        raise ModelError(f"{self.name} is not listed at {wire_mm} mm")


WIRES = {
    "steel": Wire(
        "patented spring steel wire, grade DM",
        81_500.0,
        206_000.0,
        (
            *((0.20, 2800.0), (0.22, 2770.0), (0.25, 2720.0), (0.28, 2680.0), (0.30, 2660.0)),
            *((0.32, 2640.0), (0.34, 2610.0), (0.36, 2590.0), (0.38, 2570.0)),
        ),
        0.56,
        "EN 10270-1; permissible torsion at rest 0.56 of the tensile strength, EN 13906-1",
    ),
    "stainless": Wire(
        "stainless spring wire 1.4310",
        73_000.0,
        185_000.0,
        ((0.20, 2200.0), (0.30, 2150.0), (0.40, 2100.0)),
        0.48,
        "EN 10270-3, normal strength; permissible torsion at rest 0.48 of it, EN 13906-1",
    ),
}
"""Spring wires, by name."""
WIRE_SIZES_mm = (0.14, 0.16, 0.18, 0.20, 0.22, 0.25, 0.28, 0.30, 0.32, 0.34, 0.36, 0.38)
"""Preferred diameters of EN 10270-1 in the range of keys."""


def wire_tolerance_mm(wire_mm: float) -> float:
    """Return the permissible deviation of a wire's diameter, EN 10270-1, drawn wire in coils."""
    return 0.004 if wire_mm < 0.17 else 0.005 if wire_mm < 0.27 else 0.008


def coil_tolerance_mm(mean_mm: float, index: float) -> float:
    """Return the permissible deviation of a mean coil diameter, DIN 2095 grade 1."""
    rows = ((2.5, (0.07, 0.10, 0.10)), (4.0, (0.10, 0.10, 0.15)), (10.0, (0.10, 0.15, 0.15)))
    column = 0 if index <= 8 else 1 if index <= 14 else 2
    for most_mm, values in rows:
        if mean_mm <= most_mm:
            return values[column]
    raise ModelError(f"a coil of {mean_mm} mm is too large for a key")


@dataclass(frozen=True)
class Strip:
    """Strip for leaves; bending_MPa is what it may bear at rest, 0.75 of the proof strength."""

    name: str
    young_MPa: float
    proof_MPa: float
    density_kg_m3: float
    source: str

    @property
    def bending_MPa(self) -> float:
        """Get the permissible bending stress at rest."""
        return 0.75 * self.proof_MPa


STRIPS = {
    "beryllium-copper": Strip(
        "beryllium copper CW101C, aged", 130_000.0, 1000.0, 8260.0, "EN 1654, R1200; catalogue"
    ),
    "bronze": Strip(
        "phosphor bronze CW452K", 118_000.0, 550.0, 8800.0, "EN 1654, R560 and harder; catalogue"
    ),
    "stainless": Strip("stainless strip 1.4310", 185_000.0, 1100.0, 7900.0, "EN 10151, +C1300; catalogue"),
}
"""Strips for leaves, by name."""
STRIP_SIZES_mm = (0.06, 0.08, 0.10, 0.12, 0.15, 0.18, 0.20)
STRIP_WIDTHS_mm = (1.0, 1.5, 2.0, 2.5, 3.0)

SOFTEST_shoreA, HARDEST_shoreA = 25.0, 80.0
RUBBER_POISSON_ratio = 0.49


def rubber_MPa(hardness_shoreA: float) -> float:
    """Return Young's modulus of a rubber of that hardness.

    Gent, Rubber Chemistry and Technology 31 (1958): E = 0.0981 (56 + 7.62336 S) / (0.137505 (254 - 2.54 S)).
    """
    if not 20.0 <= hardness_shoreA <= 85.0:
        raise ModelError(f"Gent's relation holds from 20 to 85 Shore A, got {hardness_shoreA}")
    return 0.0981 * (56.0 + 7.62336 * hardness_shoreA) / (0.137505 * (254.0 - 2.54 * hardness_shoreA))


def hardness_shoreA(young_MPa: float) -> float:
    """Return the hardness of a rubber of that modulus, the inverse of rubber_MPa."""
    ratio = young_MPa * 0.137505 / 0.0981
    return (254.0 * ratio - 56.0) / (7.62336 + 2.54 * ratio)
