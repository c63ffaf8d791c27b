"""Figures of an analysis: ratings, choices, distances, staircases and timing."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from fdvv.errors import ModelError
from fdvv.model.noticeable import Dimension
from fdvv.report import style
from fdvv.units import FloatArray
from fdvv_people.report.prose import stars
from fdvv_people.report.score_figures import ScoreBars, plot_score_bars
from fdvv_people.study.analysis.answer_figures import (
    PALE,
    ForestRow,
    plot_forest,
    plot_rating_bars,
    say_proxy,
)
from fdvv_people.study.analysis.ratings import people_means
from fdvv_people.study.analysis.records import JndResult, StudyAnalysis, ThresholdResult, TimingResult
from fdvv_people.study.analysis.sentences import name_rows
from fdvv_people.study.analysis.words import button_name
from fdvv_people.study.plan.answers import Answers
from fdvv_people.study.plan.tasks import task_behind

if TYPE_CHECKING:
    from matplotlib.axes import Axes

MOST_TRACKS = 12
"""Staircases that are drawn; more would be too small to read."""


def draw_ratings(found: StudyAnalysis, rating: str, scale: tuple[float, float]) -> Any:
    """Draw mean ratings by button, marks of Holm's correction above where two renderings are compared."""
    answers, shown = found.screening.answers, found.stimuli
    if found.claim is not None and not task_behind(found.kind).hides_reference:
        shown = found.claim.claim.less, found.claim.claim.more
    columns = answers.ratings[rating][:, [answers.stimuli.index(name) for name in shown]]
    tests = () if found.rated else [one for one in found.tests if one.rating == rating and one.test.n > 1]
    marks = {one.button: stars(one.p_holm) for one in tests}
    means = people_means(answers, columns)
    return plot_rating_bars(rating, means, found.buttons, shown, scale, marks, found.simulated)


def scale_around(answers: Answers, rating: str) -> tuple[float, float]:
    """Return the ends of a scale that holds every answer of a rating, for one that is not known."""
    values = answers.ratings[rating]
    low, high = float(np.nanmin(values)), float(np.nanmax(values))
    if low >= 1 and high <= 9:
        return 1.0, max(7.0, math.ceil(high))
    if low >= 0 and high <= 100:
        return 0.0, 100.0 if high > 10 else math.ceil(high) or 1.0
    return math.floor(low), math.ceil(high)


def draw_distances(found: StudyAnalysis) -> Any:
    """Draw d' by button, all buttons as a diamond."""
    rows = [
        ForestRow(button_name(one), one.d[0].d, one.d[0].low, one.d[0].high, not one.button)
        for one in name_rows(found)
    ]
    return plot_forest(rows, "d′ (standard deviations)", "distance felt", simulated=found.simulated)


def draw_people(found: StudyAnalysis) -> Any:
    rows = [
        ForestRow(one.person, 100 * one.share, math.nan, math.nan)
        for one in found.people
        if not one.reason and not math.isnan(one.share)
    ]
    whole = found.preference
    assert whole is not None
    middle = ForestRow("all people", 100 * whole.split, math.nan, math.nan, True)
    axis = f"answers for {whole.more}, ties as halves (%)"
    return plot_forest([*rows, middle], axis, "person by person", 50.0, found.simulated)


def draw_thresholds(found: StudyAnalysis) -> Any:
    several = len(found.buttons) > 1
    rows = [
        ForestRow(
            _staircase_name(one, several),
            100 * one.threshold.value, _percent(one.threshold.low), _percent(one.threshold.high),
        )
        for one in found.thresholds
    ]  # fmt: skip
    if found.threshold is not None:
        mean = found.threshold
        rows.append(ForestRow("all people", 100 * mean.mean, 100 * mean.low, 100 * mean.high, True))
    return plot_forest(rows, "force added that is discriminated (%)", "thresholds", None, found.simulated)


def _percent(value: float | None) -> float:
    return math.nan if value is None else 100 * value


def draw_timing(found: TimingResult, simulated: bool) -> Any:
    several = len(found.scores) > 1
    sd = found.scores.std(axis=0, ddof=1) if several else np.zeros(found.scores.shape[1:])
    panels = [
        ScoreBars(level, found.buttons, found.scores[:, :, i], sd[:, i])
        for i, level in enumerate(found.levels)
    ]
    return plot_score_bars(panels, found.measure_text, simulated=simulated)


