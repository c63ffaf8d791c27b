"""A button's snap as the detents of a SmartKnob: the fields of its SmartKnobConfig, as JSON.

The knob's firmware pulls towards the centre of the detent it is at, stiffness times angle, and goes to the
next one where the angle passes the snap point, in widths; snap_point_bias moves that point away from
position 0, for the way out and back alike, and may not be negative. Two positions one travel apart
therefore make a button that snaps where its press peaks and returns where its release does: position 0 is
the end that those places lie further from. Field names, law and limits: scottbez1/smartknob,
proto/smartknob.proto and firmware/src/motor_task.cpp. A dead zone of a fifth of the width, at most a
degree, lies around each centre.
"""

from __future__ import annotations

import math
from dataclasses import asdict, dataclass

import numpy as np

from fdvv.errors import ModelError
from fdvv.formats.exchange.exported import Exported
from fdvv.model.bump import Bump, find_bump
from fdvv.model.curve import ForceCurve, Stroke
from fdvv.model.model import FDVVModel
from fdvv.units import FloatArray
from fdvv_haptics.json_file import json_bytes

DEGREES_per_mm = 10.0
"""A travel of 4 mm becomes 40 degrees, near the 60 of the knob's own on/off switch."""
FALL_cN = 20.0
"""A fall of this much is strength 1: the knob's unit is its motor's, and no force."""
STRONGEST = 1.0
"""More may make the knob unstable, its definition says."""
DEAD_ratio, DEAD_degrees = 0.2, 1.0
LONGEST_TEXT_bytes = 50
STEP_mm = 0.005


@dataclass(frozen=True)
class KnobDetents:
    """The fields of a SmartKnobConfig, by their names there; strengths have no unit, usual are 0 to 1.

    Attributes
    ----------
    position : that of the released button, where the knob starts.
    min_position, max_position : its ends; a single position has no detent but the end stop's spring.
    position_width_radians : from one position to the next.
    detent_strength_unit, endstop_strength_unit : stiffness within the ends and beyond them.
    snap_point, snap_point_bias : where the next position takes over, in widths, and how far that is moved.
    text : at most 50 bytes, the name of this configuration.
    """

    position: int
    min_position: int
    max_position: int
    position_width_radians: float
    detent_strength_unit: float
    endstop_strength_unit: float
    snap_point: float
    text: str
    snap_point_bias: float = 0.0

    @property
    def snaps_at_ratio(self) -> tuple[float, float] | None:
        """Return where it snaps when pressed and when released, in widths from the released position."""
        if self.max_position == self.min_position:
            return None
        bias = self.snap_point_bias if self.position == 0 else -self.snap_point_bias
        return self.snap_point + bias, 1 - self.snap_point + bias

    def pull(self, way_ratio: FloatArray, pressed: bool) -> FloatArray:
        """Return the knob's torque, strength times radians, between released (0) and pressed (1)."""
        width = self.position_width_radians
        off = (np.asarray(way_ratio, dtype=np.float64) - float(pressed)) * width
        dead = min(width * DEAD_ratio, math.radians(DEAD_degrees))
        alone = self.max_position == self.min_position
        outside = (off < 0) & (alone | (not pressed)) | (off > 0) & (alone | pressed)
        strength = np.where(outside, self.endstop_strength_unit, self.detent_strength_unit)
        return np.asarray(strength * (off - np.clip(off, -dead, dead)))


def smartknob(
    model: FDVVModel, velocity_mm_s: float | None = None, degrees_per_mm: float = DEGREES_per_mm
) -> Exported:
    """Write a button as a SmartKnobConfig in JSON, and report how much of its force that is.

    Raises ModelError if the model has no press curve or the scale is not positive.
    """
    detents = knob_detents(model, velocity_mm_s, degrees_per_mm)
    snaps = detents.snaps_at_ratio is not None
    lost = ["force in cN (the knob's strength is its motor's)"]
    lost += [
        "preload, and every slope that is not the detent's" if snaps else "preload and the curve's shape"
    ]
    lost += ["velocities", *(["vibrations"] if model.vibrations else [])]
    snap = ("where it snaps and returns", "the fall of force, as a strength")
    kept = snap if snaps else ("that it has no snap",)
    figures = _figures(model, velocity_mm_s, detents)
    return Exported("smartknob", json_bytes(asdict(detents)), kept, tuple(lost), figures)


def knob_detents(
    model: FDVVModel, velocity_mm_s: float | None = None, degrees_per_mm: float = DEGREES_per_mm
) -> KnobDetents:
    """Choose a button's detents: two positions if its press has a bump, else one. Raises ModelError."""
    if not (np.isfinite(degrees_per_mm) and degrees_per_mm > 0):
        raise ModelError(f"degrees_per_mm must be positive, got {degrees_per_mm}")
    width = model.travel_mm * math.radians(degrees_per_mm)
    text = model.name.encode()[:LONGEST_TEXT_bytes].decode(errors="ignore")
    press = _bump(model, _press(model, velocity_mm_s))
    if press is None:
        return KnobDetents(0, 0, 0, width, 0.0, STRONGEST, 1.1, text)
    back = _bump(model, model.nearest(Stroke.RELEASE, velocity_mm_s))
    snap_ratio = press.peak_mm / model.travel_mm
    # a knob cannot return later than it snaps; where the release has no bump it returns where it snapped
    back_ratio = min((back or press).peak_mm / model.travel_mm, snap_ratio)
    middle = (snap_ratio + back_ratio) / 2
    return KnobDetents(
        position=0 if middle >= 0.5 else 1,
        min_position=0,
        max_position=1,
        position_width_radians=width,
        detent_strength_unit=min(STRONGEST, press.drop_cN / FALL_cN),
        endstop_strength_unit=STRONGEST,
        # the firmware refuses less than a half, be it by the last bit
        snap_point=max(0.5, (1 + snap_ratio - back_ratio) / 2),
        text=text,
        snap_point_bias=abs(middle - 0.5),
    )


def _press(model: FDVVModel, velocity_mm_s: float | None) -> ForceCurve:
    curve = model.nearest(Stroke.PRESS, velocity_mm_s)
    if curve is None:
        raise ModelError(f"model {model.name!r} has no press curve to take detents from")
    return curve


def _bump(model: FDVVModel, curve: ForceCurve | None) -> Bump | None:
    if curve is None:
        return None
    x = np.arange(curve.start_mm, model.travel_mm, STEP_mm)
    return find_bump(x, curve.force_cN(x))


def _figures(model: FDVVModel, velocity_mm_s: float | None, detents: KnobDetents) -> dict[str, float | None]:
    way = np.linspace(0.0, 1.0, 800)
    places = detents.snaps_at_ratio
    pressed = way > (places[0] if places else np.inf)
    knob = np.where(pressed, detents.pull(way, True), detents.pull(way, False))
    force = _press(model, velocity_mm_s).force_cN(way * model.travel_mm)
    columns = np.stack([knob, np.ones(way.size)], axis=1)
    left = force - columns @ np.linalg.lstsq(columns, force, rcond=None)[0]
    swing = float(np.mean((force - force.mean()) ** 2))
    return {
        "snap_mm": places[0] * model.travel_mm if places else None,
        "return_mm": places[1] * model.travel_mm if places else None,
        "residual_rms_cN": float(np.sqrt(np.mean(left**2))),
        "explained_ratio": 1 - float(np.mean(left**2)) / swing if swing else None,
    }
