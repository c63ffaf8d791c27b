"""Spaces of buttons that are variations of one: any subset of what a model has."""

from __future__ import annotations

import re
from collections.abc import Callable, Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from fdvv.errors import InputError
from fdvv.force_text import force_number, force_text
from fdvv.model.bump import find_bump
from fdvv.model.curve import ForceCurve, Stroke
from fdvv.model.model import FDVVModel
from fdvv.model.vibration import Vibration
from fdvv.units import FloatArray
from fdvv_people.optimize.space import BUTTON_LENGTH, Constraint, Design, DesignSpace, Parameter

Apply = Callable[[FDVVModel, float], FDVVModel]
RISE_mm = 1.0
"""Over which an added bump comes up; how it goes down is snap_mm."""
GRID_mm = 0.05
"""A curve with an added bump is a cubic through points so far apart."""
EDGE_mm = 0.1
"""Points keep this distance from the ends of the travel."""


@dataclass(frozen=True)
class Handle:
    """One number that can be varied.

    Attributes
    ----------
    parameter : its name and the bounds it has by default. neutral : the value that leaves the model as it is.
    apply : makes the model with another value.
    """

    parameter: Parameter
    neutral: float
    apply: Apply


def handles(base: FDVVModel) -> dict[str, Handle]:
    """List what can be varied of a model, in the order in which changes are made."""
    found = [*_shape(base), *_velocities(base), *_control_points(base), _travel(base)]
    found += [*_points(base), *_vibration(base)]
    return {one.parameter.name: one for one in found}


def _shape(base: FDVVModel) -> list[Handle]:
    bump = next((b for c in base.of(Stroke.PRESS) if (b := _bump(c))), None)
    default_mm = base.actuation_mm if base.actuation_mm is not None else 0.5 * base.travel_mm
    peak_mm = float(np.clip(bump or default_mm, 0.3 * base.travel_mm, 0.7 * base.travel_mm))
    return [
        Handle(Parameter("force_ratio", 0.5, 2.0), 1.0, _scaled),
        Handle(Parameter("stiffness_cN_mm", -10.0, 30.0), 0.0, _sloped),
        Handle(Parameter("bump_ratio", 0.0, 2.0), 1.0, _contrasted),
        Handle(Parameter("bump_cN", 0.0, 60.0), 0.0, lambda m, v: m),
        Handle(Parameter("bump_mm", 0.2 * base.travel_mm, 0.8 * base.travel_mm), peak_mm, lambda m, v: m),
        Handle(Parameter("snap_mm", 0.1, 1.0), 0.5, lambda m, v: m),
    ]


def _bump(curve: ForceCurve) -> float | None:
    """Return where a curve's bump has its peak; None if it has none."""
    sampled = curve.sample(0.02)
    bump = find_bump(sampled.displacement_mm, sampled.force_cN)
    return None if bump is None else float(bump.peak_mm)


def _scaled(model: FDVVModel, ratio: float, velocity_mm_s: float | None = None) -> FDVVModel:
    """Multiply all force, or that of the curves at one velocity."""

    def change(curve: ForceCurve) -> FloatArray:
        meant = velocity_mm_s is None or curve.velocity_mm_s == velocity_mm_s
        return curve.control_points_cN * (ratio if meant else 1.0)

    return _changed(model, change)


def _sloped(model: FDVVModel, stiffness_cN_mm: float) -> FDVVModel:
    """Add a spring that is slack at first contact: a straight line is exact on control points."""
    return _changed(model, lambda c: c.control_points_cN + stiffness_cN_mm * c.control_points_mm)


def _contrasted(model: FDVVModel, ratio: float) -> FDVVModel:
    """Stretch what a curve departs from its straight line: 0 is a plain spring, 1 the model."""

    def change(curve: ForceCurve) -> FloatArray:
        x, y = curve.control_points_mm, curve.control_points_cN
        line = np.polynomial.Polynomial.fit(x, y, 1)(x)
        return np.asarray(line + ratio * (y - line))

    return _changed(model, change)


def _changed(model: FDVVModel, change: Callable[[ForceCurve], FloatArray]) -> FDVVModel:
    """Return every curve other control points; their spread was never measured."""
    curves = tuple(replace(c, control_points_cN=change(c), spread=None) for c in model.curves)
    return replace(model, curves=curves)


