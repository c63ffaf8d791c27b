"""Small line charts as SVG text, for notebooks: no library, no script, readable on light and dark pages.

Axes and words take the colour of the page's text; lines have colours that stand out on both.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from fdvv.errors import ModelError
from fdvv.report.templates import environment
from fdvv.units import FloatArray

COLOURS = ("#2f8fd8", "#e0702a", "#1fa37a", "#b86fc4", "#c79a1b", "#d8577b")
"""Distinct for a colour-blind reader, and above 3:1 against both white and near-black."""
SPEEDS = ("#4ec36b", "#1f9a8a", "#2e6f8e", "#433e85", "#440154")
"""From slow to fast, as fdvv.report.style.velocity_colour; for pages whose figures are white."""
MOST_POINTS = 400
LEFT, RIGHT, TOP, BOTTOM = 46.0, 12.0, 10.0, 36.0
LEGEND, LETTER = 34.0, 6.2
"""Room of a legend beside its words, and of one letter."""
TICKS = 6  # on 430 by 230 px words lie at least 62 and 30 px apart: they do not touch


@dataclass(frozen=True, eq=False)
class ChartLine:
    """A line of a chart.

    Attributes
    ----------
    x, y : (n,) points; where one is not finite the line has a gap.
    name : for the legend; empty for none.
    colour : number of the colour, or the colour as #rrggbb.
    dashed : drawn with dashes.
    opacity : 0 to 1.
    dots : drawn as points without a line.
    """

    x: FloatArray
    y: FloatArray
    name: str = ""
    colour: int | str = 0
    dashed: bool = False
    opacity: float = 1.0
    dots: bool = False


def printable(text: str) -> str:
    """Return text from a file with a question mark for everything that cannot be printed."""
    return "".join(c if c.isprintable() else "?" for c in text)


def chart_svg(
    lines: Sequence[ChartLine],
    x_label: str,
    y_label: str,
    title: str,
    width: float = 430.0,
    height: float = 230.0,
) -> str:
    """Draw lines on common axes as one ``<svg>`` element. Raises ModelError if there is nothing to draw.

    title : what the chart shows, for those who cannot see it. All words are escaped.
    """
    x_range, y_range = (_range([getattr(line, axis) for line in lines]) for axis in "xy")
    longest = max((len(line.name) for line in lines), default=0)
    right, bottom = width - RIGHT, height - BOTTOM
    width += LEGEND + LETTER * longest if longest else 0.0

    def across(x: Any) -> Any:
        return LEFT + (right - LEFT) * (x - x_range[0]) / (x_range[1] - x_range[0])

    def up(y: Any) -> Any:
        return TOP + (bottom - TOP) * (1 - (y - y_range[0]) / (y_range[1] - y_range[0]))

    named = [line for line in lines if line.name]
    shown = [(line, *_thin(line)) for line in lines]
    text = (
        environment()
        .get_template("chart.svg")
        .render(
            **{"width": f"{width:g}", "height": f"{height:g}", "title": printable(title)},
            **{"x_label": printable(x_label), "y_label": printable(y_label)},
            **{"left": LEFT, "top": TOP, "right": right, "bottom": bottom},
            columns=[(x, across(x)) for x in _steps(*x_range)],
            rows=[(y, up(y)) for y in _steps(*y_range)],
            marks=[_mark(line, across(x), up(y)) for line, x, y in shown],
            legend=[
                (_sign(line, right + 8, TOP + 8 + 16 * row), TOP + 8 + 16 * row)
                for row, line in enumerate(named)
            ],
        )
    )
    return "".join(map(str.strip, text.splitlines()))


def _range(columns: Sequence[FloatArray]) -> tuple[float, float]:
    values = np.concatenate([np.asarray(column, dtype=np.float64) for column in columns]) if columns else None
    if values is None or not np.isfinite(values).any():
        raise ModelError("a chart needs at least one finite point")
    low, high = float(np.nanmin(values[np.isfinite(values)])), float(np.nanmax(values[np.isfinite(values)]))
    # an axis that would begin near zero begins there
    low = 0.0 if 0 < low < 0.3 * high else low
    room = (high - low) * 0.04 or abs(high) * 0.1 or 1.0
    return low if low == 0 else low - room, high + room


def _steps(low: float, high: float) -> list[float]:
    """Return round numbers within a range, about six."""
    rough = (high - low) / TICKS
    size = 10.0 ** math.floor(math.log10(rough))
    step = next(size * m for m in (1, 2, 5, 10) if size * m >= rough)
    return [step * i for i in range(math.ceil(low / step - 1e-9), math.floor(high / step + 1e-9) + 1)]


def _thin(line: ChartLine) -> tuple[FloatArray, FloatArray]:
    """Keep the lowest and the highest of each stretch of a long line, so that no peak is lost."""
    x, y = np.asarray(line.x, dtype=np.float64), np.asarray(line.y, dtype=np.float64)
    if x.size <= MOST_POINTS:
        return x, y
    kept = []
    for part in np.array_split(np.arange(x.size), MOST_POINTS // 2):
        finite = part[np.isfinite(y[part])]
        if finite.size:
            kept += sorted({int(finite[np.argmin(y[finite])]), int(finite[np.argmax(y[finite])])})
    return x[kept], y[kept]


def _mark(line: ChartLine, px: FloatArray, py: FloatArray) -> dict[str, Any]:
    """Return what the template draws of a line: points, and a path that lifts its pen over a gap."""
    finite = np.isfinite(px) & np.isfinite(py)
    follows = finite & np.concatenate([[False], finite[:-1]])
    points = list(zip(px[finite].tolist(), py[finite].tolist(), strict=True))
    pens = np.where(follows[finite], "L", "M")
    path = "".join(f"{pen}{x:.1f} {y:.1f}" for pen, (x, y) in zip(pens, points, strict=True))
    colour = line.colour if isinstance(line.colour, str) else COLOURS[line.colour % len(COLOURS)]
    return {"line": line, "name": printable(line.name), "colour": colour, "points": points, "path": path}


def _sign(line: ChartLine, x: float, y: float) -> dict[str, Any]:
    """Return the text beside a line's name."""
    places = [x + 9] if line.dots else [x, x + 18]
    return _mark(line, np.array(places), np.full(len(places), y))