@style.in_house_style
def plot_tracks(tracks: Sequence[ThresholdResult], simulated: bool = False, by_button: bool = False) -> Any:
    """Draw the first staircases as small panels: filled where the answer was right, open where it was wrong.

    The dashed line is the threshold. All share one logarithmic scale. by_button : name the button too.
    Returns the array of axes.
    """
    if not tracks:
        raise ModelError("a figure of staircases needs at least one")
    tracks = tracks[:MOST_TRACKS]
    columns = min(3, len(tracks))
    rows = -(-len(tracks) // columns)
    fig = style.new_figure(max(6.4, 3.1 * columns), 0.6 + 2.2 * rows)
    axes = fig.subplots(rows, columns, sharex=True, sharey=True, squeeze=False)
    for ax, track in zip(axes.flat, tracks, strict=False):
        _draw_track(ax, track)
        style.set_titles(ax, style.name_text(_staircase_name(track, by_button)), False)
    say_proxy(axes[0, 0], simulated)
    for ax in axes.flat[len(tracks) :]:
        ax.axis("off")
    axes[0, 0].set_yscale("log")
    _label_ratios(axes[0, 0], np.concatenate([one.ratios for one in tracks]))
    fig.supxlabel("trial (count)", fontsize=10)
    fig.supylabel("force added (%)", fontsize=10)
    return axes


@style.in_house_style
def plot_surfaces(found: Sequence[JndResult], simulated: bool = False) -> Any:
    """Draw just noticeable changes of two dimensions together, a panel for each pair of dimensions.

    A line is one person at one button; of one alone the 95 % interval is shaded. Returns the axes.
    """
    if not found or not found[0].surfaces:
        raise ModelError("a figure of surfaces needs two dimensions")
    count = len(found[0].surfaces)
    fig = style.new_figure(max(3.8, 3.3 * count), 3.4)
    axes = fig.subplots(1, count, squeeze=False)[0]
    for place, ax in enumerate(axes):
        for one in found:
            points = 100 * one.surfaces[place].points
            ax.plot(*points[:, :, 0].T, color=style.PALETTE[0], alpha=1.0 if len(found) == 1 else 0.6)
            if len(found) == 1:
                outline = np.concatenate([points[:, :, 1], points[::-1, :, 2]])
                ax.fill(*outline.T, color=style.PALETTE[0], alpha=0.15, linewidth=0)
        ax.set_xlim(left=0)
        ax.set_ylim(bottom=0)
        ax.set_xlabel(f"{found[0].surfaces[place].across} (%)")
        ax.set_ylabel(f"{found[0].surfaces[place].up} (%)")
    say_proxy(axes[0], simulated)
    return axes


def draw_jnds(found: StudyAnalysis, name: Dimension) -> Any:
    """Draw the JND of every person in one dimension, and that over people."""
    several = len(found.buttons) > 1
    rows = []
    for one in found.jnds:
        jnd, who = one.jnds[name], f"{one.person}, {one.button}" if several else one.person
        rows.append(ForestRow(who, 100 * jnd.ratio, 100 * jnd.low, 100 * jnd.high))
    mean = found.jnd[name]
    rows.append(ForestRow("all people", 100 * mean.mean, 100 * mean.low, 100 * mean.high, True))
    title = f"{name} added that three of four notice (%)"
    return plot_forest(rows, title, "just noticeable differences", None, found.simulated)


def _staircase_name(one: ThresholdResult, by_button: bool) -> str:
    return f"{one.person}, {one.button}" if by_button else one.person


def _draw_track(ax: Axes, track: ThresholdResult) -> None:
    trials = np.arange(1, track.ratios.size + 1)
    right = track.correct == 1
    ax.plot(trials, 100 * track.ratios, color=PALE, linewidth=1.2, zorder=1.0)
    ax.plot(trials[right], 100 * track.ratios[right], "o", color=style.PALETTE[0], markersize=3.5)
    wrong: Any = {"markerfacecolor": "white", "markersize": 4.0, "color": style.PALETTE[1]}
    ax.plot(trials[~right], 100 * track.ratios[~right], "o", **wrong)
    if np.isfinite(track.threshold.value):
        ax.axhline(100 * track.threshold.value, color=style.INK, linestyle="--", linewidth=1.0)


def _label_ratios(ax: Axes, ratios: FloatArray) -> None:
    from matplotlib.ticker import FixedLocator, FuncFormatter, NullLocator

    found = 100 * ratios[np.isfinite(ratios) & (ratios > 0)]
    low, high = (found.min() / 1.3, found.max() * 1.3) if found.size else (1.0, 100.0)
    steps = 2.0 ** np.arange(np.floor(np.log2(low)), np.ceil(np.log2(high)) + 1)
    ax.set_ylim(low, high)
    ax.yaxis.set_major_locator(FixedLocator([one for one in steps if low <= one <= high]))
    ax.yaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:.3g}"))
    ax.yaxis.set_minor_locator(NullLocator())
