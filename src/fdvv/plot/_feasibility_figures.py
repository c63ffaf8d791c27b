"""A figure of what is intended, what a rig can reach and what was measured, per curve."""

from __future__ import annotations

import textwrap
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from fdvv.errors import ModelError
from fdvv.model import Stroke
from fdvv.plot import _style as style
from fdvv.plot._records import FeasibleCurve

if TYPE_CHECKING:
    from matplotlib.axes import Axes

INTENDED: Any = {"color": style.INK, "linestyle": (0, (1, 1.2)), "linewidth": 1.8}
ACHIEVABLE: Any = {"color": style.PALETTE[0], "linewidth": 1.6}
MEASURED: Any = {"color": style.PALETTE[1], "linewidth": 1.4}
CUT: Any = {"color": style.PALETTE[5], "alpha": 0.25, "linewidth": 0.0}
LINE_LENGTH, MOST_LINES, TEXT_pt = 70, 3, 8.0


@style.in_house_style
def plot_feasibility(curves: Sequence[FeasibleCurve], title: str = "") -> Any:
    """Draw intended, achievable and measured force in a grid: a row per velocity, a column per stroke.

    The band of a measured curve is its spread over the presses; a shaded range is one where a limit cuts the
    command. The verdict stands below each title. Gives the (velocities, strokes) array of axes.
    Raises ModelError if there is no curve, or two for one cell.
    """
    cells = {(c.velocity_mm_s, c.stroke): c for c in curves}
    if not cells or len(cells) != len(curves):
        raise ModelError(
            f"a grid needs one curve per velocity and stroke, got {len(curves)} for {len(cells)}"
        )
    rows = sorted({v for v, _ in cells})
    columns = [s for s in Stroke if any(stroke is s for _, stroke in cells)]
    fig = style.new_figure(5.0 * len(columns) + 0.3, 2.9 * len(rows) + 0.7)
    axes = fig.subplots(len(rows), len(columns), sharex=True, squeeze=False)
    for i, velocity in enumerate(rows):
        for j, stroke in enumerate(columns):
            _draw_cell(axes[i, j], cells.get((velocity, stroke)))
            axes[i, j].set_xlabel(style.DISPLACEMENT if i == len(rows) - 1 else "")
            axes[i, j].set_ylabel(style.FORCE if j == 0 else "")
    _legend(axes, curves, title)
    return axes


def _draw_cell(ax: Axes, curve: FeasibleCurve | None) -> None:
    """Draw one velocity and stroke."""
    if curve is None:
        ax.set_visible(False)
        return
    x = curve.displacement_mm
    shown = [curve.intended_cN, curve.achievable_cN]
    if curve.band is not None and curve.band_mm is not None:
        ax.fill_between(
            curve.band_mm, curve.band.low_cN, curve.band.high_cN, color=MEASURED["color"], alpha=0.22
        )
        ax.plot(curve.band_mm, curve.band.mean_cN, **MEASURED)
        shown += [curve.band.low_cN, curve.band.high_cN]
    ax.plot(x, curve.achievable_cN, **ACHIEVABLE)
    ax.plot(x, curve.intended_cN, **INTENDED)
    ax.set_ylim(*style.limits_around(*shown))
    ax.fill_between(x, 0, 1, where=curve.cut.tolist(), transform=ax.get_xaxis_transform(), **CUT)
    _titles(ax, curve)


def _titles(ax: Axes, curve: FeasibleCurve) -> None:
    """Write stroke and speed, and between them and the axes the verdict."""
    lines = textwrap.wrap(curve.verdict, LINE_LENGTH, max_lines=MOST_LINES, placeholder=" …")
    room: Any = {"xytext": (0.0, 4.0), "textcoords": "offset points", "va": "bottom", "fontsize": TEXT_pt}
    ax.annotate("\n".join(lines), (0.0, 1.0), xycoords="axes fraction", color=style.QUIET, **room)
    title = f"{curve.stroke}, {style.velocity_text(curve.velocity_mm_s)}"
    style.set_titles(ax, title, curve.simulated)
    # the distance of one title is that of all three
    ax.set_title(title, loc="left", pad=8.0 + 1.25 * TEXT_pt * len(lines))


def _legend(axes: Any, curves: Sequence[FeasibleCurve], title: str) -> None:
    """Name the lines once for the whole grid, below it."""
    handles = [style.handle("intended", **INTENDED), style.handle("achievable", **ACHIEVABLE)]
    if any(c.band for c in curves):
        handles.append(style.handle("measured", **MEASURED))
    if any(np.any(c.cut) for c in curves):
        handles.append(style.handle("a limit cuts", color=CUT["color"], alpha=0.5, linewidth=7.0))
    labels = [str(item.get_label()) for item in handles]
    fig = axes[0, 0].figure
    fig.legend(handles, labels, loc="outside lower center", ncols=len(handles))
    if title:
        fig.suptitle(style.name_text(title), x=0.01, ha="left", fontweight="bold")
