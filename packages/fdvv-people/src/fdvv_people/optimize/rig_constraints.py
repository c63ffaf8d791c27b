"""What a rig asks of a design: that it can render the button, without a buzz."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import lru_cache

import numpy as np

from fdvv.errors import ModelError
from fdvv.model.model import FDVVModel
from fdvv.rendering.feasibility import CurveFeasibility, feasibility
from fdvv.rendering.rig_catalog import AvailableRig
from fdvv_people.optimize.space import Constraint, Design

MISSED_RATIO = 0.25
"""Of a curve's mean force; where limits and lag keep more of it, a feasibility report calls it spoilt."""
KEPT_RATIO = 0.5
"""Of a bump's drop; a report says that less cannot be followed."""
LEAST_MARGIN_RATIO = 0.5
"""Of stiffness under a finger; a report says that less buzzes."""
MOST_MARGIN_RATIO = 10.0
"""A flat curve's margin has no end; more than this says nothing."""


def rig_constraints(
    rig: AvailableRig,
    designer: Callable[[Design], FDVVModel],
    velocities_mm_s: Sequence[float] = (100.0,),
) -> tuple[Constraint, Constraint]:
    """Return the constraints that a rig puts on designs: what it misses of the force, and whether it buzzes.

    rig : known, of a RigCatalog. designer : turns a design into a button.
    velocities_mm_s : at which presses and releases are judged.

    Slacks are continuous: parts of the mean force, and a margin of stiffness; they are those of
    `feasibility`, some 20 ms a speed, kept for designs that were judged. A design that makes no model, or
    goes deeper than the rig's stop, misses all.
    """
    speeds = tuple(velocities_mm_s)

    @lru_cache(maxsize=4096)
    def judged(key: tuple[tuple[str, float], ...]) -> tuple[float, float]:
        try:
            model = designer(dict(key))
            report = feasibility(model, rig.known, rig.settings, speeds, info=rig.info)
        except ModelError:
            return -1.0, -1.0
        beyond = max(0.0, model.travel_mm - rig.info.travel_limit_mm)
        slack = min(_slack(curve) for curve in report.curves)
        margin = min(curve.stable.margin for curve in report.curves)
        return slack - beyond, min(margin - LEAST_MARGIN_RATIO, MOST_MARGIN_RATIO)

    name = rig.entry.rig_id
    force = f"{name} gives the force and the bump, as its limits and lag let it"
    stability = f"{name} does not buzz under a finger"
    return (
        Constraint("rig force", force, lambda design: judged(tuple(design.items()))[0]),
        Constraint("rig stability", stability, lambda design: judged(tuple(design.items()))[1]),
    )


def _slack(curve: CurveFeasibility) -> float:
    """Return the slack of one curve: of the mean force that is missed, and of the bump that is left."""
    reached = curve.reached
    missed = reached.shortfall_cN / max(1.0, float(np.abs(reached.intended_cN).mean()))
    kept = 1.0 if reached.kept_ratio is None else reached.kept_ratio
    return min(MISSED_RATIO - missed, kept - KEPT_RATIO)
