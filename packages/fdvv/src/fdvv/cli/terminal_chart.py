"""Force over displacement drawn with dots of braille, for commands that print to a terminal."""

from __future__ import annotations

import os
import shutil
import sys
from collections.abc import Sequence
from dataclasses import dataclass

import click
import numpy as np
import numpy.typing as npt

from fdvv.force_text import force_number, force_unit
from fdvv.model.curve import ForceCurve, Stroke
from fdvv.model.model import FDVVModel
from fdvv.units import FloatArray

ROWS, MOST_COLUMNS, LEAST_COLUMNS = 14, 84, 40
LEFT = 6
"""Columns of the labels of force."""
COLOURS = ("bright_blue", "bright_red", "bright_green", "bright_magenta", "bright_yellow", "bright_cyan")
DOTS = ((0x01, 0x08), (0x02, 0x10), (0x04, 0x20), (0x40, 0x80))
"""The bits of a braille sign, four rows of two dots."""
RELEASE_every = 3
"""A release is drawn with every third dot of its line."""


@dataclass(frozen=True)
class TerminalCurve:
    """A curve and the number of its colour."""

    curve: ForceCurve
    colour: int


def can_draw() -> bool:
    """Return whether standard output is a terminal that knows braille and is wide enough."""
    encoding = (sys.stdout.encoding or "").lower().replace("-", "")
    wide = shutil.get_terminal_size().columns >= LEAST_COLUMNS
    return sys.stdout.isatty() and encoding == "utf8" and os.environ.get("TERM") != "dumb" and wide


def print_curves(models: Sequence[FDVVModel], velocity_mm_s: float | None = None) -> None:
    """Print the curves of buttons nearest to a speed, by default their slowest, with a legend."""
    curves = [
        TerminalCurve(curve, at)
        for at, model in enumerate(models)
        for stroke in Stroke
        if (curve := model.nearest(stroke, velocity_mm_s)) is not None
    ]
    for line in chart_lines(curves, min(MOST_COLUMNS, shutil.get_terminal_size().columns - 2)):
        click.echo(line)
    names = [click.style(f"━ {model.name}", COLOURS[at % len(COLOURS)]) for at, model in enumerate(models)]
    click.echo(f"{' ' * LEFT} {'  '.join(names)}  (dotted: release)\n")


def chart_lines(curves: Sequence[TerminalCurve], columns: int) -> list[str]:
    """Draw curves into lines of so many columns, labels of both axes among them."""
    wide, high = 2 * (columns - LEFT - 1), 4 * ROWS
    ends_mm = min(0.0, *(c.curve.start_mm for c in curves)), max(c.curve.end_mm for c in curves)
    x_mm = np.linspace(*ends_mm, wide)
    drawn = [(c, _inside(c.curve, x_mm)) for c in curves]
    top_cN = float(max(np.nanmax(force) for _, force in drawn)) or 1.0
    bits = np.zeros((ROWS, wide // 2), dtype=np.int32)
    colours = np.zeros_like(bits)
    for one, force_cN in drawn:
        rows = np.round((high - 1) * (1 - np.clip(force_cN, 0.0, top_cN) / top_cN))
        for at, row in _dots(rows, one.curve.stroke):
            bits[row // 4, at // 2] |= DOTS[row % 4][at % 2]
            colours[row // 4, at // 2] = one.colour
    lines = [f"{_label(i, top_cN)} {_signs(bits[i], colours[i])}" for i in range(ROWS)]
    across = f"{ends_mm[0]:.1f}" + "mm".center(wide // 2 - 6) + f"{ends_mm[1]:.1f}"
    return [f"{force_unit():>{LEFT}}", *lines, f"{' ' * LEFT} {across}"]


def _inside(curve: ForceCurve, x_mm: FloatArray) -> FloatArray:
    force = np.asarray(curve.force_cN(x_mm), dtype=np.float64)
    return np.where((x_mm >= curve.start_mm) & (x_mm <= curve.end_mm), force, np.nan)


def _dots(rows: FloatArray, stroke: Stroke) -> list[tuple[int, int]]:
    """Return the dots of a line; steep parts are filled from one column to the next."""
    dots: list[tuple[int, int]] = []
    before: int | None = None
    for at, value in enumerate(rows):
        if np.isnan(value):
            before = None
            continue
        row = int(value)
        low, high = sorted((row, row if before is None else before))
        dots += [(at, between) for between in range(low, high + 1)]
        before = row
    return dots if stroke is Stroke.PRESS else dots[::RELEASE_every]


def _signs(bits: npt.NDArray[np.int32], colours: npt.NDArray[np.int32]) -> str:
    return "".join(
        click.style(chr(0x2800 + bit), COLOURS[colour % len(COLOURS)]) if bit else " "
        for bit, colour in zip(bits.tolist(), colours.tolist(), strict=True)
    )


def _label(row: int, top_cN: float) -> str:
    """Return the force at the left of a row: the highest, the half, and none."""
    known = {
        0: force_number(top_cN, ".0f"),
        ROWS // 2: force_number(top_cN * (1 - 0.5 * (2 * (ROWS // 2) + 1) / ROWS), ".0f"),
        ROWS - 1: "0",
    }
    return known.get(row, "").rjust(LEFT)
