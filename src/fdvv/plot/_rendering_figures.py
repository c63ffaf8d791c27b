"""Figures of rendering: target and rendered force side by side, and the error from press to press."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from fdvv.errors import ModelError
from fdvv.model import Stroke
from fdvv.plot import _style as style
from fdvv.plot._records import ErrorHistory, RenderedCurve

if TYPE_CHECKING:
    from matplotlib.axes import Axes

PAPER_ERROR_cN = 2.93
"""The paper's error after its last press, for one example curve on its rig, sensed displacement."""

TARGET = style.INK


@style.in_house_style
def plot_rendering(
    curves: Sequence[RenderedCurve], axes: Any = None, title: str = "", simulated: bool = False
) -> Any:
    """Draw target and rendered force in a grid: a row per velocity (rising), a column per stroke.

    A line is the mean of a method's presses, its band the spread from low to high.
    axes : (velocities, strokes) array of axes. Gives that array; a cell without a curve is left blank.
    Raises ModelError if there is no curve, or two for one cell.
    """
    cells = {(c.velocity_mm_s, c.stroke): c for c in curves}
    if not cells or len(cells) != len(curves):
        raise ModelError(
            f"a grid needs one curve per velocity and stroke, got {len(curves)} for {len(cells)}"
        )
    rows = sorted({v for v, _ in cells})
    columns = [s for s in Stroke if any(stroke is s for _, stroke in cells)]
    if axes is None:
        fig = style.new_figure(4.2 * len(columns) + 0.4, 2.3 * len(rows) + 0.7)
        axes = fig.subplots(len(rows), len(columns), sharex=True, sharey=True, squeeze=False)
    methods = _methods(curves)
    for i, velocity in enumerate(rows):
        for j, stroke in enumerate(columns):
            _draw_cell(axes[i, j], cells.get((velocity, stroke)), methods, simulated)
            axes[i, j].set_xlabel(style.DISPLACEMENT if i == len(rows) - 1 else "")
            axes[i, j].set_ylabel(style.FORCE if j == 0 else "")
    _grid_legend(axes, methods, title)
    return axes


def _methods(curves: Sequence[RenderedCurve]) -> dict[str, str]:
    """Give each method its colour, in the order of first appearance."""
    names = dict.fromkeys(band.method for curve in curves for band in curve.bands)
    # the first is usually the baseline: warm; the next ones follow
    order = (style.PALETTE[1], style.PALETTE[0], *style.PALETTE[2:])
    return {name: order[i % len(order)] for i, name in enumerate(names)}


def _draw_cell(ax: Axes, curve: RenderedCurve | None, methods: dict[str, str], simulated: bool) -> None:
    """Draw one velocity and stroke."""
    if curve is None:
        ax.set_visible(False)
        return
    x = curve.displacement_mm
    for band in curve.bands:
        colour = methods[band.method]
        ax.fill_between(x, band.low_cN, band.high_cN, color=colour, alpha=0.22, linewidth=0.0)
        ax.plot(x, band.mean_cN, color=colour, linewidth=1.5)
    ax.plot(x, curve.target_cN, color=TARGET, linestyle=(0, (1, 1.2)), linewidth=1.8)
    title = f"{curve.stroke}, {style.velocity_text(curve.velocity_mm_s)}"
    style.set_titles(ax, title, simulated or curve.simulated)


def _grid_legend(axes: Any, methods: dict[str, str], title: str) -> None:
    """Name target and methods once for the whole grid, below it."""
    handles = [style.handle("target", color=TARGET, linestyle=(0, (1, 1.2)), linewidth=1.8)]
    handles += [style.handle(style.name_text(name), color=colour) for name, colour in methods.items()]
    labels = [str(item.get_label()) for item in handles]
    fig = axes[0, 0].figure
    fig.legend(handles, labels, loc="outside lower center", ncols=min(len(handles), 3 * axes.shape[1]))
    if title:
        fig.suptitle(style.name_text(title), x=0.01, ha="left", fontweight="bold")


@style.in_house_style
def plot_convergence(
    histories: Sequence[ErrorHistory],
    ax: Axes | None = None,
    paper: bool = False,
    title: str = "",
    simulated: bool = False,
) -> Axes:
    """Draw the error of each curve from press to press on a logarithmic axis.

    paper : also draw the 2.93 cN that the paper reports from its rig. Errors that are not positive have
    no place on the axis and are left out. Gives the axes. Raises ModelError if there is no history.
    """
    if not histories:
        raise ModelError("a figure of convergence needs at least one history, got none")
    ax = style.axes_or_new(ax, 8.0, 4.2)
    colours = style.velocity_colours(h.velocity_mm_s for h in histories)
    for history in histories:
        error = np.where(history.error_cN > 0, history.error_cN, np.nan)
        press = np.arange(1, error.size + 1)
        look: Any = {"color": colours[history.velocity_mm_s], "marker": ".", "markersize": 6.0}
        ax.plot(press, error, style.LINE[history.stroke], **look)
    handles = [style.handle(style.velocity_text(v), color=c) for v, c in colours.items()]
    handles += style.stroke_handles(h.stroke for h in histories)
    if paper:
        look = {"color": style.PALETTE[1], "linewidth": 1.2, "linestyle": "-."}
        ax.axhline(PAPER_ERROR_cN, **look)
        handles.append(style.handle(f"{PAPER_ERROR_cN:g} cN, the paper's rig", **look))
    _press_axes(ax)
    style.legend_beside(ax, handles)
    style.set_titles(ax, style.name_text(title), simulated or any(h.simulated for h in histories))
    return ax


def _press_axes(ax: Axes) -> None:
    """Label the axes of error on press; plain numbers rather than powers of ten."""
    from matplotlib.ticker import LogLocator, MaxNLocator, NullFormatter, ScalarFormatter

    ax.set(xlabel="press (count)", ylabel="error (cN)", yscale="log")
    ax.xaxis.set_major_locator(MaxNLocator(integer=True))
    ax.yaxis.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0)))
    ax.yaxis.set_major_formatter(ScalarFormatter())
    ax.yaxis.set_minor_formatter(NullFormatter())
