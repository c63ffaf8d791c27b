"""What sets the axis of the rod off the axis of the sensor: one line per cause, worst case and likely.

Coil pocket and bushing's seat are bored in one part, so no joint lies between the two bearings. The sensor's
mount stands on the base and is moved until the core runs free, so what follows is what that must take up.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

from fdvv_rig.dimensions import Dimensions


@dataclass(frozen=True)
class Cause:
    """One cause of an offset, either way, in mm."""

    name: str
    either_way_mm: float


@dataclass(frozen=True)
class Stack:
    """Causes that add up between two axes."""

    causes: tuple[Cause, ...]

    @property
    def worst_mm(self) -> float:
        """Get the offset when every cause is at its end and all lie the same way."""
        return sum(cause.either_way_mm for cause in self.causes)

    @property
    def likely_mm(self) -> float:
        """Get the root of the sum of squares."""
        return math.sqrt(sum(cause.either_way_mm**2 for cause in self.causes))


def core_stack(d: Dimensions) -> Stack:
    """Return what sets the sensor's core off the axis of its bore before the mount is moved."""
    play_mm = (d.bushing_bore_mm - d.rod_diameter_mm) / 2
    screws_mm = (d.m3_clearance_mm - 3.0) / 2 + d.print_error_mm
    return Stack(
        (
            Cause("rod in its bushing", play_mm),
            Cause("bushing's seat in the tower", d.print_error_mm),
            Cause("tower on the base: screws in their holes", screws_mm),
            Cause("sensor in its clamp", d.fit_gap_mm),
            Cause("clamp above the mount's foot", d.print_error_mm),
        )
    )


def tilt_deg(d: Dimensions) -> float:
    """Return how far the rod may tilt between coil and bushing for their play, in degrees."""
    apart_mm = d.coil_length_mm + d.bushing_length_mm
    play_mm = (d.bushing_bore_mm + d.coil_bore_mm) / 2 - d.rod_diameter_mm
    return math.degrees(math.atan2(play_mm, apart_mm))


def turn_deg(d: Dimensions, radius_mm: float) -> float:
    """Return how far the slider may turn either way for the gap beside its tongue, in degrees."""
    return math.degrees(math.atan2(d.slide_gap_mm, radius_mm))
