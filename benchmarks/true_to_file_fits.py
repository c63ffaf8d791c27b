"""How close are fits to real files, what do they keep of a bump, do they pull, and what do they take?

    python -m benchmarks.true_to_file_fits [FOLDER]

Every measured file below FOLDER (../shared/data) is fitted from contact to bottom-out, with 15 control points
and with as many as BIC* asks for. Errors are against the raw curve, each distinct displacement once. A bump
is kept if 95 % of its fall are left: by means over 50 um, and by medians of 5 samples.
"""

from __future__ import annotations

import sys
import time
from collections.abc import Iterator, Sequence
from pathlib import Path

import numpy as np

from benchmarks.button_lines import Line
from fdvv.button.fit import measured_files, measured_parts
from fdvv.errors import FdvvError
from fdvv.formats.force.read import read_force_file
from fdvv.model.bump_kept import BUMP_KEPT_ratio
from fdvv.model.curve import MeasuredCurve, Stroke
from fdvv.model.fit import AUTO_SAMPLES, CurveFit, fit_curve

WANTED_cN = {15: (0.13, 0.30), None: (0.10, 0.20)}
"""Median and 90 % of the RMSE of presses."""
KEPT_ratio = 0.98
LEAST_cN, BELOW_cN = -0.5, 0.5

Fits = Sequence[tuple[CurveFit, MeasuredCurve]]


def name_of(size: int | None) -> str:
    return f"{size} control points" if size else "auto"


def errors(fits: Fits, size: int | None) -> Iterator[Line]:
    """Compare the RMSE with what is wanted of presses."""
    for stroke in Stroke:
        rmse = [fit.rmse_cN for fit, _ in fits if fit.curve.stroke is stroke]
        median, ninety = float(np.median(rmse)), float(np.percentile(rmse, 90))
        wanted = WANTED_cN[size]
        met = stroke is Stroke.RELEASE or (median <= wanted[0] and ninety <= wanted[1])
        asked = f"<= {wanted[0]:.2f} / {wanted[1]:.2f}" if stroke is Stroke.PRESS else "shown"
        yield Line(f"RMSE of {len(rmse)} {stroke} curves", f"{median:.3f} / {ninety:.3f} cN", asked, met)


def bumps(fits: Fits, size: int | None) -> Iterator[Line]:
    """Count the bumps kept by both measures; only auto owes them."""
    for what, field in (("50 um means", "bump_kept_ratio"), ("5-sample medians", "bump_kept_samples_ratio")):
        ratios = [ratio for fit, _ in fits if (ratio := getattr(fit, field)) is not None]
        kept = sum(ratio >= BUMP_KEPT_ratio for ratio in ratios)
        met = size is not None or kept >= KEPT_ratio * len(ratios)
        asked = "shown" if size else f">= {100 * KEPT_ratio:g} %"
        yield Line(f"bumps kept, by {what}", f"{kept} of {len(ratios)}", asked, met)


def floors(fits: Fits, _size: int | None) -> Iterator[Line]:
    """Count curves that fall where the measurement does not."""
    lowest = [
        float(f.curve.force_cN(np.linspace(f.curve.start_mm, f.curve.end_mm, 5000)).min()) for f, _ in fits
    ]
    least = [float(measured.force_cN.min()) for _, measured in fits]
    pull = sum(low < LEAST_cN <= own for low, own in zip(lowest, least, strict=True))
    yield Line(f"below {LEAST_cN} cN where the measurement is not", f"{pull} of {len(fits)}", "0", not pull)
    below = sum(low < own - BELOW_cN for low, own in zip(lowest, least, strict=True))
    yield Line(f"{BELOW_cN} cN below the least measured force", f"{below} of {len(fits)}", "0", not below)


def fitted(
    strokes: Sequence[MeasuredCurve], size: int | None
) -> tuple[list[tuple[CurveFit, MeasuredCurve]], float]:
    """Fit strokes; also the processor time per curve, in ms."""
    began = time.process_time()
    fits = [(fit_curve(stroke, control_points=size), stroke) for stroke in strokes]
    return fits, 1e3 * (time.process_time() - began) / len(fits)


def strokes_of(folder: Path) -> list[MeasuredCurve]:
    """Read every stroke that is not doubted; what is refused is passed over."""
    found: list[MeasuredCurve] = []
    for path in measured_files(folder):
        try:
            parts = measured_parts(read_force_file(path))
        except FdvvError:
            continue
        found += [] if parts.implausible else parts.strokes
    return [stroke for stroke in found if stroke.by_displacement()[0].size >= AUTO_SAMPLES]


def main(folder: str = "../shared/data") -> None:
    """Print the table."""
    strokes = strokes_of(Path(folder).resolve())
    sizes = {}
    for size in WANTED_cN:
        fits, took_ms = fitted(strokes, size)
        sizes[size] = [fit.bic_star for fit, _ in fits]
        counts = np.percentile([fit.curve.control_points_cN.size for fit, _ in fits], [5, 50, 95])
        print(f"{name_of(size)}: {took_ms:.0f} ms of processor a curve; points {counts} (5, 50, 95 %)")
        for row in (errors, bumps, floors):
            for line in row(fits, size):
                print(
                    f"{'met    ' if line.met else 'NOT MET'} {line.what}: {line.got} (wanted {line.wanted})"
                )
    above = sum(
        auto > papers + 1e-9 * abs(papers) for auto, papers in zip(sizes[None], sizes[15], strict=True)
    )
    print(
        f"{'NOT MET' if above else 'met    '} auto above the BIC* of 15: {above} of {len(strokes)} (wanted 0)"
    )


if __name__ == "__main__":
    main(*sys.argv[1:2])