def _velocities(base: FDVVModel) -> list[Handle]:
    """Return one scale per velocity, for press and release alike: what FDVV adds to FDV."""
    speeds = sorted({v for stroke in Stroke for v in base.velocities_mm_s(stroke)})
    return [
        Handle(
            Parameter(f"force_at_{_word(v)}_mm_s_ratio", 0.5, 2.0),
            1.0,
            lambda m, ratio, v=v: _scaled(m, ratio, v),  # type: ignore[misc]
        )
        for v in speeds
    ]


def _word(velocity_mm_s: float | None) -> str:
    """Write a velocity as part of a name: 0.5 is 0p5."""
    return "any" if velocity_mm_s is None else f"{velocity_mm_s:g}".replace(".", "p")


def _control_points(base: FDVVModel) -> list[Handle]:
    """Return every control point of every curve: the whole model, for those who want that many numbers."""
    found = []
    for curve in base.curves:
        for i, force_cN in enumerate(curve.control_points_cN.tolist()):
            name = f"{curve.stroke}_{_word(curve.velocity_mm_s)}_point{i}_cN"
            bounds = Parameter(name, force_cN - 30.0, force_cN + 30.0)
            key = (curve.stroke, curve.velocity_mm_s, i)
            found.append(Handle(bounds, force_cN, lambda m, v, key=key: _moved(m, key, v)))  # type: ignore[misc]
    return found


def _moved(model: FDVVModel, key: tuple[Stroke, float | None, int], force_cN: float) -> FDVVModel:
    def change(curve: ForceCurve) -> FloatArray:
        points = curve.control_points_cN.copy()
        if (curve.stroke, curve.velocity_mm_s) == key[:2]:
            points[key[2]] = force_cN
        return points

    return _changed(model, change)


def _travel(base: FDVVModel) -> Handle:
    bounds = Parameter("travel_mm", 0.6 * base.travel_mm, 1.4 * base.travel_mm)
    return Handle(bounds, base.travel_mm, _stretched)


def _stretched(model: FDVVModel, travel_mm: float) -> FDVVModel:
    """Stretch all along the travel: curves, points and onsets keep their part of it."""
    by = travel_mm / model.travel_mm

    def at(point_mm: float | None) -> float | None:
        return None if point_mm is None else min(point_mm * by, travel_mm)

    return replace(
        model,
        travel_mm=travel_mm,
        curves=tuple(replace(c, knots_mm=c.knots_mm * by, spread=None) for c in model.curves),
        actuation_mm=at(model.actuation_mm),
        reset_mm=at(model.reset_mm),
        vibrations=tuple(replace(v, onset_mm=v.onset_mm * by, spread=None) for v in model.vibrations),
        travel_spread=None,
        actuation_spread=None,
        reset_spread=None,
    )


def _points(base: FDVVModel) -> list[Handle]:
    """Return actuation and reset; a reset that the design does not name follows the actuation."""
    bounds = EDGE_mm, base.travel_mm - EDGE_mm
    actuation = 0.5 * base.travel_mm if base.actuation_mm is None else base.actuation_mm
    reset = actuation if base.reset_mm is None else base.reset_mm

    def actuate(model: FDVVModel, at_mm: float) -> FDVVModel:
        kept = at_mm if model.reset_mm is None else min(model.reset_mm, at_mm)
        return replace(model, actuation_mm=at_mm, reset_mm=kept, actuation_spread=None, reset_spread=None)

    return [
        Handle(Parameter("actuation_mm", *bounds), actuation, actuate),
        Handle(Parameter("reset_mm", *bounds), reset, lambda m, v: replace(m, reset_mm=v, reset_spread=None)),
    ]


def _vibration(base: FDVVModel) -> list[Handle]:
    """Return strength, frequency and onset of a model's vibrations; nothing where it has none."""
    if not base.vibrations:
        return []
    first = base.vibrations[0]
    frequency_Hz, edge_mm = first.modes[0].frequency_Hz, base.travel_mm - EDGE_mm

    def each(
        model: FDVVModel, gain: float = 1.0, tune: float = 1.0, onset_mm: float | None = None
    ) -> FDVVModel:
        def changed(one: Vibration) -> Vibration:
            modes = tuple(
                replace(k, amplitude_m_s2=k.amplitude_m_s2 * gain, frequency_Hz=k.frequency_Hz * tune)
                for k in one.modes
            )
            onset = one.onset_mm if onset_mm is None else onset_mm
            return replace(one, modes=modes, onset_mm=onset, spread=None)

        return replace(model, vibrations=tuple(map(changed, model.vibrations)))

    return [
        Handle(Parameter("vibration_gain_ratio", 0.0, 2.0), 1.0, lambda m, v: each(m, gain=v)),
        Handle(
            Parameter("vibration_Hz", 0.5 * frequency_Hz, 2.0 * frequency_Hz),
            frequency_Hz,
            lambda m, v: each(m, tune=v / frequency_Hz),
        ),
        Handle(Parameter("vibration_mm", EDGE_mm, edge_mm), first.onset_mm, lambda m, v: each(m, onset_mm=v)),
    ]


