"""The FDVV model of a button: what it should feel like, whatever renders it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from typing import Annotated

import numpy as np
from msgspec import Meta
from numpy.typing import ArrayLike

from fdvv.errors import ModelError
from fdvv.model.bspline import LARGEST_mm, check_size
from fdvv.model.curve import ForceCurve, OfStroke, Stroke, reading_order
from fdvv.model.spread import PointSpread
from fdvv.model.velocity import Interpolation, blend, blend_slope
from fdvv.model.vibration import Vibration
from fdvv.units import FloatArray


@dataclass(frozen=True)
class Provenance:
    """Where a model comes from.

    Attributes
    ----------
    source : the button and who measured it.
    licence : of the measurements, as their publisher states it.
    citation : how to credit it.
    method : how the curves were made from the source.
    assumptions : what no measurement backs, one sentence each.
    simulated : whether the numbers come from the twin.
    """

    source: str = ""
    licence: str = ""
    citation: str = ""
    method: str = ""
    assumptions: tuple[str, ...] = ()
    simulated: bool = False


def _check_velocities(stroke: Stroke, parts: Sequence[OfStroke], what: str) -> None:
    velocities = [part.velocity_mm_s for part in parts if part.stroke is stroke]
    if len(set(velocities)) != len(velocities):
        raise ModelError(f"{stroke} has two {what}s at one velocity: {velocities} mm/s")
    if None in velocities and len(velocities) > 1:
        raise ModelError(f"a {stroke} {what} of unknown velocity must stand alone, got {velocities} mm/s")


@dataclass(frozen=True)
class FDVVModel:
    """Force over displacement and velocity, press and release, with the vibration of the snap.

    Attributes
    ----------
    name : short, as a file would be called.
    travel_mm : from first contact to bottom-out.
    actuation_mm, reset_mm : where the contact closes on the way down and opens on the way up;
        None if unknown.
    curves : at least one; per stroke the velocities differ, and a curve of unknown velocity stands alone.
    vibrations : any number; per stroke the velocities differ.
    interpolation : how force is found between the velocities.
    provenance : where it comes from.
    travel_spread, actuation_spread, reset_spread : how these points differ between presses; None where that
        was not measured.

    Raises ModelError on anything else. Equality is of all numbers, exactly.
    """

    name: Annotated[str, Meta(min_length=1)]
    travel_mm: Annotated[float, Meta(gt=0)]
    curves: Annotated[tuple[ForceCurve, ...], Meta(min_length=1)]
    actuation_mm: Annotated[float, Meta(ge=0)] | None = None
    reset_mm: Annotated[float, Meta(ge=0)] | None = None
    vibrations: tuple[Vibration, ...] = ()
    interpolation: Interpolation = Interpolation.PCHIP
    provenance: Provenance = field(default_factory=Provenance)
    travel_spread: PointSpread | None = None
    actuation_spread: PointSpread | None = None
    reset_spread: PointSpread | None = None

    def __post_init__(self) -> None:
        object.__setattr__(self, "interpolation", Interpolation(self.interpolation))
        object.__setattr__(self, "curves", tuple(sorted(self.curves, key=reading_order)))
        object.__setattr__(self, "vibrations", tuple(self.vibrations))
        if not self.name or self.name != self.name.strip():
            raise ModelError(f"name must be text without spaces at its ends, got {self.name!r}")
        if not (np.isfinite(self.travel_mm) and self.travel_mm > 0):
            raise ModelError(f"travel_mm must be positive, got {self.travel_mm}")
        check_size(self.travel_mm, LARGEST_mm, "travel_mm")
        for label, spread in (("actuation_mm", self.actuation_spread), ("reset_mm", self.reset_spread)):
            point = getattr(self, label)
            if point is None and spread is not None:
                raise ModelError(f"{label} is unknown, so it has no spread")
            if point is not None and not 0 <= point <= self.travel_mm:
                raise ModelError(f"{label} must lie within the travel of {self.travel_mm} mm, got {point}")
        if not self.curves:
            raise ModelError("a model needs at least one curve, got none")
        for stroke in Stroke:
            _check_velocities(stroke, self.curves, "curve")
            _check_velocities(stroke, self.vibrations, "vibration")

    def of(self, stroke: Stroke | str) -> tuple[ForceCurve, ...]:
        """Return the curves of one stroke, velocities rising; empty if it has none."""
        return tuple(c for c in self.curves if c.stroke is Stroke(stroke))

    def nearest(self, stroke: Stroke | str, velocity_mm_s: float | None = None) -> ForceCurve | None:
        """Return the curve nearest in velocity, by default the slowest; None if there is none."""
        wanted = velocity_mm_s or 0.0
        return min(self.of(stroke), key=lambda c: abs((c.velocity_mm_s or 0.0) - wanted), default=None)

    def velocities_mm_s(self, stroke: Stroke | str) -> tuple[float, ...]:
        """Return the known velocities of one stroke, rising."""
        return tuple(c.velocity_mm_s for c in self.of(stroke) if c.velocity_mm_s is not None)

    def _serving(
        self, displacement_mm: ArrayLike, velocity_mm_s: ArrayLike, stroke: Stroke | str
    ) -> tuple[tuple[ForceCurve, ...], Interpolation, FloatArray, FloatArray]:
        """Return the arguments of blend: curves, method, velocities and displacements of one shape."""
        curves = self.of(stroke)
        if not curves:
            raise ModelError(f"model {self.name!r} has no {Stroke(stroke)} curve")
        x, v = np.broadcast_arrays(
            np.asarray(displacement_mm, dtype=np.float64), np.asarray(velocity_mm_s, dtype=np.float64)
        )
        return curves, self.interpolation, np.asarray(v), np.asarray(x)

    def force_cN(
        self, displacement_mm: ArrayLike, velocity_mm_s: ArrayLike, stroke: Stroke | str = Stroke.PRESS
    ) -> FloatArray:
        """Evaluate the force anywhere; displacement and velocity broadcast against each other.

        Outside the measured velocities the nearest one holds, outside the knots the end values.
        Raises ModelError if the model has no curve of that stroke.
        """
        return blend(*self._serving(displacement_mm, velocity_mm_s, stroke))

    def stiffness_cN_mm(
        self, displacement_mm: ArrayLike, velocity_mm_s: ArrayLike, stroke: Stroke | str = Stroke.PRESS
    ) -> FloatArray:
        """Evaluate dF/dx (cN/mm) anywhere, as force_cN does the force."""
        return blend(*self._serving(displacement_mm, velocity_mm_s, stroke), derivative=1)

    def damping_cN_s_mm(
        self, displacement_mm: ArrayLike, velocity_mm_s: ArrayLike, stroke: Stroke | str = Stroke.PRESS
    ) -> FloatArray:
        """Evaluate dF/dv (cN s/mm) anywhere, as force_cN does the force; 0 beyond the measured velocities."""
        return blend_slope(*self._serving(displacement_mm, velocity_mm_s, stroke))

    def vibration(self, stroke: Stroke | str, velocity_mm_s: float) -> Vibration | None:
        """Return the vibration of the stroke nearest in velocity; None if it has none."""
        candidates = [v for v in self.vibrations if v.stroke is Stroke(stroke)]
        return min(candidates, key=lambda v: abs((v.velocity_mm_s or 0.0) - velocity_mm_s), default=None)

    def renamed(self, name: str) -> FDVVModel:
        return replace(self, name=name)

    def __repr__(self) -> str:
        curves = f"{len(self.curves)} curves, {len(self.vibrations)} vibrations"
        return f"FDVVModel({self.name!r}, {self.travel_mm:g} mm, {curves})"
