"""The whole way from a recording to averaged curves and points, each with its spread."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from fdvv.errors import ModelError
from fdvv.model.curve import Stroke
from fdvv.preprocess.average import AveragedCurve, average_curve, pool
from fdvv.preprocess.clock import ClockFit
from fdvv.preprocess.fuse import CurveOfForce
from fdvv.preprocess.paths import FEWEST, Paths
from fdvv.preprocess.press import NEAR_mm, StrokeTrack, spans_of, whole_press
from fdvv.preprocess.probe import Probe, probe_of, resting_mm
from fdvv.preprocess.reject import Judged, Limits, Reason, judge, unlike
from fdvv.preprocess.takes import presses_of
from fdvv.recording.types import Recording
from fdvv.units import FloatArray, N_from_cN


@dataclass(frozen=True)
class Settings:
    """What the processing takes for granted.

    Attributes
    ----------
    cap_g : mass of the moving cap, its stem, markers and a third of its spring; 40 % off changes a curve by
        0.7 cN rms at most, since only the tip's share of the motion is taken back.
    limits : when a press is left out.
    paces_mm_s : presses without a requested velocity are assigned the nearest of these, if it is within
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


@dataclass(frozen=True, eq=False)
class _Done:
    """One averaged curve, what it is made of, the button's force behind it, and presses unlike the others."""

    average: AveragedCurve
    tracks: list[StrokeTrack]
    shape: CurveOfForce
    strange: list[Judged]


class Curves:
    """Averages strokes, one velocity after another; presses unlike the others are left out on the way.

    Attributes
    ----------
    judged : all presses, as they are thought of so far.
    warnings : velocities that have no curve.
    """

    def __init__(self, judged: list[Judged], probe: Probe | None, paths: Paths, unlike_limit: float) -> None:
        self.judged, self._probe, self._paths, self._limit = judged, probe, paths, unlike_limit
        self.warnings: list[str] = []

    def average(self) -> tuple[list[AveragedCurve], list[list[StrokeTrack]]]:
        """Average both strokes at every velocity that has enough presses, in reading order."""
        known = {stroke: self._probe.curve(stroke) if self._probe else None for stroke in Stroke}
        averages: dict[Stroke, list[_Done]] = {stroke: [] for stroke in Stroke}
        velocities = {entry.press.velocity_mm_s for entry in self.judged}
        for requested_mm_s in sorted(velocities, key=lambda v: v or 0.0):
            for stroke, curve in self._at_velocity(requested_mm_s, known).items():
                known[stroke] = curve.shape
                averages[stroke].append(curve)
        ordered = [curve for stroke in Stroke for curve in averages[stroke]]
        return [c.average for c in ordered], [c.tracks for c in ordered]

    def _at_velocity(
        self, requested_mm_s: float | None, known: Mapping[Stroke, CurveOfForce | None]
    ) -> dict[Stroke, _Done]:
        """Average both strokes at one velocity, and again without the outlying presses."""
        while True:
            used = [o for o in self.judged if o.reason is None and o.press.velocity_mm_s == requested_mm_s]
            curves = {stroke: self._curve(used, stroke, requested_mm_s, known[stroke]) for stroke in Stroke}
            strange = [entry for curve in curves.values() if curve for entry in curve.strange]
            if not strange:
                break
            self.judged = [replace(o, reason=Reason.FORCE) if o in strange else o for o in self.judged]
        if len(used) < FEWEST:
            velocity = requested_mm_s or "unknown"
            self.warnings.append(f"{velocity} mm/s: {len(used)} presses can be used, no curve")
        return {stroke: curve for stroke, curve in curves.items() if curve}

    def _curve(
        self, used: Sequence[Judged], stroke: Stroke, requested_mm_s: float | None, known: CurveOfForce | None
    ) -> _Done | None:
        paths = self._paths.find(used, stroke, known)
        if paths is None:
            return None
        whole, tracks, shape = paths
        pooled = pool(tracks, shape, *_extent_mm(tracks))
        speeds = np.array([entry.achieved_mm_s for entry in whole])
        strange = [whole[i] for i in unlike(pooled, self._limit)]
        return _Done(average_curve(tracks, pooled, requested_mm_s, speeds), tracks, shape, strange)


