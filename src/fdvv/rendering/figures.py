"""Figures of rendering: target and rendered force side by side, and the error from press to press."""

from __future__ import annotations

import textwrap
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from fdvv.errors import ModelError
from fdvv.model.curve import Stroke
from fdvv.report import style
from fdvv.report.records import ErrorHistory, FeasibleCurve, RenderedCurve
from fdvv.units import FloatArray

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
    """Return each method its colour, in the order of first appearance."""
    names = dict.fromkeys(band.method for curve in curves for band in curve.bands)
    # the first is usually the baseline: warm; the next ones follow
    order = (style.PALETTE[1], style.PALETTE[0], *style.PALETTE[2:])
    return {name: order[i % len(order)] for i, name in enumerate(names)}


def _draw_cell(ax: Axes, curve: RenderedCurve | None, methods: dict[str, str], simulated: bool) -> None:
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
            _draw_feasible(axes[i, j], cells.get((velocity, stroke)))
            axes[i, j].set_xlabel(style.DISPLACEMENT if i == len(rows) - 1 else "")
            axes[i, j].set_ylabel(style.FORCE if j == 0 else "")
    _legend(axes, curves, title)
    return axes


def _draw_feasible(ax: Axes, curve: FeasibleCurve | None) -> None:
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


ENVELOPE_s = 0.002


@style.in_house_style
def plot_heard(
    t_s: FloatArray,
    signal: FloatArray,
    events_s: Mapping[str, float],
    ring: tuple[float, Sequence[tuple[float, float, float, float]]] | None = None,
    unit: str = "V",
    title: str = "",
    ax: Axes | None = None,
    simulated: bool = False,
) -> Axes:
    """Draw a signal with its envelope, its events and the modes that were fitted to it.

    t_s, signal : (n,) one press.
    events_s : name and time of each, as "snap", "bottom"; drawn as vertical lines.
    ring : onset (s) and, per mode, frequency (Hz), decay (1/s), amplitude in the unit and phase (rad); drawn
        from the onset on, all modes together, until the slowest has fallen to a tenth.
    unit : of the signal.

    The envelope is the rms over 2 ms. Gives the axes. Raises ModelError for columns of different length.
    """
    if t_s.shape != signal.shape or t_s.size < 2:
        raise ModelError(f"a signal needs a time for each sample, got {signal.shape} at {t_s.shape}")
    ax = style.axes_or_new(ax, 8.0, 3.6)
    ax.plot(1e3 * t_s, signal, color=style.QUIET, linewidth=0.8, label="signal")
    ax.plot(1e3 * t_s, _envelope(t_s, signal), color=style.PALETTE[4], label="envelope")
    if ring is not None:
        at, shown = _ringing(t_s, *ring)
        ax.plot(1e3 * at, shown, color=style.PALETTE[1], label="fitted modes")
    for (name, at_s), colour in zip(events_s.items(), style.PALETTE[2:] * len(events_s), strict=False):
        ax.axvline(
            1e3 * at_s, color=colour, linestyle="--", linewidth=1.2, label=f"{name} {1e3 * at_s:.1f} ms"
        )
    ax.set(xlabel="time (ms)", ylabel=f"signal ({unit})")
    ax.legend(loc="upper left", bbox_to_anchor=(1.01, 1.0), borderaxespad=0.0)
    style.set_titles(ax, style.name_text(title), simulated)
    return ax


def _envelope(t_s: FloatArray, signal: FloatArray) -> FloatArray:
    width = max(1, round(ENVELOPE_s * (t_s.size - 1) / float(t_s[-1] - t_s[0])))
    mean = np.convolve(signal**2, np.ones(width) / width, mode="same")
    return np.sqrt(mean)


def _ringing(
    t_s: FloatArray, onset_s: float, modes: Sequence[tuple[float, float, float, float]]
) -> tuple[FloatArray, FloatArray]:
    """Return fine times after the onset and the sum of the modes there."""
    longest_s = np.log(10) / min(decay for _, decay, _, _ in modes)
    after = np.linspace(0.0, min(longest_s, float(t_s[-1]) - onset_s), 400)
    total = sum(
        amplitude * np.exp(-decay * after) * np.sin(2 * np.pi * f * after + phase)
        for f, decay, amplitude, phase in modes
    )
    return onset_s + after, np.asarray(total)
