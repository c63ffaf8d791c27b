"""Presses with a model's vibrations and without, and what comes of them on the cap."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict, dataclass
from functools import partial
from typing import Any

import numpy as np

from fdvv.compensation.method import Trial
from fdvv.compensation.presses import split_strokes
from fdvv.device.contract import Device
from fdvv.errors import InputError, ModelError
from fdvv.model.curve import Stroke
from fdvv.model.model import FDVVModel
from fdvv.model.noticeable import LITERATURE, Jnds
from fdvv.model.press import Press
from fdvv.model.vibration import Vibration
from fdvv.program.button import vibrations_of
from fdvv.program.render_vibration import converter
from fdvv.program.surface import Limits
from fdvv.program.synth import ConvertedVibration, slot_of_vibration
from fdvv.protocol import tables
from fdvv.protocol.messages import MM_S16_PER_mm_s, UM16_PER_mm
from fdvv.twin.image import image_of
from fdvv.units import FloatArray
from fdvv.vibration.compare import (
    AROUND_s,
    BANDS_Hz,
    CapMotions,
    RATE_Hz,
    VibrationError,
    compare_vibration,
    least_s,
    without_slow_motion,
)
from fdvv.vibration.exciter import KnownExciter

FASTEST_Hz = 4000.0
"""A record with fewer samples a second cannot show a vibration of 800 Hz."""
NOT_ASKED = "not asked for"
SAME_mm, BEGIN_mm = 1e-9, 0.5
"""Presses with the same displacements down to there are the same press."""


@dataclass(frozen=True)
class Playback:
    """How a probe plays the vibrations of a model.

    Attributes
    ----------
    presses : with vibrations, per velocity, after the silent ones.
    exciter : if it is known, vibrations are played through its inverse.
    """

    presses: int
    exciter: KnownExciter | None = None


@dataclass(frozen=True, eq=False)
class ShownVibration:
    """One pair of presses to look at: acceleration of the cap, (n,), over time since the onset's place.

    All without what is slower than half of the vibration's slowest mode.
    with_m_s2 : of a press that played the vibration; None if nothing was played. without_m_s2 : of one that
    did not; the same press otherwise, where a simulated person repeated it.
    """

    since_ms: FloatArray
    asked_m_s2: FloatArray
    without_m_s2: FloatArray
    with_m_s2: FloatArray | None


@dataclass(frozen=True, eq=False)
class RenderedVibration:
    """What became of the vibration of one stroke at one velocity.

    Attributes
    ----------
    asked : the vibration; None if the model has none for this stroke.
    reason : why there is nothing to compare; empty if there is.
    error, shown : None without a comparison.
    """

    asked: Vibration | None
    reason: str = ""
    error: VibrationError | None = None
    shown: ShownVibration | None = None

    @property
    def total_JND(self) -> float:
        return self.error.total_JND if self.error else 0.0

    def to_dict(self) -> dict[str, Any]:
        """Return the figures for a file; no waveforms."""
        if self.asked is None:
            return {"outcome": NOT_ASKED}
        about = {
            "asked_onset_mm": self.asked.onset_mm,
            "asked_frequency_Hz": principal_Hz(self.asked),
            "asked_duration_ms": 1e3 * self.asked.duration_s,
        }
        if self.error is None:
            return {"outcome": self.reason, **about}
        error = asdict(self.error) | {"bands_Hz": [list(band) for band in BANDS_Hz]}
        outcome = "played" if self.error.played else "not played"
        return {"outcome": outcome, **about, **error, "total_JND": self.error.total_JND}


NONE_ASKED = RenderedVibration(None)


def principal_Hz(vibration: Vibration) -> float:
    """Return the frequency of the mode with the most energy."""
    return max(vibration.modes, key=lambda m: m.amplitude_m_s2**2 / max(m.decay_1_s, 1.0)).frequency_Hz


def has_exciter(device: Device) -> bool:
    """Return whether a device plays vibrations within presses, as far as it says."""
    return bool(getattr(device, "has_exciter", False)) and hasattr(device, "upload_program")


def upload_vibrating(device: Any, trial: Trial, model: FDVVModel, playback: Playback) -> None:
    """Upload the table of a trial with the model's vibrations. InputError if the board cannot play them.

    A simulated person then repeats the silent presses made before, so that nothing but the vibration differs.
    """
    try:
        device.upload_program(vibrating_image(model, trial, playback.exciter))
    except ModelError as error:
        raise InputError(model.name, "vibrations", str(error), "weaken or shorten them") from error
    if hasattr(device, "repeat_presses"):
        device.repeat_presses()


def vibrating_image(model: FDVVModel, trial: Trial, exciter: KnownExciter | None) -> bytes:
    """Return the program of a trial's table, exactly as without, that also plays the model's vibrations."""
    signals, events = vibrations_of(model)
    plain = partial(slot_of_vibration, counts_per_m_s2=Limits().counts_per_m_s2)
    convert = converter(exciter) if exciter else plain
    made = [convert(signal.vibration()) for signal in signals]
    names = [signal.name for signal in signals]
    played = [
        tables.Vibration(
            at_um16=round(UM16_PER_mm * event.at_mm),
            slowest_mm_s16=round(MM_S16_PER_mm_s * (event.slowest_mm_s or 0.0)),
            fastest_mm_s16=65_535
            if event.fastest_mm_s is None
            else round(MM_S16_PER_mm_s * event.fastest_mm_s),
            states=1,
            stroke=event.stroke.code,
            slot=names.index(event.signal),
        )
        for event in events
    ]
    waves = [sound.slot.wave for sound in made]
    slots = [_slot_record(sound) for sound in made]
    return image_of(trial.surface, model.travel_mm, played, slots, trial.tuning.paced, waves).image


def _slot_record(made: ConvertedVibration) -> tables.Slot:
    slot = made.slot
    return tables.Slot(
        waveform=slot.waveform,
        frequency_Hz16=slot.frequency_Hz16,
        duration_samples=slot.duration_samples,
        amplitude_counts=slot.amplitude_counts,
        decay_q16=slot.decay_q16,
        wave_at=0,
        wave_samples=0,
    )


def judge_vibration(
    model: FDVVModel,
    stroke: Stroke,
    velocity_mm_s: float,
    silent: Sequence[Press],
    played: Sequence[Press],
    jnds: Jnds = LITERATURE,
) -> RenderedVibration:
    """Compare the cap's acceleration in presses of one velocity with the vibration of one stroke.

    silent, played : without and with the model's vibrations; none of the latter where nothing was played.
    jnds : what the differences are counted in.
    """
    asked = model.vibration(stroke, velocity_mm_s)
    if asked is None:
        return RenderedVibration(None)
    if not all(map(shows_vibration, (*silent, *played))):
        return RenderedVibration(asked, "not measured: the record does not hold the cap's acceleration")
    cuts = [_Cut.of(press, asked, model.travel_mm) for press in (*silent, *played)]
    if any(cut is None for cut in cuts):
        return RenderedVibration(asked, "not measured: the cap did not reach its place in every press")
    complete = [cut for cut in cuts if cut is not None]
    first_s = max(-AROUND_s, *(cut.first_s for cut in complete))
    last_s = min(asked.duration_s + AROUND_s, *(cut.last_s for cut in complete))
    if last_s < least_s(asked):
        return RenderedVibration(asked, "not measured: the stroke ends within one period of it")
    return _compare(asked, complete[: len(silent)], complete[len(silent) :], (first_s, last_s), jnds)


@dataclass(frozen=True, eq=False)
class _Cut:
    """A press around the place of an onset: its clock is 0 there.

    begin_mm : displacements of the press's beginning, by which a repeated press is known.
    """

    t_s: FloatArray
    acceleration_m_s2: FloatArray
    speed_mm_s: float
    first_s: float
    last_s: float
    onset_s: float
    begin_mm: FloatArray

    @classmethod
    def of(cls, press: Press, vibration: Vibration, travel_mm: float) -> _Cut | None:
        """Find where the cap passes the onset in the vibration's stroke; None if it does not."""
        rows = split_strokes(press.displacement_mm, travel_mm)[list(Stroke).index(vibration.stroke)]
        t_s, x_mm = press.t_s[rows], press.displacement_mm[rows]
        passed = (
            x_mm >= vibration.onset_mm if vibration.stroke is Stroke.PRESS else x_mm <= vibration.onset_mm
        )
        at = int(np.argmax(passed)) if passed.any() else 0
        if at == 0:
            return None
        speed = np.gradient(press.displacement_mm, press.t_s)
        onset_s = float(
            np.interp(0.0, *_sort_pairs(x_mm[at - 1 : at + 1] - vibration.onset_mm, t_s[at - 1 : at + 1]))
        )
        row = (rows.start or 0) + at
        return cls(
            press.t_s - onset_s,
            1e-3 * np.gradient(speed, press.t_s),
            abs(float(speed[row])),
            float(t_s[0]) - onset_s,
            float(t_s[-1]) - onset_s,
            onset_s,
            press.displacement_mm[: int(np.argmax(press.displacement_mm > BEGIN_mm))],
        )


