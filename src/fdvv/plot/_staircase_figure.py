"""Staircases of a study, a small panel each."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from fdvv.errors import ModelError
from fdvv.plot import _style as style
from fdvv.plot._answer_figures import PALE, say_proxy
from fdvv.units import FloatArray

if TYPE_CHECKING:
    from matplotlib.axes import Axes


@dataclass(frozen=True, eq=False)
class StaircaseTrack:
    """One staircase: ratio and whether the answer was right, trial by trial; nan threshold where none."""

    name: str
    ratios: FloatArray
    correct: FloatArray
    threshold: float


@style.in_house_style
def plot_tracks(tracks: Sequence[StaircaseTrack], simulated: bool = False) -> Any:
    """Draw every staircase as a small panel: filled where the answer was right, open where it was wrong.

    The dashed line is the threshold. All share one logarithmic scale. Gives the array of axes.
    """
    if not tracks:
        raise ModelError("a figure of staircases needs at least one")
    columns = min(3, len(tracks))
    rows = -(-len(tracks) // columns)
    fig = style.new_figure(max(6.4, 3.1 * columns), 0.6 + 2.2 * rows)
    axes = fig.subplots(rows, columns, sharex=True, sharey=True, squeeze=False)
    for ax, track in zip(axes.flat, tracks, strict=False):
        _draw_track(ax, track)
        style.set_titles(ax, style.name_text(track.name), False)
    say_proxy(axes[0, 0], simulated)
    for ax in axes.flat[len(tracks) :]:
        ax.axis("off")
    axes[0, 0].set_yscale("log")
    _label_ratios(axes[0, 0], np.concatenate([one.ratios for one in tracks]))
    fig.supxlabel("trial (count)", fontsize=10)
    fig.supylabel("force added (%)", fontsize=10)
    return axes


def _draw_track(ax: Axes, track: StaircaseTrack) -> None:
    trials = np.arange(1, track.ratios.size + 1)
    right = track.correct == 1
    ax.plot(trials, 100 * track.ratios, color=PALE, linewidth=1.2, zorder=1.0)
    ax.plot(trials[right], 100 * track.ratios[right], "o", color=style.PALETTE[0], markersize=3.5)
    wrong: Any = {"markerfacecolor": "white", "markersize": 4.0, "color": style.PALETTE[1]}
    ax.plot(trials[~right], 100 * track.ratios[~right], "o", **wrong)
    if np.isfinite(track.threshold):
        ax.axhline(100 * track.threshold, color=style.INK, linestyle="--", linewidth=1.0)


def _label_ratios(ax: Axes, ratios: FloatArray) -> None:
    """Write plain percentages on a logarithmic axis, halving from step to step."""
    from matplotlib.ticker import FixedLocator, FuncFormatter, NullLocator

    found = 100 * ratios[np.isfinite(ratios) & (ratios > 0)]
    low, high = (found.min() / 1.3, found.max() * 1.3) if found.size else (1.0, 100.0)
    steps = 2.0 ** np.arange(np.floor(np.log2(low)), np.ceil(np.log2(high)) + 1)
    ax.set_ylim(low, high)
    ax.yaxis.set_major_locator(FixedLocator([one for one in steps if low <= one <= high]))
    ax.yaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:.3g}"))
    ax.yaxis.set_minor_locator(NullLocator())
