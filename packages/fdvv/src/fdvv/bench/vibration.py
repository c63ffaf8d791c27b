"""The vibrations of a recording: snaps found by accelerometer or microphone, at every velocity and stroke."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from fdvv.errors import ModelError
from fdvv.model.curve import Stroke
from fdvv.model.spread import ModeSpread, VibrationSpread
from fdvv.model.vibration import Vibration
from fdvv.preprocess.average import AveragedCurve
from fdvv.preprocess.press import RawPress, StrokeTrack
from fdvv.preprocess.process import Processed
from fdvv.recording.types import Quantity, Recording, Stream
from fdvv.units import FloatArray
from fdvv.vibration.pool import MeasuredVibration, SnapEnergy, snap_energy
from fdvv.vibration.ring import Ring
from fdvv.vibration.shared import PacePresses, Scaling, SharedMode, fit_scaling, measure_paces
from fdvv.vibration.snap import HeardPress, NotFound

FEWEST_VELOCITIES = 2
"""With fewer the exponent would be taken from a book."""


@dataclass(frozen=True)
class StrokeScaling:
    """How the principal amplitude of one stroke grows with the cap's speed at the snap and the fall of force.

    Attributes
    ----------
    scaling : its velocities are those of the cap at the snap, its amplitudes m/s2.
    speed_ratio : the cap's speed at the snap over the mean speed of the stroke, the median over velocities.
    """

    stroke: Stroke
    scaling: Scaling
    speed_ratio: float

    def report(self) -> dict[str, Any]:
        """Return the figures by name; the exponent's error is null where two velocities leave none."""
        law = self.scaling
        return {
            "stroke": str(self.stroke),
            "amplitude_at_100_m_s2": law.amplitude_at_100,
            "exponent": law.exponent,
            "exponent_error": law.exponent_sd if math.isfinite(law.exponent_sd) else None,
            "snap_velocities_mm_s": list(law.velocities_mm_s),
        }


def stroke_scaling(
    strokes: Sequence[StrokeVibration], vibrations: Sequence[Vibration], stroke: Stroke
) -> StrokeScaling | None:
    """Fit the law of one stroke; None where fewer than two velocities have a vibration."""
    pairs = [
        (measured, measured.found, v)
        for v in vibrations
        for measured in strokes
        if isinstance(measured.found, MeasuredVibration)
        and v.stroke is measured.stroke is stroke
        and v.velocity_mm_s == measured.velocity_mm_s
    ]
    if len(pairs) < FEWEST_VELOCITIES:
        return None
    speeds = [vibration.snap_velocity_mm_s.value for _, vibration, _ in pairs]
    amplitudes = [abs(v.modes[0].amplitude_m_s2) for _, _, v in pairs]
    if min(speeds) <= 0 or min(amplitudes) <= 0:
        return None
    ratios = [speed / measured.achieved_mm_s for speed, (measured, _, _) in zip(speeds, pairs, strict=True)]
    energies = [vibration.energy.energy_mJ for _, vibration, _ in pairs]
    law = fit_scaling(speeds, amplitudes, energies if min(energies) > 0 else None)
    return StrokeScaling(stroke, law, float(np.median(ratios)))


def scale_vibrations(
    scaling: StrokeScaling, strokes: Sequence[StrokeVibration], vibrations: Sequence[Vibration]
) -> list[Vibration]:
    """Return vibrations for a stroke's missing velocities: the nearest one's, its amplitudes by the law.

    Velocities whose force does not fall have none. An onset that was found is kept.
    """
    own = [v for v in vibrations if v.stroke is scaling.stroke and v.velocity_mm_s is not None]
    known = {v.velocity_mm_s for v in own}
    return [
        _scale(scaling, measured, own)
        for measured in strokes
        if measured.stroke is scaling.stroke
        and measured.velocity_mm_s is not None
        and measured.velocity_mm_s not in known
        and measured.energy is not None
        and own
    ]


