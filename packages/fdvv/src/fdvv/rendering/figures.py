"""Figures of rendering: target and rendered force side by side, and the error from press to press."""

from __future__ import annotations

import textwrap
from collections.abc import Callable, Sequence
from itertools import product
from typing import TYPE_CHECKING, Any

import numpy as np

from fdvv.errors import ModelError
from fdvv.force_text import force_text
from fdvv.model.curve import Stroke
from fdvv.report import style
from fdvv.report.records import ErrorHistory, FeasibleCurve, RenderedCurve

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.lines import Line2D

PAPER_ERROR_cN = 2.93
"""The paper's error after its last press, for one example curve on its rig, sensed displacement."""
INTENDED: Any = {"color": style.INK, "linestyle": (0, (1, 1.2)), "linewidth": 1.8}
ACHIEVABLE: Any = {"color": style.PALETTE[0], "linewidth": 1.6}
MEASURED: Any = {"color": style.PALETTE[1], "linewidth": 1.4}
CUT: Any = {"color": style.PALETTE[5], "alpha": 0.25, "linewidth": 0.0}
JND_BAND: Any = {"color": "#dde2e7", "linewidth": 0.0, "zorder": 0.5}
NOTICED_pt = 4.0  # assumed; bars lie 0.035 of the axes apart, less than 6 pt: thicker bars would merge
LINE_LENGTH, MOST_LINES, TEXT_pt = 70, 3, 8.0
"""Assumed: 70 letters of 8 pt for a cell 5 in wide, three lines above the axes; a longer verdict is cut."""


@style.in_house_style
def plot_rendering(curves: Sequence[RenderedCurve], title: str = "", simulated: bool = False) -> Any:
    """Draw target and rendered force in a grid: a row per velocity (rising), a column per stroke.

    A line is the mean of a method's presses, its band the spread from low to high. Where a curve says so,
    the target has a grey band of one just noticeable difference, and a bar below the curves marks where
    a finger would notice more than half of a method's presses.
    Returns the (velocities, strokes) array of axes; a cell without a curve is left blank.
    Raises ModelError if there is no curve, or two for one cell.
    """
    methods = _methods(curves)
    axes = _draw_grid(curves, (4.2, 2.3, 0.4), lambda ax, c: _draw_cell(ax, c, methods, simulated), True)
    handles = [style.handle("target", **INTENDED)]
    handles += [style.handle(style.name_text(name), color=colour) for name, colour in methods.items()]
    handles += _legend_handles(curves)
    _legend_below(axes, handles, min(len(handles), 3 * axes.shape[1]), title)
    return axes


def _draw_grid(
    curves: Sequence[Any], size_in: tuple[float, float, float], draw: Callable[..., None], sharey: bool
) -> Any:
    """Draw every curve in its cell of a grid; a row per velocity (rising), a column per stroke.

    size_in : width and height of a cell, and what is left over beside the cells.
    """
    cells = {(c.velocity_mm_s, c.stroke): c for c in curves}
    if not cells or len(cells) != len(curves):
        raise ModelError(
            f"a grid needs one curve per velocity and stroke, got {len(curves)} for {len(cells)}"
        )
    rows = sorted({v for v, _ in cells})
    columns = [s for s in Stroke if any(stroke is s for _, stroke in cells)]
    width_in, height_in, beside_in = size_in
    fig = style.new_figure(width_in * len(columns) + beside_in, height_in * len(rows) + 0.7)
    axes = fig.subplots(len(rows), len(columns), sharex=True, sharey=sharey, squeeze=False)
    for (i, velocity), (j, stroke) in product(enumerate(rows), enumerate(columns)):
        ax = axes[i, j]
        if (velocity, stroke) in cells:
            draw(ax, cells[velocity, stroke])
        else:
            ax.set_visible(False)
        ax.set_xlabel(style.DISPLACEMENT if i == len(rows) - 1 else "")
        ax.set_ylabel(style.FORCE if j == 0 else "")
    return axes