def bumped(model: FDVVModel, bump_cN: float, bump_mm: float, snap_mm: float) -> FDVVModel:
    """Add a bump to every curve: up by bump_cN over 1 mm, peak at bump_mm, gone snap_mm behind it."""
    from scipy.interpolate import make_interp_spline

    if bump_cN == 0:
        return model

    def change(curve: ForceCurve) -> ForceCurve:
        steps = max(8, round((curve.end_mm - curve.start_mm) / GRID_mm))
        x = np.linspace(curve.start_mm, curve.end_mm, 1 + steps)
        up = np.clip((x - bump_mm + RISE_mm) / RISE_mm, 0.0, 1.0)
        down = np.clip((x - bump_mm) / snap_mm, 0.0, 1.0)
        hump = up**2 * (3 - 2 * up) - down**2 * (3 - 2 * down)
        spline = make_interp_spline(x, curve.force_cN(x) + bump_cN * hump, k=3)
        return ForceCurve(curve.stroke, curve.velocity_mm_s, 3, spline.t, spline.c)

    return replace(model, curves=tuple(change(curve) for curve in model.curves))


CONTROL_POINT = re.compile(r"(press|release)_\w+_point\d+_cN")
"""Names of handles that are single control points."""


def unknown(name: str, known: dict[str, Handle]) -> InputError:
    """Refuse a name that is no handle, with the list of those there are."""
    there = ", ".join(one for one in known if not CONTROL_POINT.fullmatch(one))
    remedy = f"use FDV, FDVV, {there}, or a control point such as press_50_point3_cN"
    return InputError("space", name, "is nothing that this button has", remedy)


FDV = ("force_ratio", "stiffness_cN_mm", "bump_cN", "bump_mm", "snap_mm", "actuation_mm")
"""Force on displacement, with the vibration of the base where it has one: what a name FDV stands for."""
POINTS = ("actuation_mm", "reset_mm", "vibration_mm")
BUMP = ("bump_cN", "bump_mm", "snap_mm")
LEAST_cN, LARGEST_cN = 5.0, 440.0
"""A cap must come back by itself, and a rig's motor gives no more."""
STEP_mm = 0.1  # assumed: some 35 places on 4 mm, for each design drawn; a narrower dip is missed


def model_parameters(base: FDVVModel) -> tuple[Parameter, ...]:
    """List what can be varied of a button, with the bounds it has by default."""
    return tuple(one.parameter for one in handles(base).values())


def model_space(
    base: FDVVModel,
    names: Sequence[str] = ("FDV",),
    bounds: Mapping[str, tuple[float, float]] | None = None,
    constraints: Sequence[Constraint] = (),
    most_cN: float | None = None,
) -> DesignSpace:
    """Return the space of variations of a button.

    Parameters
    ----------
    base : the button.
    names : of what is varied (`model_parameters`); "FDV" stands for force, stiffness, bump, actuation and
        vibration, "FDVV" for that and a scale of force per velocity.
    bounds : (low, high) by name, where the default ones do not serve.
    constraints : on top of those that a button must hold: points within the travel and in order, a force
        that brings the cap back and that a motor gives.
    most_cN : no force is larger; None: what the motor gives.

    Raises InputError on a name that the button does not have.
    """
    known = handles(base)
    chosen = _expanded(base, names, known)
    limits = bounds or {}
    for name in (*chosen, *limits):
        if name not in known or name not in chosen:
            raise unknown(name, known)
    own = [handle.parameter for name, handle in known.items() if name in chosen]
    parameters = tuple(Parameter(p.name, *limits[p.name]) if p.name in limits else p for p in own)
    held = _held(chosen, base, known, LARGEST_cN if most_cN is None else most_cN)
    return DesignSpace(f"variations of {base.name}", parameters, (*held, *constraints), BUTTON_LENGTH)


