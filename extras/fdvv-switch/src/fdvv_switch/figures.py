"""Figures of a designed mechanism: its curves with target, band and residual, and its parts as drawings."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import cycle
from typing import TYPE_CHECKING, Any

import numpy as np

from fdvv.errors import ModelError
from fdvv.force_text import force_text
from fdvv.model.curve import Stroke
from fdvv.report import style
from fdvv.units import FloatArray
from fdvv_switch.section import Drawing

if TYPE_CHECKING:
    from matplotlib.axes import Axes

TARGET: Any = {"color": style.INK, "linestyle": (0, (1, 1.2)), "linewidth": 1.8}
DESIGN: Any = {"color": style.PALETTE[0], "linewidth": 1.6}
TWIN: Any = {"color": style.PALETTE[1], "linewidth": 1.6, "linestyle": (0, (3, 3))}
BOUND: Any = {"color": style.PALETTE[5], "linewidth": 1.0, "linestyle": (0, (4, 2))}
LAYER_COLOURS = (style.INK, style.PALETTE[1], style.PALETTE[0], style.PALETTE[2])


@dataclass(frozen=True, eq=False)
class DesignedStroke:
    """One stroke of a designed mechanism.

    Attributes
    ----------
    displacement_mm : (n,) strictly rising.
    target_cN, design_cN, low_cN, high_cN : (n,) what was wanted, what the design gives, and the band of parts
        within tolerance.
    twin_mm, twin_cN : (m,) what the twin gave when it pressed the design slowly; None if it could not.

    Raises ModelError on columns of different length.
    """

    stroke: Stroke
    displacement_mm: FloatArray
    target_cN: FloatArray
    design_cN: FloatArray
    low_cN: FloatArray
    high_cN: FloatArray
    twin_mm: FloatArray | None = None
    twin_cN: FloatArray | None = None

    def __post_init__(self) -> None:
        for name in ("target_cN", "design_cN", "low_cN", "high_cN"):
            if getattr(self, name).shape != self.displacement_mm.shape:
                raise ModelError(f"{name} must match displacement_mm")
        if (self.twin_mm is None) != (self.twin_cN is None):
            raise ModelError("what the twin gave needs places and forces")


@style.in_house_style
def plot_mechanism(strokes: Sequence[DesignedStroke], bound_cN: float, title: str = "") -> Any:
    """Draw target, design, band and the twin's slow press, and below what the design misses.

    bound_cN : drawn to either side of the residual. Gives the (2, strokes) array of axes.
    Raises ModelError if there is no stroke.
    """
    if not strokes:
        raise ModelError("a figure of a mechanism needs at least one stroke")
    fig = style.new_figure(5.0 * len(strokes) + 0.3, 5.6)
    grid = fig.subplots(2, len(strokes), sharex=True, sharey="row", squeeze=False, height_ratios=(2.2, 1.0))
    for column, stroke in enumerate(strokes):
        _curves(grid[0, column], stroke)
        _residual(grid[1, column], stroke, bound_cN)
    grid[0, 0].set_ylabel(style.FORCE)
    grid[1, 0].set_ylabel("design less target (cN)")
    _legend(fig, strokes, bound_cN)
    if title:
        fig.suptitle(style.name_text(title), x=0.01, ha="left", fontweight="bold")
    return grid


def _curves(ax: Axes, stroke: DesignedStroke) -> None:
    x = stroke.displacement_mm
    ax.fill_between(x, stroke.low_cN, stroke.high_cN, color=DESIGN["color"], alpha=style.BAND, linewidth=0.0)
    ax.plot(x, stroke.design_cN, **DESIGN)
    if stroke.twin_mm is not None and stroke.twin_cN is not None:
        ax.plot(stroke.twin_mm, stroke.twin_cN, **TWIN)
    ax.plot(x, stroke.target_cN, **TARGET)
    style.set_titles(ax, str(stroke.stroke), simulated=stroke.twin_mm is not None)


def _residual(ax: Axes, stroke: DesignedStroke, bound_cN: float) -> None:
    ax.plot(stroke.displacement_mm, stroke.design_cN - stroke.target_cN, **DESIGN)
    for side in (-bound_cN, bound_cN):
        ax.axhline(side, **BOUND)
    ax.set_xlabel(style.DISPLACEMENT)


def _legend(fig: Any, strokes: Sequence[DesignedStroke], bound_cN: float) -> None:
    band = {"color": DESIGN["color"], "alpha": 2 * style.BAND, "linewidth": 7.0}
    handles = [
        style.handle("target", **TARGET),
        style.handle("design", **DESIGN),
        style.handle("parts within tolerance, 5 to 95 %", **band),
    ]
    if any(s.twin_mm is not None for s in strokes):
        handles.append(style.handle("the twin, slow", **TWIN))
    handles.append(style.handle(f"± {force_text(bound_cN)}", **BOUND))
    fig.legend(handles, [str(h.get_label()) for h in handles], loc="outside lower center", ncols=len(handles))


@style.in_house_style
def plot_parts(parts: Sequence[Drawing]) -> Any:
    """Draw parts beside each other, each to its own scale, lengths in mm. Gives the (parts,) array of axes.

    Raises ModelError if there is none.
    """
    if not parts:
        raise ModelError("nothing to draw")
    fig = style.new_figure(4.4 * len(parts) + 0.3, 3.9)
    row = fig.subplots(1, len(parts), squeeze=False)[0]
    for ax, part in zip(row, parts, strict=True):
        _draw_part(ax, part)
    return row


def _draw_part(ax: Axes, part: Drawing) -> None:
    layers = list(dict.fromkeys(line.layer for line in part.outlines))
    for line in part.outlines:
        points = np.vstack([line.points_mm, line.points_mm[:1]]) if line.closed else line.points_mm
        colour = LAYER_COLOURS[layers.index(line.layer) % len(LAYER_COLOURS)]
        ax.plot(points[:, 0], points[:, 1], color=colour, linewidth=1.2)
    ax.set_aspect("equal", adjustable="datalim")
    ax.set_title(part.title, loc="left", fontsize=9.5)
    ax.set_xlabel("mm")
    if len(layers) > 1:
        handles = [
            style.handle(name.replace("_", " ").lower(), color=colour)
            for name, colour in zip(layers, cycle(LAYER_COLOURS), strict=False)
        ]
        ax.legend(handles=handles, loc="upper center", bbox_to_anchor=(0.5, -0.16), ncols=len(layers))
