"""Sound files: whole numbers of a WAV by the standard library, all else by soundfile."""

from __future__ import annotations

import io
import wave
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from fdvv.errors import BuildError
from fdvv.recording.reading import Reading, refusal
from fdvv.recording.types import Quantity, Stream

CLOCK = "sound card"
REMEDY = "give a WAV, FLAC, OGG or MP3 file that plays"
LIKE_ratio = 0.999
"""Correlation above which two channels are one microphone; lossy coding leaves that much."""


@dataclass(frozen=True, eq=False)
class Samples:
    """What a sound file holds.

    Attributes
    ----------
    raw : (n, channels).
    full, zero : raw at full scale above zero, and at silence.
    """

    raw: npt.NDArray[Any]
    rate_Hz: float
    full: float
    zero: float = 0.0


def sound_kind(content: bytes) -> str | None:
    """Recognise a sound file by its first bytes; None for anything else."""
    if content[:4] in (b"RIFF", b"RIFX", b"RF64") and content[8:12] == b"WAVE":
        return "wav"
    for start, kind in ((b"OggS", "ogg"), (b"fLaC", "flac"), (b"ID3", "mp3")):
        if content.startswith(start):
            return kind
    # a frame of MP3 without a tag: eleven bits set, then a version and a layer that exist
    frame = len(content) > 1 and content[0] == 0xFF and content[1] & 0xE0 == 0xE0
    return "mp3" if frame and content[1] & 0x18 != 0x08 and content[1] & 0x06 == 0x02 else None


def read_sound(source: Path, content: bytes, full_scale_V: float | None) -> Reading:
    """Read a sound file; its samples are volts only where full_scale_V says what full scale was.

    Two channels that are one are given once. Raises InputError; BuildError where soundfile is needed and
    is not installed.
    """
    kind = sound_kind(content) or "sound"
    found = (_wav(source, content) if kind == "wav" else None) or _any(source, content)
    if not found.raw.size:
        raise refusal(source, "whole file", "it holds no sample", REMEDY)
    warnings = []
    channels = list(found.raw.T)
    if len(channels) == 2 and (alike := _likeness(*channels)) > LIKE_ratio:
        channels.pop()
        likeness = "the same" if alike == 1 else f"alike to {alike:.5f}"
        warnings.append(f"both channels are {likeness}; the left one is read")
    t_s = np.arange(found.raw.shape[0]) / found.rate_Hz
    if full_scale_V is None:
        of = "parts of full scale" if found.full == 1 else "counts of a converter"
        warnings.append(f"the samples are {of}, no volts; give full_scale_V where it is known")
        quantity, scale = Quantity.COUNTS, 1.0
    else:
        quantity, scale = Quantity.SOUND, full_scale_V / found.full
    several = len(channels) > 1
    streams = [
        Stream(f"sound {i}" if several else "sound", quantity, CLOCK, t_s, raw, scale, found.zero)
        for i, raw in enumerate(map(np.ascontiguousarray, channels), 1)
    ]
    return Reading(kind, streams, (), warnings)


def _likeness(left: npt.NDArray[Any], right: npt.NDArray[Any]) -> float:
    if np.array_equal(left, right):
        return 1.0
    a, b = (channel - channel.mean(dtype=np.float64) for channel in (left, right))
    power = float(np.sqrt((a @ a) * (b @ b)))
    level = 0.9 < float(np.sqrt((a @ a) / (b @ b))) < 1.1 if b.any() else False
    return min(float(a @ b) / power, 1 - 1e-9) if power and level else 0.0


def _wav(source: Path, content: bytes) -> Samples | None:
    try:
        with wave.open(io.BytesIO(content)) as file:
            width, channels, rate_Hz = file.getsampwidth(), file.getnchannels(), file.getframerate()
            data = file.readframes(file.getnframes())
    except wave.Error:
        return None
    except (EOFError, ValueError, OverflowError, RuntimeError):
        raise refusal(source, "whole file", "the WAV is cut short or damaged", REMEDY) from None
    frame = width * channels
    data = data[: len(data) // frame * frame] if frame else b""
    if width not in (1, 2, 3, 4) or not rate_Hz or not data:
        raise refusal(source, "header", "it tells of no sample", REMEDY)
    zero = 128.0 if width == 1 else 0.0
    return Samples(_whole(data, width).reshape(-1, channels), rate_Hz, 2.0 ** (8 * width - 1), zero)


def _whole(data: bytes, width: int) -> npt.NDArray[Any]:
    if width != 3:
        return np.frombuffer(data, {1: "u1", 2: "<i2", 4: "<i4"}[width])
    wide = np.zeros((len(data) // 3, 4), dtype=np.uint8)
    wide[:, 1:] = np.frombuffer(data, np.uint8).reshape(-1, 3)
    return wide.view("<i4")[:, 0] >> 8


def _any(source: Path, content: bytes) -> Samples:
    try:
        import soundfile
    except ImportError:
        raise BuildError(f"{source}: needs soundfile; pip install 'fdvv[audio]'") from None
    try:
        raw, rate_Hz = soundfile.read(io.BytesIO(content), dtype="float32", always_2d=True)
    except (soundfile.SoundFileError, RuntimeError, ValueError, TypeError) as error:
        reason = f"no sound that can be decoded ({' '.join(str(error).split())})"
        raise refusal(source, "whole file", reason, REMEDY) from None
    return Samples(raw, float(rate_Hz), 1.0)
