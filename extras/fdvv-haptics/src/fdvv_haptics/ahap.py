"""Apple's AHAP, the haptic patterns of Core Haptics: events and curves of intensity and sharpness, as JSON.

Keys, ranges and meaning: Apple, "Representing haptic patterns in AHAP files". Parameter curves multiply an
event's intensity and are added to its sharpness; missing values have defaults, values outside are clamped,
unknown keys are ignored. Every parameter curve acts on all events of the pattern.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import msgspec
import numpy as np

from fdvv.errors import InputError, ModelError
from fdvv.formats.exchange.exported import Exported
from fdvv.model.vibration import Vibration
from fdvv.units import FloatArray
from fdvv_haptics.json_file import check_points, json_bytes, read_json
from fdvv_haptics.pulse import Curves, LONGEST_s, Pulse, frequency_Hz, read_scale

REMEDY = "give an AHAP file with at least one haptic event"
POINTS_per_curve = 16
"""Longer curves are cut into several. Apple states no limit; writers of AHAP are said to keep to this one."""
TRANSIENT_s = 0.03
"""Length of a transient: Apple gives none; it is a click of a few tens of milliseconds."""
DEFAULT, DEFAULT_SHARPNESS = 1.0, 0.5
HAPTIC = ("HapticContinuous", "HapticTransient")
"""Event types that are read; the others are sounds."""
CONTROLS = (("HapticIntensityControl", 1.0), ("HapticSharpnessControl", 0.0))
"""Curves that act on all events, and what holds before their first point."""


class Point(msgspec.Struct, rename="pascal"):
    """A control point of a curve; its time counts from the curve's."""

    time: float
    parameter_value: float


class Parameter(msgspec.Struct):
    name: str = msgspec.field(name="ParameterID")
    value: float = msgspec.field(name="ParameterValue")


class Event(msgspec.Struct, rename="pascal"):
    time: float
    event_type: str
    event_duration: float = 0.0
    event_parameters: list[Parameter] = []


class Curve(msgspec.Struct):
    """A curve that changes all events while it lasts."""

    name: str = msgspec.field(name="ParameterID")
    time: float = msgspec.field(name="Time")
    points: list[Point] = msgspec.field(name="ParameterCurveControlPoints")


class Part(msgspec.Struct, rename="pascal"):
    """One entry of the pattern; of others than these two nothing is read."""

    event: Event | None = None
    parameter_curve: Curve | None = None


class Pattern(msgspec.Struct, rename="pascal"):
    pattern: list[Part]
    metadata: dict[str, Any] = {}


def ahap(vibration: Vibration, name: str = "vibration") -> Exported:
    """Write a vibration as one continuous event with its curves of intensity and sharpness.

    Raises ModelError if the vibration is silent or longer than an event may be.
    """
    drawn = Curves.of(vibration)
    if drawn.t_s[-1] > LONGEST_s:
        raise ModelError(f"an event of AHAP lasts {LONGEST_s:g} s at most, got {drawn.t_s[-1]:g} s")
    base = float(drawn.sharpness[0])
    event = {
        "Time": 0.0,
        "EventType": "HapticContinuous",
        "EventDuration": float(drawn.t_s[-1]),
        "EventParameters": [
            {"ParameterID": "HapticIntensity", "ParameterValue": 1.0},
            {"ParameterID": "HapticSharpness", "ParameterValue": base},
        ],
    }
    pattern: list[dict[str, Any]] = [{"Event": event}]
    pattern += _curves("HapticIntensityControl", drawn.t_s, drawn.intensity)
    if np.ptp(drawn.sharpness) > 1e-6:
        pattern += _curves("HapticSharpnessControl", drawn.t_s, drawn.sharpness - base)
    about = {"Project": name, "Description": drawn.description}
    data = json_bytes({"Version": 1.0, "Metadata": about, "Pattern": pattern})
    kept = ("amplitude over time", "frequency over time, as sharpness")
    return Exported("ahap", data, kept, drawn.lost, {"full_scale_m_s2": drawn.scale_m_s2})


