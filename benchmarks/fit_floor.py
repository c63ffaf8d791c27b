"""How far are fits with 15 control points from the best that 15 can do?

    python -m benchmarks.fit_floor [FOLDER] [EXCHANGES]

For every press below FOLDER (../shared/data): the RMSE of the fit; that of the search alone, which holds
neither bump nor floor; that after EXCHANGES (400) random exchanges of one to four knots, each searched to its
end; and a bound that no knots pass: as many quadratic pieces as the spline has, cut where they are best
(dynamic programming), but not connected. Last the noise from sample to sample, which no curve can follow.
"""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np

from benchmarks.true_to_file_fits import strokes_of
from fdvv.errors import FitError
from fdvv.model import bspline
from fdvv.model.curve import Stroke
from fdvv.model.fit import PAPERS_CONTROL_POINTS, fit_curve
from fdvv.model.knot_search import Spline, free_knots, refine
from fdvv.model.residual import noise_cN
from fdvv.units import FloatArray

DEGREE, MOST_EXCHANGED = 2, 4
PIECES = PAPERS_CONTROL_POINTS - DEGREE


def rmse_cN(x: FloatArray, y: FloatArray, spline: Spline) -> float:
    return float(np.sqrt(np.mean((bspline.evaluate(*spline, DEGREE, x) - y) ** 2)))


def exchanged(
    x: FloatArray, y: FloatArray, found: Spline, exchanges: int, random: np.random.Generator
) -> Spline:
    """Exchange knots at random and search on, while that lowers the error."""
    least, spacing, ends = rmse_cN(x, y, found), float(np.median(np.diff(x))), DEGREE + 1
    for _ in range(exchanges):
        inner, count = found[0][ends:-ends], int(random.integers(1, MOST_EXCHANGED + 1))
        kept = np.delete(inner, random.choice(inner.size, count, replace=False))
        far = np.abs(bspline.evaluate(*found, DEGREE, x) - y) ** random.uniform(0, 2)
        new = np.sort(np.concatenate([kept, random.choice(x, count, p=far / far.sum())]))
        if np.diff(np.concatenate([x[:1], new, x[-1:]])).min() < spacing:
            continue
        try:
            knots = np.concatenate([found[0][:ends], new, found[0][-ends:]])
            trial = refine(x, y, DEGREE, knots, 2)
        except FitError:
            continue
        if rmse_cN(x, y, trial) < least:
            found, least = trial, rmse_cN(x, y, trial)
    return found


def unconnected_cN(x: FloatArray, y: FloatArray, pieces: int = PIECES) -> float:
    """Return the least RMSE of quadratic pieces that need not join: no spline of as many spans is below."""
    cost = np.full((x.size, x.size + 1), np.inf)
    for first in range(x.size):
        cost[first, first + 1 :] = _piece_costs(x[first:], y[first:])
    best = cost[0].copy()
    for _ in range(pieces - 1):
        best[1:] = np.minimum(best[1:], np.min(best[:-1, None] + cost, axis=0)[1:])
    return float(np.sqrt(best[-1] / x.size))


def _piece_costs(x: FloatArray, y: FloatArray) -> FloatArray:
    """Return the squared errors of the best quadratics through the first 1, 2, ... samples."""
    u, v = x - x[0], y - y[0]
    scale = np.maximum(u, 1e-9)
    powers = [np.cumsum(u**k) / scale**k for k in range(2 * DEGREE + 1)]
    normal = np.array([[powers[i + j] for j in range(DEGREE + 1)] for i in range(DEGREE + 1)])
    normal += 1e-11 * np.eye(DEGREE + 1)[:, :, None] * np.arange(1, x.size + 1)
    right = np.array([np.cumsum(v * u**k) / scale**k for k in range(DEGREE + 1)])
    found = np.linalg.solve(normal.transpose(2, 0, 1), right.T[:, :, None])[:, :, 0]
    cost = np.maximum(np.cumsum(v**2) - np.sum(found * right.T, axis=1), 0.0)
    cost[: DEGREE + 1] = 0.0
    return np.asarray(cost, dtype=np.float64)


def main(folder: str = "../shared/data", exchanges: str = "400") -> None:
    """Print medians and 90th percentiles of all presses, and how much lower the exchanges come."""
    rows = []
    for number, stroke in enumerate(strokes_of(Path(folder).resolve())):
        if stroke.stroke is Stroke.PRESS:
            x, y, _ = stroke.by_displacement()
            fit = fit_curve(stroke, control_points=PAPERS_CONTROL_POINTS).rmse_cN
            free = free_knots(x, y, DEGREE, PAPERS_CONTROL_POINTS)
            best = exchanged(x, y, free, int(exchanges), np.random.default_rng(number))
            rows.append([fit, rmse_cN(x, y, free), rmse_cN(x, y, best), unconnected_cN(x, y), noise_cN(y)])
    table = np.array(rows)
    for name, column in zip(
        ("fit", "search alone", "exchanged", "unconnected", "noise"), table.T, strict=True
    ):
        print(f"{name:14s} {np.median(column):.3f} / {np.percentile(column, 90):.3f} cN")
    ratio = table[:, 2] / table[:, 1]
    print(f"exchanged over search: {np.exp(np.log(ratio).mean()):.3f} (mean), {ratio.min():.2f} (least)")


if __name__ == "__main__":
    main(*sys.argv[1:3])
