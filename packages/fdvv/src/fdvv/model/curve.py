"""Force on displacement for one stroke at one velocity: as measured, and as a B-spline."""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum
from typing import Annotated, Protocol

import numpy as np
import numpy.typing as npt
from msgspec import Meta

from fdvv.errors import ModelError
from fdvv.model import bspline
from fdvv.model.bspline import ExactlyEqual, LARGEST_cN, LARGEST_mm, check_size, check_velocity, set_columns
from fdvv.model.spread import CurveSpread
from fdvv.units import Column, FloatArray


class Stroke(StrEnum):
    """The two halves of a button's cycle."""

    PRESS = "press"
    RELEASE = "release"


class OfStroke(Protocol):
    """Anything that belongs to one stroke at one velocity."""

    @property
    def stroke(self) -> Stroke: ...

    @property
    def velocity_mm_s(self) -> float | None: ...


def reading_order(part: OfStroke) -> tuple[bool, float]:
    """Return the key that sorts presses before releases, slow before fast."""
    return part.stroke is not Stroke.PRESS, part.velocity_mm_s or 0.0


@dataclass(frozen=True, eq=False)
class MeasuredCurve:
    """One measured stroke: raw samples, none dropped or smoothed.

    Attributes
    ----------
    displacement_mm : (n,) in the order of rising displacement, repeats allowed (real stages stick);
        a release is stored in this order too.
    force_cN : (n,) force against the finger at each displacement.
    stroke : press or release.
    velocity_mm_s : mean speed of the stroke; None if the source does not say.

    Raises ModelError on columns of different length, fewer than two samples, falling displacement or
    values that are not finite.
    """

    displacement_mm: FloatArray
    force_cN: FloatArray
    stroke: Stroke
    velocity_mm_s: float | None = None

    def __post_init__(self) -> None:
        set_columns(self, "displacement_mm", "force_cN")
        object.__setattr__(self, "stroke", Stroke(self.stroke))
        check_velocity(self.velocity_mm_s)
        if self.displacement_mm.shape != self.force_cN.shape:
            shapes = f"{self.displacement_mm.shape = } and {self.force_cN.shape = }"
            raise ModelError(f"displacement and force must pair up, got {shapes}")
        if self.displacement_mm.size < 2:
            raise ModelError(f"a curve needs at least 2 samples, got {self.displacement_mm.size}")
        if np.any(np.diff(self.displacement_mm) < 0):
            at = int(np.flatnonzero(np.diff(self.displacement_mm) < 0)[0]) + 1
            raise ModelError(f"displacement_mm must not fall, it does at index {at}")

    def by_displacement(self) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Average the samples that share a displacement: (displacement_mm, force_cN, count), each (m,).

        A stage that sticks repeats its displacement; a curve is single-valued, so the mean of the
        repeats is the raw curve. The displacement comes out strictly rising.
        """
        displacement, inverse, count = np.unique(
            self.displacement_mm, return_inverse=True, return_counts=True
        )
        force = np.bincount(inverse, self.force_cN) / count
        return displacement, force, count.astype(np.float64)

    def between(self, start_mm: float, end_mm: float) -> MeasuredCurve:
        """Keep the samples with start_mm <= displacement <= end_mm."""
        keep = (self.displacement_mm >= start_mm) & (self.displacement_mm <= end_mm)
        return MeasuredCurve(self.displacement_mm[keep], self.force_cN[keep], self.stroke, self.velocity_mm_s)


@dataclass(frozen=True, eq=False)
class ForceCurve(ExactlyEqual):
    """Force on displacement for one stroke at one velocity, as a clamped B-spline.

    Attributes
    ----------
    stroke : press or release.
    velocity_mm_s : mean speed of the stroke; None if it is unknown (a slow bench measurement).
    degree : polynomial degree, 1 to 5.
    knots_mm : (n + degree + 1,) not falling, the first and last degree + 1 equal; they bound the curve.
    control_points_cN : (n,) one force per basis function; with ``control_points_mm`` (the Greville
        abscissae) these are the points a designer drags.
    spread : how the presses it was averaged from differ; None if it was not measured that way. It belongs to
        this shape at this stroke and velocity: a change of one of them resets it to None.

    Outside its knots the curve holds its end values, with derivative 0: a resting cap and a stop are
    not part of the curve. Raises ModelError on anything that is not such a spline.
    """

    stroke: Stroke
    velocity_mm_s: Annotated[float, Meta(gt=0)] | None
    degree: Annotated[int, Meta(ge=1, le=5)]
    knots_mm: Annotated[Column, Meta(min_length=4)]
    control_points_cN: Annotated[Column, Meta(min_length=2)]
    spread: CurveSpread | None = None

    def __post_init__(self) -> None:
        object.__setattr__(self, "stroke", Stroke(self.stroke))
        set_columns(self, "knots_mm", "control_points_cN")
        check_velocity(self.velocity_mm_s)
        check_size(self.knots_mm, LARGEST_mm, "knots_mm")
        check_size(self.control_points_cN, LARGEST_cN, "control_points_cN")
        bspline.check(self.knots_mm, self.control_points_cN, self.degree)

    @property
    def start_mm(self) -> float:
        return float(self.knots_mm[0])

    @property
    def end_mm(self) -> float:
        return float(self.knots_mm[-1])

    @property
    def control_points_mm(self) -> FloatArray:
        """Return the (n,) Greville abscissae: the displacement of each control point."""
        return bspline.greville(self.knots_mm, self.degree)

    def force_cN(self, displacement_mm: npt.ArrayLike) -> FloatArray:
        """Evaluate the force, in the shape of displacement_mm; end values outside the knots."""
        return bspline.evaluate(self.knots_mm, self.control_points_cN, self.degree, displacement_mm)

    def stiffness_cN_mm(self, displacement_mm: npt.ArrayLike) -> FloatArray:
        """Evaluate dF/dx in cN/mm, in the shape of displacement_mm; 0 outside the knots."""
        return bspline.evaluate(self.knots_mm, self.control_points_cN, self.degree, displacement_mm, 1)

    def sample(self, step_mm: float = 0.05) -> MeasuredCurve:
        """Sample the curve from start to end, about every step_mm, both ends included."""
        count = max(2, round((self.end_mm - self.start_mm) / step_mm) + 1)
        displacement = np.linspace(self.start_mm, self.end_mm, count)
        return MeasuredCurve(displacement, self.force_cN(displacement), self.stroke, self.velocity_mm_s)
