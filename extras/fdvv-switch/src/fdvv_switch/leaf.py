"""A leaf that rides on a cam of the slider: strip, cam, and what both give the finger.

The cam holds the leaf at height h, 0 where the leaf just reaches the fixed contact; above it the leaf alone
bends, below it leaf and fixed contact do, side by side. With leaf force P, cam slope t = h' and coefficient
of friction m, the wedge gives P (t + m)/(1 - m t) against a press and P (t - m)/(1 + m t) against a release.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from fdvv.errors import ModelError
from fdvv.force_text import force_text
from fdvv.units import FloatArray
from fdvv_switch.coil import Coil, cN_PER_N
from fdvv_switch.guide import Guide
from fdvv_switch.making import Making
from fdvv_switch.material import STRIPS, Strip, STRIP_SIZES_mm, STRIP_WIDTHS_mm

TIP_MASS_ratio = 0.243
"""Part of a cantilever's mass that moves with its tip, 33/140 of it with the first mode's shape, rounded."""

DEGREE = 3


@dataclass(frozen=True)
class Leaf:
    """A cantilever of strip and the fixed contact, a shorter cantilever of the same strip.

    Attributes
    ----------
    thickness_mm, width_mm, length_mm : of the leaf; length_mm from the clamp to where the cam touches.
    contact_length_mm : of the fixed contact.
    offset_mm : how far the tip is bent from its free shape where it just reaches the fixed contact.
    material : a name of STRIPS.
    young_ratio : this lot's Young's modulus over the nominal one.
    """

    thickness_mm: float
    width_mm: float
    length_mm: float
    contact_length_mm: float
    offset_mm: float
    material: str = "beryllium-copper"
    young_ratio: float = 1.0

    def __post_init__(self) -> None:
        if self.material not in STRIPS:
            raise ModelError(f"strip is one of {', '.join(STRIPS)}, got {self.material!r}")
        sizes = (self.thickness_mm, self.width_mm, self.length_mm, self.contact_length_mm, self.young_ratio)
        if not all(v > 0 for v in sizes) or self.offset_mm < 0:
            raise ModelError(f"every size of a leaf must be above 0, got {self}")

    @property
    def strip(self) -> Strip:
        """Get what it is made of."""
        return STRIPS[self.material]

    def _stiffness(self, length_mm: float) -> float:
        """Return E b t^3 / (4 L^3) in cN/mm."""
        modulus = self.young_ratio * self.strip.young_MPa
        return cN_PER_N * modulus * self.width_mm * self.thickness_mm**3 / (4.0 * length_mm**3)

    @property
    def stiffness_cN_mm(self) -> float:
        """Get the stiffness of the leaf's tip."""
        return self._stiffness(self.length_mm)

    @property
    def contact_cN_mm(self) -> float:
        """Get the stiffness of the fixed contact."""
        return self._stiffness(self.contact_length_mm)

    @property
    def preload_cN(self) -> float:
        """Get the force of the leaf where it just reaches the fixed contact."""
        return self.stiffness_cN_mm * self.offset_mm

    @property
    def tip_mass_g(self) -> float:
        """Get the mass that moves with the tip."""
        volume_mm3 = self.thickness_mm * self.width_mm * self.length_mm
        return TIP_MASS_ratio * volume_mm3 * self.strip.density_kg_m3 * 1e-6

    def force_cN(self, height_mm: FloatArray) -> FloatArray:
        """Return the force between leaf and cam; 0 where the cam has left the leaf.

        height_mm : of the cam, 0 where the leaf just reaches the fixed contact.
        """
        alone = self.preload_cN + self.stiffness_cN_mm * height_mm
        both = self.preload_cN + (self.stiffness_cN_mm + self.contact_cN_mm) * height_mm
        return np.asarray(np.where(height_mm >= 0.0, alone, np.maximum(both, 0.0)))

    def stress_MPa(self, force_cN: float) -> float:
        """Return the bending stress at the clamp, 6 P L / (b t^2)."""
        return 6.0 * force_cN / cN_PER_N * self.length_mm / (self.width_mm * self.thickness_mm**2)


