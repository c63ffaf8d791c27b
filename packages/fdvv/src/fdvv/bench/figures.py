"""Figures of one recorded press: its raw streams, the clocks, the force's filter, the path between frames."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from fdvv.errors import ModelError
from fdvv.force_text import force_text
from fdvv.model.curve import Stroke
from fdvv.preprocess.average import AveragedCurve
from fdvv.preprocess.paper import PaperRecipe, paper_average
from fdvv.preprocess.press import StrokeTrack
from fdvv.preprocess.process import Processed
from fdvv.preprocess.reject import Judged, Reason
from fdvv.preprocess.takes import EdgeBounds, edge_bounds, idle_cN
from fdvv.recording.types import UNITS, Quantity, Recording, Stream, Take
from fdvv.report import style

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure


STROKE = {Stroke.PRESS: style.PALETTE[0], Stroke.RELEASE: style.PALETTE[1]}
"""Colours of strokes where colour means nothing else."""
FRAMES: Any = {"linestyle": "", "marker": "o", "markersize": 4.5, "markerfacecolor": "white"}
BESIDE: Any = {"loc": "upper left", "bbox_to_anchor": (1.01, 1.0), "borderaxespad": 0.0}
"""Where a legend hides no curve."""
SAMPLES: Any = {"linestyle": "", "marker": ".", "markersize": 3.0, "alpha": 0.6, "color": style.QUIET}
PROBE: Any = {"color": style.INK, "linestyle": ":", "linewidth": 1.3}
MARKS = {"light": "#e69f00", "closed": "#009e73", "open": "#cc79a7"}
FAR_ms = 8.0
"""Beyond this from the line a bar is drawn to the rim: its edge was paired with nothing."""
SLACK_s = 2e-4
"""An edge that misses the line by less is one with it, as in the fit."""
TIGHTEST = 25
"""So many ends of bars on either side bound the line."""


@style.in_house_style
def plot_take(recording: Recording, number: int, simulated: bool = False) -> Figure:
    """Draw the raw streams of one take, one panel each, on the clocks of their instruments, with the marks.

    number : of the take. Markers are drawn as displacements from their first position along each axis.
    Raises ModelError if there is no such take.
    """
    take = _take(recording, number)
    fig = style.new_figure(8.0, 0.6 + 1.35 * max(len(take.streams), 1))
    panels = fig.subplots(len(take.streams), 1, squeeze=False)[:, 0]
    for ax, stream in zip(panels, take.streams, strict=True):
        _draw_stream(ax, stream)
        for mark in (mark for mark in take.marks if mark.clock == stream.clock):
            ax.axvline(mark.t_s, color=_mark_colour(mark.name), linewidth=0.7, alpha=0.8, zorder=1)
    style.set_titles(panels[0], f"take {number}, raw", simulated or recording.simulated)
    _name_marks(fig, take)
    return fig


def _take(recording: Recording, number: int) -> Take:
    takes = [take for take in recording.takes if take.number == number]
    if not takes or not takes[0].streams:
        raise ModelError(f"recording {recording.name!r} has no take {number} with streams")
    return takes[0]


def _draw_stream(ax: Axes, stream: Stream) -> None:
    values = stream.values
    if values.ndim == 2:
        seen = values[np.isfinite(values).all(axis=1)]
        values = values - (seen[0] if seen.size else 0.0)
        for axis, line in zip("xyz", values.T, strict=True):
            ax.plot(stream.t_s, line, linewidth=1.0, label=axis, color=style.PALETTE["xyz".index(axis)])
        ax.legend(loc="center left", fontsize=8.0)
    else:
        ax.plot(stream.t_s, values, linewidth=0.9, color=style.INK)
    unit = UNITS[stream.quantity]
    ax.set_ylabel(f"{stream.name}\n({unit})" if unit != "1" else f"{stream.name}\n(no unit)")
    ax.set_xlabel(f"time on the clock of the {stream.clock} (s), {stream.rate_Hz:.0f} samples a second")
    ax.xaxis.label.set_fontsize(8.0)


def _mark_colour(name: str) -> str:
    return MARKS.get(name.partition(" ")[0], style.QUIET)


def _name_marks(fig: Figure, take: Take) -> None:
    names = list(dict.fromkeys(mark.name.partition(" ")[0] for mark in take.marks))
    if names:
        handles = [style.handle(f"mark: {name}", color=_mark_colour(name), linewidth=1.2) for name in names]
        fig.legend(handles, [str(h.get_label()) for h in handles], loc="outside lower center", ncols=5)


@style.in_house_style
def plot_clocks(recording: Recording, processed: Processed, simulated: bool = False) -> Figure:
    """Draw what every edge of the light says of the camera's clock, against the line that was fitted.

    Above, a bar is what two frames bound an edge by. Below, close to the line, only the ends of bars: latest
    moments are triangles that point down, earliest ones point up, and the line runs between them. Raises
    ModelError where no light joined two clocks.
    """
    bounds = edge_bounds(recording, processed.clock)
    if bounds is None:
        raise ModelError(f"recording {recording.name!r} has no light that joined two clocks")
    fig, clock = style.new_figure(8.0, 5.2), processed.clock
    wide, close = fig.subplots(2, 1, sharex=True)
    _draw_bars(wide, bounds)
    _draw_ends(close, bounds, clock.doubt_s)
    wide.set_ylabel("edge less line (ms)\nall edges")
    close.set(ylabel="edge less line (µs)\nthe tightest", xlabel="time on the clock of the board (s)")
    refused = f", {clock.refused} refused" if clock.refused else ""
    title = f"clocks: {clock.edges} edges{refused}, {1e6 * (clock.rate - 1):+.1f} ppm"
    style.set_titles(wide, title, simulated or recording.simulated)
    return fig


def _draw_bars(ax: Axes, bounds: EdgeBounds) -> None:
    agrees = (bounds.low_s <= SLACK_s) & (bounds.high_s >= -SLACK_s)
    for which, colour, label in ((agrees, 0, "agrees"), (~agrees, 1, "contradicts the line")):
        if which.any():
            low_ms, high_ms = 1e3 * bounds.low_s[which], 1e3 * bounds.high_s[which]
            look: Any = {"color": style.PALETTE[colour], "linewidth": 0.9, "alpha": 0.7, "label": label}
            ax.vlines(bounds.board_s[which], low_ms, high_ms, **look)
    ax.axhline(0.0, color=style.INK, linewidth=1.0)
    ax.set_ylim(style.limits_around(np.clip(1e3 * np.r_[bounds.low_s, bounds.high_s], -FAR_ms, FAR_ms)))
    if not agrees.all():
        ax.legend(loc="upper right")


def _draw_ends(ax: Axes, bounds: EdgeBounds, doubt_s: float) -> None:
    latest, earliest = np.sort(np.abs(bounds.high_s)), np.sort(np.abs(bounds.low_s))
    some = min(TIGHTEST, latest.size) - 1
    reach_us = 1.1e6 * max(float(latest[some]), float(earliest[some]), 2 * doubt_s, 1e-9)
    look: Any = {"linestyle": "", "markersize": 5.0}
    for end_s, marker, colour, label in (
        (bounds.high_s, "v", style.PALETTE[0], "not later"),
        (bounds.low_s, "^", style.PALETTE[1], "not before"),
    ):
        ax.plot(bounds.board_s, 1e6 * end_s, marker=marker, color=colour, **look, label=label)
    ax.axhline(0.0, color=style.INK, linewidth=1.0, label=f"line, doubt ± {1e6 * doubt_s:.2g} µs")
    ax.axhspan(-1e6 * doubt_s, 1e6 * doubt_s, color=style.QUIET, alpha=style.BAND)
    ax.set_ylim(-reach_us, reach_us)
    ax.legend(**BESIDE)


@style.in_house_style
def plot_force(recording: Recording, processed: Processed, number: int, simulated: bool = False) -> Figure:
    """Draw the force of one take as its converter gave it and as the sensor received it, and the difference.

    Raises ModelError if the take holds no press.
    """
    entry, take = _press_of_take(processed, number), _take(recording, number)
    stream, press = take.of(Quantity.FORCE)[0], entry.press
    inside = (stream.t_s >= entry.spans.start_s - 0.03) & (stream.t_s <= entry.spans.end_s + 0.03)
    shown = (press.t_s >= entry.spans.start_s - 0.03) & (press.t_s <= entry.spans.end_s + 0.03)
    read_cN = stream.values - idle_cN(recording)
    fig = style.new_figure(8.0, 4.8)
    top, below = fig.subplots(2, 1, sharex=True, height_ratios=(2.4, 1))
    top.plot(stream.t_s[inside], read_cN[inside], color=style.PALETTE[1], label="as read, zero taken off")
    label = f"filter of {recording.bench.force_filter_ms:g} ms undone"
    if recording.bench.force_play_cN:
        label += f", play of {force_text(recording.bench.force_play_cN)} too"
    top.plot(press.t_s[shown], press.force_cN[shown], color=style.PALETTE[0], linewidth=1.1, label=label)
    change_cN = press.force_cN[shown] - np.interp(press.t_s[shown], stream.t_s, read_cN)
    below.plot(press.t_s[shown], change_cN, color=style.INK, linewidth=0.9)
    top.set_ylabel(style.FORCE)
    below.set(ylabel="change (cN)", xlabel="time on the clock of the board (s)")
    top.legend(loc="upper right")
    velocity = style.velocity_text(press.velocity_mm_s)
    style.set_titles(top, f"force of {press.name}, {velocity}", simulated or recording.simulated)
    return fig


def _press_of_take(processed: Processed, number: int) -> Judged:
    presses = [entry for entry in processed.judged if entry.press.take == number]
    if not presses:
        raise ModelError(f"no press was seen in take {number}")
    return presses[0]


@style.in_house_style
def plot_displacement(processed: Processed, number: int, simulated: bool = False) -> Figure:
    """Draw the frames of one press and the path that was found between them, strokes coloured.

    Raises ModelError if the take holds no press.
    """
    entry = _press_of_take(processed, number)
    press, spans = entry.press, entry.spans
    fig = style.new_figure(8.0, 4.2)
    ax = fig.add_subplot()
    near = (press.frame_s >= spans.start_s - 0.03) & (press.frame_s <= spans.end_s + 0.03)
    frames_mm = press.frame_mm[near] + processed.zero_mm
    ax.plot(press.frame_s[near], frames_mm, color=style.QUIET, **FRAMES, label="frames", zorder=3)
    which = (press.take, press.part)
    for track in (t for group in processed.tracks for t in group if (t.take, t.part) == which):
        look: Any = {"color": STROKE[track.stroke], "marker": ".", "markersize": 3.0, "linewidth": 1.2}
        label = f"{track.stroke}, path at the force's samples"
        ax.plot(track.t_s, track.displacement_mm, **look, label=label)
    for moment_s in (spans.start_s, spans.bottom_s, spans.leave_s, spans.end_s):
        ax.axvline(moment_s, color=style.QUIET, linewidth=0.8, linestyle=":", zorder=1)
    for switched_s, name in ((press.closed_s, "closed"), (press.open_s, "open")):
        if switched_s is not None:
            ax.axvline(switched_s, color=MARKS[name], linewidth=1.0, label=f"circuit {name}")
    ax.set(xlabel="time on the clock of the board (s)", ylabel=style.DISPLACEMENT)
    ax.legend(**BESIDE)
    said = f", left out: {entry.reason}" if entry.reason else ""
    title = f"path of {press.name}, {style.velocity_text(press.velocity_mm_s)}{said}"
    style.set_titles(ax, title, simulated)
    return fig


LEFT_OUT = ("x", "+", "1", "2", "3", "4", "*", "d")
"""One marker for each reason, so that it shows without colour too."""


@style.in_house_style
def plot_velocities(processed: Processed, simulated: bool = False) -> Figure:
    """Draw the speed of every press in the order they were made, beside the requested velocity.

    Presses that are left out have their own marker and colour for each reason.
    """
    fig = style.new_figure(8.0, 4.4)
    ax = fig.add_subplot()
    order = np.arange(1, len(processed.judged) + 1)
    requested_mm_s = np.array([entry.press.velocity_mm_s or np.nan for entry in processed.judged])
    made = np.array([entry.achieved_mm_s for entry in processed.judged])
    ax.plot(order, requested_mm_s, drawstyle="steps-mid", color=style.QUIET, linewidth=1.2, label="asked")
    used = np.array([entry.reason is None for entry in processed.judged])
    ax.plot(order[used], made[used], "o", markersize=4.5, color=style.PALETTE[0], label=f"used: {used.sum()}")
    for i, reason in enumerate(Reason):
        which = np.array([entry.reason is reason for entry in processed.judged])
        if which.any():
            look: Any = {"color": style.PALETTE[1 + i % 7], "markersize": 7.0, "markeredgewidth": 1.8}
            label = f"{reason}: {which.sum()}"
            ax.plot(order[which], made[which], LEFT_OUT[i], **look, label=style.wrap(label))
    ax.set(xlabel="press (count, in the order made)", ylabel="mean speed of the press (mm/s)")
    ax.set_ylim(0.0, 1.06 * float(np.nanmax(np.concatenate([made, requested_mm_s, [1.0]]))))
    ax.legend(**BESIDE)
    style.set_titles(ax, "speeds asked and achieved", simulated)
    return fig


@style.in_house_style
def plot_registration(
    processed: Processed,
    stroke: Stroke | str,
    velocity_mm_s: float | None,
    recipe: PaperRecipe | None = None,
    simulated: bool = False,
) -> Figure:
    """Draw all samples of all presses of one stroke and velocity on displacement, their mean and its band.

    recipe : of the paper, drawn beside; by default with its sigmas in samples.
    Raises ModelError if there is no such curve.
    """
    stroke, recipe = Stroke(stroke), recipe or PaperRecipe()
    curve, tracks = _find_curve(processed, stroke, velocity_mm_s)
    theirs = paper_average(processed.judged, stroke, velocity_mm_s, recipe, processed.zero_mm)
    fig = style.new_figure(8.0, 4.6)
    ax = fig.add_subplot()
    x_mm = np.concatenate([track.displacement_mm for track in tracks])
    force_cN = np.concatenate([track.force_cN for track in tracks])
    ax.plot(x_mm, force_cN, **SAMPLES, label=f"{x_mm.size} samples of {len(tracks)} presses")
    style.draw_band(ax, curve.displacement_mm, curve.force_cN, curve.spread_cN, style.PALETTE[0])
    ax.plot(curve.displacement_mm, curve.force_cN, color=style.PALETTE[0], label="mean")
    look: Any = {"color": style.PALETTE[1], "linestyle": (0, (4, 1.5)), "linewidth": 1.3}
    ax.plot(theirs.displacement_mm, theirs.force_cN, **look, label=style.wrap(recipe_text(recipe)))
    handles: list[Any] = [*ax.get_legend_handles_labels()[0], *style.band_handles([curve.presses])]
    style.legend_beside(ax, handles)
    ax.set(xlabel=style.DISPLACEMENT, ylabel=style.FORCE)
    ax.set_ylim(style.limits_around(force_cN, theirs.force_cN))
    style.set_titles(ax, f"{stroke}, {style.velocity_text(velocity_mm_s)}", simulated)
    return fig


def recipe_text(recipe: PaperRecipe) -> str:
    """Describe the paper's recipe with the units of its sigmas."""
    first, last = recipe.streams, recipe.curve
    return f"the paper's recipe, σ {first.sigma:g} {first.unit} and {last.sigma:g} {last.unit}"


