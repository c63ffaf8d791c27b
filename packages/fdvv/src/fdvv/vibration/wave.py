"""Vibrations as samples and as WAV files: 16 bit, one channel."""

from __future__ import annotations

import io
import wave
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import numpy.typing as npt

from fdvv.errors import InputError, ModelError
from fdvv.io.files import read_limited, write_atomic
from fdvv.model.vibration import Vibration
from fdvv.units import FloatArray

LISTEN_Hz = 48_000
"""What every sound card plays."""
FULL = 32_767
COUNT_STEP = 16
"""Steps of 16 bits in one of the board's 12."""
SILENCE_counts = 2048
QUIET_s = 0.02
"""Silence before and after, so that no player cuts the onset off."""
LARGEST_bytes = 20_000_000  # assumed; 3.5 minutes of 16 bits at 48 kHz, where a slot of the board lasts 4.1 s


@dataclass(frozen=True, eq=False)
class Wav:
    """A WAV file and what its numbers mean.

    Attributes
    ----------
    data : the file.
    full_scale : value of a sample of 32767, in the unit of what was written.
    """

    data: bytes
    full_scale: float

    def save(self, path: Path | str) -> None:
        write_atomic(Path(path), self.data)


@dataclass(frozen=True, eq=False)
class Sound:
    """What a WAV file holds: samples (n,) as whole numbers of 16 bits, and their rate."""

    samples: npt.NDArray[np.int16]
    rate_Hz: int


def vibration_samples(vibration: Vibration, rate_Hz: int = LISTEN_Hz, quiet_s: float = QUIET_s) -> FloatArray:
    """Return a vibration's acceleration (m/s²) at a rate, with silence before and after."""
    count = round((vibration.duration_s + 2 * quiet_s) * rate_Hz)
    return vibration.acceleration_m_s2(np.arange(count) / rate_Hz - quiet_s)


def to_wav(samples: FloatArray, rate_Hz: int = LISTEN_Hz, full_scale: float | None = None) -> Wav:
    """Make a WAV file of samples (n,) in any unit.

    full_scale : what becomes 32767; the largest |sample| if None, so that what is weak is heard too. Raises
    ModelError if samples are not finite or exceed it.
    """
    if samples.ndim != 1 or not samples.size or not np.isfinite(samples).all():
        raise ModelError(f"a sound needs finite samples in one row, got {samples.shape}")
    peak = float(np.abs(samples).max())
    scale = full_scale if full_scale is not None else peak or 1.0
    if not (np.isfinite(scale) and scale > 0) or peak > scale * (1 + 1e-9):
        raise ModelError(
            f"full_scale must be positive and at least the largest sample, {peak:g}, got {scale:g}"
        )
    return Wav(_pack(np.rint(samples / scale * FULL).astype("<i2"), rate_Hz), scale)


def board_wav(counts: npt.NDArray[np.uint16], rate_Hz: int) -> Wav:
    """Make a WAV file of the board's samples (n,) of 12 bits, bit for bit: 16 (count - 2048)."""
    centred = COUNT_STEP * (counts.astype(np.int64) - SILENCE_counts)
    return Wav(_pack(centred.astype("<i2"), rate_Hz), FULL / COUNT_STEP)


def _pack(samples: npt.NDArray[np.int16], rate_Hz: int) -> bytes:
    held = io.BytesIO()
    with wave.open(held, "wb") as sound:
        sound.setnchannels(1)
        sound.setsampwidth(2)
        sound.setframerate(rate_Hz)
        sound.writeframes(samples.tobytes())
    return held.getvalue()


def read_wav(source: Path | bytes) -> Sound:
    """Read a WAV file of 16 bits and one channel, or its bytes. Raises InputError."""
    remedy = "give a WAV file of 16 bits and one channel"
    data = source if isinstance(source, bytes) else read_limited(source, LARGEST_bytes, remedy)
    name = "sound" if isinstance(source, bytes) else source
    try:
        with wave.open(io.BytesIO(data), "rb") as sound:
            shape = (sound.getnchannels(), sound.getsampwidth())
            rate_Hz, frames = sound.getframerate(), sound.readframes(sound.getnframes())
    except (wave.Error, EOFError) as error:
        raise InputError(
            name, "whole file", f"not a WAV file ({str(error) or 'it ends early'})", remedy
        ) from error
    if shape != (1, 2):
        raise InputError(name, "head", f"{shape[0]} channels of {8 * shape[1]} bits", remedy)
    if len(frames) % 2:
        raise InputError(name, "samples", "the last one is cut short", remedy)
    return Sound(np.frombuffer(frames, "<i2").astype(np.int16), rate_Hz)
