"""Figures of a probe: force with what a finger would notice, and vibration in time and by bands."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from fdvv.errors import ModelError
from fdvv.model.curve import Stroke
from fdvv.rendering.evaluation.probe_curve import ProbeCurve
from fdvv.rendering.evaluation.verdict import short_outcome
from fdvv.rendering.evaluation.vibration_presses import RenderedVibration
from fdvv.report import style
from fdvv.report.records import RenderedBand, RenderedCurve
from fdvv.vibration.compare import BANDS_Hz

if TYPE_CHECKING:
    from matplotlib.axes import Axes

ASKED: Any = {"color": style.INK, "linestyle": (0, (1, 1.2)), "linewidth": 1.8}
RENDERED: Any = {"color": style.PALETTE[1], "linewidth": 1.4}
OWN: Any = {"color": style.QUIET, "linewidth": 1.2}
CELL_in, ROW_in = 4.2, 2.1
FAINTEST_m_s2 = 0.01
"""Bands below it are drawn there."""


def method_curves(methods: Mapping[str, Sequence[ProbeCurve]], simulated: bool) -> list[RenderedCurve]:
    """Return what several methods rendered of the same curves, in one order, for plot_rendering.

    A line is the median of the presses, its band the quartiles.
    """
    curves = []
    for rows in zip(*methods.values(), strict=True):
        first = rows[0]
        bands = tuple(_band(name, curve) for name, curve in zip(methods, rows, strict=True))
        where = (first.stroke, first.velocity_mm_s, first.displacement_mm, first.target_cN)
        curves.append(RenderedCurve(*where, bands, simulated, first.jnds.force_cN(first.target_cN)))
    return curves


def _band(method: str, curve: ProbeCurve) -> RenderedBand:
    low, middle, high = np.percentile(curve.rendered_cN, [25, 50, 75], axis=0)
    return RenderedBand(method, middle, low, high, (curve.total_JND > 1).mean(axis=0))


def worst_vibrations(curves: Sequence[ProbeCurve]) -> list[ProbeCurve]:
    """Return of each stroke the curve whose vibration is noticed most; none where nothing was compared."""
    worst = []
    for stroke in Stroke:
        mine = [c for c in curves if c.stroke is stroke and c.vibration.error]
        worst += [max(mine, key=lambda c: c.vibration.total_JND)] if mine else []
    return worst


@style.in_house_style
def plot_vibrations(curves: Sequence[ProbeCurve], simulated: bool = False) -> Any:
    """Draw the vibration asked for and what the cap did: a row per stroke; over time, and by bands.

    Of each stroke the speed is drawn at which it is noticed most. Returns the (strokes, 2) array of axes.
    Raises ModelError if no curve has a vibration that was compared.
    """
    shown = worst_vibrations(curves)
    if not shown:
        raise ModelError("a figure of vibrations needs one that was compared, got none")
    fig = style.new_figure(2 * CELL_in, ROW_in * len(shown) + 0.7)
    axes = fig.subplots(len(shown), 2, squeeze=False)
    for row, curve in zip(axes, shown, strict=True):
        _draw_time(row[0], curve.vibration)
        _draw_bands(row[1], curve.vibration)
        title = f"{curve.stroke}, {style.velocity_text(curve.velocity_mm_s)}"
        style.set_titles(row[0], title, simulated)
        style.set_titles(row[1], short_outcome(curve.vibration), False)
    axes[-1, 0].set_xlabel("time since the place of the onset (ms)")
    axes[-1, 1].set_xlabel("frequency (Hz)")
    played = any(c.vibration.error and c.vibration.error.played for c in shown)
    handles = [style.handle("asked for", **ASKED), style.handle("the cap without it", **OWN)]
    handles += [style.handle("the cap with it (left), what it adds (right)", **RENDERED)] if played else []
    fig.legend(handles, [str(h.get_label()) for h in handles], loc="outside lower center", ncols=len(handles))
    return axes


def _draw_time(ax: Axes, vibration: RenderedVibration) -> None:
    shown = vibration.shown
    assert shown is not None
    ax.plot(shown.since_ms, shown.without_m_s2, **OWN)
    if shown.with_m_s2 is not None:
        ax.plot(shown.since_ms, shown.with_m_s2, **RENDERED)
    ax.plot(shown.since_ms, shown.asked_m_s2, **ASKED)
    ax.set_ylabel("acceleration (m/s²)")


def _draw_bands(ax: Axes, vibration: RenderedVibration) -> None:
    """Draw the rms of each band as a step; the scale of levels is logarithmic."""
    error = vibration.error
    assert error is not None
    edges = [low for low, _ in BANDS_Hz] + [BANDS_Hz[-1][1]]
    lines = [(error.own_m_s2, OWN), (error.asked_m_s2, ASKED)]
    if error.added_m_s2 is not None:
        lines.insert(1, (error.added_m_s2, RENDERED))
    for levels, look in lines:
        ax.stairs(np.maximum(levels, FAINTEST_m_s2), edges, baseline=None, **look)
    ax.set(xscale="log", yscale="log", xlim=(edges[0], edges[-1]), ylabel="rms in the band (m/s²)")
    ax.set_ylim(bottom=FAINTEST_m_s2)
    ax.set_xticks(edges, [f"{edge:g}" for edge in edges])
    ax.xaxis.minorticks_off()
    levels_m_s2 = [10.0**power for power in range(-2, 1 + int(np.ceil(np.log10(ax.get_ylim()[1]))))]
    ax.set_yticks(levels_m_s2, [f"{level:g}" for level in levels_m_s2])
