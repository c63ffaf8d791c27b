"""A dome: a truncated cone whose wall tips over, and hinges at its edges; under it a foot.

The wall turns as a rigid section about a neutral ring, so that only its circumference is strained: the theory
of the coned disc spring (Almen and Laszlo, Transactions of the ASME 58, 1936), here with exact angles,
because a dome's wall is steep. In the limit of flat cones both agree. The hinges are thinner rings, three
times as long as they are thick, that bend (assumed length).
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from fdvv.errors import ModelError
from fdvv.units import FloatArray
from fdvv_switch.coil import cN_PER_N
from fdvv_switch.guide import Guide
from fdvv_switch.leaf import Leaf
from fdvv_switch.material import RUBBER_POISSON_ratio, rubber_MPa

HINGE_LENGTH_ratio = 3.0
ALONG, ACROSS = 8, 4
"""Gauss points along the wall and through it; the energy is a polynomial of few terms over the radius."""
FLATTEST = 1e-3
LEAF_ROOM_mm = 1.5
"""Height that a leaf under the dome needs to bend."""
TOPS, LEAST_WAY_mm = 400, 0.01
"""Places of the dome's top between which its force is interpolated."""


@dataclass(frozen=True)
class Dome:
    """A rubber dome.

    Attributes
    ----------
    base_mm, top_mm : diameters of the wall's middle line at its foot and at its top.
    height_mm : of that line.
    wall_mm, hinge_mm : thickness of the wall, and of the hinges at its two edges.
    hardness_shoreA : of the rubber; its modulus is Gent's.
    press_in_mm : how far the resting key already presses it in.
    """

    base_mm: float
    top_mm: float
    height_mm: float
    wall_mm: float
    hinge_mm: float
    hardness_shoreA: float
    press_in_mm: float

    def __post_init__(self) -> None:
        if not 0 < self.top_mm < self.base_mm or min(self.height_mm, self.wall_mm) <= 0:
            raise ModelError(f"a dome needs a top narrower than its base, a height and a wall, got {self}")
        if self.hinge_mm < 0:
            raise ModelError(f"a hinge has a thickness, got {self}")

    @property
    def angle_deg(self) -> float:
        """Get the angle of the wall against the board."""
        return math.degrees(math.atan2(self.height_mm, 0.5 * (self.base_mm - self.top_mm)))

    def force_cN(self, x: FloatArray) -> FloatArray:
        """Return the force at displacements of the key (mm); friction, loss and foot left out."""
        young = rubber_MPa(self.hardness_shoreA)
        radii = (0.5 * self.base_mm, 0.5 * self.top_mm)
        # a key that stands off its dome does not pull at it
        s = np.maximum(self.press_in_mm + x, 0.0)
        wall = cone_force_N(s, *radii, self.height_mm, self.wall_mm, young)
        hinge = hinge_force_N(s, *radii, self.height_mm, self.hinge_mm, young)
        return np.asarray(cN_PER_N * (wall + hinge))

    def strain_ratio(self, x: FloatArray) -> float:
        """Return the largest strain of the wall's circumference on the way to the last displacement."""
        strains = _section(
            self.press_in_mm + x, 0.5 * self.base_mm, 0.5 * self.top_mm, self.height_mm, self.wall_mm
        )
        return float(np.abs(strains.strain).max())


@dataclass(frozen=True, eq=False)
class _Section:
    """A turning section: strain and its rate over the angle (n, points), weights (points,), lever (n,)."""

    strain: FloatArray
    rate: FloatArray
    weight: FloatArray
    along_mm: FloatArray


def _section(s: FloatArray, outer: float, inner: float, height: float, wall: float) -> _Section:
    """Turn the section; a point u along and z across the wall from the neutral ring c has radius
    c + u cos b + z sin b at the wall's angle b."""
    first, cosine, sine = _angles(s, outer, inner, height)
    neutral = (outer - inner) / math.log(outer / inner)
    start, end = (inner - neutral) / math.cos(first), (outer - neutral) / math.cos(first)
    u, wu = np.polynomial.legendre.leggauss(ALONG)
    z, wz = np.polynomial.legendre.leggauss(ACROSS)
    grid = np.meshgrid(0.5 * (end - start) * u + 0.5 * (end + start), 0.5 * wall * z, indexing="ij")
    weight = np.outer(0.5 * (end - start) * wu, 0.5 * wall * wz).ravel()
    u, z = (points.ravel() for points in grid)
    radius = neutral + u * math.cos(first) + z * math.sin(first)
    strain = np.outer(cosine - math.cos(first), u) + np.outer(sine - math.sin(first), z)
    rate = np.outer(-sine, u) + np.outer(cosine, z)
    meridian = math.hypot(outer - inner, height)
    return _Section(strain / radius, rate / radius, weight * radius, meridian * cosine)


