"""The whole way from a recording to averaged curves and points, each with its spread."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from fdvv.errors import ModelError
from fdvv.model import Stroke
from fdvv.preprocess._average import AveragedCurve, Pooled, averaged, pool
from fdvv.preprocess._clock import ClockFit
from fdvv.preprocess._extend import extend
from fdvv.preprocess._fuse import CurveOfForce, Fusion, Path, Seen, fuse, unknown_curve
from fdvv.preprocess._press import StrokeTrack
from fdvv.preprocess._probe import Probe, probe_of
from fdvv.preprocess._reject import Judged, Limits, Reason, judge
from fdvv.preprocess._strokes import LEFT_mm, spans_of, whole_press
from fdvv.preprocess._takes import idle_cN, presses_of
from fdvv.preprocess._travel import travels_mm
from fdvv.recording import Bench, Recording
from fdvv.units import cN_from_N

OFF_STOP_mm = 0.12
"""Frames nearer to the stop than this tell of the stop, not of the stroke."""

UNKNOWN_PIECES = 25
"""Spans of the button's force where nothing was known of it."""

UNKNOWN_N = 1e3
"""Nothing is known of it."""

LEAST_NOISE_mm, USUAL_NOISE_mm, LEAST_STEPS = 0.002, 0.03, 30
"""A frame is never surer than the first; the second is taken where fewer steps at rest tell."""

FIRST_cN, FIRST_mm = 12.0, 0.4
"""The first give of the cap is read from so much force above the resting finger's, within this depth."""

NEAREST_ratio = 1.5
"""A press further than this from every pace belongs to none."""

GAIN_OFF = 0.1
"""Presses at one pace differ in force as a whole by less: that is the pace's own spread."""

FEWEST_FRAMES = 2
"""Frames that must show a stroke on its way: one leaves its speed to the equation alone."""

FEWEST = 3
"""Of presses of one kind: fewer give no spread."""


@dataclass(frozen=True)
class Settings:
    """What the processing takes for granted.

    Attributes
    ----------
    cap_g : mass of the moving cap, its stem, markers and a third of its spring; 40 % off changes a curve by
        0.7 cN rms at most, since only the tip's share of the motion is taken back.
    limits : when a press is left out.
    paces_mm_s : presses that were not asked for at a pace are given the nearest of these, if it is within
        half as much again; without any they are averaged together.
    """

    cap_g: float = 3.0
    limits: Limits = field(default_factory=Limits)
    paces_mm_s: tuple[float, ...] = ()

    def __post_init__(self) -> None:
        if not (np.isfinite(self.cap_g) and self.cap_g > 0):
            raise ModelError(f"cap_g must be above 0, got {self.cap_g}")
        if not all(np.isfinite(pace) and pace > 0 for pace in self.paces_mm_s):
            raise ModelError(f"paces_mm_s must be above 0, got {self.paces_mm_s}")


@dataclass(frozen=True)
class Feature:
    """A number that every press tells: median, standard deviation between presses, and of how many."""

    value: float
    spread: float
    presses: int


@dataclass(frozen=True, eq=False)
class Processed:
    """What a recording came to.

    Attributes
    ----------
    clock : how the camera's clock ran against the board's.
    judged : every press, and why some are left out.
    probe : the slow probe, None if there was none.
    curves : averaged, presses before releases, slow before fast; without the probe.
    tracks : the strokes behind each curve, in the same order.
    travel_mm : from the resting cap to the stop.
    actuation_mm, reset_mm : where the circuit closed and opened; None if nobody looked.
    zero_mm : how deep the resting finger had pressed the cap before presses began, added to all depths.
    warnings : one sentence each.
    """

    clock: ClockFit
    judged: tuple[Judged, ...]
    probe: Probe | None
    curves: tuple[AveragedCurve, ...]
    tracks: tuple[tuple[StrokeTrack, ...], ...]
    travel_mm: Feature
    actuation_mm: Feature | None
    reset_mm: Feature | None
    zero_mm: float
    warnings: tuple[str, ...] = ()


