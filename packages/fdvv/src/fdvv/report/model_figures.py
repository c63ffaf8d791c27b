"""Figures of models: their curves, their surface, several side by side, their vibration."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from fdvv.errors import ModelError
from fdvv.model.curve import ForceCurve, Stroke
from fdvv.model.landmarks import landmarks
from fdvv.model.model import FDVVModel
from fdvv.model.vibration import Vibration
from fdvv.report import style

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.lines import Line2D

STEP_mm = 0.02  # 4 mm on a figure 7 in wide: a point every 2.5 pt at most, so that no corner shows
SURFACE_ROWS = 16  # assumed; more patches make a vector file larger
SURFACE_COLUMNS = 49  # assumed, likewise: 48 patches over the travel


@style.in_house_style
def plot_model(model: FDVVModel, ax: Axes | None = None, simulated: bool = False) -> Axes:
    """Draw every curve of a model with its landmarks: actuation, reset and onsets of vibration.

    Colour tells the velocity (light slow, dark fast), solid press from dashed release; a band is the spread
    between presses where the model keeps it. Simulated is written if the model says so or the caller does.
    Returns the axes.
    """
    ax = style.axes_or_new(ax, 8.0, 4.6)
    colours = style.velocity_colours(c.velocity_mm_s for c in model.curves)
    for curve in model.curves:
        _draw_curve(ax, curve, colour=colours[curve.velocity_mm_s])
    handles: list[Any] = [style.handle(style.velocity_text(v), color=c) for v, c in colours.items()]
    handles += style.stroke_handles(c.stroke for c in model.curves)
    handles += style.band_handles(c.spread.presses for c in model.curves if c.spread)
    handles += _mark_landmarks(ax, model)
    style.legend_beside(ax, handles)
    _force_axes(ax, style.name_text(model.name), simulated or model.provenance.simulated)
    return ax


@style.in_house_style
def plot_surface(
    model: FDVVModel, stroke: Stroke | str = Stroke.PRESS, ax: Any = None, simulated: bool = False
) -> Any:
    """Draw force over displacement and velocity for one stroke, the measured curves as lines on it.

    ax : three-dimensional axes. Returns the axes. Raises ModelError unless the stroke has curves at two
    velocities or more.
    """
    speeds = model.velocities_mm_s(stroke)
    if len(speeds) < 2:
        needed = f"needs {stroke} curves at 2 velocities, has {len(speeds)}"
        raise ModelError(f"a surface of {model.name!r} {needed}")
    if ax is None:
        ax = style.new_figure(7.0, 4.9).add_subplot(projection="3d")
    x = np.linspace(0.0, model.travel_mm, SURFACE_COLUMNS)
    # rows at every measured velocity, so that the curves lie on the surface
    ranks = np.arange(len(speeds))
    steps = max(1, SURFACE_ROWS // ranks[-1])
    v = np.interp(np.linspace(0.0, ranks[-1], steps * ranks[-1] + 1), ranks, speeds)
    force = model.force_cN(x[np.newaxis, :], v[:, np.newaxis], stroke)
    parts = (v - v[0]) / (v[-1] - v[0])
    shades = [[(*style.velocity_colour(float(part)), 0.35)] * x.size for part in parts]
    grid_x, grid_v = np.meshgrid(x, v)
    look: Any = {"rstride": 1, "cstride": 1, "shade": False, "linewidth": 0.0}
    ax.plot_surface(grid_x, grid_v, force, facecolors=shades, **look)
    for curve in model.of(stroke):
        velocity = curve.velocity_mm_s or 0.0
        colour = style.velocity_colour((velocity - speeds[0]) / (speeds[-1] - speeds[0]))
        ax.plot(x, np.full_like(x, velocity), curve.force_cN(x), color=colour, linewidth=2.0)
    _surface_axes(ax)
    title = f"{style.name_text(model.name)}, {Stroke(stroke)}"
    style.set_titles(ax, title, simulated or model.provenance.simulated)
    return ax


def _surface_axes(ax: Any) -> None:
    """Label three-dimensional axes and turn them so that the slow curves are in front."""
    from matplotlib.ticker import MaxNLocator

    ax.set(xlabel=style.DISPLACEMENT, ylabel=style.VELOCITY, zlabel=style.FORCE)
    ax.view_init(elev=28, azim=-58)
    ax.set_box_aspect((1.3, 1.0, 0.85), zoom=1.08)
    for axis in (ax.xaxis, ax.yaxis, ax.zaxis):
        axis.set_major_locator(MaxNLocator(5))
        axis.labelpad = 7.0


@style.in_house_style
def plot_comparison(
    models: Sequence[FDVVModel],
    ax: Axes | None = None,
    velocity_mm_s: float | None = None,
    simulated: bool = False,
) -> Axes:
    """Draw models over each other, each by its curves nearest to a velocity (its slowest by default).

    Circles mark peak and valley of the bump, triangles actuation and reset; a band is the spread between
    presses where a model keeps it. Returns the axes. Raises ModelError if there is no model.
    """
    if not models:
        raise ModelError("a comparison needs at least one model, got none")
    ax = style.axes_or_new(ax, 8.0, 4.6)
    handles: list[Any] = []
    presses: list[int] = []
    for model, colour in zip(models, _category_colours(len(models)), strict=True):
        for stroke in Stroke:
            curve = model.nearest(stroke, velocity_mm_s)
            _draw_curve(ax, curve, colour=colour)
            presses += [curve.spread.presses] if curve and curve.spread else []
        _mark_points(ax, model, velocity_mm_s, colour)
        said = " (simulated)" if model.provenance.simulated else ""
        handles.append(style.handle(style.name_text(model.name) + said, color=colour))
    handles += style.stroke_handles(c.stroke for m in models for c in m.curves)
    handles += style.band_handles(presses)
    handles += [style.handle(label, linestyle="", **look) for label, look in _POINTS.items()]
    style.legend_beside(ax, handles)
    _force_axes(ax, "", simulated or any(model.provenance.simulated for model in models))
    return ax


@style.in_house_style
def plot_vibration(model: FDVVModel, ax: Axes | None = None, simulated: bool = False) -> Axes:
    """Draw the acceleration of each vibration of a model on the time after its onset.

    Vibrations that are the same at several velocities or on both strokes are drawn once and named
    together. Returns the axes. Raises ModelError if the model has no vibration.
    """
    if not model.vibrations:
        raise ModelError(f"model {model.name!r} has no vibration to draw")
    ax = style.axes_or_new(ax, 7.0, 3.4)
    alike: dict[object, list[Vibration]] = {}
    for vibration in model.vibrations:
        alike.setdefault((vibration.modes, vibration.duration_s), []).append(vibration)
    for group, colour in zip(alike.values(), _category_colours(len(alike)), strict=True):
        first = group[0]
        t_s = np.linspace(0.0, first.duration_s, 400)
        line = style.LINE[first.stroke]
        ax.plot(t_s, first.acceleration_m_s2(t_s), line, color=colour, label=_vibration_text(group))
    ax.set(xlabel="time after onset (s)", ylabel="acceleration (m/s²)")
    ax.axhline(0.0, color=style.QUIET, linewidth=0.8, zorder=1)
    ax.legend(loc="upper right")
    title = f"{style.name_text(model.name)}, vibration"
    style.set_titles(ax, title, simulated or model.provenance.simulated)
    return ax


_MARKS: dict[str, Any] = {
    "actuation": {"marker": "v", "markersize": 7.0},
    "reset": {"marker": "^", "markersize": 7.0},
    "vibration onset": {"marker": "*", "markersize": 9.0},
}
_POINTS: dict[str, Any] = {
    "peak and valley": {"marker": "o", "markersize": 5.5, "markerfacecolor": "white"},
    "actuation": _MARKS["actuation"],
    "reset": _MARKS["reset"],
}


def _draw_curve(ax: Axes, curve: ForceCurve | None, colour: Any) -> None:
    if curve is None:
        return
    if curve.spread is not None:
        places = curve.spread.displacement_mm
        style.draw_band(ax, places, curve.force_cN(places), curve.spread.spread_cN, colour)
    drawn = curve.sample(STEP_mm)
    ax.plot(drawn.displacement_mm, drawn.force_cN, style.LINE[curve.stroke], color=colour)


def _force_axes(ax: Axes, title: str, simulated: bool) -> None:
    """Label axes of force on displacement; the resting cap and no force are always in view."""
    ax.set(xlabel=style.DISPLACEMENT, ylabel=style.FORCE)
    ax.set_xlim(left=min(0.0, ax.get_xlim()[0]))
    ax.set_ylim(bottom=min(0.0, ax.dataLim.y0 * 1.05))
    ax.margins(x=0.02)
    style.set_titles(ax, title, simulated)


def _mark_landmarks(ax: Axes, model: FDVVModel) -> list[Line2D]:
    """Mark where a model's events lie on its curves, and give their legend entries."""
    spreads_mm = [s.spread_mm if s else None for s in (model.actuation_spread, model.reset_spread)]
    events: list[tuple[str, Stroke, float | None, float | None]] = [
        ("actuation", Stroke.PRESS, model.actuation_mm, spreads_mm[0]),
        ("reset", Stroke.RELEASE, model.reset_mm, spreads_mm[1]),
    ]
    events += [
        ("vibration onset", v.stroke, v.onset_mm, v.spread.onset_mm if v.spread else None)
        for v in model.vibrations
    ]
    handles: dict[str, Line2D] = {}
    for what, stroke, at_mm, spread_mm in events:
        if at_mm is None or not model.of(stroke):
            continue
        force = [float(curve.force_cN(at_mm)) for curve in model.of(stroke)]
        look = _MARKS[what] | {"markerfacecolor": "white", "color": style.INK, "linestyle": ""}
        ax.plot([at_mm] * len(force), force, **look, zorder=5)
        label = f"{what}, {at_mm:.2f}" + (f" ± {spread_mm:.2f} mm" if spread_mm is not None else " mm")
        handles[label] = style.handle(label, **look)
    return list(handles.values())