def _find_curve(
    processed: Processed, stroke: Stroke, velocity_mm_s: float | None
) -> tuple[AveragedCurve, tuple[StrokeTrack, ...]]:
    for curve, tracks in zip(processed.curves, processed.tracks, strict=True):
        if (curve.stroke, curve.velocity_mm_s) == (stroke, velocity_mm_s):
            return curve, tracks
    raise ModelError(f"no {stroke} at {style.velocity_text(velocity_mm_s)} was averaged")


@style.in_house_style
def plot_averages(processed: Processed, simulated: bool = False) -> Figure:
    """Draw the averaged curves of all velocities with their bands, a panel for each stroke, and the probe."""
    strokes = [s for s in Stroke if any(c.stroke is s for c in processed.curves)]
    fig = style.new_figure(4.6 * len(strokes) + 0.6, 4.6)
    panels = fig.subplots(1, len(strokes), sharex=True, sharey=True, squeeze=False)[0]
    colours = style.velocity_colours(c.velocity_mm_s for c in processed.curves)
    for ax, stroke in zip(panels, strokes, strict=True):
        if processed.probe:
            ax.plot(processed.probe.displacement_mm, processed.probe.force_cN(stroke), **PROBE)
        for curve in processed.curves:
            if curve.stroke is stroke:
                colour = colours[curve.velocity_mm_s]
                style.draw_band(ax, curve.displacement_mm, curve.force_cN, curve.spread_cN, colour)
                ax.plot(curve.displacement_mm, curve.force_cN, color=colour)
        ax.set(xlabel=style.DISPLACEMENT, ylabel=style.FORCE if ax is panels[0] else "")
        style.set_titles(ax, str(stroke), simulated)
    handles: list[Any] = [style.handle(style.velocity_text(v), color=c) for v, c in colours.items()]
    if processed.probe:
        velocity = style.velocity_text(processed.probe.velocity_mm_s)
        handles.append(style.handle(f"probe, {velocity}", **PROBE))
    handles += style.band_handles(c.presses for c in processed.curves)
    fig.legend(handles, [str(h.get_label()) for h in handles], loc="outside lower center", ncols=4)
    return fig
