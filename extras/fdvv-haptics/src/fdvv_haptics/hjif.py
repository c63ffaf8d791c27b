"""MPEG's haptics as JSON, HJIF of ISO/IEC 23090-31: every mode as a sine of its own with its fall.

Fields and their limits: as the standard's reference software reads and checks them (MPEGGroup,
HapticReferenceSoftware, IOJson.cpp). Times are whole ticks, frequencies whole Hz; amplitudes are joined by
straight lines. Unlike AHAP and .haptic it holds phases, and several modes at once, each in a band of its own.
"""

from __future__ import annotations

from itertools import accumulate
from pathlib import Path
from typing import Any

import msgspec
import numpy as np

from fdvv.errors import InputError, ModelError
from fdvv.formats.exchange.exported import Exported
from fdvv.model.vibration import Mode, Vibration
from fdvv.units import FloatArray
from fdvv_haptics.json_file import check_points, json_bytes, read_json
from fdvv_haptics.mjcf import polyline
from fdvv_haptics.pulse import LONGEST_s, Pulse, mode_of, read_scale

REMEDY = "give an HJIF file with sine effects of a vectorial band"
TICKS_Hz = 48_000
"""The finest timescale of the main profile: 21 µs."""
TOLERANCE_ratio = 0.002
BANDS_of_level_1 = 7
HIGHEST_Hz = 24_000


class Keyframe(msgspec.Struct):
    """A corner: ticks after the effect's position, amplitude of -1 to 1, frequency in Hz."""

    relative_position: int = 0
    amplitude_modulation: float | None = None
    frequency_modulation: float | None = None


class Effect(msgspec.Struct):
    position: int
    effect_type: str = "Basis"
    phase: float = 0.0
    base_signal: str = "Sine"
    keyframes: list[Keyframe] = []


class Band(msgspec.Struct):
    band_type: str
    effects: list[Effect]


class Channel(msgspec.Struct):
    bands: list[Band]
    gain: float = 1.0


class Perception(msgspec.Struct):
    perception_modality: str
    channels: list[Channel]


class Hjif(msgspec.Struct):
    perceptions: list[Perception]
    timescale: int = 1000
    description: str = ""


def hjif(vibration: Vibration, date: str, name: str = "vibration") -> Exported:
    """Write a vibration as an HJIF file of the main profile.

    date : ISO 8601, that of the file.
    Raises ModelError if the vibration is silent, longer than 30 s or has a mode above 24 kHz.
    """
    scale = sum(abs(mode.amplitude_m_s2) for mode in vibration.modes)
    if not scale:
        raise ModelError("the vibration is silent, there is nothing to write")
    if vibration.duration_s > LONGEST_s or any(m.frequency_Hz > HIGHEST_Hz for m in vibration.modes):
        raise ModelError(f"at most {LONGEST_s:g} s and {HIGHEST_Hz} Hz can be written")
    bands = [_band(mode, vibration.duration_s, scale) for mode in vibration.modes]
    channel = {
        "id": 0,
        "description": name,
        "gain": 1.0,
        "mixing_coefficient": 1.0,
        "body_part_mask": 0,
        "bands": bands,
    }
    perception = {
        "id": 0,
        "avatar_id": 0,
        "description": name,
        "perception_modality": "Vibrotactile",
        "reference_devices": [],
        "effect_library": [],
        "channels": [channel],
    }
    record = {
        "version": "2025",
        "profile": "Main",
        "level": 1 if len(bands) <= BANDS_of_level_1 else 2,
        "date": date,
        "description": f"{name}; 1 is {scale!r} m/s2 of the cap",
        "timescale": TICKS_Hz,
        "avatars": [],
        "perceptions": [perception],
        "syncs": [],
    }
    lost = ("frequencies to a whole Hz", "the place of the onset and the stroke")
    kept = ("every mode with its phase and fall",)
    return Exported("hjif", json_bytes(record), kept, lost, {"full_scale_m_s2": scale})