def _extent_mm(tracks: Sequence[StrokeTrack]) -> tuple[float, float]:
    """Return the range of depth in which at least three presses or a third of them have samples.

    A press begins at the resting cap, so its curve begins at 0: that is the button's contact.
    """
    enough = max(FEWEST, len(tracks) // 3)
    deepest = sorted(float(track.displacement_mm.max()) for track in tracks)
    shallowest = sorted(float(track.displacement_mm.min()) for track in tracks)
    start_mm = shallowest[enough - 1] if tracks[0].stroke is Stroke.RELEASE else 0.0
    return deepest[-enough], max(start_mm, 0.0)


SOFTEST_mm_N = 0.1
"""A stop gives way by less; more is noise."""


def travels_mm(used: Sequence[Judged], zero_mm: float, arrival_cN: float) -> list[float]:
    """Return for every press the depth at which the stop begins to bear.

    While the finger rests on the stop its force wanders, and the cap with it: from that, over all presses,
    comes how much the stop gives, and so where it was at the force with which the cap arrives.
    """
    rests = [_rest(entry) for entry in used]
    give_mm_N = _give_mm_N([rest for rest in rests if rest[0].size > 2])
    depths_mm = []
    for entry, (force_cN, _) in zip(used, rests, strict=True):
        more_N = float(N_from_cN(float(np.median(force_cN)) - arrival_cN)) if force_cN.size else 0.0
        depths_mm.append(entry.spans.bottom_mm + zero_mm - give_mm_N * max(more_N, 0.0))
    return depths_mm


def _rest(entry: Judged) -> tuple[FloatArray, FloatArray]:
    press = entry.press
    there = (press.frame_s >= entry.spans.bottom_s) & (press.frame_s <= entry.spans.leave_s)
    there &= press.frame_mm > entry.spans.bottom_mm - NEAR_mm
    return np.interp(press.frame_s[there], press.t_s, press.force_cN), press.frame_mm[there]


def _give_mm_N(rests: Sequence[tuple[FloatArray, FloatArray]]) -> float:
    """Find the slope of position on force within presses: their zeros differ, their stop does not."""
    if not rests:
        return 0.0
    force_N = np.concatenate([N_from_cN(force - force.mean()) for force, _ in rests])
    place_mm = np.concatenate([place - place.mean() for _, place in rests])
    square = float(force_N @ force_N)
    return min(max(float(force_N @ place_mm) / square, 0.0), SOFTEST_mm_N) if square > 0 else 0.0


NEAREST_ratio = 1.5
"""A press further than this from every velocity belongs to none."""


@dataclass(frozen=True)
class Feature:
    """A number measured by every press: median, standard deviation between presses, and of how many."""

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
    raw = presses_of(recording)
    if not raw.presses:
        raise ModelError(f"recording {recording.name!r}: no press was seen; {'; '.join(raw.lost[:3])}")
    probe = probe_of(recording, raw.zero_cN)
    spans = [spans_of(p.frame_s, p.frame_mm, whole_press(p)) for p in raw.presses]
    judged = judge(raw.presses, spans, settings.limits)
    if settings.paces_mm_s:
        judged = [_assign_pace(entry, settings.paces_mm_s) for entry in judged]
    zero_mm = resting_mm(judged, probe)
    paths = Paths(settings.cap_g, recording.bench.tip_mass_g, zero_mm)
    work = Curves(judged, probe, paths, settings.limits.unlike)
    curves, tracks = work.average()
    if not curves:
        raise ModelError(f"recording {recording.name!r}: fewer than {FEWEST} presses of any pace can be used")
    used = [entry for entry in work.judged if entry.reason is None]
    return Processed(
        raw.clock,
        tuple(work.judged),
        probe,
        tuple(curves),
        tuple(tuple(group) for group in tracks),
        _feature(travels_mm(used, zero_mm, _arrival_cN(curves))),
        _switch_point(used, tracks, Stroke.PRESS),
        _switch_point(used, tracks, Stroke.RELEASE),
        zero_mm,
        (*raw.lost, *work.warnings),
    )


def _feature(values: Sequence[float]) -> Feature:
    finite = np.array([v for v in values if np.isfinite(v)])
    spread = float(np.std(finite, ddof=1)) if finite.size > 1 else 0.0
    return Feature(float(np.median(finite)), spread, int(finite.size))


def _assign_pace(entry: Judged, paces_mm_s: Sequence[float]) -> Judged:
    """Assign a press without a velocity to the nearest one, in ratio; leave it out if it is near none."""
    if entry.press.velocity_mm_s is not None:
        return entry
    if not np.isfinite(entry.achieved_mm_s):
        return replace(entry, reason=entry.reason or Reason.OFF_PACE)
    apart = np.abs(np.log(np.array(paces_mm_s) / entry.achieved_mm_s))
    pace = paces_mm_s[int(np.argmin(apart))]
    off = Reason.OFF_PACE if apart.min() > np.log(NEAREST_ratio) else None
    return replace(entry, press=replace(entry.press, velocity_mm_s=pace), reason=entry.reason or off)


def _arrival_cN(curves: Sequence[AveragedCurve]) -> float:
    return float(np.median([c.force_cN[-1] for c in curves if c.stroke is Stroke.PRESS] or [0.0]))


def _switch_point(
    used: Sequence[Judged], groups: Sequence[Sequence[StrokeTrack]], stroke: Stroke
) -> Feature | None:
    tracks = {(t.take, t.part): t for group in groups for t in group if t.stroke is stroke}
    places = []
    for entry in used:
        moment = entry.press.closed_s if stroke is Stroke.PRESS else entry.press.open_s
        track = tracks.get((entry.press.take, entry.press.part))
        if moment is not None and track is not None and track.t_s[0] <= moment <= track.t_s[-1]:
            # the board looks once a step: the circuit switched half a step before, on average
            half_s = 0.5 * float(track.t_s[1] - track.t_s[0])
            places.append(float(np.interp(moment - half_s, track.t_s, track.displacement_mm)))
    return _feature(places) if len(places) >= FEWEST else None
