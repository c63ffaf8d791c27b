"""How close are fits to real raw curves: free knots of each degree and uniform knots, in one run?

Run as ``python -m benchmarks.switches FOLDER``, a folder of measured curves. Each stroke is cut from contact
to bottom-out; the error is against the raw curve, each distinct displacement counting once; "rows" is
against every raw row. Nothing is tuned here: the settings are the defaults of ``fdvv fit``.
"""

from __future__ import annotations

import sys
from collections.abc import Callable
from pathlib import Path

import numpy as np

from fdvv.errors import InputError
from fdvv.formats.force.average import average_by_velocity
from fdvv.formats.force.read import find_force_files, read_force_file
from fdvv.model.bump_kept import BUMP_KEPT_ratio
from fdvv.model.curve import MeasuredCurve, Stroke
from fdvv.model.fit import CurveFit, FitMethod, active_part, fit_curve

WAYS: dict[str, Callable[[MeasuredCurve], CurveFit]] = {
    "free knots, degree 2, auto (default)": fit_curve,
    "free knots, degree 2": lambda m: fit_curve(m, control_points=15),
    "free knots, degree 1": lambda m: fit_curve(m, control_points=15, degree=1),
    "free knots, degree 3": lambda m: fit_curve(m, control_points=15, degree=3),
    "uniform knots, degree 3 (the paper)": lambda m: fit_curve(m, FitMethod.UNIFORM, 15),
    "uniform, 8 points": lambda m: fit_curve(m, FitMethod.UNIFORM, 8),
    "uniform, 30 points": lambda m: fit_curve(m, FitMethod.UNIFORM, 30),
    "free knots, degree 2, 8 points": lambda m: fit_curve(m, control_points=8),
    "free knots, degree 2, 30 points": lambda m: fit_curve(m, control_points=30),
}


def strokes(folder: Path) -> list[MeasuredCurve]:
    """Read every stroke of a folder; a refused file is reported and left out."""
    found = []
    for path in find_force_files(folder):
        try:
            mean = average_by_velocity(read_force_file(path))[0]
        except InputError as error:
            print(f"refused: {error}")
            continue
        found += [active_part(curve) for curve in (mean.press, mean.release) if curve is not None]
    return found


def row(label: str, fits: list[CurveFit]) -> str:
    rmse, rows = ([getattr(f, name) for f in fits] for name in ("rmse_cN", "rows_rmse_cN"))
    kept = [f.bump_kept_ratio for f in fits if f.bump_kept_ratio is not None]
    held = f"{sum(k >= BUMP_KEPT_ratio for k in kept)}/{len(kept)}"
    ms = 1e3 * np.array([f.time_s for f in fits])
    return (
        f"{label:36s} {np.median(rmse):7.3f} {np.percentile(rmse, 90):7.3f} {np.median(rows):7.3f} "
        f"{held:>7s} {np.median(ms):7.1f} {np.percentile(ms, 90):7.1f}"
    )


def main() -> None:
    if len(sys.argv) != 2:
        raise SystemExit("usage: python -m benchmarks.switches FOLDER")
    curves = strokes(Path(sys.argv[1]))
    for stroke in Stroke:
        mine = [c for c in curves if c.stroke is stroke]
        print(f"{len(mine)} {stroke} curves, 15 control points unless said; RMSE in cN")
        print(f"{'':36s} {'median':>7s} {'90 %':>7s} {'rows':>7s} {'bumps':>7s} {'ms':>7s} {'90 %':>7s}")
        for label, way in WAYS.items():
            print(row(label, [way(c) for c in mine]))


if __name__ == "__main__":
    main()