def _scale(scaling: StrokeScaling, measured: StrokeVibration, own: Sequence[Vibration]) -> Vibration:
    assert measured.energy is not None
    assert measured.velocity_mm_s is not None
    requested_mm_s = measured.velocity_mm_s
    near = min(own, key=lambda v: abs(math.log((v.velocity_mm_s or requested_mm_s) / requested_mm_s)))
    vibration = measured.found if isinstance(measured.found, MeasuredVibration) else None
    speed = vibration.snap_velocity_mm_s.value if vibration else scaling.speed_ratio * measured.achieved_mm_s
    wanted = scaling.scaling.amplitude(speed, measured.energy.energy_mJ)
    grown = wanted / abs(near.modes[0].amplitude_m_s2)
    modes = tuple(replace(mode, amplitude_m_s2=grown * mode.amplitude_m_s2) for mode in near.modes)
    onset_mm = vibration.onset_mm.value if vibration else near.onset_mm
    return replace(near, velocity_mm_s=requested_mm_s, onset_mm=onset_mm, modes=modes, spread=None)


def scaling_words(scaling: StrokeScaling, made: Sequence[Vibration]) -> str:
    law = scaling.scaling
    velocities = ", ".join(f"{v.velocity_mm_s:g}" for v in made if v.stroke is scaling.stroke)
    known = f"± {law.exponent_sd:.2f}" if math.isfinite(law.exponent_sd) else "of unknown error"
    return (
        f"vibration on the {scaling.stroke} at {velocities} mm/s was not found but scaled from other paces: "
        f"amplitude as the cap's speed at the snap to the power {law.exponent:.2f} ({known}) and the root of "
        "its energy"
    )


ON_HOUSING = (
    "the accelerometer sat on the housing: amplitudes of vibration are the housing's acceleration, taken for "
    "the cap's"
)


@dataclass(frozen=True, eq=False)
class StrokeVibration:
    """One stroke at one velocity and the vibration of its snap; NotFound says why there is none.

    Attributes
    ----------
    velocity_mm_s, achieved_mm_s : as requested, None if it was not; and as pressed.
    energy : the fall of force that drives the snap; None where force does not fall.
    """

    stroke: Stroke
    velocity_mm_s: float | None
    achieved_mm_s: float
    found: MeasuredVibration | NotFound
    energy: SnapEnergy | None = None

    @property
    def reason(self) -> str | None:
        """Why no ring was found; None where one was."""
        said = self.found if isinstance(self.found, NotFound) else self.found.ring
        return said.reason if isinstance(said, NotFound) else None

    def report(self) -> dict[str, Any]:
        """Return the figures by name; null where nothing was found."""
        figures: dict[str, Any] = {
            "stroke": str(self.stroke),
            "velocity_mm_s": self.velocity_mm_s,
            "reason": self.reason,
            "presses": 0,
            "onset_mm": None,
            "onset_spread_mm": None,
            "snap_velocity_mm_s": None,
            "duration_s": None,
            "duration_error_s": None,
            "modes": [],
        }
        heard = self.found
        if isinstance(heard, NotFound):
            return figures
        figures |= {"presses": heard.shown, "onset_mm": heard.onset_mm.value}
        figures |= {
            "onset_spread_mm": heard.onset_mm.sd,
            "snap_velocity_mm_s": heard.snap_velocity_mm_s.value,
        }
        if isinstance(heard.ring, Ring):
            figures |= {"duration_s": heard.ring.duration_s, "duration_error_s": heard.ring.duration_sd_s}
            figures["modes"] = [
                {
                    "frequency_Hz": m.frequency_Hz,
                    "frequency_error_Hz": m.frequency_sd_Hz,
                    "frequency_spread_Hz": m.frequency_spread_Hz,
                    "decay_1_s": m.decay_1_s,
                    "decay_error_1_s": m.decay_sd_1_s,
                    "decay_spread_1_s": m.decay_spread_1_s,
                }
                for m in heard.ring.modes
            ]
        return figures


def missing_words(missing: Sequence[tuple[StrokeVibration, str]]) -> list[str]:
    """Describe where there is no vibration, strokes and velocities of one reason together."""
    by_reason: dict[str, list[StrokeVibration]] = {}
    for measured, reason in missing:
        by_reason.setdefault(reason, []).append(measured)
    return [f"no vibration on the {_conditions(strokes)}: {reason}" for reason, strokes in by_reason.items()]