def _angles(s: FloatArray, outer: float, inner: float, height: float) -> tuple[float, FloatArray, FloatArray]:
    meridian = math.hypot(outer - inner, height)
    sine = np.clip((height - s) / meridian, -0.999, 0.999)
    return math.atan2(height, outer - inner), np.sqrt(1.0 - sine**2), sine


def cone_force_N(
    s: FloatArray,
    outer_mm: float,
    inner_mm: float,
    height_mm: float,
    wall_mm: float,
    young_MPa: float,
    poisson_ratio: float = RUBBER_POISSON_ratio,
) -> FloatArray:
    """Return the force of a truncated cone pressed in by s (mm), edges free to turn and to widen.

    outer_mm : radius of the wall's middle line at its foot; inner_mm : at its top; height_mm : of that line;
    wall_mm : thickness of the wall; young_MPa : Young's modulus; poisson_ratio : Poisson's.
    """
    part = _section(s, outer_mm, inner_mm, height_mm, wall_mm)
    moment = np.einsum("ij,ij,j->i", part.strain, part.rate, part.weight)
    modulus = young_MPa / (1.0 - poisson_ratio**2)
    return np.asarray(-2.0 * math.pi * modulus * moment / np.maximum(part.along_mm, FLATTEST))


def hinge_force_N(
    s: FloatArray, outer_mm: float, inner_mm: float, height_mm: float, hinge_mm: float, young_MPa: float
) -> FloatArray:
    """Return the force of two bent rings, E h^3 / (12 (1 - v^2) l) of moment per length and angle."""
    first, cosine, sine = _angles(s, outer_mm, inner_mm, height_mm)
    plate = young_MPa * hinge_mm**2 / (12.0 * HINGE_LENGTH_ratio * (1.0 - RUBBER_POISSON_ratio**2))
    turned = first - np.arctan2(sine, cosine)
    meridian = math.hypot(outer_mm - inner_mm, height_mm)
    rings = 2.0 * math.pi * (outer_mm + inner_mm)
    return np.asarray(rings * plate * turned / np.maximum(meridian * cosine, FLATTEST))


@dataclass(frozen=True)
class Pin:
    """A pin of rubber that is compressed along its axis, E A / L."""

    diameter_mm: float
    length_mm: float
    hardness_shoreA: float

    def __post_init__(self) -> None:
        if not (self.diameter_mm >= 0 and self.length_mm > 0):
            raise ModelError(f"a pin has a diameter and a length, got {self}")

    @property
    def stiffness_cN_mm(self) -> float:
        """Get its stiffness."""
        area = 0.25 * math.pi * self.diameter_mm**2
        return cN_PER_N * rubber_MPa(self.hardness_shoreA) * area / self.length_mm


@dataclass(frozen=True)
class DomeMechanism:
    """A dome under a guided key, a soft pad between them, and what the dome's top meets after a gap.

    Loss in the rubber grows with its force, as the guide's load_ratio has it.

    Attributes
    ----------
    foot : a pin of rubber or a leaf of metal.
    gap_mm : how far the dome's top goes before the foot bears.
    pad : the pin of rubber that gives way between key and dome; None where the key sits on the dome.
    """

    dome: Dome
    guide: Guide
    foot: Pin | Leaf
    gap_mm: float
    pad: Pin | None = None

    kind = "dome"

    @property
    def tip_mm(self) -> float:
        """Get the height of the foot's tip over the plane of the dome's base, on which it stands."""
        return self.dome.height_mm - 0.5 * self.dome.hinge_mm - self.dome.press_in_mm - self.gap_mm

    @property
    def rim_mm(self) -> float:
        """Get the height of the rim under the base: a cone goes on past flat, so its top must find room."""
        length = self.foot.length_mm if isinstance(self.foot, Pin) else LEAF_ROOM_mm
        return max(length - self.tip_mm - 0.5 * self.dome.hinge_mm, 0.0)

    def strokes_cN(self, x: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return the slow press and release at displacements (mm), each as long as x."""
        top = np.linspace(0.0, max(float(x[-1]), LEAST_WAY_mm), TOPS)
        force = self.dome.force_cN(top) + self.foot.stiffness_cN_mm * np.maximum(top - self.gap_mm, 0.0)
        give = 0.0 if self.pad is None else 1.0 / self.pad.stiffness_cN_mm
        held = through_pad_cN(x, top, force, give)
        return self.guide.strokes_cN(x, held, held)


def through_pad_cN(x: FloatArray, top_mm: FloatArray, force_cN: FloatArray, give_mm_cN: float) -> FloatArray:
    """Return the force on the key at x (mm) from that on the dome's top, a pad of that give between them.

    Where a soft pad lets the top run ahead of the key, the key jumps to the force beyond.
    """
    key = top_mm + give_mm_cN * (force_cN - force_cN[0])
    return np.asarray(np.interp(x, np.maximum.accumulate(key), force_cN))
