"""Figures of all recorded presses: paces, registration on displacement, averaged curves with their spread."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from fdvv.errors import ModelError
from fdvv.model import Stroke
from fdvv.plot import _style as style
from fdvv.preprocess import (
    AveragedCurve,
    PaperRecipe,
    Processed,
    Reason,
    StrokeTrack,
    paper_average,
)

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

SAMPLES: Any = {"linestyle": "", "marker": ".", "markersize": 3.0, "alpha": 0.6, "color": style.QUIET}
LEFT_OUT = ("x", "+", "1", "2", "3", "4", "*", "d")
"""One marker for each reason, so that it is told without colour too."""


@style.in_house_style
def plot_paces(processed: Processed, simulated: bool = False) -> Figure:
    """Draw the speed of every press in the order they were made, beside the pace that was asked for.

    Presses that are left out have their own marker and colour for each reason.
    """
    fig = style.new_figure(8.0, 4.4)
    ax = fig.add_subplot()
    order = np.arange(1, len(processed.judged) + 1)
    asked = np.array([one.press.velocity_mm_s or np.nan for one in processed.judged])
    made = np.array([one.achieved_mm_s for one in processed.judged])
    ax.plot(order, asked, drawstyle="steps-mid", color=style.QUIET, linewidth=1.2, label="asked")
    used = np.array([one.reason is None for one in processed.judged])
    ax.plot(order[used], made[used], "o", markersize=4.5, color=style.PALETTE[0], label=f"used: {used.sum()}")
    for i, reason in enumerate(Reason):
        which = np.array([one.reason is reason for one in processed.judged])
        if which.any():
            look: Any = {"color": style.PALETTE[1 + i % 7], "markersize": 7.0, "markeredgewidth": 1.8}
            label = f"{reason}: {which.sum()}"
            ax.plot(order[which], made[which], LEFT_OUT[i], **look, label=style.wrapped(label))
    ax.set(xlabel="press (count, in the order made)", ylabel="mean speed of the press (mm/s)")
    ax.set_ylim(0.0, 1.06 * float(np.nanmax(np.concatenate([made, asked, [1.0]]))))
    ax.legend(loc="upper left", bbox_to_anchor=(1.01, 1.0), borderaxespad=0.0)
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
    """Draw all samples of all presses of one stroke and pace on displacement, their mean and its band.

    recipe : of the paper, drawn beside; by default with its sigmas in samples.
    Raises ModelError if there is no such curve.
    """
    stroke, recipe = Stroke(stroke), recipe or PaperRecipe()
    curve, tracks = _found(processed, stroke, velocity_mm_s)
    theirs = paper_average(processed.judged, stroke, velocity_mm_s, recipe, processed.zero_mm)
    fig = style.new_figure(8.0, 4.6)
    ax = fig.add_subplot()
    x_mm, force_cN = (
        np.concatenate([getattr(t, n) for t in tracks]) for n in ("displacement_mm", "force_cN")
    )
    ax.plot(x_mm, force_cN, **SAMPLES, label=f"{x_mm.size} samples of {len(tracks)} presses")
    style.draw_band(ax, curve.displacement_mm, curve.force_cN, curve.spread_cN, style.PALETTE[0])
    ax.plot(curve.displacement_mm, curve.force_cN, color=style.PALETTE[0], label="mean")
    look: Any = {"color": style.PALETTE[1], "linestyle": (0, (4, 1.5)), "linewidth": 1.3}
    ax.plot(theirs.displacement_mm, theirs.force_cN, **look, label=style.wrapped(recipe_text(recipe)))
    handles: list[Any] = [*ax.get_legend_handles_labels()[0], *style.band_handles([curve.presses])]
    style.legend_beside(ax, handles)
    ax.set(xlabel=style.DISPLACEMENT, ylabel=style.FORCE)
    ax.set_ylim(style.limits_around(force_cN, theirs.force_cN))
    style.set_titles(ax, f"{stroke}, {style.velocity_text(velocity_mm_s)}", simulated)
    return fig


def recipe_text(recipe: PaperRecipe) -> str:
    """Say the paper's recipe with the units of its sigmas."""
    first, last = recipe.streams, recipe.curve
    return f"the paper's recipe, σ {first.sigma:g} {first.unit} and {last.sigma:g} {last.unit}"


def _found(
    processed: Processed, stroke: Stroke, velocity_mm_s: float | None
) -> tuple[AveragedCurve, tuple[StrokeTrack, ...]]:
    for curve, tracks in zip(processed.curves, processed.tracks, strict=True):
        if curve.stroke is stroke and curve.velocity_mm_s == velocity_mm_s:
            return curve, tracks
    raise ModelError(f"no {stroke} at {style.velocity_text(velocity_mm_s)} was averaged")


@style.in_house_style
def plot_averages(processed: Processed, simulated: bool = False) -> Figure:
    """Draw the averaged curves of all paces with their bands, a panel for each stroke, and the probe."""
    strokes = [s for s in Stroke if any(c.stroke is s for c in processed.curves)]
    fig = style.new_figure(4.6 * len(strokes) + 0.6, 4.6)
    panels = fig.subplots(1, len(strokes), sharex=True, sharey=True, squeeze=False)[0]
    colours = style.velocity_colours(c.velocity_mm_s for c in processed.curves)
    for ax, stroke in zip(panels, strokes, strict=True):
        _draw_probe(ax, processed, stroke)
        for curve in processed.curves:
            if curve.stroke is stroke:
                colour = colours[curve.velocity_mm_s]
                style.draw_band(ax, curve.displacement_mm, curve.force_cN, curve.spread_cN, colour)
                ax.plot(curve.displacement_mm, curve.force_cN, color=colour)
        ax.set(xlabel=style.DISPLACEMENT, ylabel=style.FORCE if ax is panels[0] else "")
        style.set_titles(ax, str(stroke), simulated)
    handles: list[Any] = [style.handle(style.velocity_text(v), color=c) for v, c in colours.items()]
    if processed.probe:
        told = style.velocity_text(processed.probe.velocity_mm_s)
        handles.append(style.handle(f"probe, {told}", **PROBE))
    handles += style.band_handles(c.presses for c in processed.curves)
    fig.legend(handles, [str(h.get_label()) for h in handles], loc="outside lower center", ncols=4)
    return fig


PROBE: Any = {"color": style.INK, "linestyle": ":", "linewidth": 1.3}


def _draw_probe(ax: Axes, processed: Processed, stroke: Stroke) -> None:
    probe = processed.probe
    if probe is not None:
        force_cN = probe.press_cN if stroke is Stroke.PRESS else probe.release_cN
        ax.plot(probe.displacement_mm, force_cN, **PROBE)