def _curves(name: str, t_s: FloatArray, values: FloatArray) -> list[dict[str, Any]]:
    made = []
    for first in range(0, t_s.size - 1, POINTS_per_curve - 1):
        part = slice(first, first + POINTS_per_curve)
        start = float(t_s[first])
        points = [
            {"Time": float(t) - start, "ParameterValue": float(value)}
            for t, value in zip(t_s[part], values[part], strict=True)
        ]
        curve = {"ParameterID": name, "Time": start, "ParameterCurveControlPoints": points}
        made.append({"ParameterCurve": curve})
    return made


def read_ahap(source: Path | str | bytes, scale_m_s2: float | None = None) -> Pulse:
    """Read the haptic events of an AHAP file as one pulse; sounds are left out.

    scale_m_s2 : what intensity 1 stands for; by default what the file's description says.
    Where events overlap the stronger one sets the frequency and their powers add. Raises InputError.
    """
    name = "AHAP" if isinstance(source, bytes) else str(source)
    found = read_json(source, Pattern, name, REMEDY)
    check_points(name, "$.Pattern", len(found.pattern), REMEDY)
    events = [p.event for p in found.pattern if p.event and p.event.event_type in HAPTIC]
    if not events:
        raise InputError(name, "$.Pattern", "no haptic event in it", REMEDY)
    curves = [p.parameter_curve for p in found.pattern if p.parameter_curve]
    check_points(name, "$.Pattern", sum(len(c.points) for c in curves), REMEDY)
    if scale_m_s2 is None:
        scale_m_s2 = read_scale(found.metadata.get("Description"), name, "intensity")
    try:
        return _joined(events, curves, scale_m_s2)
    except ModelError as error:
        raise InputError(name, "$.Pattern", str(error), REMEDY) from error


def _duration_s(event: Event) -> float:
    held = TRANSIENT_s if event.event_type == "HapticTransient" else event.event_duration
    if not (0 < held <= LONGEST_s and 0 <= event.time <= 3600):
        raise ModelError(f"an event at {event.time:g} s of {held:g} s cannot be played")
    return held


def _joined(events: list[Event], curves: list[Curve], scale: float) -> Pulse:
    start = min(event.time for event in events)
    end = max(event.time + _duration_s(event) for event in events)
    if end - start > LONGEST_s:
        raise ModelError(f"the pattern lasts {end - start:g} s, a button's vibration at most {LONGEST_s:g} s")
    corners = {0.0, end - start}
    corners |= {c.time + p.time - start for c in curves for p in c.points}
    corners |= {event.time - start for event in events}
    # events that fade or overlap bend between their corners; one alone does not
    bends = len(events) > 1 or events[0].event_type == "HapticTransient"
    grid = np.linspace(0.0, end - start, 500 if bends else 2)
    t = np.unique(np.append(grid, [c for c in corners if 0 <= c <= end - start]))
    power, pitch, loudest = np.zeros(t.size), np.full(t.size, DEFAULT_SHARPNESS), np.zeros(t.size)
    intensity, shift = (_control(curves, n, t + start, d) for n, d in CONTROLS)
    for event in events:
        at = t + start - event.time
        # the last corner is start + duration, which rounding may put behind the event's end
        inside = (at >= 0) & (at <= _duration_s(event) * (1 + 1e-12))
        own = np.where(inside, _value(event, "HapticIntensity", DEFAULT) * intensity, 0.0)
        if event.event_type == "HapticTransient":
            own = own * np.maximum(0.0, 1 - at / TRANSIENT_s)
        own = np.clip(own, 0.0, 1.0)
        power += own**2
        pitch = np.where(own > loudest, _value(event, "HapticSharpness", DEFAULT_SHARPNESS) + shift, pitch)
        loudest = np.maximum(own, loudest)
    return Pulse(t, scale * np.minimum(np.sqrt(power), 1.0), frequency_Hz(pitch))


def _value(event: Event, name: str, default: float) -> float:
    return min(max(next((p.value for p in event.event_parameters if p.name == name), default), 0.0), 1.0)


def _control(curves: list[Curve], name: str, t: FloatArray, default: float) -> FloatArray:
    points = sorted((c.time + p.time, p.parameter_value) for c in curves if c.name == name for p in c.points)
    if not points:
        return np.full(t.size, default)
    at, value = (np.array(column) for column in zip(*points, strict=True))
    return np.asarray(np.interp(t, at, value, left=default))
