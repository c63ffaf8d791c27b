"""The whole way from a recording to averaged curves and points, each with its spread."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from fdvv.errors import ModelError
from fdvv.model import Stroke
from fdvv.preprocess._average import AveragedCurve
from fdvv.preprocess._clock import ClockFit
from fdvv.preprocess._curves import Curves
from fdvv.preprocess._paths import FEWEST, Paths
from fdvv.preprocess._press import StrokeTrack
from fdvv.preprocess._probe import Probe, probe_of
from fdvv.preprocess._reject import Judged, Reason, judge
from fdvv.preprocess._settings import Settings
from fdvv.preprocess._strokes import spans_of, whole_press
from fdvv.preprocess._takes import presses_of
from fdvv.preprocess._travel import travels_mm
from fdvv.preprocess._zero import resting_mm
from fdvv.recording import Recording

NEAREST_ratio = 1.5
"""A press further than this from every pace belongs to none."""


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
    probe = probe_of(recording, found.zero_cN)
    spans = [spans_of(p.frame_s, p.frame_mm, whole_press(p)) for p in found.presses]
    judged = _paced(judge(found.presses, spans, settings.limits), settings.paces_mm_s)
    zero_mm = resting_mm(judged, probe)
    paths = Paths(settings.cap_g, recording.bench.tip_mass_g, zero_mm)
    work = Curves(judged, probe, paths, settings.limits.unlike)
    curves, tracks = work.average()
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
