"""Figures of a study: mean scores by condition, and how scores fell while designs were learned."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from fdvv.errors import ModelError
from fdvv.report import style
from fdvv.units import FloatArray

if TYPE_CHECKING:
    from matplotlib.axes import Axes

BAR_WIDTH = 0.66
BEYOND: Any = {"linestyle": "", "marker": "^", "color": style.PALETTE[1], "markersize": 5.0, "clip_on": False}
"""A triangle at the upper edge stands for a dot that is beyond it."""
ROOM = 1.16
JITTER = 0.22
"""Half the width over which the dots of people are spread."""


@dataclass(frozen=True, eq=False)
class ScoreBars:
    """Scores of several conditions at one level.

    Attributes
    ----------
    level : title of the panel. names : of the conditions; the first is what was designed.
    scores : (people, conditions) the dots; bars are their means.
    spread : (conditions,) half lengths of the error bars.
    marks : one per condition, written above its bar; empty: none.
    """

    level: str
    names: tuple[str, ...]
    scores: FloatArray
    spread: FloatArray
    marks: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        count = len(self.names)
        if self.scores.ndim != 2 or self.scores.shape[1] != count or self.spread.shape != (count,):
            raise ModelError(f"{count} conditions need columns of as many, got {self.scores.shape}")
        if self.marks and len(self.marks) != count:
            raise ModelError(f"{count} conditions need as many marks, got {len(self.marks)}")


@dataclass(frozen=True, eq=False)
class TrainingScores:
    """Scores of the designs tried at one level.

    level : title of the panel. scores : (people, trials), NaN where a trial has none.
    """

    level: str
    scores: FloatArray


@style.in_house_style
def plot_score_bars(
    panels: Sequence[ScoreBars], score: str, spread: str = "1 SD", simulated: bool = False
) -> Any:
    """Draw a panel of bars per level, side by side on one scale; a dot is a person.

    score : name of the axis, with its unit. spread : what the error bars are. Returns the (panels,) array of
    axes. ModelError without a panel.
    """
    axes = _panels(len(panels), 4.6, 4.3)
    for ax, panel in zip(axes, panels, strict=True):
        _draw_bars(ax, panel)
        ax.set_ylabel(f"mean ± {spread}, {score}")
        style.set_titles(ax, style.name_text(panel.level), simulated)
    tops = [panel.scores.mean(axis=0) + panel.spread for panel in panels]
    top = ROOM * float(np.max(tops))
    for ax, panel in zip(axes, panels, strict=True):
        _mark_beyond(ax, np.arange(float(len(panel.names))), panel.scores, top)
        _write_means(ax, panel, top)
    axes[0].set_ylim(0.0, top)
    return axes


def _draw_bars(ax: Axes, panel: ScoreBars) -> None:
    places, means = np.arange(float(len(panel.names))), panel.scores.mean(axis=0)
    colours = [style.PALETTE[0]] + ["#cbd2d9"] * (len(panel.names) - 1)
    ax.bar(places, means, BAR_WIDTH, color=colours, zorder=1.0)
    aside = np.linspace(-JITTER, JITTER, len(panel.scores))
    for place, column in zip(places, panel.scores.T, strict=True):
        ax.plot(place + aside, column, ".", color=style.QUIET, markersize=3.5, alpha=0.8, zorder=2.0)
    ax.errorbar(places, means, panel.spread, fmt="none", ecolor=style.INK, capsize=4.0, elinewidth=1.2)
    ax.set_xticks(places, [style.name_text(name).replace(" ", "\n") for name in panel.names])
    ax.grid(axis="x", visible=False)


def _write_means(ax: Axes, panel: ScoreBars, top: float) -> None:
    """Write each mean and its mark above what is drawn of its bar."""
    means = panel.scores.mean(axis=0)
    drawn = np.where(panel.scores <= top / ROOM, panel.scores, 0.0).max(axis=0)
    heights = np.maximum(means + panel.spread, drawn)
    for place, mark in enumerate(panel.marks or [""] * len(means)):
        label = f"{means[place]:.1f}" + (f"\n{mark}" if mark else "")
        at = (float(place), float(heights[place]))
        ax.annotate(label, at, (0, 4), textcoords="offset points", ha="center", fontsize=8.5)


def _mark_beyond(ax: Axes, places: FloatArray, scores: FloatArray, top: float) -> None:
    """Draw a triangle at the edge for every place of (rows, places) scores with a dot beyond it."""
    beyond = np.any(scores > top, axis=0)
    if beyond.any():
        ax.plot(places[beyond], np.full(int(beyond.sum()), top), **BEYOND, label="beyond the scale")


@style.in_house_style
def plot_training(panels: Sequence[TrainingScores], score: str, simulated: bool = False) -> Any:
    """Draw per level the scores of the designs tried, in order: people, their median, the best so far.

    The scale holds nine of ten scores; a triangle tells that there is one beyond it.
    The best so far is the smallest score of each person until then, lucky ones among them; its median stands.
    Returns the (panels,) array of axes. ModelError without a panel.
    """
    axes = _panels(len(panels), 4.6, 3.6)
    for ax, panel in zip(axes, panels, strict=True):
        _draw_training(ax, panel)
        style.set_titles(ax, style.name_text(panel.level), simulated)
        ax.set_xlabel("trial (count)")
    scores = np.concatenate([panel.scores.ravel() for panel in panels])
    top = ROOM * float(np.nanpercentile(scores, 90))
    for ax, panel in zip(axes, panels, strict=True):
        _mark_beyond(ax, np.arange(1.0, panel.scores.shape[1] + 1), panel.scores, top)
    axes[0].set_ylim(0.0, top)
    axes[0].set_ylabel(score)
    named: dict[str, Any] = {}
    for ax in axes:
        handles, labels = ax.get_legend_handles_labels()
        named |= zip(labels, handles, strict=True)
    axes[0].figure.legend(list(named.values()), list(named), loc="outside lower center", ncols=len(named))
    return axes


def _draw_training(ax: Axes, panel: TrainingScores) -> None:
    """Draw one level; of one person alone there is neither a median nor a spread."""
    trials, alone = np.arange(1, panel.scores.shape[1] + 1), len(panel.scores) == 1
    dot: Any = {"color": style.QUIET, "alpha": 0.9 if alone else 0.45, "markersize": 6.0 if alone else 4.0}
    for number, row in enumerate(panel.scores):
        ax.plot(trials, row, ".", **dot, label="a person's trial" if number == 0 else None)
    # before its first score a person has no best, and of a trial that nobody scored there is no median
    best = np.fmin.accumulate(panel.scores, axis=1)
    scored, started = (np.isfinite(columns).any(axis=0) for columns in (panel.scores, best))
    if not alone:
        low, high = np.nanpercentile(best[:, started], [25, 75], axis=0)
        ax.fill_between(trials[started], low, high, color=style.PALETTE[0], alpha=style.BAND, linewidth=0.0)
        middle = np.nanmedian(panel.scores[:, scored], axis=0)
        ax.plot(trials[scored], middle, color=style.PALETTE[1], label="median of people")
    label = "best so far" if alone else "best so far, median and quartiles"
    line: Any = {"color": style.PALETTE[0], "linewidth": 2.0, "label": label}
    ax.plot(trials[started], np.nanmedian(best[:, started], axis=0), **line)


def _panels(count: int, width_in: float, height_in: float) -> Any:
    if not count:
        raise ModelError("a figure of a study needs at least one level")
    fig = style.new_figure(max(width_in * count + 0.4, 6.4), height_in)
    # "simulated" of one panel must not run into the title of the next
    return fig.subplots(1, count, sharey=True, squeeze=False, gridspec_kw={"wspace": 0.06})[0]
