"""Figures of fits: the spline over the raw samples, and what the number of control points costs."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from fdvv.errors import ModelError
from fdvv.force_text import force_text
from fdvv.model.curve import MeasuredCurve
from fdvv.model.fit import CurveFit, FitMethod
from fdvv.report import style

if TYPE_CHECKING:
    from matplotlib.axes import Axes

RAW = "#9aa5b1"
ROW = 0.035
"""Height of a row of knots, in heights of the axes."""
POINTS: Any = {
    "linestyle": ":",
    "linewidth": 0.9,
    "marker": "o",
    "markersize": 4.5,
    "markerfacecolor": "white",
}


@style.in_house_style
def plot_fit(
    measured: MeasuredCurve,
    fits: Sequence[CurveFit],
    axes: tuple[Axes, Axes] | None = None,
    title: str = "",
    simulated: bool = False,
) -> tuple[Axes, Axes]:
    """Draw raw samples under their fits, with knots and control points, and the residuals below.

    axes : for the curves and for the residuals (fit minus raw, at each distinct displacement).
    Ticks at the foot are the distinct knots of each fit. Returns both axes. Raises ModelError if there
    is no fit.
    """
    if not fits:
        raise ModelError("a figure of fits needs at least one fit, got none")
    if axes is None:
        fig = style.new_figure(7.5, 5.4)
        upper, lower = fig.subplots(2, 1, sharex=True, height_ratios=(3, 1))
        axes = (upper, lower)
    top, residual = axes
    dots: Any = {"linestyle": "", "marker": ".", "markersize": 3.0, "color": RAW}
    top.plot(measured.displacement_mm, measured.force_cN, **dots, label="raw samples")
    x, raw, _ = measured.by_displacement()
    residual.axhline(0.0, color=style.QUIET, linewidth=0.8, zorder=1)
    colours = _method_colours([fit.method for fit in fits])
    for row, (fit, colour) in enumerate(zip(fits, colours, strict=True)):
        _draw_fit(top, fit, colour, row)
        residual.plot(x, fit.curve.force_cN(x) - raw, color=colour, linewidth=1.0)
    top.set(ylabel=style.FORCE)
    top.set_ylim(style.limits_around(measured.force_cN, [0.0]))
    residual.set(xlabel=style.DISPLACEMENT, ylabel="fit − raw (cN)")
    _fit_legend(top, len(fits))
    style.set_titles(top, style.name_text(title) if title else str(measured.stroke), simulated)
    return axes


def _draw_fit(ax: Axes, fit: CurveFit, colour: str, row: int) -> None:
    curve = fit.curve
    drawn = curve.sample(0.01)
    count = curve.control_points_cN.size
    label = f"{fit.method}, {count} control points, RMSE {force_text(fit.rmse_cN, '.2f')}"
    ax.plot(drawn.displacement_mm, drawn.force_cN, color=colour, label=label)
    ax.plot(curve.control_points_mm, curve.control_points_cN, color=colour, **POINTS)
    # ticks in axes heights, so that they stay at the foot whatever the force
    knots = np.unique(curve.knots_mm)
    height = np.full_like(knots, ROW * (row + 0.6))
    ax.plot(knots, height, "|", color=colour, markersize=8.0, transform=ax.get_xaxis_transform())


def _fit_legend(ax: Axes, rows: int) -> None:
    handles: list[Any] = [line for line in ax.get_lines() if not str(line.get_label()).startswith("_")]
    handles.append(style.handle("control points", **POINTS))
    handles.append(style.handle("knots", linestyle="", marker="|", markersize=8.0))
    labels = [str(item.get_label()) for item in handles]
    ax.legend(handles, labels, loc="lower right", bbox_to_anchor=(1.0, ROW * (rows + 0.2)))


def _method_colours(methods: Sequence[str]) -> list[str]:
    own = {FitMethod.ADAPTIVE: style.PALETTE[0], FitMethod.UNIFORM: style.PALETTE[1]}
    free = [c for c in style.PALETTE if c not in own.values()]
    colours: list[str] = []
    for method in methods:
        colour = own.get(FitMethod(method)) if method in set(FitMethod) else None
        taken = colour is None or colour in colours
        colours.append(free[len(colours) % len(free)] if taken else str(colour))
    return colours


@style.in_house_style
def plot_scan(
    scores: Mapping[str, Mapping[int, float]],
    ax: Axes | None = None,
    title: str = "",
    simulated: bool = False,
) -> Axes:
    """Draw BIC* against the number of control points for each method, the best of each marked.

    scores : method ("uniform", "adaptive") to size to BIC*, as scan_sizes gives it. Returns the axes.
    Raises ModelError if no method has a score.
    """
    present = {method: found for method, found in scores.items() if found}
    if not present:
        raise ModelError("a scan needs at least one score, got none")
    ax = style.axes_or_new(ax, 7.0, 3.8)
    for colour, (method, found) in zip(_method_colours(list(present)), present.items(), strict=True):
        sizes = sorted(found)
        best = min(sizes, key=lambda size: found[size])
        label = f"{style.name_text(method)}, least at {best}"
        ax.plot(sizes, [found[size] for size in sizes], marker=".", color=colour, label=label)
        ax.plot([best], [found[best]], "o", markersize=9.0, markerfacecolor="none", color=colour)
    ax.set(xlabel="number of control points (count)", ylabel="BIC* (no unit, lower is better)")
    ax.legend(loc="upper right")
    style.set_titles(ax, style.name_text(title), simulated)
    return ax
