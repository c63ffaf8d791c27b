"""A figure of designs: the force curve of each with where it switches and where it vibrates."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from fdvv.errors import ModelError
from fdvv.model import FDVVModel, Stroke
from fdvv.plot import _style as style
from fdvv.units import FloatArray

if TYPE_CHECKING:
    from matplotlib.axes import Axes

STEP_mm = 0.02
ACTUATION: Any = {"color": style.PALETTE[2], "linestyle": (0, (4, 2)), "linewidth": 1.4}
VIBRATION: Any = {"color": style.PALETTE[1], "linestyle": (0, (1, 1.5)), "linewidth": 1.6}


@dataclass(frozen=True, eq=False)
class DesignPanel:
    """One design.

    Attributes
    ----------
    title : of the panel. model : the button. points : (n, 2) control points, mm and cN; None: none are drawn.
    """

    title: str
    model: FDVVModel
    points: FloatArray | None = None


@style.in_house_style
def plot_designs(panels: Sequence[DesignPanel], columns: int = 2, simulated: bool = False) -> Any:
    """Draw designs in a grid with common scales: force of the press, actuation and onset of vibration.

    Gives the (rows, columns) array of axes. ModelError without a design.
    """
    if not panels:
        raise ModelError("a figure of designs needs at least one")
    rows = -(-len(panels) // columns)
    fig = style.new_figure(4.0 * columns + 0.4, 2.35 * rows + 0.6)
    axes = fig.subplots(rows, columns, sharex=True, sharey=True, squeeze=False)
    for number, ax in enumerate(axes.flat):
        ax.set_visible(number < len(panels))
    for ax, panel in zip(axes.flat, panels, strict=False):
        _draw_design(ax, panel)
        style.set_titles(ax, style.name_text(panel.title), simulated or panel.model.provenance.simulated)
    for number, ax in enumerate(axes.flat):
        ax.set_xlabel(style.DISPLACEMENT if number + columns >= len(panels) else "")
        ax.tick_params(labelbottom=number + columns >= len(panels))
        ax.set_ylabel(style.FORCE if number % columns == 0 else "")
    axes[0, 0].set_ylim(bottom=0.0)
    _legend(axes, panels)
    return axes


def _draw_design(ax: Axes, panel: DesignPanel) -> None:
    """Draw one design."""
    model = panel.model
    x = np.arange(0.0, model.travel_mm + STEP_mm / 2, STEP_mm)
    force = model.of(Stroke.PRESS)[0].force_cN(x)
    ax.plot(x, force, color=style.PALETTE[0], linewidth=1.8)
    if panel.points is not None:
        ax.plot(*panel.points.T, "o", color=style.PALETTE[0], markerfacecolor="white", markersize=5.5)
    if model.actuation_mm is not None:
        ax.axvline(model.actuation_mm, **ACTUATION)
    for vibration in model.vibrations:
        if vibration.stroke is Stroke.PRESS:
            ax.axvline(vibration.onset_mm, **VIBRATION)


def _legend(axes: Any, panels: Sequence[DesignPanel]) -> None:
    """Name curve, points and marks once for all, below."""
    handles = [style.handle("force of the press", color=style.PALETTE[0])]
    if any(panel.points is not None for panel in panels):
        look: Any = {"linestyle": "", "marker": "o", "color": style.PALETTE[0], "markerfacecolor": "white"}
        handles.append(style.handle("control point", **look))
    handles += [style.handle("activation", **ACTUATION), style.handle("vibration", **VIBRATION)]
    labels = [str(item.get_label()) for item in handles]
    axes[0, 0].figure.legend(handles, labels, loc="outside lower center", ncols=len(handles))
