"""The vibrations of a recording: what accelerometer or microphone told of snaps, at every pace and stroke."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from fdvv.errors import ModelError
from fdvv.model import ModeSpread, Stroke, Vibration, VibrationSpread
from fdvv.preprocess import AveragedCurve, Processed, RawPress, StrokeTrack
from fdvv.recording import Quantity, Recording, Stream
from fdvv.vibration import (
    HeardPress,
    MeasuredVibration,
    NotFound,
    Ring,
    SnapEnergy,
    measure_vibration,
    shared_mode,
    shared_rings,
    snap_energy,
    with_shared,
)

CONTACT_mm, STOP_mm = 0.3, 0.1
"""Parts of a curve beside contact and stop in which no fall of force is looked for."""


@dataclass(frozen=True, eq=False)
class HeardStroke:
    """One stroke at one pace, and what was heard of its snap; NotFound says why nothing was."""

    stroke: Stroke
    velocity_mm_s: float | None
    found: MeasuredVibration | NotFound


@dataclass(frozen=True, eq=False)
class RecordedVibrations:
    """What a recording tells of vibration.

    Attributes
    ----------
    heard : every stroke and pace, presses before releases, slow before fast.
    vibrations : those whose modes and amplitude are known, as a model holds them.
    warnings : why the others are missing, one sentence each.
    """

    heard: tuple[HeardStroke, ...]
    vibrations: tuple[Vibration, ...]
    warnings: tuple[str, ...]


def recorded_vibrations(recording: Recording, processed: Processed) -> RecordedVibrations:
    """Search the vibration of a recording for snaps, pooled over the presses of each stroke and pace.

    An accelerometer is taken before a microphone. A mode that one pace told sharpens the search at the
    others. Without either there is nothing, said once.
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
    heard = _heard(recording, processed, streams, shaken)
    scale = None if shaken else recording.bench.sound_V_s_m or None
    vibrations, warnings = [], []
    for one in heard:
        try:
            vibrations.append(_vibration(one, scale))
        except ModelError as error:
            warnings.append(
                f"no vibration on the {one.stroke} at {one.velocity_mm_s or 'unknown'} mm/s: {error}"
            )
    return RecordedVibrations(tuple(heard), tuple(vibrations), tuple(warnings))


def _heard(
    recording: Recording, processed: Processed, streams: dict[int, Stream], shaken: bool
) -> list[HeardStroke]:
    """Measure every stroke and pace; again where others tell of modes that it did not; then with one mode."""
    presses = {(one.press.take, one.press.part): one.press for one in processed.judged if one.reason is None}
    delay_s = 0.0 if shaken else 1e-3 * recording.bench.sound_filter_ms
    heard = []
    for curve, tracks in zip(processed.curves, processed.tracks, strict=True):
        found = [
            heard_press(presses[key], track, streams[track.take], delay_s)
            for track in tracks
            if (key := (track.take, track.part)) in presses and track.take in streams
        ]
        heard.append((curve, found, _energy(curve)))
    first = [_measured(*one, shaken, ()) for one in heard]
    known = shared_rings(_rings(first))
    again = [
        was if len(_known(was)) >= len(known) else _measured(*one, shaken, known)
        for one, was in zip(heard, first, strict=True)
    ]
    mode = shared_mode(_rings(again))
    if mode is not None:
        again = [one if isinstance(one, NotFound) else with_shared(one, mode) for one in again]
    return [
        HeardStroke(curve.stroke, curve.velocity_mm_s, found)
        for (curve, _, _), found in zip(heard, again, strict=True)
    ]


def _measured(
    curve: AveragedCurve,
    heard: list[HeardPress],
    energy: SnapEnergy | None,
    shaken: bool,
    known: tuple[tuple[float, float], ...],
) -> MeasuredVibration | NotFound:
    if not heard:
        return NotFound("no press of it was heard")
    return measure_vibration(heard, curve.velocity_mm_s or curve.achieved_mm_s, energy, shaken, known)


def _rings(found: list[MeasuredVibration | NotFound]) -> list[Ring]:
    return [
        one.ring for one in found if isinstance(one, MeasuredVibration) and isinstance(one.ring, Ring)
    ]


def _known(found: MeasuredVibration | NotFound) -> tuple[tuple[float, float], ...]:
    return () if isinstance(found, NotFound) else found.rings


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


def _vibration(one: HeardStroke, scale_V_s_m: float | None) -> Vibration:
    """Give a found vibration with its spread. ModelError, or what was said of one that was not found."""
    missing = one.found if isinstance(one.found, NotFound) else one.found.ring
    if isinstance(one.found, NotFound) or isinstance(missing, NotFound):
        assert isinstance(missing, NotFound)
        raise ModelError(missing.reason)
    vibration = one.found.vibration(scale_V_s_m)
    return replace(vibration, velocity_mm_s=one.velocity_mm_s, spread=_spread(one.found, vibration))


def _spread(found: MeasuredVibration, vibration: Vibration) -> VibrationSpread | None:
    """Give what is known of how presses differ: onset and amplitude press by press, the ring's as a whole."""
    amplitude = found.amplitude
    if found.shown < 2 or amplitude is None:
        return None
    ratio = amplitude.sd / amplitude.value if amplitude.value else 0.0
    first = ModeSpread(amplitude_m_s2=abs(vibration.modes[0].amplitude_m_s2) * ratio)
    return VibrationSpread(
        found.shown,
        onset_mm=found.onset_mm.sd,
        modes=(first, *(ModeSpread() for _ in vibration.modes[1:])),
    )
