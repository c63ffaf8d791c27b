"""Small line charts as SVG text, for notebooks: no library, no script, readable on light and dark pages.

Axes and words take the colour of the page's text; lines have colours that stand out on both.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from html import escape

import numpy as np

from fdvv.errors import ModelError
from fdvv.units import FloatArray

COLOURS = ("#2f8fd8", "#e0702a", "#1fa37a", "#b86fc4", "#c79a1b", "#d8577b")
"""Distinct for a colour-blind reader, and above 3:1 against both white and near-black."""
MOST_POINTS = 400
LEFT, RIGHT, TOP, BOTTOM = 46.0, 12.0, 10.0, 36.0
LEGEND, LETTER = 34.0, 6.2
"""Room of a legend beside its words, and of one letter."""
TICKS = 6


@dataclass(frozen=True, eq=False)
class ChartLine:
    """A line of a chart.

    Attributes
    ----------
    x, y : (n,) points; where one is not finite the line has a gap.
    name : for the legend; empty for none.
    colour : number of the colour.
    dashed : drawn with dashes.
    opacity : 0 to 1.
    dots : drawn as points without a line.
    """

    x: FloatArray
    y: FloatArray
    name: str = ""
    colour: int = 0
    dashed: bool = False
    opacity: float = 1.0
    dots: bool = False


def printable(text: str) -> str:
    """Return text from a file with a question mark for everything that cannot be printed."""
    return "".join(c if c.isprintable() else "?" for c in text)


def _escaped(text: str) -> str:
    return escape(printable(text))


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
    right = width - RIGHT
    width += LEGEND + LETTER * longest if longest else 0.0
    across = right - LEFT, LEFT
    up = height - TOP - BOTTOM, TOP
    parts = [
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width:g} {height:g}" width="{width:g}" '
        f'height="{height:g}" role="img" '
        f'aria-label="{_escaped(title)}" font-family="sans-serif" font-size="11">',
        f"<title>{_escaped(title)}</title>",
        *_axes(x_range, y_range, x_label, y_label, right, height - BOTTOM),
    ]
    for line in lines:
        shown = _thinned(line)
        px = across[1] + across[0] * (shown[0] - x_range[0]) / (x_range[1] - x_range[0])
        py = up[1] + up[0] * (1 - (shown[1] - y_range[0]) / (y_range[1] - y_range[0]))
        parts.append(_dots(line, px, py) if line.dots else _path(line, px, py))
    parts += _legend(lines, right)
    return "".join(parts) + "</svg>"


def _range(columns: Sequence[FloatArray]) -> tuple[float, float]:
    values = np.concatenate([np.asarray(column, dtype=np.float64) for column in columns]) if columns else None
    if values is None or not np.isfinite(values).any():
        raise ModelError("a chart needs at least one finite point")
    low, high = float(np.nanmin(values[np.isfinite(values)])), float(np.nanmax(values[np.isfinite(values)]))
    low, high = min(low, 0.0) if low > 0 and low < 0.3 * high else low, high
    room = (high - low) * 0.04 or abs(high) * 0.1 or 1.0
    return low if low == 0 else low - room, high + room


def _steps(low: float, high: float) -> list[float]:
    """Return round numbers within a range, about six."""
    rough = (high - low) / TICKS
    size = 10.0 ** math.floor(math.log10(rough))
    step = next(size * m for m in (1, 2, 5, 10) if size * m >= rough)
    return [step * i for i in range(math.ceil(low / step - 1e-9), math.floor(high / step + 1e-9) + 1)]


def _axes(
    x_range: tuple[float, float],
    y_range: tuple[float, float],
    x_label: str,
    y_label: str,
    right: float,
    bottom: float,
) -> list[str]:
    made = [f'<g stroke="currentColor" fill="none"><path d="M{LEFT} {TOP}V{bottom}H{right}" opacity="0.6"/>']
    labels = ['<g fill="currentColor" opacity="0.85">']
    for value in _steps(*x_range):
        at = LEFT + (right - LEFT) * (value - x_range[0]) / (x_range[1] - x_range[0])
        made.append(f'<path d="M{at:.1f} {TOP}V{bottom}" opacity="0.12"/>')
        labels.append(f'<text x="{at:.1f}" y="{bottom + 14:g}" text-anchor="middle">{value:g}</text>')
    for value in _steps(*y_range):
        at = TOP + (bottom - TOP) * (1 - (value - y_range[0]) / (y_range[1] - y_range[0]))
        made.append(f'<path d="M{LEFT} {at:.1f}H{right}" opacity="0.12"/>')
        labels.append(f'<text x="{LEFT - 5}" y="{at + 4:.1f}" text-anchor="end">{value:g}</text>')
    middle = (LEFT + right) / 2, (TOP + bottom) / 2
    labels.append(
        f'<text x="{middle[0]:.1f}" y="{bottom + 30:g}" text-anchor="middle">{_escaped(x_label)}</text>'
    )
    turned = f'transform="translate(11 {middle[1]:.1f}) rotate(-90)"'
    labels.append(f'<text {turned} text-anchor="middle">{_escaped(y_label)}</text>')
    return [*made, "</g>", *labels, "</g>"]


def _thinned(line: ChartLine) -> tuple[FloatArray, FloatArray]:
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


def _path(line: ChartLine, px: FloatArray, py: FloatArray) -> str:
    commands, pen = [], "M"
    for x, y in zip(px.tolist(), py.tolist(), strict=True):
        if math.isfinite(x) and math.isfinite(y):
            commands.append(f"{pen}{x:.1f} {y:.1f}")
            pen = "L"
        else:
            pen = "M"
    dashes = ' stroke-dasharray="5 3"' if line.dashed else ""
    colour = COLOURS[line.colour % len(COLOURS)]
    return (
        f'<path d="{"".join(commands)}" fill="none" stroke="{colour}" stroke-width="1.6" '
        f'stroke-linejoin="round" opacity="{line.opacity:.2g}"{dashes}/>'
    )


def _dots(line: ChartLine, px: FloatArray, py: FloatArray) -> str:
    colour = COLOURS[line.colour % len(COLOURS)]
    circles = [
        f'<circle cx="{x:.1f}" cy="{y:.1f}" r="3.4" fill="none" stroke="{colour}" stroke-width="1.6"/>'
        for x, y in zip(px.tolist(), py.tolist(), strict=True)
        if math.isfinite(x) and math.isfinite(y)
    ]
    return "".join(circles)


def _legend(lines: Sequence[ChartLine], right: float) -> list[str]:
    """Name the lines beside the axes."""
    made = []
    for row, line in enumerate(line for line in lines if line.name):
        y = TOP + 8 + 16 * row
        start = right + 8
        sign = (
            _dots(line, np.array([start + 9]), np.array([y]))
            if line.dots
            else _path(line, np.array([start, start + 18]), np.array([y, y]))
        )
        text = f'<text x="{start + 24:g}" y="{y + 4:g}" fill="currentColor">{_escaped(line.name)}</text>'
        made += [sign, text]
    return made