def _conditions(strokes: Sequence[StrokeVibration]) -> str:
    velocities: dict[Stroke, list[str]] = {}
    for measured in sorted(strokes, key=lambda measured: measured.stroke is Stroke.RELEASE):
        speed = "unknown" if measured.velocity_mm_s is None else f"{measured.velocity_mm_s:g}"
        velocities.setdefault(measured.stroke, []).append(speed)
    parts = {str(stroke): f"at {', '.join(of_stroke)} mm/s" for stroke, of_stroke in velocities.items()}
    if len(set(parts.values())) == 1:
        return f"{' and '.join(parts)} {next(iter(parts.values()))}"
    return " and ".join(f"{stroke} {where}" for stroke, where in parts.items())


def mode_words(mode: SharedMode) -> str:
    return (
        f"the housing rings alike at every pace: {mode.frequency_Hz:.0f} Hz with a decay of "
        f"{mode.decay_1_s:.0f} 1/s, the middle of {mode.paces} rings (standard errors "
        f"{mode.frequency_sd_Hz:.1f} Hz and {mode.decay_sd_1_s:.0f} 1/s)"
    )


CONTACT_mm, STOP_mm = 0.3, 0.1
"""Parts of a curve beside contact and stop in which no fall of force is looked for."""


@dataclass(frozen=True, eq=False)
class RecordedVibrations:
    """The vibrations found in a recording.

    Attributes
    ----------
    strokes : every stroke and velocity, presses before releases, slow before fast.
    vibrations : those whose modes and amplitude are known, as a model holds them; and those scaled by a law,
        if requested.
    warnings : why the others are missing, one sentence for each reason.
    assumptions : what no measurement backs, one sentence each.
    scalings : how amplitude grows with the cap's speed at the snap, of strokes with a vibration at two
        velocities or more.
    """

    strokes: tuple[StrokeVibration, ...]
    vibrations: tuple[Vibration, ...]
    warnings: tuple[str, ...]
    assumptions: tuple[str, ...] = ()
    scalings: tuple[StrokeScaling, ...] = ()


def find_vibrations(
    recording: Recording, processed: Processed, extrapolate: bool = False
) -> RecordedVibrations:
    """Search the vibration of a recording for snaps, pooled over the presses of each stroke and velocity.

    An accelerometer is taken before a microphone. Modes found at some velocities
    sharpen the search at others. Without either sensor the result is empty, with one warning.

    extrapolate : velocities without a vibration get that of the nearest one, its amplitude scaled.
    """
    for quantity in (Quantity.ACCELERATION, Quantity.SOUND):
        streams = {take.number: take.of(quantity)[0] for take in recording.takes if take.of(quantity)}
        if streams:
            break
    else:
        deaf = "no vibration: nothing listened, neither microphone nor accelerometer"
        return RecordedVibrations((), (), (deaf,))
    shaken = quantity is Quantity.ACCELERATION
    strokes, mode = _measure_strokes(recording, processed, streams, shaken)
    own, missing = _vibrations(strokes, None if shaken else recording.bench.sound_V_s_m or None)
    scalings = tuple(s for s in (stroke_scaling(strokes, own, stroke) for stroke in Stroke) if s is not None)
    assumptions = [*([ON_HOUSING] if own and shaken else []), *([mode_words(mode)] if own and mode else [])]
    warnings = missing_words(missing)
    if extrapolate:
        more = [v for s in scalings for v in scale_vibrations(s, strokes, own)]
        assumptions += [scaling_words(s, more) for s in scalings if any(v.stroke is s.stroke for v in more)]
        own = sorted([*own, *more], key=lambda v: (v.stroke is Stroke.RELEASE, v.velocity_mm_s or 0.0))
    elif any(measured.stroke is s.stroke for s in scalings for measured, _ in missing):
        warnings.append("strokes that lack it at some paces only can be given it by --extrapolate-vibration")
    return RecordedVibrations(tuple(strokes), tuple(own), tuple(warnings), tuple(assumptions), scalings)


