"""Many presses of one kind as one curve, with its spread."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from fdvv.errors import ModelError
from fdvv.model.curve import Stroke
from fdvv.preprocess.fuse import CurveOfForce, EvenBasis, rough
from fdvv.preprocess.press import StrokeTrack
from fdvv.units import FloatArray

IntArray = np.ndarray[tuple[Any, ...], np.dtype[np.int64]]
GRID_mm = 0.05
"""Force is registered on displacement every 50 um, as in the paper."""
PENALTIES = np.logspace(-5, 4, 19)
"""Weights of roughness that cross-validation chooses from: half a decade apart, where its minimum is flat."""


@dataclass(frozen=True, eq=False)
class AveragedCurve:
    """Force on displacement of many presses at one velocity, on the 50 um grid.

    Attributes
    ----------
    stroke, velocity_mm_s : which stroke, at what requested velocity; None if none was.
    achieved_mm_s, achieved_spread_mm_s : mean speed of the presses, median and standard deviation.
    displacement_mm : (n,) rising.
    force_cN : (n,) mean over the presses.
    spread_cN : (n,) standard deviation between presses.
    presses : how many.
    width_mm : length over which the smoothing averages: a bump much narrower would be lost.
    """

    stroke: Stroke
    velocity_mm_s: float | None
    achieved_mm_s: float
    achieved_spread_mm_s: float
    displacement_mm: FloatArray
    force_cN: FloatArray
    spread_cN: FloatArray
    presses: int
    width_mm: float


@dataclass(frozen=True, eq=False)
class Pooled:
    """A mean curve, how far every press is from it, and over what length it was smoothed.

    Attributes
    ----------
    grid_mm, force_cN : (n,).
    apart_cN : (presses, n) each press less the mean; NaN where it has no samples near.
    width_mm : of the smoothing.
    """

    grid_mm: FloatArray
    force_cN: FloatArray
    apart_cN: FloatArray
    width_mm: float


def pool(tracks: Sequence[StrokeTrack], shape: CurveOfForce, end_mm: float, start_mm: float = 0.0) -> Pooled:
    """Average strokes at the moments of their samples, without drawing lines between samples.

    What differs from the button's own curve ``shape`` is fitted by a spline on 50 um with a penalty on its
    third differences, weighed by generalised cross-validation against the scatter within presses.
    """
    if not tracks:
        raise ModelError("no press is left to average")
    x: FloatArray = np.concatenate([track.displacement_mm for track in tracks]).astype(np.float64)
    who = np.concatenate([np.full(track.t_s.size, i) for i, track in enumerate(tracks)])
    rest_cN: FloatArray = np.concatenate([track.force_cN for track in tracks]) - shape(x)[0]
    low = GRID_mm * math.ceil(start_mm / GRID_mm - 1e-9)
    high = GRID_mm * int(end_mm / GRID_mm + 1e-9)
    inside = (x >= low - GRID_mm) & (x <= high + GRID_mm)
    x, who, rest_cN = x[inside], who[inside], rest_cN[inside]
    basis = EvenBasis(low, GRID_mm, round((high - low) / GRID_mm))
    weights, width_mm = _smooth(basis, x, rest_cN, who)
    grid = low + GRID_mm * np.arange(basis.pieces + 1.0)
    left_cN: FloatArray = rest_cN - basis.rows(x) @ weights
    apart = np.array([_apart(grid, x[who == i], left_cN[who == i]) for i in range(len(tracks))])
    return Pooled(grid, shape(grid)[0] + basis.rows(grid) @ weights, apart, width_mm)


def _smooth(basis: EvenBasis, x: FloatArray, rest_cN: FloatArray, who: IntArray) -> tuple[FloatArray, float]:
    rows, penalty = basis.rows(x), rough(basis.size)
    square, roughness = rows.T @ rows, penalty.T @ penalty
    inner = rest_cN - _by_press(x, rest_cN, who)
    # scatter within presses alone: what presses differ by as a whole would ask for no smoothing at all
    inner_target = rows.T @ inner
    normals = [square + w * roughness + 1e-9 * np.eye(basis.size) for w in PENALTIES * x.size / basis.size]
    free = [float(np.trace(np.linalg.solve(normal, square))) for normal in normals]
    left = [inner - rows @ np.linalg.solve(normal, inner_target) for normal in normals]
    # 1.4 and not 1 a degree of freedom: plain cross-validation now and then hardly smooths (Kim and Gu 2004)
    scores = [
        x.size * float(rest @ rest) / max(x.size - 1.4 * own, 1.0) ** 2
        for rest, own in zip(left, free, strict=True)
    ]
    best = int(np.argmin(scores))
    weights: FloatArray = np.linalg.solve(normals[best], rows.T @ rest_cN).astype(np.float64)
    return weights, basis.step * basis.pieces / max(free[best], 1.0)


def _by_press(x: FloatArray, rest_cN: FloatArray, who: IntArray) -> FloatArray:
    """Return each press's own line through the residuals: it differs as a whole, which is not scatter."""
    line = np.zeros_like(rest_cN)
    for i in np.unique(who):
        mine = who == i
        if mine.sum() > 4:
            line[mine] = np.polyval(np.polyfit(x[mine], rest_cN[mine], 1), x[mine])
    common = np.polyval(np.polyfit(x, rest_cN, 1), x)
    return line - common


def _apart(grid: FloatArray, x: FloatArray, left_cN: FloatArray) -> FloatArray:
    """Put the residuals of one press on the grid, NaN beyond its samples."""
    order = np.argsort(x)
    if not order.size:
        return np.full(grid.size, np.nan)
    return np.interp(grid, x[order], left_cN[order], left=np.nan, right=np.nan)


def average_curve(
    tracks: Sequence[StrokeTrack], pooled: Pooled, velocity_mm_s: float | None, achieved_mm_s: FloatArray
) -> AveragedCurve:
    """Return the curve and its spread; the spread at a position is that of the presses seen there."""
    there = np.isfinite(pooled.apart_cN).sum(axis=0)
    square = np.nansum(pooled.apart_cN**2, axis=0) / np.maximum(there - 1, 1)
    known, spread = there >= 2, np.zeros_like(square)
    if known.any():
        spread = np.sqrt(np.interp(pooled.grid_mm, pooled.grid_mm[known], square[known]))
    return AveragedCurve(
        tracks[0].stroke,
        velocity_mm_s,
        float(np.median(achieved_mm_s)),
        float(np.std(achieved_mm_s, ddof=1)) if achieved_mm_s.size > 1 else 0.0,
        pooled.grid_mm,
        pooled.force_cN,
        spread,
        len(tracks),
        pooled.width_mm,
    )
