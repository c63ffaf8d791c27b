"""Apple's AHAP, the haptic patterns of Core Haptics: events and curves of intensity and sharpness, as JSON.

Keys, ranges and meaning: Apple, "Representing haptic patterns in AHAP files". Parameter curves multiply an
event's intensity and are added to its sharpness; missing values have defaults, values outside are clamped,
unknown keys are ignored. Every parameter curve acts on all events of the pattern.
"""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import msgspec
import numpy as np

from fdvv.errors import ModelError
from fdvv.formats.exchange.exported import Exported
from fdvv.formats.exchange.pulse import (
    Pulse,
    check_points,
    clipped,
    describe_scale,
    frequency_Hz,
    pulse_of,
    read_json,
    read_scale,
    refuse,
    scale_of,
    sharpness,
)
from fdvv.model.vibration import Vibration
from fdvv.units import FloatArray

WHAT = "an AHAP file with at least one haptic event"
POINTS_per_curve = 16
"""Longer curves are cut into several. Apple states no limit; writers of AHAP are said to keep to this one."""
TRANSIENT_s = 0.03
"""Length of a transient: Apple gives none; it is a click of a few tens of milliseconds."""
LONGEST_s = 30.0
"""An event may last this long in Core Haptics."""
DEFAULT = 1.0
DEFAULT_SHARPNESS = 0.5


class Point(msgspec.Struct, rename="pascal"):
    """A control point of a curve; its time counts from the curve's."""

    time: float
    parameter_value: float


class Parameter(msgspec.Struct):
    """A fixed value of an event."""

    name: str = msgspec.field(name="ParameterID")
    value: float = msgspec.field(name="ParameterValue")


class Event(msgspec.Struct, rename="pascal"):
    """A segment of the pattern."""

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
    """An AHAP file."""

    pattern: list[Part]
    metadata: dict[str, Any] = {}


def ahap(vibration: Vibration, name: str = "vibration") -> Exported:
    """Write a vibration as one continuous event with its curves of intensity and sharpness.

    Raises ModelError if the vibration is silent or longer than an event may be.
    """
    pulse = pulse_of(vibration)
    scale = scale_of(pulse)
    if pulse.t_s[-1] > LONGEST_s:
        raise ModelError(f"an event of AHAP lasts {LONGEST_s:g} s at most, got {pulse.t_s[-1]:g} s")
    pitch = sharpness(pulse.frequency_Hz)
    base = float(pitch[0])
    event = {
        "Time": 0.0,
        "EventType": "HapticContinuous",
        "EventDuration": float(pulse.t_s[-1]),
        "EventParameters": [
            {"ParameterID": "HapticIntensity", "ParameterValue": 1.0},
            {"ParameterID": "HapticSharpness", "ParameterValue": base},
        ],
    }
    pattern: list[dict[str, Any]] = [{"Event": event}]
    pattern += _curves("HapticIntensityControl", pulse.t_s, pulse.amplitude_m_s2 / scale)
    if np.ptp(pitch) > 1e-6:
        pattern += _curves("HapticSharpnessControl", pulse.t_s, pitch - base)
    record = {
        "Version": 1.0,
        "Metadata": {"Project": name, "Description": describe_scale(scale)},
        "Pattern": pattern,
    }
    return Exported(
        "ahap",
        (json.dumps(record, indent=2, ensure_ascii=False, allow_nan=False) + "\n").encode(),
        ("amplitude over time", "frequency over time, as sharpness"),
        ("phase, so the wave's own shape", "the place of the onset and the stroke", *clipped(vibration)),
        {"full_scale_m_s2": scale},
    )


def _curves(name: str, t_s: FloatArray, values: FloatArray) -> list[dict[str, Any]]:
    made = []
    for first in range(0, t_s.size - 1, POINTS_per_curve - 1):
        part = slice(first, first + POINTS_per_curve)
        start = float(t_s[first])
        points = [
            {"Time": float(t) - start, "ParameterValue": float(value)}
            for t, value in zip(t_s[part], values[part], strict=True)
        ]
        made.append(
            {"ParameterCurve": {"ParameterID": name, "Time": start, "ParameterCurveControlPoints": points}}
        )
    return made


def read_ahap(source: Path | str | bytes, scale_m_s2: float | None = None) -> Pulse:
    """Read the haptic events of an AHAP file as one pulse; sounds are left out.

    scale_m_s2 : what intensity 1 stands for; by default what the file's description says.
    Where events overlap the stronger one sets the frequency and their powers add. Raises InputError.
    """
    name = "AHAP" if isinstance(source, bytes) else str(source)
    found = read_json(source, Pattern, name, WHAT)
    check_points(name, "$.Pattern", len(found.pattern), WHAT)
    events = [p.event for p in found.pattern if p.event and p.event.event_type in DURATIONS]
    if not events:
        raise refuse(name, "$.Pattern", "no haptic event in it", WHAT)
    curves = [p.parameter_curve for p in found.pattern if p.parameter_curve]
    check_points(name, "$.Pattern", sum(len(c.points) for c in curves), WHAT)
    scale = scale_m_s2 if scale_m_s2 is not None else read_scale(found.metadata.get("Description"))
    if scale is None:
        raise refuse(name, "intensity", "the file does not say what 1 stands for", "the full scale in m/s2")
    try:
        return _joined(events, curves, scale)
    except ModelError as error:
        raise refuse(name, "$.Pattern", str(error), WHAT) from error


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
    value = next((p.value for p in event.event_parameters if p.name == name), default)
    return min(max(value, 0.0), 1.0)


def _control(curves: list[Curve], name: str, t: FloatArray, default: float) -> FloatArray:
    points = sorted((c.time + p.time, p.parameter_value) for c in curves if c.name == name for p in c.points)
    if not points:
        return np.full(t.size, default)
    at, value = (np.array(column) for column in zip(*points, strict=True))
    return np.asarray(np.interp(t, at, value, left=default))


DURATIONS = ("HapticContinuous", "HapticTransient")
CONTROLS = (("HapticIntensityControl", 1.0), ("HapticSharpnessControl", 0.0))
