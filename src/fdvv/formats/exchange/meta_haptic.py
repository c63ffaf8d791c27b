"""Meta's .haptic, written by Haptics Studio: envelopes of amplitude and frequency, as JSON.

Fields, ranges and rules: the data model of the Haptics SDK, version 1.0.0. Both envelopes are 0 to 1; which
frequencies the second stands for is the player's affair. A breakpoint may have an emphasis, a click of its
own.
"""

from __future__ import annotations

import json
from pathlib import Path

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

WHAT = "a .haptic file of major version 1 with an amplitude envelope"
MIDDLE = 0.5
"""Frequency where a file has no frequency envelope."""
LONGEST_s = 30.0


class Emphasis(msgspec.Struct):
    """A click at a breakpoint; needs both values."""

    amplitude: float
    frequency: float


class Amplitude(msgspec.Struct):
    """A breakpoint of the amplitude."""

    time: float
    amplitude: float
    emphasis: Emphasis | None = None


class Frequency(msgspec.Struct):
    """A breakpoint of the frequency."""

    time: float
    frequency: float


class Envelopes(msgspec.Struct):
    """The two envelopes."""

    amplitude: list[Amplitude]
    frequency: list[Frequency] | None = None


class Continuous(msgspec.Struct):
    """The one continuous signal."""

    envelopes: Envelopes


class Signals(msgspec.Struct):
    """All signals; there is one."""

    continuous: Continuous


class Version(msgspec.Struct):
    """Of the format."""

    major: int
    minor: int = 0
    patch: int = 0


class Metadata(msgspec.Struct):
    """What people wrote about it."""

    description: str = ""


class Haptic(msgspec.Struct):
    """A .haptic file."""

    version: Version
    signals: Signals
    metadata: Metadata | None = None


def meta_haptic(vibration: Vibration, name: str = "vibration") -> Exported:
    """Write a vibration as the two envelopes. Raises ModelError if it is silent."""
    pulse = pulse_of(vibration)
    scale = scale_of(pulse)
    times = pulse.t_s.tolist()
    loud, pitch = (pulse.amplitude_m_s2 / scale).tolist(), sharpness(pulse.frequency_Hz).tolist()
    envelopes = {
        "amplitude": [{"time": t, "amplitude": a} for t, a in zip(times, loud, strict=True)],
        "frequency": [{"time": t, "frequency": f} for t, f in zip(times, pitch, strict=True)],
    }
    record = {
        "version": {"major": 1, "minor": 0, "patch": 0},
        "metadata": {
            "editor": "fdvv",
            "source": "",
            "project": name,
            "tags": [],
            "description": describe_scale(scale),
        },
        "signals": {"continuous": {"envelopes": envelopes}},
    }
    return Exported(
        "haptic",
        (json.dumps(record, indent=2, ensure_ascii=False, allow_nan=False) + "\n").encode(),
        ("amplitude over time", "frequency over time, as 0 to 1"),
        ("phase, so the wave's own shape", "the place of the onset and the stroke", *clipped(vibration)),
        {"full_scale_m_s2": scale},
    )


def read_meta_haptic(source: Path | str | bytes, scale_m_s2: float | None = None) -> Pulse:
    """Read a .haptic file as a pulse; an emphasis lifts the amplitude of its breakpoint.

    scale_m_s2 : what amplitude 1 stands for; by default what the file's description says.
    Raises InputError.
    """
    name = ".haptic" if isinstance(source, bytes) else str(source)
    found = read_json(source, Haptic, name, WHAT)
    if found.version.major != 1:
        raise refuse(name, "$.version.major", f"version {found.version.major} is not known here", WHAT)
    envelopes = found.signals.continuous.envelopes
    place = "$.signals.continuous.envelopes"
    check_points(name, place, len(envelopes.amplitude) + len(envelopes.frequency or []), WHAT)
    text = found.metadata.description if found.metadata else ""
    scale = scale_m_s2 if scale_m_s2 is not None else read_scale(text)
    if scale is None:
        raise refuse(name, "amplitude", "the file does not say what 1 stands for", "the full scale in m/s2")
    try:
        return _pulse(envelopes, scale)
    except ModelError as error:
        raise refuse(name, place, str(error), WHAT) from error


def _pulse(envelopes: Envelopes, scale: float) -> Pulse:
    t = np.array([p.time for p in envelopes.amplitude])
    loud = np.array(
        [max(p.amplitude, p.emphasis.amplitude if p.emphasis else 0.0) for p in envelopes.amplitude]
    )
    if t.size < 2 or np.any(np.diff(t) < 0) or not (t[0] >= 0 and t[-1] <= LONGEST_s):
        raise ModelError(f"the amplitude needs 2 or more times that rise from 0 to at most {LONGEST_s:g} s")
    if np.any((loud < 0) | (loud > 1)):
        raise ModelError("an amplitude lies outside 0 to 1")
    pitch = envelopes.frequency or [Frequency(float(t[0]), MIDDLE)]
    at, value = np.array([p.time for p in pitch]), np.array([p.frequency for p in pitch])
    if np.any(np.diff(at) < 0) or np.any((value < 0) | (value > 1)):
        raise ModelError("the frequency needs times that rise and values of 0 to 1")
    # a step is two breakpoints at one time; the later of them holds
    keep = np.append(np.diff(t) > 0, True)
    t, loud = t[keep], loud[keep]
    if t[0] > 0:
        t, loud = np.append(0.0, t), np.append(0.0, loud)
    return Pulse(t, scale * loud, frequency_Hz(np.interp(t, at, value)))