def _methods(curves: Sequence[RenderedCurve]) -> dict[str, str]:
    """Return each method its colour, in the order of first appearance."""
    names = dict.fromkeys(band.method for curve in curves for band in curve.bands)
    # the first is usually the baseline: warm; the next ones follow
    order = (style.PALETTE[1], style.PALETTE[0], *style.PALETTE[2:])
    return {name: order[i % len(order)] for i, name in enumerate(names)}


def _legend_handles(curves: Sequence[RenderedCurve]) -> list[Line2D]:
    handles = []
    if any(curve.jnd_cN is not None for curve in curves):
        handles.append(style.handle("± 1 JND of force", linewidth=7.0, color=JND_BAND["color"]))
    if any(band.noticed_ratio is not None for curve in curves for band in curve.bands):
        handles.append(style.handle("noticed", linewidth=NOTICED_pt, color=style.QUIET))
    return handles


def _draw_cell(ax: Axes, curve: RenderedCurve, methods: dict[str, str], simulated: bool) -> None:
    x = curve.displacement_mm
    if curve.jnd_cN is not None:
        ax.fill_between(x, curve.target_cN - curve.jnd_cN, curve.target_cN + curve.jnd_cN, **JND_BAND)
    _mark_noticed(ax, curve, methods)
    for band in curve.bands:
        colour = methods[band.method]
        ax.fill_between(x, band.low_cN, band.high_cN, color=colour, alpha=0.22, linewidth=0.0)
        ax.plot(x, band.mean_cN, color=colour, linewidth=1.5)
    ax.plot(x, curve.target_cN, **INTENDED)
    title = f"{curve.stroke}, {style.velocity_text(curve.velocity_mm_s)}"
    style.set_titles(ax, title, simulated or curve.simulated)


def _mark_noticed(ax: Axes, curve: RenderedCurve, methods: dict[str, str]) -> None:
    """Draw a bar per method at the bottom of the axes, where most of its presses would be noticed."""
    step_mm = float(np.median(np.diff(curve.displacement_mm)))
    shown = [band for band in curve.bands if band.noticed_ratio is not None]
    for i, band in enumerate(shown):
        rows = np.flatnonzero(np.asarray(band.noticed_ratio) > 0.5)
        runs = np.split(rows, np.flatnonzero(np.diff(rows) > 1) + 1) if rows.size else []
        for run in runs:
            span = curve.displacement_mm[run[0]] - step_mm / 2, curve.displacement_mm[run[-1]] + step_mm / 2
            look: Any = {"color": methods[band.method], "linewidth": NOTICED_pt, "solid_capstyle": "butt"}
            y = 0.02 + 0.035 * (len(shown) - 1 - i)
            ax.plot(span, [y, y], transform=ax.get_xaxis_transform(), gid="noticed", **look)


def _legend_below(axes: Any, handles: Sequence[Line2D], columns: int, title: str) -> None:
    """Name the lines once for the whole grid."""
    labels = [str(item.get_label()) for item in handles]
    fig = axes[0, 0].figure
    fig.legend(handles, labels, loc="outside lower center", ncols=columns)
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
    no place on the axis and are left out. Returns the axes. Raises ModelError if there is no history.
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
        handles.append(style.handle(f"{force_text(PAPER_ERROR_cN)}, the paper's rig", **look))
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


@style.in_house_style
def plot_feasibility(curves: Sequence[FeasibleCurve], title: str = "") -> Any:
    """Draw intended, achievable and measured force in a grid: a row per velocity, a column per stroke.

    The band of a measured curve is its spread over the presses; a shaded range is one where a limit cuts the
    command. The verdict is below each title. Returns the (velocities, strokes) array of axes.
    Raises ModelError if there is no curve, or two for one cell.
    """
    axes = _draw_grid(curves, (5.0, 2.9, 0.3), _draw_feasible, sharey=False)
    handles = [style.handle("intended", **INTENDED), style.handle("achievable", **ACHIEVABLE)]
    if any(c.band for c in curves):
        handles.append(style.handle("measured", **MEASURED))
    if any(np.any(c.cut) for c in curves):
        handles.append(style.handle("a limit cuts", color=CUT["color"], alpha=0.5, linewidth=7.0))
    _legend_below(axes, handles, len(handles), title)
    return axes


def _draw_feasible(ax: Axes, curve: FeasibleCurve) -> None:
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
