"""Curves of every stroke and pace, slow ones first, since each tells the next what to expect."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from fdvv.model import Stroke
from fdvv.preprocess._average import AveragedCurve, averaged, pool
from fdvv.preprocess._fuse import CurveOfForce
from fdvv.preprocess._paths import FEWEST, Paths
from fdvv.preprocess._press import StrokeTrack
from fdvv.preprocess._probe import Probe
from fdvv.preprocess._reject import Judged, Reason
from fdvv.preprocess._unlike import unlike


@dataclass(frozen=True, eq=False)
class _Done:
    """One averaged curve, what it is made of, the button's force behind it, and presses unlike the others."""

    average: AveragedCurve
    tracks: list[StrokeTrack]
    shape: CurveOfForce
    strange: list[Judged]


class Curves:
    """Averages strokes pace by pace; presses unlike the others are left out on the way.

    Attributes
    ----------
    judged : all presses, as they are thought of so far.
    warnings : paces that have no curve.
    """

    def __init__(self, judged: list[Judged], probe: Probe | None, paths: Paths, unlike_limit: float) -> None:
        self.judged, self._probe, self._paths, self._limit = judged, probe, paths, unlike_limit
        self.warnings: list[str] = []

    def average(self) -> tuple[list[AveragedCurve], list[list[StrokeTrack]]]:
        """Average both strokes at every pace that has enough presses, in reading order."""
        known = {stroke: self._probe.curve(stroke) if self._probe else None for stroke in Stroke}
        found: dict[Stroke, list[_Done]] = {stroke: [] for stroke in Stroke}
        for pace in sorted({one.press.velocity_mm_s for one in self.judged}, key=lambda v: v or 0.0):
            for stroke, curve in self._pace(pace, known).items():
                known[stroke] = curve.shape
                found[stroke].append(curve)
        ordered = [curve for stroke in Stroke for curve in found[stroke]]
        return [c.average for c in ordered], [c.tracks for c in ordered]

    def _pace(self, pace: float | None, known: Mapping[Stroke, CurveOfForce | None]) -> dict[Stroke, _Done]:
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
    ) -> _Done | None:
        """Average one stroke at one pace; None if too few presses show it."""
        found = self._paths.find(used, stroke, known)
        if found is None:
            return None
        whole, tracks, shape = found
        pooled = pool(tracks, shape, *_extent_mm(tracks))
        speeds = np.array([one.achieved_mm_s for one in whole])
        strange = [whole[i] for i in unlike(pooled, self._limit)]
        return _Done(averaged(tracks, pooled, pace, speeds), tracks, shape, strange)


def _extent_mm(tracks: Sequence[StrokeTrack]) -> tuple[float, float]:
    """Tell to what depth, and from where on, at least three presses or a third of them have samples.

    A press begins at the resting cap, so its curve begins at 0: that is the button's contact.
    """
    enough = max(FEWEST, len(tracks) // 3)
    deepest = sorted(float(track.displacement_mm.max()) for track in tracks)
    shallowest = sorted(float(track.displacement_mm.min()) for track in tracks)
    start_mm = shallowest[enough - 1] if tracks[0].stroke is Stroke.RELEASE else 0.0
    return deepest[-enough], max(start_mm, 0.0)