def _sort_pairs(x: FloatArray, y: FloatArray) -> tuple[FloatArray, FloatArray]:
    order = np.argsort(x)
    return x[order], y[order]


def _compare(
    asked: Vibration,
    silent: Sequence[_Cut],
    played: Sequence[_Cut],
    span_s: tuple[float, float],
    jnds: Jnds,
) -> RenderedVibration:
    pairs = [(cut, other) for cut in played if (other := _partner(cut, silent)) is not None]
    paired = [other for _, other in pairs] if 2 * len(pairs) > len(played) else []
    played = [cut for cut, _ in pairs] if paired else played
    before, after = int(-span_s[0] * RATE_Hz), int(span_s[1] * RATE_Hz)
    since_s = np.arange(-before, after + 1) / RATE_Hz
    base = _motions(paired or silent, since_s, before)
    with_it = _motions(played, since_s, before, paired) if played else None
    error = compare_vibration(asked, base, with_it, jnds)
    rows = [asked.acceleration_m_s2(since_s), base.acceleration_m_s2[0]]
    rows += [with_it.acceleration_m_s2[0]] if with_it else []
    still = without_slow_motion(asked, since_s, np.array(rows))
    shown = ShownVibration(1e3 * since_s, still[0], still[1], still[2] if with_it else None)
    return RenderedVibration(asked, "", error, shown)


