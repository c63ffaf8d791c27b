"""Figures of what people answered: ratings by button, choices, differences with intervals."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from fdvv.errors import ModelError
from fdvv.report import style
from fdvv.units import FloatArray
from fdvv_people.study.analysis.ratings import spread_of
from fdvv_people.study.analysis.records import ChoiceResult
from fdvv_people.study.analysis.words import button_name

if TYPE_CHECKING:
    from matplotlib.axes import Axes

PALE = "#cbd2d9"
COLOURS = (PALE, style.PALETTE[0], style.PALETTE[2], style.PALETTE[5], style.PALETTE[3], style.PALETTE[4])
"""Of stimuli in order: the first is what the others are held against."""
ROW_in = 0.42
LEAST_LABELLED = 0.07
"""Part of a bar below which its number has no room in it."""


def say_proxy(ax: Axes, simulated: bool) -> None:
    """Write over the whole figure, for answers that no person gave, that they are no evidence."""
    if simulated:
        look: Any = {"x": 0.99, "ha": "right", "fontsize": 9.5, "fontstyle": "italic", "color": "#b42318"}
        ax.figure.figure.suptitle("simulated participants: a proxy, no evidence", **look)


@dataclass(frozen=True)
class ForestRow:
    """One value with its interval; main : drawn as a diamond. A bound may be infinite or nan."""

    name: str
    value: float
    low: float
    high: float
    main: bool = False


@style.in_house_style
def plot_rating_bars(
    rating: str,
    people: FloatArray,
    buttons: Sequence[str],
    stimuli: Sequence[str],
    scale: tuple[float, float],
    marks: Mapping[str, str],
    simulated: bool,
) -> Any:
    """Draw mean ratings by button: thin bars are 1 SD between people, thick ones the interval of the mean.

    people : (people, buttons, stimuli) means of each person, the dots; nan missing. scale : ends of the axis.
    marks : written above a button, by its name. Returns the axes.
    """
    count, (low, high) = len(stimuli), scale
    if people.ndim != 3 or people.shape[1:] != (len(buttons), count):
        shape = len(buttons), count
        raise ModelError(f"{shape} buttons and stimuli need columns of as many, got {people.shape}")
    ax = style.new_figure(max(6.4, 1.0 + (0.55 + 0.36 * count) * len(buttons)), 4.4).add_subplot()
    width = 0.8 / count
    places = np.arange(float(len(buttons)))
    for number, stimulus in enumerate(stimuli):
        look: Any = {"color": COLOURS[number % len(COLOURS)], "label": style.name_text(stimulus)}
        _draw_bars(ax, people[:, :, number], places + (number - (count - 1) / 2) * width, width, scale, look)
    step = 0.08 * (high - low)
    ax.set_ylim(low, high + step * (1.3 if marks else 0.4))
    ax.set_yticks(np.arange(low, high + 0.5, 1.0 if high - low <= 12 else (high - low) / 5))
    for place, button in zip(places, buttons, strict=True):
        if button in marks:
            at = (float(place), high + 0.5 * step)
            ax.annotate(marks[button], at, ha="center", va="bottom", fontsize=9)
    ax.set_xticks(places, [style.wrap(style.name_text(name), 14) for name in buttons])
    ax.grid(axis="x", visible=False)
    ax.set_ylabel(rating)
    style.set_titles(ax, f"mean {style.name_text(rating)}", False)
    say_proxy(ax, simulated)
    beside: Any = {"loc": "outside lower center", "ncols": min(count, 4)}
    ax.figure.legend(**beside)
    return ax


def _draw_bars(
    ax: Axes, people: FloatArray, places: FloatArray, width: float, scale: tuple[float, float], look: Any
) -> None:
    """Draw one stimulus. people : (people, buttons)."""
    spreads = [spread_of(column) for column in people.T]
    means, sd, low, high = np.array([(one.mean, one.sd, one.low, one.high) for one in spreads]).T
    base = scale[0]
    ax.bar(places, means - base, 0.92 * width, base, alpha=0.85, zorder=1.0, **look)
    aside = np.linspace(-0.26, 0.26, len(people)) * width if len(people) > 1 else np.zeros(1)
    for place, column in zip(places, people.T, strict=True):
        ax.plot(place + aside, column, ".", color=style.QUIET, markersize=3.5, alpha=0.8, zorder=2.0)
    ax.errorbar(places, means, sd, fmt="none", ecolor=style.INK, capsize=3.0, elinewidth=0.9, zorder=3.0)
    ax.vlines(places, np.clip(low, *scale), np.clip(high, *scale), color=style.INK, linewidth=3.0, zorder=3.0)


@style.in_house_style
def plot_choices(rows: Sequence[ChoiceResult], simulated: bool = False) -> Any:
    """Draw what was chosen as one bar a button, and below it the share of ``more`` with its interval.

    Returns the axes. ModelError without a row.
    """
    if not rows:
        raise ModelError("a figure of choices needs at least one row")
    ax = style.new_figure(7.4, 1.5 + 1.35 * ROW_in * len(rows)).add_subplot()
    places = np.arange(float(len(rows)))[::-1]
    counts = np.array([(one.more_count, one.equal_count, one.less_count) for one in rows], dtype=np.float64)
    shares = counts / np.maximum(counts.sum(axis=1, keepdims=True), 1.0)
    left = np.zeros(len(rows))
    drawn = [(rows[0].more, style.PALETTE[0]), ("equal", "#eef1f4"), (rows[0].less, PALE)]
    for column, (name, colour) in enumerate(drawn):
        if column == 1 and not counts[:, 1].any():
            continue
        ax.barh(places, shares[:, column], 0.56, left, color=colour, label=style.name_text(name), zorder=1.0)
        _write_counts(ax, places, left, shares[:, column], counts[:, column], column == 0)
        left = left + shares[:, column]
    _draw_shares(ax, rows, places - 0.42)
    ax.axvline(0.5, color=style.QUIET, linestyle=":", linewidth=1.2, zorder=2.0)
    ax.set_yticks(places, [style.name_text(button_name(one)) for one in rows])
    ax.set_xlim(0.0, 1.0)
    ax.set_ylim(-0.75, len(rows) - 0.6)
    ticks = np.linspace(0.0, 1.0, 5)
    ax.set_xticks(ticks, [f"{100 * one:.0f}" for one in ticks])
    ax.set_xlabel("answers (%)")
    ax.grid(visible=False)
    style.set_titles(ax, "what was answered", False)
    say_proxy(ax, simulated)
    ax.figure.legend(loc="outside lower center", ncols=4)
    return ax


def _write_counts(
    ax: Axes, places: FloatArray, left: FloatArray, shares: FloatArray, counts: FloatArray, dark: bool
) -> None:
    for place, start, share, count in zip(places, left, shares, counts, strict=True):
        if share >= LEAST_LABELLED:
            colour = "white" if dark else style.INK
            at = (float(start + share / 2), float(place))
            ax.annotate(f"{count:.0f}", at, ha="center", va="center", fontsize=8.5, color=colour)


def _draw_shares(ax: Axes, rows: Sequence[ChoiceResult], places: FloatArray) -> None:
    label = f"share of {style.name_text(rows[0].more)}, 95 % interval"
    for place, one in zip(places, rows, strict=True):
        ends = [one.interval.low, one.interval.high]
        ax.plot(ends, [place, place], color=style.PALETTE[1], linewidth=2.0)
        ax.plot([one.share.share], [place], "D", color=style.PALETTE[1], markersize=4.5, label=label)
        label = "_"


@style.in_house_style
def plot_forest(
    rows: Sequence[ForestRow], axis: str, title: str, none: float | None = 0.0, simulated: bool = False
) -> Any:
    """Draw values with their intervals, one below the other. none : where there is no difference.

    A bound that is infinite is an arrow. Returns the axes. ModelError without a row.
    """
    if not rows:
        raise ModelError("a figure of values needs at least one row")
    ax = style.new_figure(7.0, 1.3 + 0.75 * ROW_in * len(rows)).add_subplot()
    finite = [v for one in rows for v in (one.value, one.low, one.high) if np.isfinite(v)]
    left, right = style.limits_around([*finite, *([] if none is None else [none])], margin=0.08)
    for place, one in zip(range(len(rows) - 1, -1, -1), rows, strict=True):
        _draw_row(ax, one, float(place), left, right)
    if none is not None:
        ax.axvline(none, color=style.QUIET, linestyle=":", linewidth=1.2)
    ax.set_xlim(left, right)
    ax.set_ylim(-0.6, len(rows) - 0.4)
    ax.set_yticks(np.arange(float(len(rows)))[::-1], [style.name_text(one.name) for one in rows])
    ax.grid(axis="y", visible=False)
    ax.set_xlabel(axis)
    style.set_titles(ax, title, False)
    say_proxy(ax, simulated)
    return ax


def _draw_row(ax: Axes, one: ForestRow, place: float, left: float, right: float) -> None:
    colour = style.PALETTE[1] if one.main else style.PALETTE[0]
    if np.isnan(one.value):
        ax.annotate("no value", (left, place), (6, 0), textcoords="offset points", va="center", fontsize=8.5)
        return
    low, high = np.clip([one.low, one.high], left, right)
    if not np.isnan(low):
        ax.plot([low, high], [place, place], color=colour, linewidth=2.0, zorder=2.0)
    if one.high > right:
        ax.plot([right], [place], ">", color=colour, markersize=6.0, clip_on=False)
    if np.isfinite(one.value):
        ax.plot([one.value], [place], "D" if one.main else "o", color=colour, markersize=6.5, zorder=3.0)
