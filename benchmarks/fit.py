"""How fast and how close are fits, beside plain SciPy doing the same work in the same run?

Run as ``python -m benchmarks.fit``. The strokes are made here (contact step, bump, noise of a bench), with
fixed seeds. The plain loop is the same search (dense knots, removal, walk) with SciPy's make_lsq_spline as
its inner solver, and the same BIC* scan with it.
"""

from __future__ import annotations

import statistics
import time
from collections.abc import Callable

import numpy as np
from scipy.interpolate import BSpline, make_lsq_spline

from fdvv.model.curve import MeasuredCurve, Stroke
from fdvv.model.fit import FitMethod, bic_star, fit_curve, scan_sizes
from fdvv.units import FloatArray

SEEDS = range(5)
SIZE, DEGREE = 15, 2


def stroke(seed: int) -> MeasuredCurve:
    """Make a tactile stroke as a bench of 5 um steps sees it."""
    rng = np.random.default_rng(seed)
    x = np.arange(0, 4.0, 0.005)
    bump = rng.uniform(10, 30) * np.exp(-(((x - rng.uniform(1, 2)) / 0.35) ** 2))
    return MeasuredCurve(
        x, np.minimum(500 * x, 35 + 10 * x) + bump + rng.normal(0, 0.1, x.size), Stroke.PRESS
    )


def squared_error(x: FloatArray, y: FloatArray, inner: FloatArray) -> float:
    t = np.concatenate([np.full(DEGREE + 1, x[0]), inner, np.full(DEGREE + 1, x[-1])])
    try:
        spline = make_lsq_spline(x, y, t, DEGREE)
    except (ValueError, np.linalg.LinAlgError):
        return float("inf")
    return float(np.sum((spline(x) - y) ** 2))


def plain_walk(x: FloatArray, y: FloatArray, inner: FloatArray, rounds: int) -> FloatArray:
    """Let each knot step left and right with a step that grows and shrinks."""
    step = np.full(inner.size, (x[-1] - x[0]) / 60)
    best = squared_error(x, y, inner)
    for _ in range(rounds):
        for j in range(inner.size):
            moved = False
            for sign in (-1, 1):
                trial = inner.copy()
                trial[j] += sign * step[j]
                ends = (x[0], *trial, x[-1])
                if min(np.diff(ends)) < 0.005:
                    continue
                error = squared_error(x, y, trial)
                if error < best:
                    best, inner, moved = error, trial, True
                    break
            step[j] *= 1.5 if moved else 0.5
        if step.max() < 5e-4:
            break
    return inner


def plain_free_knots(x: FloatArray, y: FloatArray) -> float:
    """Search free knots with SciPy alone; give the RMSE."""
    rise = np.concatenate([[0.0], np.cumsum(np.abs(np.diff(y)))])
    density = 0.5 * (x - x[0]) / (x[-1] - x[0]) + 0.5 * rise / rise[-1]
    inner = np.unique(np.round(np.interp(np.linspace(0, 1, 39)[1:-1], density, x), 3))
    while inner.size > SIZE - DEGREE - 1:
        errors = [squared_error(x, y, np.delete(inner, j)) for j in range(inner.size)]
        inner = np.delete(inner, int(np.argmin(errors)))
    inner = plain_walk(x, y, inner, 25)
    return float(np.sqrt(squared_error(x, y, inner) / x.size))


def plain_scan(measured: MeasuredCurve) -> dict[int, float]:
    """Scan BIC* over uniform cubic knots with SciPy alone."""
    x, y = measured.displacement_mm, measured.force_cN
    scores = {}
    for size in range(5, 41):
        t = np.concatenate([np.full(4, x[0]), np.linspace(x[0], x[-1], size - 2)[1:-1], np.full(4, x[-1])])
        spline: BSpline = make_lsq_spline(x, y, t, 3)
        scores[size] = bic_star(x.size, size, float(np.sum((spline(x) - y) ** 2)))
    return scores


def time_ms(work: Callable[[], object], repeats: int = 5) -> tuple[float, float, float]:
    """Time work: (median, least, greatest) in ms."""
    spent = []
    for _ in range(repeats):
        begun = time.perf_counter()
        work()
        spent.append(1e3 * (time.perf_counter() - begun))
    return statistics.median(spent), min(spent), max(spent)


def row(label: str, times: tuple[float, float, float], rmse_cN: float | None) -> str:
    error = "" if rmse_cN is None else f"  RMSE {rmse_cN:.3f} cN"
    return f"{label:42s} {times[0]:9.2f} ms  ({times[1]:.2f} to {times[2]:.2f}){error}"


def main() -> None:
    strokes = [stroke(seed) for seed in SEEDS]
    first = strokes[0]
    x, y = first.displacement_mm, first.force_cN
    print(f"fit of {SIZE} control points to {x.size} samples; median of repeats, least to greatest")
    fits = [fit_curve(s, control_points=SIZE) for s in strokes]
    plain = [plain_free_knots(s.displacement_mm, s.force_cN) for s in strokes[:2]]
    print(
        row(
            "free knots, fdvv",
            time_ms(lambda: fit_curve(first, control_points=SIZE)),
            statistics.median(f.rmse_cN for f in fits),
        )
    )
    print(
        row(
            "free knots, plain SciPy loop",
            time_ms(lambda: plain_free_knots(x, y), 2),
            statistics.median(plain),
        )
    )
    uniform = statistics.median(fit_curve(s, FitMethod.UNIFORM, SIZE).rmse_cN for s in strokes)
    print(
        row("uniform knots, fdvv (SciPy inside)", time_ms(lambda: fit_curve(first, "uniform", SIZE)), uniform)
    )
    print(row("BIC* scan of 36 sizes, uniform, fdvv", time_ms(lambda: scan_sizes(first)), None))
    print(row("BIC* scan of 36 sizes, plain SciPy loop", time_ms(lambda: plain_scan(first)), None))
    print(
        row(
            "BIC* scan of 36 sizes, free knots, fdvv", time_ms(lambda: scan_sizes(first, "adaptive"), 2), None
        )
    )


if __name__ == "__main__":
    main()
