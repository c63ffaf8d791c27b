"""A specification curve: one claim under every reasonable way to analyse it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from fdvv.errors import ModelError
from fdvv.plot import _style as style
from fdvv.plot._answer_figures import say_proxy
from fdvv.units import FloatArray

if TYPE_CHECKING:
    from matplotlib.axes import Axes


@dataclass(frozen=True, eq=False)
class SpecificationCurve:
    """All ways, by rising estimate.

    Attributes
    ----------
    estimate, low, high : (ways,). significant : (ways,) of bool. registered : place of the one fixed
        beforehand. choices : by name of a choice, what each way chose, (ways,) of str.
    """

    estimate: FloatArray
    low: FloatArray
    high: FloatArray
    significant: np.ndarray
    registered: int
    choices: Mapping[str, tuple[str, ...]]

    def __post_init__(self) -> None:
        n = self.estimate.size
        lengths = [self.low.size, self.high.size, self.significant.size, *map(len, self.choices.values())]
        if not n or set(lengths) != {n} or not 0 <= self.registered < n:
            raise ModelError("a specification curve needs at least one way, and everything of each")


@style.in_house_style
def plot_specifications(
    curve: SpecificationCurve, axis: str, marked: str, none: float = 0.5, simulated: bool = False
) -> Any:
    """Draw estimates above and, below each, what was chosen for it.

    axis : name of the estimate. marked : what the registered way is called. none : no difference.
    Gives both axes.
    """
    rows = [(name, value) for name, values in curve.choices.items() for value in dict.fromkeys(values)]
    fig = style.new_figure(8.6, 3.0 + 0.23 * (len(rows) + len(curve.choices)))
    ratio = [2.6, 0.23 * (len(rows) + len(curve.choices)) + 0.1]
    top, below = fig.subplots(2, 1, sharex=True, gridspec_kw={"height_ratios": ratio})
    _draw_estimates(top, curve, marked, none)
    top.set_ylabel(axis)
    style.set_titles(top, f"{curve.estimate.size} ways to analyse the main claim", False)
    say_proxy(top, simulated)
    _draw_choices(below, curve)
    fig.legend(loc="outside lower center", ncols=3)
    return np.array([top, below])


def _draw_estimates(ax: Axes, curve: SpecificationCurve, marked: str, none: float) -> None:
    ways = np.arange(1, curve.estimate.size + 1)
    ax.axhline(none, color=style.QUIET, linestyle=":", linewidth=1.2)
    for yes, colour, label in (
        (True, style.PALETTE[0], "significant"),
        (False, style.QUIET, "not significant"),
    ):
        some = curve.significant == yes
        if some.any():
            ax.vlines(ways[some], curve.low[some], curve.high[some], color=colour, linewidth=1.2, alpha=0.5)
            ax.plot(ways[some], curve.estimate[some], "o", color=colour, markersize=3.6, label=label)
    at = curve.registered
    look: Any = {"color": style.PALETTE[1], "markersize": 9.0, "zorder": 4.0, "label": marked}
    ax.plot(ways[at : at + 1], curve.estimate[at : at + 1], "D", **look)
    ax.margins(x=0.02)


def _draw_choices(ax: Axes, curve: SpecificationCurve) -> None:
    """Draw a dot where a way chose what its row says."""
    ways = np.arange(1, curve.estimate.size + 1)
    ticks, labels, place = [], [], 0
    for name, values in curve.choices.items():
        ticks.append(place)
        labels.append(name)
        for value in dict.fromkeys(values):
            place += 1
            some = np.array([one == value for one in values])
            ax.plot(ways[some], np.full(int(some.sum()), place), "|", color=style.INK, markersize=7.0)
            ticks.append(place)
            labels.append(style.name_text(value))
        place += 1
    ax.axvline(ways[curve.registered], color=style.PALETTE[1], linewidth=1.0, alpha=0.6, zorder=0.5)
    ax.set_ylim(place - 0.3, -0.7)
    ax.set_yticks(ticks, labels, fontsize=8.5)
    for label in ax.get_yticklabels():
        label.set_fontweight("bold" if label.get_text() in curve.choices else "normal")
    ax.set_xlabel("way (by rising estimate)")
    ax.grid(visible=False)
    ax.tick_params(axis="y", length=0)