def _motions(
    cuts: Sequence[_Cut], since_s: FloatArray, before: int, paired: Sequence[_Cut] = ()
) -> CapMotions:
    """Sample presses evenly; those of a pair by the clock of the silent one, for both share its gesture."""
    shifts = (
        [cut.onset_s - silent.onset_s for cut, silent in zip(cuts, paired, strict=True)] if paired else None
    )
    rows = [
        np.interp(since_s - (shifts[i] if shifts else 0.0), cut.t_s, cut.acceleration_m_s2)
        for i, cut in enumerate(cuts)
    ]
    return CapMotions(np.array(rows), np.array([c.speed_mm_s for c in cuts]), before, bool(paired))


def _partner(cut: _Cut, silent: Sequence[_Cut]) -> _Cut | None:
    """Return the silent press that began in the same way, if there is one."""
    for other in silent:
        size = min(cut.begin_mm.size, other.begin_mm.size)
        if size > 1 and np.allclose(cut.begin_mm[:size], other.begin_mm[:size], rtol=0, atol=SAME_mm):
            return other
    return None


def shows_vibration(press: Press) -> bool:
    """Return whether a record holds the cap's true displacement, densely enough."""
    rate_Hz = (press.t_s.size - 1) / (press.t_s[-1] - press.t_s[0])
    sensed_only = press.sensed_mm is not None and np.array_equal(press.sensed_mm, press.displacement_mm)
    return bool(rate_Hz >= FASTEST_Hz and not sensed_only)