def _mark_points(ax: Axes, model: FDVVModel, velocity_mm_s: float | None, colour: Any) -> None:
    """Mark peak, valley, actuation and reset of one model on its curves."""
    release = model.nearest(Stroke.RELEASE, velocity_mm_s)
    points: list[tuple[str, float | None, float | None]] = []
    if model.of(Stroke.PRESS):
        marks = landmarks(model, velocity_mm_s)
        points += [
            ("peak and valley", marks.peak_mm, marks.peak_cN),
            ("peak and valley", marks.valley_mm, marks.valley_cN),
            ("actuation", marks.actuation_mm, marks.actuation_cN),
        ]
    if release is not None and model.reset_mm is not None:
        points.append(("reset", model.reset_mm, float(release.force_cN(model.reset_mm))))
    for what, x_mm, force_cN in points:
        if x_mm is not None and force_cN is not None:
            ax.plot([x_mm], [force_cN], **{"linestyle": "", "color": colour, "zorder": 5} | _POINTS[what])


def _category_colours(count: int) -> list[Any]:
    """Return count distinct colours: the palette, or evenly spaced hues if it is too short."""
    from matplotlib import colormaps

    if count <= len(style.PALETTE):
        return list(style.PALETTE[:count])
    return [colormaps["turbo"](0.05 + 0.9 * i / (count - 1)) for i in range(count)]


def _vibration_text(group: Sequence[Vibration]) -> str:
    """Name the strokes, velocities and frequencies of vibrations that are the same."""
    strokes = " and ".join(str(s) for s in Stroke if any(v.stroke is s for v in group))
    speeds = sorted({v.velocity_mm_s for v in group if v.velocity_mm_s is not None})
    at = f"{', '.join(f'{s:g}' for s in speeds)} mm/s" if speeds else "every speed"
    return f"{strokes}, {at}: {', '.join(_frequencies(group))} Hz"


def _frequencies(group: Sequence[Vibration]) -> list[str]:
    """Write the frequencies of vibrations that are the same, with the spread of one that is alone."""
    first = group[0]
    known = first.spread.modes if first.spread and len(group) == 1 else ()
    spreads_Hz = [mode.frequency_Hz for mode in known] or [None] * len(first.modes)
    return [
        f"{mode.frequency_Hz:g}" + (f" ± {spread:.2g}" if spread is not None else "")
        for mode, spread in zip(first.modes, spreads_Hz, strict=True)
    ]