def _vibrations(
    strokes: Sequence[StrokeVibration], scale_V_s_m: float | None
) -> tuple[list[Vibration], list[tuple[StrokeVibration, str]]]:
    vibrations, missing = [], []
    for measured in strokes:
        if isinstance(measured.found, NotFound) or measured.reason is not None:
            missing.append((measured, measured.reason or ""))
            continue
        try:
            vibration = measured.found.vibration(scale_V_s_m)
        except ModelError as error:
            missing.append((measured, str(error)))
        else:
            spread = _spread(measured.found, vibration)
            vibrations.append(replace(vibration, velocity_mm_s=measured.velocity_mm_s, spread=spread))
    return vibrations, missing


def _measure_strokes(
    recording: Recording, processed: Processed, streams: dict[int, Stream], shaken: bool
) -> tuple[list[StrokeVibration], SharedMode | None]:
    presses = {(j.press.take, j.press.part): j.press for j in processed.judged if j.reason is None}
    delay_s = 0.0 if shaken else 1e-3 * recording.bench.sound_filter_ms
    groups = []
    for curve, tracks in zip(processed.curves, processed.tracks, strict=True):
        records = tuple(
            press_record(presses[key], track, streams[track.take], delay_s)
            for track in tracks
            if (key := (track.take, track.part)) in presses and track.take in streams
        )
        speed_mm_s = curve.velocity_mm_s or curve.achieved_mm_s
        groups.append(PacePresses(curve.stroke, speed_mm_s, records, _energy(curve)))
    results, mode = measure_paces(groups, shaken)
    measured = [
        StrokeVibration(curve.stroke, curve.velocity_mm_s, curve.achieved_mm_s, result, group.energy)
        for curve, group, result in zip(processed.curves, groups, results, strict=True)
    ]
    return measured, mode


def press_record(press: RawPress, track: StrokeTrack, sound: Stream, delay_s: float) -> HeardPress:
    """Return sound and displacement of one stroke on the clock of the board.

    delay_s : of the filter before the microphone's converter, taken off. Where the stroke was reconstructed
    its path counts, beside it the frames.
    """
    t_s = sound.t_s - delay_s
    here = (t_s >= press.frame_s[0]) & (t_s <= press.frame_s[-1])
    beside = (press.frame_s < track.t_s[0]) | (press.frame_s > track.t_s[-1])
    frames_s = np.concatenate([press.frame_s[beside], track.t_s])
    frames_mm = np.concatenate([press.frame_mm[beside], track.displacement_mm])
    order = np.argsort(frames_s)
    return HeardPress(t_s[here], sound.values[here], frames_s[order], frames_mm[order], track.stroke)


def _energy(curve: AveragedCurve) -> SnapEnergy | None:
    x_mm = curve.displacement_mm
    inside = (x_mm >= CONTACT_mm) & (x_mm <= x_mm[-1] - STOP_mm)
    return snap_energy(x_mm[inside], curve.force_cN[inside])


def _spread(measured: MeasuredVibration, vibration: Vibration) -> VibrationSpread | None:
    """Return how presses differ: onset and amplitude one by one, frequency and decay by jackknife."""
    ring = measured.ring
    if measured.shown < 2 or isinstance(ring, NotFound):
        return None
    first = ring.mode
    lasting = first.decay_spread_1_s / first.decay_1_s if first.decay_spread_1_s is not None else None
    return VibrationSpread(
        measured.shown,
        onset_mm=_round(measured.onset_mm.sd),
        duration_s=_round(lasting and vibration.duration_s * lasting),
        modes=tuple(
            ModeSpread(
                _round(mode.frequency_spread_Hz),
                _round(_deviation_ratio(sizes) * abs(kept.amplitude_m_s2)),
                _round(mode.decay_spread_1_s),
            )
            for mode, kept, sizes in zip(ring.modes, vibration.modes, ring.amplitudes.T, strict=True)
        ),
    )


def _deviation_ratio(sizes: FloatArray) -> float:
    """Return the spread over the median, from the median deviation, which a few outliers do not move."""
    middle = float(np.median(sizes))
    return 1.4826 * float(np.median(np.abs(sizes - middle))) / middle if middle else 0.0


def _round(value: float | None) -> float | None:
    return None if value is None else float(f"{value:.4g}")