def process(recording: Recording, settings: Settings | None = None) -> Processed:
    """Turn a recording into averaged curves: clocks, presses, judgement, paths, curves, points.

    Raises ModelError where a step finds nothing to work on; the message says which.
    """
    settings = settings or Settings()
    found = presses_of(recording)
    if not found.presses:
        raise ModelError(f"recording {recording.name!r}: no press was seen; {'; '.join(found.lost[:3])}")
    probe = probe_of(recording, idle_cN(recording))
    spans = [spans_of(p.frame_s, p.frame_mm, whole_press(p)) for p in found.presses]
    judged = _paced(judge(found.presses, spans, settings.limits), settings.paces_mm_s)
    zero_mm = _zero_mm(judged, probe)
    work = _Work(judged, probe, recording.bench, settings, zero_mm)
    curves, tracks = work.curves()
    if not curves:
        raise ModelError(f"recording {recording.name!r}: fewer than {FEWEST} presses of any pace can be used")
    used = [one for one in work.judged if one.reason is None]
    return Processed(
        found.clock,
        tuple(work.judged),
        probe,
        tuple(curves),
        tuple(tuple(group) for group in tracks),
        _feature(travels_mm(used, zero_mm, _arrival_cN(curves))),
        _switched(used, tracks, Stroke.PRESS),
        _switched(used, tracks, Stroke.RELEASE),
        zero_mm,
        (*found.lost, *work.warnings),
    )


def _feature(values: Sequence[float]) -> Feature:
    finite = np.array([v for v in values if np.isfinite(v)])
    spread = float(np.std(finite, ddof=1)) if finite.size > 1 else 0.0
    return Feature(float(np.median(finite)), spread, int(finite.size))


def _paced(judged: Sequence[Judged], paces_mm_s: Sequence[float]) -> list[Judged]:
    """Give presses of no pace the nearest one, in ratio; leave out those that are near none."""
    return [
        _nearest(one, paces_mm_s) if paces_mm_s and one.press.velocity_mm_s is None else one for one in judged
    ]


def _nearest(one: Judged, paces_mm_s: Sequence[float]) -> Judged:
    if not np.isfinite(one.achieved_mm_s):
        return replace(one, reason=one.reason or Reason.OFF_PACE)
    apart = np.abs(np.log(np.array(paces_mm_s) / one.achieved_mm_s))
    pace = paces_mm_s[int(np.argmin(apart))]
    off = Reason.OFF_PACE if apart.min() > np.log(NEAREST_ratio) else None
    return replace(one, press=replace(one.press, velocity_mm_s=pace), reason=one.reason or off)


def _arrival_cN(curves: Sequence[AveragedCurve]) -> float:
    """Give the force with which a cap arrives at its stop, the middle of all presses' curves."""
    return float(np.median([c.force_cN[-1] for c in curves if c.stroke is Stroke.PRESS] or [0.0]))


