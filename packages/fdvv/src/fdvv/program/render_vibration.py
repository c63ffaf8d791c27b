"""From a model's vibration to what the vibration board plays on an exciter that is known."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from enum import StrEnum

import numpy as np

from fdvv.errors import ModelError
from fdvv.model.vibration import Vibration
from fdvv.program.surface import Limits
from fdvv.program.synth import (
    RATE_HZ,
    WAVE_PEAK,
    AMPLITUDE_MAX_counts,
    ConvertedVibration,
    SILENCE_counts,
    Slot,
    Waveform,
    render,
    slot_of_vibration,
)
from fdvv.units import FloatArray
from fdvv.vibration.exciter import FULL_SCALE_V, KnownExciter
from fdvv.vibration.inverse import Drive, InverseSettings, acceleration_m_s2, correlation, drive_for
from fdvv.vibration.wave import Wav, board_wav, to_wav, vibration_samples

PLAIN = Limits().counts_per_m_s2
COUNTS_V = SILENCE_counts / FULL_SCALE_V
RING_s = 0.03
NO_WORSE = 0.01
"""A plain slot is kept if the inverse is no more alike than by so much: it takes no room among the waves."""


class SynthesisMethod(StrEnum):
    """How a slot was made: the vibration's own waveform, or the exciter's inverse."""

    PLAIN = "plain"
    INVERSE = "inverse"


@dataclass(frozen=True, eq=False)
class RenderedVibration:
    """A slot, and what the known exciter makes of it.

    Attributes
    ----------
    way : how it was made.
    lead_s : how long before the vibration's onset it begins.
    likeness : of the acceleration expected of the board's very samples to the vibration (correlation).
    strength_ratio : of that along the vibration's shape to what was asked.
    error_ratio : rms of their difference over rms of the vibration.
    """

    slot: Slot
    way: SynthesisMethod
    lead_s: float
    likeness: float
    strength_ratio: float
    error_ratio: float


def render_vibration(
    vibration: Vibration, exciter: KnownExciter, settings: InverseSettings | None = None
) -> RenderedVibration:
    """Choose the slot whose acceleration of the cap is most like a vibration, plain or through the inverse.

    Raises ModelError if the board can play neither.
    """
    chosen = settings or InverseSettings()
    wave = _wave(drive_for(exciter, vibration, chosen))
    inverse = _judge(wave, SynthesisMethod.INVERSE, vibration, exciter, chosen.lead_s)
    sine = _plain(vibration, exciter, chosen.limit_V)
    plain = _judge(sine, SynthesisMethod.PLAIN, vibration, exciter, 0.0)
    return plain if plain.likeness >= inverse.likeness - NO_WORSE else inverse


def converter(
    exciter: KnownExciter, settings: InverseSettings | None = None
) -> Callable[[Vibration], ConvertedVibration]:
    """Return what compiling a program uses to make slots, where the exciter is known."""

    def convert(vibration: Vibration) -> ConvertedVibration:
        made = render_vibration(vibration, exciter, settings)
        return ConvertedVibration(made.slot, float("nan"), made.error_ratio)

    return convert


def slot_volts(slot: Slot, samples: int | None = None) -> FloatArray:
    """Return the volts of a slot at 16 kHz, bit for bit as the board plays it."""
    count = slot.duration_samples if samples is None else samples
    return (render(slot, count).astype(np.float64) - SILENCE_counts) / COUNTS_V


def vibration_wav(vibration: Vibration, exciter: KnownExciter | None = None, board: bool = False) -> Wav:
    """Make a vibration's WAV file: its acceleration at 48 kHz, or the board's samples bit for bit at 16 kHz.

    exciter : where it is known, the board's samples are those of its inverse. Raises ModelError.
    """
    if not board:
        return to_wav(vibration_samples(vibration))
    made = render_vibration(vibration, exciter).slot if exciter else slot_of_vibration(vibration, PLAIN).slot
    return board_wav(render(made, made.duration_samples), RATE_HZ)


def _wave(drive: Drive) -> Slot:
    peak = float(np.abs(drive.volts).max()) * COUNTS_V
    samples = np.rint(drive.volts * COUNTS_V * (WAVE_PEAK / peak if peak else 0.0)).astype(int)
    length = int(np.ceil(samples.size / drive.rate_Hz * RATE_HZ))
    counts = min(AMPLITUDE_MAX_counts, round(peak * 128 / WAVE_PEAK))
    wave = tuple(samples.tolist())
    return Slot(Waveform.SAMPLED, round(16 * drive.rate_Hz), length, counts, wave=wave)


def _plain(vibration: Vibration, exciter: KnownExciter, limit_V: float) -> Slot:
    """Play the vibration's waveform as it is, as strong as its strongest mode asks, within the limit."""
    strongest = max(vibration.modes, key=lambda mode: abs(mode.amplitude_m_s2))
    counts = COUNTS_V / abs(complex(exciter.response(strongest.frequency_Hz)))
    peak = float(np.abs(vibration.acceleration_m_s2(np.linspace(0, vibration.duration_s, 4001))).max())
    strength = max(peak, *(mode.amplitude_m_s2 for mode in vibration.modes)) * counts
    if not strength:
        return slot_of_vibration(vibration, 1.0).slot
    return slot_of_vibration(vibration, counts * min(1.0, limit_V * COUNTS_V / strength)).slot


def _judge(
    slot: Slot, way: SynthesisMethod, vibration: Vibration, exciter: KnownExciter, lead_s: float
) -> RenderedVibration:
    """Compare what the exciter makes of the board's samples with the vibration."""
    longest = max(slot.duration_samples, round((vibration.duration_s + lead_s) * RATE_HZ))
    volts = slot_volts(slot, longest + round(RING_s * RATE_HZ))
    rendered = acceleration_m_s2(exciter, volts)
    wanted = vibration.acceleration_m_s2((np.arange(volts.size) + 0.5) / RATE_HZ - lead_s)
    power = float(wanted @ wanted)
    if not power:
        raise ModelError("the vibration is silent, there is nothing to render")
    strength, error = float(rendered @ wanted) / power, float(np.sum((rendered - wanted) ** 2)) / power
    likeness = correlation(rendered, wanted)
    return RenderedVibration(slot, way, lead_s, likeness, strength, float(np.sqrt(error)))
