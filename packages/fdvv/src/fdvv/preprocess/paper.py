"""The recipe of the FDVV paper as a baseline: filter, upsample, register on 50 um, average, smooth.

"Gaussian filters (sigma = 1.2 mm) are applied to both force and displacement data, separately"; displacement
is brought to the force's clock "via linear interpolation"; force is registered and averaged "every 50 um"; "a
Gaussian filter (sigma = 0.8 mm) is then applied to smooth the averaged curve" (Liao, Kim, Lee, Oulasvirta,
CHI 2020, Preprocessing). Filters as wide as the printed ones erase the bump of the button in its figures, so
that another unit may have been meant: here it must be declared.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from enum import StrEnum

import numpy as np

from fdvv.errors import ModelError
from fdvv.model.curve import Stroke
from fdvv.preprocess.average import AveragedCurve, GRID_mm
from fdvv.preprocess.reject import Judged
from fdvv.units import FloatArray

EVEN_WIDTH = 2 * math.sqrt(math.pi)
"""A mean over this many sigmas keeps as much noise as a Gaussian does."""


class SigmaUnit(StrEnum):
    """What a sigma counts: samples of what is filtered, time, or way at the mean speed of the stroke."""

    SAMPLES = "samples"
    MS = "ms"
    MM = "mm"


@dataclass(frozen=True)
class Gaussian:
    """A Gaussian filter whose width has a declared unit."""

    sigma: float
    unit: SigmaUnit

    def __post_init__(self) -> None:
        object.__setattr__(self, "unit", SigmaUnit(self.unit))
        if not (np.isfinite(self.sigma) and self.sigma >= 0):
            raise ModelError(f"sigma must be at least 0 and finite, got {self.sigma}")

    def in_time_s(self, step_s: float, speed_mm_s: float) -> float:
        """Return sigma in seconds for samples every step_s, at a velocity."""
        per = {SigmaUnit.SAMPLES: step_s, SigmaUnit.MS: 1e-3, SigmaUnit.MM: 1 / speed_mm_s}
        return self.sigma * per[self.unit]

    def in_way_mm(self, step_mm: float, speed_mm_s: float) -> float:
        """Return sigma in millimetres for positions every step_mm, at a velocity."""
        per = {SigmaUnit.SAMPLES: step_mm, SigmaUnit.MS: 1e-3 * speed_mm_s, SigmaUnit.MM: 1.0}
        return self.sigma * per[self.unit]


@dataclass(frozen=True)
class PaperRecipe:
    """The two filters of the paper.

    Attributes
    ----------
    streams : of force and displacement, each on its own samples, before anything else.
    curve : of the averaged curve; its samples are 50 um apart.
    """

    streams: Gaussian = Gaussian(1.2, SigmaUnit.SAMPLES)
    curve: Gaussian = Gaussian(0.8, SigmaUnit.SAMPLES)


AS_PRINTED = PaperRecipe(Gaussian(1.2, SigmaUnit.MM), Gaussian(0.8, SigmaUnit.MM))
"""With the unit that the paper prints."""


def paper_average(
    judged: Sequence[Judged],
    stroke: Stroke,
    velocity_mm_s: float | None,
    recipe: PaperRecipe,
    zero_mm: float = 0.0,
) -> AveragedCurve:
    """Average the presses of one velocity that are not left out, as the paper does.

    judged : presses and what is thought of them; the paper leaves out those that did not hit the bottom.
    zero_mm : added to displacement, as Processed.zero_mm.

    Raises ModelError if no press is left.
    """
    used = [entry for entry in judged if entry.reason is None and entry.press.velocity_mm_s == velocity_mm_s]
    if not used:
        raise ModelError("no press is left to average")
    speeds = np.array([entry.achieved_mm_s for entry in used])
    speed_mm_s = float(np.median(speeds))
    strokes = [_cut(entry, stroke, recipe.streams, zero_mm) for entry in used]
    end_mm = min(float(x_mm.max()) for x_mm, _ in strokes)
    grid: FloatArray = GRID_mm * np.arange(math.floor(end_mm / GRID_mm) + 1.0)
    forces_cN = np.array([register(x_mm, force_cN, grid) for x_mm, force_cN in strokes])
    step_s = float(np.diff(used[0].press.t_s[:2])[0])
    stream_mm = speed_mm_s * recipe.streams.in_time_s(step_s, speed_mm_s)
    curve_mm = recipe.curve.in_way_mm(GRID_mm, speed_mm_s)
    several = len(used) > 1
    return AveragedCurve(
        stroke,
        velocity_mm_s,
        speed_mm_s,
        float(np.std(speeds, ddof=1)) if several else 0.0,
        grid,
        gaussian_smooth(forces_cN.mean(axis=0), curve_mm / GRID_mm),
        np.std(forces_cN, axis=0, ddof=1) if several else np.zeros(grid.size),
        len(used),
        EVEN_WIDTH * math.hypot(stream_mm, curve_mm),
    )


def gaussian_smooth(values: FloatArray, sigma: float) -> FloatArray:
    """Apply a Gaussian of sigma samples along even samples, (n,); the ends are mirrored."""
    from scipy.ndimage import gaussian_filter1d

    return np.asarray(gaussian_filter1d(values, sigma)) if sigma > 0 else values


def register(x_mm: FloatArray, force_cN: FloatArray, grid_mm: FloatArray) -> FloatArray:
    """Return the force at positions, on lines between samples in the order of displacement.

    Of samples that lie no deeper than one before them the first is kept: a curve has one value.
    """
    order = np.argsort(x_mm, kind="stable")
    places, first = np.unique(x_mm[order], return_index=True)
    return np.interp(grid_mm, places, force_cN[order][first])


def _cut(entry: Judged, stroke: Stroke, streams: Gaussian, zero_mm: float) -> tuple[FloatArray, FloatArray]:
    press, speed_mm_s = entry.press, entry.achieved_mm_s
    begin_s, end_s = entry.spans.of(stroke)
    columns = []
    for t_s, values in ((press.frame_s, press.frame_mm), (press.t_s, press.force_cN)):
        step_s = float(np.median(np.diff(t_s)))
        columns.append(gaussian_smooth(values, streams.in_time_s(step_s, speed_mm_s) / step_s))
    inside = (press.t_s >= begin_s) & (press.t_s <= end_s)
    x_mm = np.interp(press.t_s[inside], press.frame_s, columns[0]) + zero_mm
    return x_mm, columns[1][inside]
