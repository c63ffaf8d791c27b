"""Figures of one recorded press: its raw streams, the clocks, the force's filter, the path between frames."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from fdvv.errors import ModelError
from fdvv.model import Stroke
from fdvv.plot import _style as style
from fdvv.preprocess import EdgeBounds, Judged, Processed, StrokeTrack, edge_bounds, idle_cN
from fdvv.recording import UNITS, Quantity, Recording, Stream, Take

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

STROKE = {Stroke.PRESS: style.PALETTE[0], Stroke.RELEASE: style.PALETTE[1]}
"""Colours of strokes where nothing else is told by colour."""

FRAMES: Any = {"linestyle": "", "marker": "o", "markersize": 4.5, "markerfacecolor": "white"}
MARKS = {"light": "#e69f00", "closed": "#009e73", "open": "#cc79a7"}
FAR_ms = 8.0
"""Beyond this from the line a bar is drawn to the rim: its edge was paired with nothing."""

SLACK_s = 2e-4
"""An edge that misses the line by less is one with it, as in the fit."""

TIGHTEST = 25
"""So many ends of bars on either side tell where the line must run."""


@style.in_house_style
def plot_take(recording: Recording, number: int, simulated: bool = False) -> Figure:
    """Draw the raw streams of one take, one panel each, on the clocks of their instruments, with the marks.

    number : of the take. Markers are drawn as they were tracked, the way from their first place along each
    axis. Raises ModelError if there is no such take.
    """
    take = _take(recording, number)
    fig = style.new_figure(8.0, 0.6 + 1.35 * max(len(take.streams), 1))
    panels = fig.subplots(len(take.streams), 1, squeeze=False)[:, 0]
    for ax, stream in zip(panels, take.streams, strict=True):
        _draw_stream(ax, stream)
        _draw_marks(ax, take, stream.clock)
    style.set_titles(panels[0], f"take {number}, raw", simulated or recording.simulated)
    _name_marks(fig, take)
    return fig


def _take(recording: Recording, number: int) -> Take:
    found = [take for take in recording.takes if take.number == number]
    if not found or not found[0].streams:
        raise ModelError(f"recording {recording.name!r} has no take {number} with streams")
    return found[0]


def _draw_stream(ax: Axes, stream: Stream) -> None:
    """Draw one stream in its unit; of several axes each its own line, from its first place."""
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


def _draw_marks(ax: Axes, take: Take, clock: str) -> None:
    for mark in take.marks:
        if mark.clock == clock:
            ax.axvline(mark.t_s, color=_mark_colour(mark.name), linewidth=0.7, alpha=0.8, zorder=1)


def _mark_colour(name: str) -> str:
    return MARKS.get(name.partition(" ")[0], style.QUIET)


def _name_marks(fig: Figure, take: Take) -> None:
    """Name the marks once for all panels, on and off of one thing together."""
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
    told = f"clocks: {clock.edges} edges{refused}, {1e6 * (clock.rate - 1):+.1f} ppm"
    style.set_titles(wide, told, simulated or recording.simulated)
    return fig


def _draw_bars(ax: Axes, bounds: EdgeBounds) -> None:
    """Draw the bounds of every edge, those that the line misses in red."""
    agrees = (bounds.low_s <= SLACK_s) & (bounds.high_s >= -SLACK_s)
    for which, colour, label in (
        (agrees, style.PALETTE[0], "agrees"),
        (~agrees, style.PALETTE[1], "contradicts the line"),
    ):
        if which.any():
            low_ms, high_ms = (1e3 * column[which] for column in (bounds.low_s, bounds.high_s))
            look: Any = {"color": colour, "linewidth": 0.9, "alpha": 0.7, "label": label}
            ax.vlines(bounds.board_s[which], low_ms, high_ms, **look)
    ax.axhline(0.0, color=style.INK, linewidth=1.0)
    ax.set_ylim(style.limits_around(np.clip(1e3 * np.r_[bounds.low_s, bounds.high_s], -FAR_ms, FAR_ms)))
    if not agrees.all():
        ax.legend(loc="upper right")


def _draw_ends(ax: Axes, bounds: EdgeBounds, doubt_s: float) -> None:
    """Draw the ends of bars that are nearest to the line, and the doubt that they leave."""
    latest, earliest = np.sort(np.abs(bounds.high_s)), np.sort(np.abs(bounds.low_s))
    some = min(TIGHTEST, latest.size) - 1
    reach_us = 1.1e6 * max(float(latest[some]), float(earliest[some]), 2 * doubt_s, 1e-9)
    look: Any = {"linestyle": "", "markersize": 5.0}
    ax.plot(
        bounds.board_s, 1e6 * bounds.high_s, marker="v", color=style.PALETTE[0], **look, label="not later"
    )
    ax.plot(
        bounds.board_s, 1e6 * bounds.low_s, marker="^", color=style.PALETTE[1], **look, label="not before"
    )
    label = f"line, doubt ± {1e6 * doubt_s:.2g} µs"
    ax.axhline(0.0, color=style.INK, linewidth=1.0, label=label)
    ax.axhspan(-1e6 * doubt_s, 1e6 * doubt_s, color=style.QUIET, alpha=style.BAND)
    ax.set_ylim(-reach_us, reach_us)
    ax.legend(loc="upper left", bbox_to_anchor=(1.01, 1.0), borderaxespad=0.0)


@style.in_house_style
def plot_force(recording: Recording, processed: Processed, number: int, simulated: bool = False) -> Figure:
    """Draw the force of one take as its converter gave it and as the sensor felt it, and the difference.

    Raises ModelError if the take holds no press.
    """
    one, take = _judged(processed, number), _take(recording, number)
    stream, press = take.of(Quantity.FORCE)[0], one.press
    inside = (stream.t_s >= one.spans.start_s - 0.03) & (stream.t_s <= one.spans.end_s + 0.03)
    felt = (press.t_s >= one.spans.start_s - 0.03) & (press.t_s <= one.spans.end_s + 0.03)
    read_cN = stream.values - idle_cN(recording)
    fig = style.new_figure(8.0, 4.8)
    top, below = fig.subplots(2, 1, sharex=True, height_ratios=(2.4, 1))
    top.plot(stream.t_s[inside], read_cN[inside], color=style.PALETTE[1], label="as read, zero taken off")
    label = f"filter of {recording.bench.force_filter_ms:g} ms undone"
    if recording.bench.force_play_cN:
        label += f", play of {recording.bench.force_play_cN:g} cN too"
    top.plot(press.t_s[felt], press.force_cN[felt], color=style.PALETTE[0], linewidth=1.1, label=label)
    change_cN = press.force_cN[felt] - np.interp(press.t_s[felt], stream.t_s, read_cN)
    below.plot(press.t_s[felt], change_cN, color=style.INK, linewidth=0.9)
    top.set_ylabel(style.FORCE)
    below.set(ylabel="change (cN)", xlabel="time on the clock of the board (s)")
    top.legend(loc="upper right")
    pace = style.velocity_text(press.velocity_mm_s)
    style.set_titles(top, f"force of {press.name}, {pace}", simulated or recording.simulated)
    return fig


def _judged(processed: Processed, number: int) -> Judged:
    found = [one for one in processed.judged if one.press.take == number]
    if not found:
        raise ModelError(f"no press was seen in take {number}")
    return found[0]


@style.in_house_style
def plot_displacement(processed: Processed, number: int, simulated: bool = False) -> Figure:
    """Draw the frames of one press and the path that was found between them, strokes coloured.

    Raises ModelError if the take holds no press.
    """
    one = _judged(processed, number)
    press, spans = one.press, one.spans
    fig = style.new_figure(8.0, 4.2)
    ax = fig.add_subplot()
    near = (press.frame_s >= spans.start_s - 0.03) & (press.frame_s <= spans.end_s + 0.03)
    frames_mm = press.frame_mm[near] + processed.zero_mm
    ax.plot(press.frame_s[near], frames_mm, color=style.QUIET, **FRAMES, label="frames", zorder=3)
    for track in _tracks(processed, one):
        look: Any = {"color": STROKE[track.stroke], "marker": ".", "markersize": 3.0, "linewidth": 1.2}
        ax.plot(
            track.t_s, track.displacement_mm, **look, label=f"{track.stroke}, path at the force's samples"
        )
    for moment_s in (spans.start_s, spans.bottom_s, spans.leave_s, spans.end_s):
        ax.axvline(moment_s, color=style.QUIET, linewidth=0.8, linestyle=":", zorder=1)
    for switched_s, name in ((press.closed_s, "closed"), (press.open_s, "open")):
        if switched_s is not None:
            ax.axvline(switched_s, color=MARKS[name], linewidth=1.0, label=f"circuit {name}")
    ax.set(xlabel="time on the clock of the board (s)", ylabel=style.DISPLACEMENT)
    ax.legend(loc="upper left", bbox_to_anchor=(1.01, 1.0), borderaxespad=0.0)
    said = f", left out: {one.reason}" if one.reason else ""
    title = f"path of {press.name}, {style.velocity_text(press.velocity_mm_s)}{said}"
    style.set_titles(ax, title, simulated)
    return fig


def _tracks(processed: Processed, one: Judged) -> list[StrokeTrack]:
    """Give the strokes of a press that were averaged; none if it was left out."""
    name = (one.press.take, one.press.part)
    return [track for group in processed.tracks for track in group if (track.take, track.part) == name]
