"""The vibrations of a recording: what accelerometer or microphone told of snaps, at every pace and stroke."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from fdvv.errors import ModelError
from fdvv.model import ModeSpread, Stroke, Vibration, VibrationSpread
from fdvv.preprocess import AveragedCurve, Processed, RawPress, StrokeTrack
from fdvv.recording import Quantity, Recording, Stream
from fdvv.units import FloatArray
from fdvv.vibration import (
    HeardPress,
    MeasuredVibration,
    NotFound,
    PacePresses,
    SharedMode,
    SnapEnergy,
    measure_paces,
    snap_energy,
)
from fdvv.workflow._capture_heard import ON_HOUSING, HeardStroke, missing_words, shared_words
from fdvv.workflow._capture_scaling import StrokeScaling, scaled_vibrations, scaling_words, stroke_scaling

CONTACT_mm, STOP_mm = 0.3, 0.1
"""Parts of a curve beside contact and stop in which no fall of force is looked for."""


@dataclass(frozen=True, eq=False)
class RecordedVibrations:
    """What a recording tells of vibration.

    Attributes
    ----------
    heard : every stroke and pace, presses before releases, slow before fast.
    vibrations : those whose modes and amplitude are known, as a model holds them; and those that a law gave,
        if that was asked for.
    warnings : why the others are missing, one sentence for each reason.
    assumptions : what no measurement backs, one sentence each.
    scalings : how amplitude grows with the cap's speed at the snap, of strokes heard at two paces or more.
    """

    heard: tuple[HeardStroke, ...]
    vibrations: tuple[Vibration, ...]
    warnings: tuple[str, ...]
    assumptions: tuple[str, ...] = ()
    scalings: tuple[StrokeScaling, ...] = ()


def recorded_vibrations(
    recording: Recording, processed: Processed, extrapolate: bool = False
) -> RecordedVibrations:
    """Search the vibration of a recording for snaps, pooled over the presses of each stroke and pace.

    An accelerometer is taken before a microphone. Modes that some paces told sharpen the search at others.
    Without either there is nothing, said once.

    extrapolate : paces without a vibration of their own get that of the nearest pace, its amplitude scaled.
    """
    for quantity in (Quantity.ACCELERATION, Quantity.SOUND):
        streams = {take.number: take.of(quantity)[0] for take in recording.takes if take.of(quantity)}
        if streams:
            break
    else:
        return RecordedVibrations(
            (), (), ("no vibration: nothing listened, neither microphone nor accelerometer",)
        )
    shaken = quantity is Quantity.ACCELERATION
    heard, mode = _heard(recording, processed, streams, shaken)
    own, missing = _vibrations(heard, None if shaken else recording.bench.sound_V_s_m or None)
    scalings = tuple(s for s in (stroke_scaling(heard, own, stroke) for stroke in Stroke) if s is not None)
    told = [*([ON_HOUSING] if own and shaken else []), *([shared_words(mode)] if own and mode else [])]
    warnings = missing_words(missing)
    if extrapolate:
        more = [v for s in scalings for v in scaled_vibrations(s, heard, own)]
        told += [scaling_words(s, more) for s in scalings if any(v.stroke is s.stroke for v in more)]
        own = sorted([*own, *more], key=lambda v: (v.stroke is Stroke.RELEASE, v.velocity_mm_s or 0.0))
    elif any(one.stroke is s.stroke for s in scalings for one, _ in missing):
        warnings.append("strokes that lack it at some paces only can be given it by --extrapolate-vibration")
    return RecordedVibrations(tuple(heard), tuple(own), tuple(warnings), tuple(told), scalings)


def _vibrations(
    heard: Sequence[HeardStroke], scale_V_s_m: float | None
) -> tuple[list[Vibration], list[tuple[HeardStroke, str]]]:
    """Give vibrations that are known, and strokes where none is with the reason."""
    found, missing = [], []
    for one in heard:
        if isinstance(one.found, NotFound) or one.reason is not None:
            missing.append((one, one.reason or ""))
            continue
        try:
            vibration = one.found.vibration(scale_V_s_m)
        except ModelError as error:
            missing.append((one, str(error)))
            continue
        spread = _spread(one.found, vibration)
        found.append(replace(vibration, velocity_mm_s=one.velocity_mm_s, spread=spread))
    return found, missing


def _heard(
    recording: Recording, processed: Processed, streams: dict[int, Stream], shaken: bool
) -> tuple[list[HeardStroke], SharedMode | None]:
    """Measure every stroke and pace; with the mode that they share."""
    presses = {(one.press.take, one.press.part): one.press for one in processed.judged if one.reason is None}
    delay_s = 0.0 if shaken else 1e-3 * recording.bench.sound_filter_ms
    paces = []
    for curve, tracks in zip(processed.curves, processed.tracks, strict=True):
        heard = tuple(
            heard_press(presses[key], track, streams[track.take], delay_s)
            for track in tracks
            if (key := (track.take, track.part)) in presses and track.take in streams
        )
        pace_mm_s = curve.velocity_mm_s or curve.achieved_mm_s
        paces.append(PacePresses(curve.stroke, pace_mm_s, heard, _energy(curve)))
    found, mode = measure_paces(paces, shaken)
    strokes = [
        HeardStroke(curve.stroke, curve.velocity_mm_s, curve.achieved_mm_s, one, pace.energy)
        for curve, pace, one in zip(processed.curves, paces, found, strict=True)
    ]
    return strokes, mode


def heard_press(press: RawPress, track: StrokeTrack, sound: Stream, delay_s: float) -> HeardPress:
    """Bring sound and place of one stroke together on the clock of the board.

    delay_s : of the filter before the microphone's converter, taken off. Where the stroke was reconstructed
    its path counts, beside it the frames.
    """
    t_s = sound.t_s - delay_s
    here = (t_s >= press.frame_s[0]) & (t_s <= press.frame_s[-1])
    beside = (press.frame_s < track.t_s[0]) | (press.frame_s > track.t_s[-1])
    place_s = np.concatenate([press.frame_s[beside], track.t_s])
    place_mm = np.concatenate([press.frame_mm[beside], track.displacement_mm])
    order = np.argsort(place_s)
    return HeardPress(t_s[here], sound.values[here], place_s[order], place_mm[order], track.stroke)


def _energy(curve: AveragedCurve) -> SnapEnergy | None:
    inside = curve.displacement_mm >= CONTACT_mm
    inside &= curve.displacement_mm <= curve.displacement_mm[-1] - STOP_mm
    return snap_energy(curve.displacement_mm[inside], curve.force_cN[inside])


def _spread(found: MeasuredVibration, vibration: Vibration) -> VibrationSpread | None:
    """Give how presses differ: in onset and amplitude one by one, in frequency and decay by leaving out."""
    ring = found.ring
    if found.shown < 2 or isinstance(ring, NotFound):
        return None
    first = ring.mode
    lasting = first.decay_spread_1_s / first.decay_1_s if first.decay_spread_1_s is not None else None
    return VibrationSpread(
        found.shown,
        onset_mm=_rounded(found.onset_mm.sd),
        duration_s=_rounded(lasting and vibration.duration_s * lasting),
        modes=tuple(
            ModeSpread(
                _rounded(mode.frequency_spread_Hz),
                _rounded(_deviation_ratio(sizes) * abs(told.amplitude_m_s2)),
                _rounded(mode.decay_spread_1_s),
            )
            for mode, told, sizes in zip(ring.modes, vibration.modes, ring.amplitudes.T, strict=True)
        ),
    )


def _deviation_ratio(sizes: FloatArray) -> float:
    """Give the spread over the median, from the median deviation, which a few outliers do not move."""
    middle = float(np.median(sizes))
    return 1.4826 * float(np.median(np.abs(sizes - middle))) / middle if middle else 0.0


def _rounded(value: float | None) -> float | None:
    """Keep four digits of a spread: presses tell it to some per cent."""
    return None if value is None else float(f"{value:.4g}")