def _band(mode: Mode, duration_s: float, scale: float) -> dict[str, Any]:
    """Draw one mode in whole ticks, its decay as straight pieces; a negative amplitude is half a turn."""
    ticks = np.unique(np.linspace(0, max(1, round(duration_s * TICKS_Hz)), 2000).round())
    fall = abs(mode.amplitude_m_s2) / scale * np.exp(-mode.decay_1_s * ticks / TICKS_Hz)
    at = polyline(ticks, fall, TOLERANCE_ratio)
    pitch = max(1, round(mode.frequency_Hz))
    frames = [
        {"relative_position": int(t), "amplitude_modulation": float(a), "frequency_modulation": pitch}
        for t, a in zip(ticks[at], fall[at], strict=True)
    ]
    half_turn = 0.0 if mode.amplitude_m_s2 >= 0 else np.pi
    effect = {
        "effect_type": "Basis",
        "position": 0,
        "phase": float((mode.phase_rad + half_turn) % (2 * np.pi)),
        "base_signal": "Sine",
        "keyframes": frames,
    }
    limits = {"lower_frequency_limit": 0, "upper_frequency_limit": max(1000, pitch)}
    return {"band_type": "VectorialWave", **limits, "effects": [effect]}


def read_hjif(source: Path | str | bytes, scale_m_s2: float | None = None) -> tuple[tuple[Mode, ...], float]:
    """Read the sine effects of an HJIF file: one mode for each, and how long all together last, s.

    All must begin together, as a snap's do. scale_m_s2 : what amplitude 1 stands for; by default what the
    description says.
    Raises InputError.
    """
    name = "HJIF" if isinstance(source, bytes) else str(source)
    found = read_json(source, Hjif, name, REMEDY)
    scale = read_scale(found.description, name, "amplitude") if scale_m_s2 is None else scale_m_s2
    if not 0 < found.timescale <= TICKS_Hz:
        raise InputError(name, "$.timescale", f"{found.timescale} is not 1 to {TICKS_Hz}", REMEDY)
    effects = [
        (effect, channel.gain)
        for perception in found.perceptions
        if perception.perception_modality == "Vibrotactile"
        for channel in perception.channels
        for band in channel.bands
        if band.band_type == "VectorialWave"
        for effect in band.effects
        if effect.base_signal == "Sine" and effect.effect_type == "Basis"
    ]
    check_points(name, "$.perceptions", sum(len(effect.keyframes) for effect, _ in effects), REMEDY)
    if not effects:
        raise InputError(name, "$.perceptions", "no sine effect in it", REMEDY)
    if len({effect.position for effect, _ in effects}) > 1:
        reason, remedy = "its effects begin at different times", "give the effects of one snap"
        raise InputError(name, "$.perceptions", reason, remedy)
    try:
        modes = tuple(_mode(effect, gain * scale, found.timescale) for effect, gain in effects)
    except (ModelError, OverflowError) as error:
        raise InputError(name, "$.perceptions", str(error), REMEDY) from error
    return modes, max(effect.keyframes[-1].relative_position for effect, _ in effects) / found.timescale


def _mode(effect: Effect, scale: float, timescale: int) -> Mode:
    t = np.array([k.relative_position for k in effect.keyframes], dtype=np.float64) / timescale
    if t.size < 2 or t[0] != 0 or np.any(np.diff(t) <= 0) or t[-1] > LONGEST_s:
        raise ModelError(f"an effect needs corners that rise from 0 to at most {LONGEST_s:g} s")
    loud = _held([k.amplitude_modulation for k in effect.keyframes], 1.0)
    pitch = _held([k.frequency_modulation for k in effect.keyframes], 0.0)
    if np.any(np.abs(loud) > 1) or np.any((pitch <= 0) | (pitch > HIGHEST_Hz)):
        raise ModelError(f"amplitudes lie within -1 to 1, frequencies above 0 and to {HIGHEST_Hz} Hz")
    return mode_of(Pulse(t, scale * np.abs(loud), pitch), effect.phase)


def _held(values: list[float | None], first: float) -> FloatArray:
    """Let the last value hold where there is none."""
    held = accumulate(values, lambda last, value: last if value is None else value, initial=first)
    return np.array(list(held)[1:], dtype=np.float64)