def _zero_mm(judged: Sequence[Judged], probe: Probe | None) -> float:
    """Tell how deep the cap was before presses began, under the finger that rested on it.

    With a probe from its curve; without one from how the place goes with the first force of slow presses.
    """
    used = [one for one in judged if one.reason is None]
    rests = [one.press.force_cN[one.press.t_s < one.spans.start_s - 0.02] for one in used]
    rest_cN = float(np.median([np.median(rest) for rest in rests if rest.size])) if rests else 0.0
    if probe is not None:
        return probe.rest_mm(rest_cN)
    slowest = sorted(used, key=lambda one: one.achieved_mm_s)[: max(FEWEST, len(used) // 4)]
    return max(rest_cN, 0.0) * _first_give_mm_cN(slowest, rest_cN)


def _first_give_mm_cN(used: Sequence[Judged], rest_cN: float) -> float:
    """Tell by how much the cap gives way at first: the slope of place on force, which is known far better."""
    places, forces = [], []
    for one in used:
        press = one.press
        place = np.interp(press.t_s, press.frame_s, press.frame_mm)
        first = (press.t_s > one.spans.start_s - 0.1) & (press.t_s < one.spans.bottom_s) & (place < FIRST_mm)
        first &= (press.force_cN > rest_cN - 1) & (press.force_cN < rest_cN + FIRST_cN)
        places.append(place[first])
        forces.append(press.force_cN[first])
    place, force = np.concatenate([*places, np.zeros(0)]), np.concatenate([*forces, np.zeros(0)])
    if place.size < LEAST_STEPS or np.ptp(force) < 0.5 * FIRST_cN:
        return 0.0
    return max(float(np.polyfit(force, place, 1)[0]), 0.0)


@dataclass(frozen=True, eq=False)
class _Curve:
    """One averaged curve, what it is made of, the button's force behind it, and presses unlike the others."""

    average: AveragedCurve
    tracks: list[StrokeTrack]
    shape: CurveOfForce
    strange: list[Judged]


class _Work:
    """Curves of every stroke and pace, slow ones first, since each tells the next what to expect."""

    def __init__(
        self, judged: list[Judged], probe: Probe | None, bench: Bench, settings: Settings, zero_mm: float
    ) -> None:
        self.judged, self.probe, self.bench, self.settings = judged, probe, bench, settings
        self.zero_mm = zero_mm
        self.warnings: list[str] = []

    def curves(self) -> tuple[list[AveragedCurve], list[list[StrokeTrack]]]:
        """Average both strokes at every pace that has enough presses, in reading order."""
        known = {stroke: self.probe.curve(stroke) if self.probe else None for stroke in Stroke}
        found: dict[Stroke, list[_Curve]] = {stroke: [] for stroke in Stroke}
        for pace in sorted({one.press.velocity_mm_s for one in self.judged}, key=lambda v: v or 0.0):
            for stroke, curve in self._pace(pace, known).items():
                known[stroke] = curve.shape
                found[stroke].append(curve)
        ordered = [curve for stroke in Stroke for curve in found[stroke]]
        return [c.average for c in ordered], [c.tracks for c in ordered]

    def _pace(self, pace: float | None, known: Mapping[Stroke, CurveOfForce | None]) -> dict[Stroke, _Curve]:
        """Average both strokes at one pace; presses unlike the others are left out, and it is done again."""
        while True:
            used = [o for o in self.judged if o.reason is None and o.press.velocity_mm_s == pace]
            curves = {stroke: self._curve(used, stroke, pace, known[stroke]) for stroke in Stroke}
            strange = [one for curve in curves.values() if curve for one in curve.strange]
            if not strange:
                break
            self.judged = [replace(o, reason=Reason.FORCE) if o in strange else o for o in self.judged]
        if len(used) < FEWEST:
            self.warnings.append(f"{pace or 'unknown'} mm/s: {len(used)} presses can be used, no curve")
        return {stroke: curve for stroke, curve in curves.items() if curve}

    def _curve(
        self, used: Sequence[Judged], stroke: Stroke, pace: float | None, known: CurveOfForce | None
    ) -> _Curve | None:
        """Average one stroke at one pace; None if too few presses show it."""
        seen = [self._seen(one, stroke) for one in used]
        whole = [(one, s) for one, s in zip(used, seen, strict=True) if s is not None]
        if len(whole) < FEWEST:
            return None
        tracks, shape = self._paths(whole, stroke, known)
        pooled = pool(tracks, shape, _end_mm(tracks))
        speeds = np.array([one.achieved_mm_s for one, _ in whole])
        strange = [whole[i][0] for i in _unlike(pooled, self.settings.limits.unlike)]
        return _Curve(averaged(tracks, pooled, pace, speeds), tracks, shape, strange)

    def _seen(self, one: Judged, stroke: Stroke) -> Seen | None:
        """Cut one stroke out: from where the cap has left its rest to the last frame before the stop."""
        press, spans = one.press, one.spans
        near = press.frame_mm > spans.bottom_mm - OFF_STOP_mm
        begin_s, end_s = spans.of(stroke)
        if stroke is Stroke.PRESS:
            inside = (press.frame_s <= end_s) & ~near & (press.frame_s >= begin_s - 0.01)
        else:
            # one frame of the cap back at rest tells when it must have arrived
            after = press.frame_s[press.frame_s > end_s]
            last_s = float(after[0]) if after.size else end_s
            inside = (press.frame_s >= begin_s) & ~near & (press.frame_s <= last_s)
        frames = np.flatnonzero(inside)
        if np.sum(inside & (press.frame_mm > LEFT_mm)) < FEWEST_FRAMES:
            return None
        low, high = press.frame_s[frames[0]], press.frame_s[frames[-1]]
        step_s = float(press.t_s[1] - press.t_s[0])
        felt = (press.t_s >= low - 0.2 * step_s) & (press.t_s <= high + 0.2 * step_s)
        t_s = press.t_s[felt]
        if t_s.size < 4:
            return None
        shown = (press.frame_s >= t_s[0]) & (press.frame_s <= t_s[-1])
        if shown.sum() < 2:
            return None
        depth_mm = press.frame_mm + self.zero_mm
        guess = np.interp(t_s, press.frame_s, depth_mm)
        return Seen(t_s, press.force_cN[felt], press.frame_s[shown], depth_mm[shown], guess)

    def _paths(
        self, whole: Sequence[tuple[Judged, Seen]], stroke: Stroke, known: CurveOfForce | None
    ) -> tuple[list[StrokeTrack], CurveOfForce]:
        """Find the paths between frames, then once more with what lies between the stop and a frame."""
        moving_g = self.settings.cap_g + self.bench.tip_mass_g
        noise_mm = _frame_noise_mm([one for one, _ in whole])
        fusion = Fusion(moving_g, noise_mm)
        if known is None:
            fusion = replace(fusion, pieces=UNKNOWN_PIECES, unknown_N=UNKNOWN_N)
        known = known or unknown_curve
        paths, shape = fuse([seen for _, seen in whole], known, fusion)
        longer = [
            self._longer(one, stroke, seen, path, shape, moving_g)
            for (one, seen), path in zip(whole, paths, strict=True)
        ]
        paths, shape = fuse(longer, known, fusion)
        ends = zip(whole, longer, paths, strict=True)
        return [self._track(one, stroke, seen, path) for (one, _), seen, path in ends], shape

    def _longer(
        self, one: Judged, stroke: Stroke, seen: Seen, path: Path, shape: CurveOfForce, moving_g: float
    ) -> Seen:
        """Add what no frame shows, between the stop and the nearest frame."""
        felt = one.press.t_s, one.press.force_cN
        ends_mm = self.zero_mm + LEFT_mm, one.spans.bottom_mm + self.zero_mm - LEFT_mm
        return extend(seen, path, stroke is Stroke.PRESS, felt, shape, moving_g, ends_mm)

    def _track(self, one: Judged, stroke: Stroke, seen: Seen, path: Path) -> StrokeTrack:
        """Give a stroke with the force between finger and cap: the tip's own motion is taken back."""
        tip_kg = 1e-3 * self.bench.tip_mass_g
        back = np.flatnonzero(path.displacement_mm < LEFT_mm) if stroke is Stroke.RELEASE else np.zeros(0)
        # what follows the return to rest is the upper stop's
        until = slice(None, int(back[0]) if back.size and back[0] > 3 else None)
        return StrokeTrack(
            one.press.take,
            one.press.part,
            stroke,
            seen.t_s[until],
            path.displacement_mm[until],
            path.velocity_mm_s[until],
            path.acceleration_m_s2[until],
            (seen.force_cN - cN_from_N(tip_kg * path.acceleration_m_s2))[until],
        )


def _slipped(pooled: Pooled) -> list[int]:
    """Find presses whose force is that of the others times a number: the sensor slipped, or was tilted."""
    gains = []
    for apart in pooled.apart_cN:
        seen = np.isfinite(apart)
        mean = pooled.force_cN[seen]
        gains.append(1 + float(apart[seen] @ mean) / max(float(mean @ mean), 1e-9))
    off = np.abs(np.array(gains) - np.median(gains))
    far = np.flatnonzero(off > max(GAIN_OFF, 4 * 1.4826 * float(np.median(off))))
    return [int(i) for i in far if off[i] >= 0.5 * off.max()] if len(gains) > FEWEST else []


def _frame_noise_mm(used: Sequence[Judged]) -> float:
    """Tell the noise of a frame from frames that followed each other while the cap rested."""
    steps = []
    for one in used:
        rest = one.press.frame_mm[one.press.frame_s < one.spans.start_s - 0.02]
        steps.append(np.diff(rest))
    joined = np.concatenate(steps) if steps else np.zeros(0)
    if joined.size < LEAST_STEPS:
        return USUAL_NOISE_mm
    return max(1.4826 * float(np.median(np.abs(joined))) / float(np.sqrt(2)), LEAST_NOISE_mm)


def _end_mm(tracks: Sequence[StrokeTrack]) -> float:
    """Tell to what depth at least three presses, or a third of them, have samples."""
    deepest = sorted(float(track.displacement_mm.max()) for track in tracks)
    return deepest[-max(FEWEST, len(deepest) // 3)]


def _unlike(pooled: Pooled, limit: float) -> list[int]:
    """Find presses that differ from the mean by much more than presses do, the worst first."""
    slipped = _slipped(pooled)
    if slipped:
        return slipped
    apart = np.sqrt(np.nanmean(pooled.apart_cN**2, axis=1))
    usual = float(np.median(apart))
    far = np.flatnonzero(apart > limit * max(usual, 1.0))
    return [int(i) for i in far if apart[i] >= 0.5 * apart.max()] if apart.size > FEWEST else []


def _switched(
    used: Sequence[Judged], groups: Sequence[Sequence[StrokeTrack]], stroke: Stroke
) -> Feature | None:
    """Tell where the circuit switched, on the paths of all presses of one stroke."""
    tracks = {(t.take, t.part): t for group in groups for t in group if t.stroke is stroke}
    places = []
    for one in used:
        moment = one.press.closed_s if stroke is Stroke.PRESS else one.press.open_s
        track = tracks.get((one.press.take, one.press.part))
        if moment is not None and track is not None and track.t_s[0] <= moment <= track.t_s[-1]:
            # the board looks once a step: the circuit switched half a step before, on average
            half_s = 0.5 * float(track.t_s[1] - track.t_s[0])
            places.append(float(np.interp(moment - half_s, track.t_s, track.displacement_mm)))
    return _feature(places) if len(places) >= FEWEST else None