def neutral_design(space: DesignSpace, base: FDVVModel) -> dict[str, float]:
    """Return the design that leaves a button as it is, as near as the bounds of the space allow."""
    return space.nearest({name: handle.neutral for name, handle in handles(base).items()})


def model_of(base: FDVVModel, design: Design, name: str = "design") -> FDVVModel:
    """Make the variation of a button that a design names; what it does not name stays the base's."""
    return _made(base, handles(base), design, name)


def _made(base: FDVVModel, known: Mapping[str, Handle], design: Design, name: str = "design") -> FDVVModel:
    model = base
    for one, handle in known.items():
        # three numbers make one bump, which is added in the place of the first
        if one == BUMP[0]:
            model = bumped(model, *(design.get(part, known[part].neutral) for part in BUMP))
        elif one in design:
            model = handle.apply(model, design[one])
    changed = ", ".join(f"{one} {value:.4g}" for one, value in design.items())
    provenance = model.provenance
    method = "; ".join(part for part in (provenance.method, f"{base.name} with {changed}") if part)
    return replace(model, name=name, provenance=replace(provenance, method=method))


def _expanded(base: FDVVModel, names: Sequence[str], known: Collection[str]) -> tuple[str, ...]:
    """Put what they stand for in the place of FDV and FDVV."""
    vibration = tuple(one for one in known if one.startswith("vibration_"))
    speeds = tuple(one for one in known if one.startswith("force_at_"))
    words = {"FDV": (*FDV, *vibration), "FDVV": (*FDV, *vibration, *speeds)}
    if "FDVV" in names and not speeds:
        reason = f"{base.name} has no curve of known velocity"
        raise InputError("space", "FDVV", reason, "use FDV, or a button measured at some speeds")
    return tuple(dict.fromkeys(one for name in names for one in words.get(name, (name,))))


def _held(
    chosen: Collection[str], base: FDVVModel, known: Mapping[str, Handle], most_cN: float
) -> Iterator[Constraint]:
    """Return what a button must hold, with slacks in mm and cN; points first, for they cost nothing."""

    def value(design: Design, name: str) -> float:
        return design.get(name, known[name].neutral)

    def travel(design: Design) -> float:
        deepest_mm = max((design[point] for point in POINTS if point in design), default=0.0)
        return value(design, "travel_mm") - EDGE_mm - deepest_mm

    yield Constraint("travel", f"points lie {EDGE_mm:g} mm or more ahead of the stop", travel)
    if "reset_mm" in chosen:
        order = "the contact opens no deeper than it closes"
        yield Constraint("order", order, lambda d: value(d, "actuation_mm") - value(d, "reset_mm"))
    text = (
        f"force stays between {force_number(LEAST_cN)} and {force_text(most_cN, '.0f')} past the first "
        "part of the travel"
    )
    yield Constraint("force", text, lambda d: _force_slack(_curves_of(base, known, d), most_cN))


def _curves_of(base: FDVVModel, known: Mapping[str, Handle], design: Design) -> FDVVModel:
    """Make a design's curves, whatever its points: those out of order make no model at all."""
    return _made(base, known, {name: value for name, value in design.items() if name not in POINTS})


def _force_slack(model: FDVVModel, most_cN: float) -> float:
    low_cN, high_cN = force_ends_cN(model)
    return min(low_cN - LEAST_cN, most_cN - high_cN)


def force_ends_cN(model: FDVVModel) -> tuple[float, float]:
    """Return the least and the largest force of all curves; at contact a cap may be free."""
    x = np.arange(0.1 * model.travel_mm, 0.98 * model.travel_mm, STEP_mm)
    force = np.concatenate([curve.force_cN(x) for curve in model.curves])
    return float(force.min()), float(force.max())


def monotone_constraint(base: FDVVModel) -> Constraint:
    """Ask that a faster press is nowhere softer than a slower one, as dampers make it; slack in cN."""
    x, known = np.linspace(0.1, 0.9, 17), handles(base)

    def slack(design: Design) -> float:
        model = _curves_of(base, known, design)
        means = [curve.force_cN(x * model.travel_mm).mean() for curve in model.of(Stroke.PRESS)]
        return float(np.diff(means).min(initial=0.0))

    return Constraint("monotone", "on average a faster press is not softer than a slower one", slack)
