"""Meta's .haptic, written by Haptics Studio: envelopes of amplitude and frequency, as JSON.

Fields, ranges and rules: the data model of the Haptics SDK, version 1.0.0. Both envelopes are 0 to 1; which
frequencies the second stands for is the player's affair. A breakpoint may have an emphasis, a click of its
own.
"""

from __future__ import annotations

from pathlib import Path

import msgspec
import numpy as np

from fdvv.errors import InputError, ModelError
from fdvv.formats.exchange.exported import Exported
from fdvv.model.vibration import Vibration
from fdvv_haptics.json_file import check_points, json_bytes, read_json
from fdvv_haptics.pulse import Curves, LONGEST_s, Pulse, frequency_Hz, read_scale

REMEDY = "give a .haptic file of major version 1 with an amplitude envelope"
MIDDLE = 0.5
"""Frequency where a file has no frequency envelope."""


class Emphasis(msgspec.Struct):
    """A click at a breakpoint; needs both values."""

    amplitude: float
    frequency: float


class Amplitude(msgspec.Struct):
    time: float
    amplitude: float
    emphasis: Emphasis | None = None


class Frequency(msgspec.Struct):
    time: float
    frequency: float


class Envelopes(msgspec.Struct):
    amplitude: list[Amplitude]
    frequency: list[Frequency] | None = None


class Continuous(msgspec.Struct):
    envelopes: Envelopes


class Signals(msgspec.Struct):
    continuous: Continuous


class Version(msgspec.Struct):
    major: int
    minor: int = 0
    patch: int = 0


class Metadata(msgspec.Struct):
    description: str = ""


class Haptic(msgspec.Struct):
    version: Version
    signals: Signals
    metadata: Metadata | None = None


def meta_haptic(vibration: Vibration, name: str = "vibration") -> Exported:
    """Write a vibration as the two envelopes. Raises ModelError if it is silent."""
    drawn = Curves.of(vibration)
    columns = (column.tolist() for column in (drawn.t_s, drawn.intensity, drawn.sharpness))
    points = list(zip(*columns, strict=True))
    envelopes = {
        "amplitude": [{"time": t, "amplitude": intensity} for t, intensity, _ in points],
        "frequency": [{"time": t, "frequency": pitch} for t, _, pitch in points],
    }
    about = {"editor": "fdvv", "source": "", "project": name, "tags": [], "description": drawn.description}
    record = {
        "version": {"major": 1, "minor": 0, "patch": 0},
        "metadata": about,
        "signals": {"continuous": {"envelopes": envelopes}},
    }
    kept = ("amplitude over time", "frequency over time, as 0 to 1")
    return Exported("haptic", json_bytes(record), kept, drawn.lost, {"full_scale_m_s2": drawn.scale_m_s2})


def read_meta_haptic(source: Path | str | bytes, scale_m_s2: float | None = None) -> Pulse:
    """Read a .haptic file as a pulse; an emphasis lifts the amplitude of its breakpoint.

    scale_m_s2 : what amplitude 1 stands for; by default what the file's description says.
    Raises InputError.
    """
    name = ".haptic" if isinstance(source, bytes) else str(source)
    found = read_json(source, Haptic, name, REMEDY)
    if found.version.major != 1:
        reason = f"version {found.version.major} is not known here"
        raise InputError(name, "$.version.major", reason, REMEDY)
    envelopes = found.signals.continuous.envelopes
    place = "$.signals.continuous.envelopes"
    check_points(name, place, len(envelopes.amplitude) + len(envelopes.frequency or []), REMEDY)
    if scale_m_s2 is None:
        scale_m_s2 = read_scale(found.metadata and found.metadata.description, name, "amplitude")
    try:
        return _pulse(envelopes, scale_m_s2)
    except ModelError as error:
        raise InputError(name, place, str(error), REMEDY) from error


def _pulse(envelopes: Envelopes, scale: float) -> Pulse:
    t = np.array([p.time for p in envelopes.amplitude])
    clicks = [p.emphasis.amplitude if p.emphasis else 0.0 for p in envelopes.amplitude]
    loud = np.array([max(p.amplitude, click) for p, click in zip(envelopes.amplitude, clicks, strict=True)])
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
