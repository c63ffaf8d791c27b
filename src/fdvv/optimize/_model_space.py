"""Spaces of buttons that are variations of one: any subset of what a model has."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np

from fdvv.errors import InputError
from fdvv.model import FDVVModel, Stroke
from fdvv.optimize._model_handles import EDGE_mm, bumped, handles, unknown
from fdvv.optimize._space import Constraint, Design, DesignSpace, Parameter

FDV = ("force_ratio", "stiffness_cN_mm", "bump_cN", "bump_mm", "snap_mm", "actuation_mm")
"""Force on displacement, with the vibration of the base where it has one: what a name FDV stands for."""
POINTS = ("actuation_mm", "reset_mm", "vibration_mm")
BUMP = ("bump_cN", "bump_mm", "snap_mm")
LEAST_cN, LARGEST_cN = 5.0, 440.0
"""A cap must come back by itself, and a rig's motor gives no more."""
STEP_mm = 0.1


def model_parameters(base: FDVVModel) -> tuple[Parameter, ...]:
    """List what can be varied of a button, with the bounds it has by default."""
    return tuple(one.parameter for one in handles(base).values())


def model_space(
    base: FDVVModel,
    names: Sequence[str] = ("FDV",),
    bounds: Mapping[str, tuple[float, float]] | None = None,
    constraints: Sequence[Constraint] = (),
) -> DesignSpace:
    """Give the space of variations of a button.

    Parameters
    ----------
    base : the button.
    names : of what is varied (`model_parameters`); "FDV" stands for force, stiffness, bump, actuation and
        vibration, "FDVV" for that and a scale of force per velocity.
    bounds : (low, high) by name, where the default ones do not serve.
    constraints : on top of those that a button must hold: points within the travel and in order, a force
        that brings the cap back and that a motor gives.

    Raises InputError on a name that the button does not have.
    """
    known = handles(base)
    chosen = _expanded(base, names)
    for name in (*chosen, *(bounds or {})):
        if name not in known or (name not in chosen):
            raise unknown(name, known)
    own = [known[name].parameter for name in known if name in chosen]
    limits = bounds or {}
    parameters = tuple(Parameter(p.name, *limits[p.name]) if p.name in limits else p for p in own)
    space = DesignSpace(f"variations of {base.name}", parameters)
    return replace(space, constraints=(*_held(space, base), *constraints))


def neutral_design(space: DesignSpace, base: FDVVModel) -> dict[str, float]:
    """Give the design that leaves a button as it is, as near as the bounds of the space allow."""
    known = handles(base)
    return {one.name: float(np.clip(known[one.name].neutral, one.low, one.high)) for one in space.parameters}


def model_of(space: DesignSpace, base: FDVVModel, design: Design, name: str = "design") -> FDVVModel:
    """Make the button of a design of a model space; what the design does not name stays the base's."""
    known = handles(base)
    model = base
    bump = {one: design.get(one, known[one].neutral) for one in BUMP}
    for one, handle in known.items():
        if one == BUMP[0]:
            model = bumped(model, bump["bump_cN"], bump["bump_mm"], bump["snap_mm"])
        elif one in design:
            model = handle.apply(model, design[one])
    changed = ", ".join(f"{one} {value:.4g}" for one, value in design.items())
    provenance = model.provenance
    method = "; ".join(part for part in (provenance.method, f"{base.name} with {changed}") if part)
    return replace(model, name=name, provenance=replace(provenance, method=method))


def _expanded(base: FDVVModel, names: Sequence[str]) -> tuple[str, ...]:
    """Put what they stand for in the place of FDV and FDVV."""
    known = handles(base)
    vibration = tuple(one for one in known if one.startswith("vibration_"))
    speeds = tuple(one for one in known if one.startswith("force_at_"))
    words = {"FDV": (*FDV, *vibration), "FDVV": (*FDV, *vibration, *speeds)}
    if "FDVV" in names and not speeds:
        reason = f"{base.name} has no curve of known velocity"
        raise InputError("space", "FDVV", reason, "use FDV, or a button measured at some speeds")
    return tuple(dict.fromkeys(one for name in names for one in words.get(name, (name,))))


def _held(space: DesignSpace, base: FDVVModel) -> tuple[Constraint, ...]:
    """Give what a button must hold, with slacks in mm and cN; points first, for they cost nothing."""
    known = handles(base)

    def value(design: Design, name: str) -> float:
        return design[name] if name in design else known[name].neutral

    def travel(design: Design) -> float:
        points = [name for name in POINTS if name in design]
        return value(design, "travel_mm") - EDGE_mm - max((design[p] for p in points), default=0.0)

    found = [
        Constraint("travel", f"points lie {EDGE_mm:g} mm or more ahead of the stop", travel),
    ]
    if "reset_mm" in space.names:
        order = "the contact opens no deeper than it closes"
        found.append(Constraint("order", order, lambda d: value(d, "actuation_mm") - value(d, "reset_mm")))
    told = f"force stays between {LEAST_cN:g} and {LARGEST_cN:g} cN past the first part of the travel"
    found.append(Constraint("force", told, lambda d: _force_slack(_curves_of(space, base, d))))
    return tuple(found)


def _curves_of(space: DesignSpace, base: FDVVModel, design: Design) -> FDVVModel:
    """Make a design's curves, whatever its points: those out of order make no model at all."""
    return model_of(space, base, {name: value for name, value in design.items() if name not in POINTS})


def _force_slack(model: FDVVModel) -> float:
    """Give how far the forces of all curves stay within limits, cN; at contact a cap may be free."""
    x = np.arange(0.1 * model.travel_mm, 0.98 * model.travel_mm, STEP_mm)
    force = np.concatenate([curve.force_cN(x) for curve in model.curves])
    return float(min(force.min() - LEAST_cN, LARGEST_cN - force.max()))


def monotone_constraint(space: DesignSpace, base: FDVVModel) -> Constraint:
    """Ask that a faster press is nowhere softer than a slower one, as dampers make it; slack in cN."""
    x = np.linspace(0.1, 0.9, 17)

    def slack(design: Design) -> float:
        model = _curves_of(space, base, design)
        curves = model.of(Stroke.PRESS)
        rows = np.array([curve.force_cN(x * model.travel_mm).mean() for curve in curves])
        return float(np.diff(rows).min(initial=0.0)) if len(rows) > 1 else 0.0

    return Constraint("monotone", "on average a faster press is not softer than a slower one", slack)