@dataclass(frozen=True, eq=False)
class Cam:
    """Height of the leaf's nose over the slider's displacement, a cubic B-spline.

    Attributes
    ----------
    knots_mm, height_mm : (n + 4,) knots and (n,) control heights; beyond its ends the cam runs on level.
    nose_mm : radius of the leaf's nose; the cam's surface lies that much below the path of the nose's centre.
    """

    knots_mm: FloatArray
    height_mm: FloatArray
    nose_mm: float

    def __post_init__(self) -> None:
        if self.knots_mm.size != self.height_mm.size + DEGREE + 1 or self.nose_mm <= 0:
            raise ModelError("a cam needs four knots more than heights, and a nose")

    @property
    def start_mm(self) -> float:
        """Get where the cam begins."""
        return float(self.knots_mm[0])

    @property
    def end_mm(self) -> float:
        """Get where the cam runs on level."""
        return float(self.knots_mm[-1])

    def at(self, x: FloatArray, derivative: int = 0) -> FloatArray:
        """Return height, slope or second derivative at slider displacements; level beyond the ends."""
        from scipy.interpolate import BSpline

        inside = np.clip(x, self.start_mm, self.end_mm)
        value = BSpline(self.knots_mm, self.height_mm, DEGREE)(inside, nu=derivative)
        return np.asarray(value if derivative == 0 else np.where(inside == x, value, 0.0))

    def curvature_1_mm(self, x: FloatArray) -> FloatArray:
        """Return the curvature of the nose's path, positive in a hollow."""
        return np.asarray(self.at(x, 2) / (1.0 + self.at(x, 1) ** 2) ** 1.5)

    def surface_mm(self, x: FloatArray) -> FloatArray:
        """Return the cam's own surface under the path of the nose: (n, 2), along and across the travel."""
        slope = self.at(x, 1)
        long = np.sqrt(1.0 + slope**2)
        return np.column_stack([x + self.nose_mm * slope / long, self.at(x) - self.nose_mm / long])


@dataclass(frozen=True, eq=False)
class LeafMechanism:
    """A coil that returns the slider and a leaf on its cam.

    Attributes
    ----------
    friction_ratio : coefficient between leaf and cam.
    shift_mm, lift_mm : how far the cam stands off its place, along and across the travel.
    """

    coil: Coil
    guide: Guide
    leaf: Leaf
    cam: Cam
    friction_ratio: float
    shift_mm: float = 0.0
    lift_mm: float = 0.0

    kind = "leaf"

    def strokes_cN(self, x: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return the slow press and release at displacements (mm), each as long as x."""
        force = self.leaf.force_cN(self.cam.at(x - self.shift_mm) + self.lift_mm)
        slope = self.cam.at(x - self.shift_mm, 1)
        down, up = wedge(force, slope, self.friction_ratio)
        spring = self.coil.preload_cN + self.coil.rate_cN_mm * x
        return self.guide.strokes_cN(x, spring + down, spring + up)


def wedge(force: FloatArray, slope: FloatArray, friction: float) -> tuple[FloatArray, FloatArray]:
    """Return what a leaf's force becomes along the travel, pressing and releasing."""
    down = force * (slope + friction) / np.maximum(1.0 - friction * slope, 1e-3)
    up = force * (slope - friction) / np.maximum(1.0 + friction * slope, 1e-3)
    return np.asarray(down), np.asarray(up)


LENGTH_STEP_mm, OFFSET_STEP_mm = 0.05, 0.01


def choose_leaf(preload_cN: float, stiffness_cN_mm: float, largest_cN: float, making: Making) -> Leaf:
    """Choose the least stressed leaf of a stiffness.

    preload_cN : its force where it just reaches the fixed contact. stiffness_cN_mm : of its tip.
    largest_cN : the most that the cam asks of it.
    Raises ModelError if none is short enough, long enough and strong enough.
    """
    leaves = list(_candidates(preload_cN, stiffness_cN_mm, making))
    limit = STRIPS[making.strip].bending_MPa
    if not leaves:
        low, high = making.leaf_mm
        raise ModelError(
            f"no strip of {making.strip} between {low:g} and {high:g} mm long has "
            f"{force_text(stiffness_cN_mm, '.0f', per='/mm')}"
        )
    best = min(leaves, key=lambda leaf: leaf.stress_MPa(largest_cN))
    if best.stress_MPa(largest_cN) > limit:
        raise ModelError(
            f"the least stressed leaf of {making.strip} bears {best.stress_MPa(largest_cN):.0f} MPa, "
            f"{limit:.0f} are permissible"
        )
    return best


def _candidates(preload_cN: float, stiffness_cN_mm: float, making: Making) -> Iterator[Leaf]:
    young = cN_PER_N * STRIPS[making.strip].young_MPa
    for thickness in STRIP_SIZES_mm:
        for width in STRIP_WIDTHS_mm:
            length = (young * width * thickness**3 / (4.0 * stiffness_cN_mm)) ** (1.0 / 3.0)
            length = round(round(length / LENGTH_STEP_mm) * LENGTH_STEP_mm, 4)
            if making.leaf_mm[0] <= length <= making.leaf_mm[1]:
                stiffness = young * width * thickness**3 / (4.0 * length**3)
                offset = round(round(preload_cN / stiffness / OFFSET_STEP_mm) * OFFSET_STEP_mm, 4)
                contact = round(length / making.contact_ratio ** (1.0 / 3.0), 2)
                yield Leaf(thickness, width, length, contact, offset, making.strip)
