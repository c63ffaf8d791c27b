"""Drift detection: does a press still fit an identified rig, and if not, what changed?"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from fdvv.compensation.identification.balance import (
    BACK_EMF,
    DELAY,
    ELECTRIC,
    FRICTION,
    GAIN,
    LAG,
    MASS,
    OWN,
    PLAY,
    SIDE,
    STICK,
    VISCOUS,
    WEIGHT,
    Sensor,
    ticks_of,
)
from fdvv.compensation.identification.estimation import RigEstimation
from fdvv.compensation.identification.identify import along, parameter_vector, residual_cN
from fdvv.compensation.identification.own_force import NODES
from fdvv.compensation.identification.rig_model import Prior, RigModel
from fdvv.force_text import force_number, force_text, force_unit
from fdvv.model.press import Press
from fdvv.units import FloatArray

DRIFT_Z_THRESHOLD = 4.0
"""A change is reported beyond this many standard deviations; presses are many."""
MOST_changes = 3
OUTLIER_RESIDUAL_ratio, OUTLIER_RESIDUAL_cN = 3.0, 2.0
"""A press is an outlier if its residual exceeds that of the identification by this factor and this force."""
SHARED_ratio = 0.25
"""Part of a standard error that counts against a change: errors are correlated, and a press repeats most."""
UNINFORMATIVE_VARIANCE = 1e6
"""Variance of a change already reported, in squares of the prior's spread."""
LEAST_drag_ratio, LEAST_drag_N_s_m = 0.15, 0.2
POSITION_LAG = "position lag"
ESTIMATED = Sensor(filter_s=0.0, cone_g=0.0)
"""Of the force in the record of a press with the loop closed."""
LEAST_lag_ms, LEAST_spring_cN_mm = 0.2, 2.0
PARTS = {
    "gain": "coil",
    "drag": "mover",
    "friction": "mover",
    "weight": "mover",
    "spring": "mover",
    "mass": "mover",
    "play": "force sensor",
    POSITION_LAG: "position sensor",
    "delay": "coil driver",
}
"""Part that a change is of."""
ERRORS = {
    0: "gain",
    VISCOUS: "drag_N_s_m",
    FRICTION: "friction_cN",
    WEIGHT: "weight_cN",
    MASS: "mass_g",
    PLAY: "play_cN",
    STICK: "stick_cN",
    SIDE: "side_ratio",
    LAG: "position_lag_s",
    ELECTRIC: "electric_lag_s",
}
"""Standard error of each parameter."""


@dataclass(frozen=True, eq=False)
class _Change:
    """A possible change: name, unit, direction in parameter space, old value, least size, lower bound.

    A smaller change is not reported. The gain's is relative; the others are in the unit.
    """

    name: str
    unit: str
    along: FloatArray
    was: float
    least: float
    lowest: float = 0.0


def detect_drift(
    rig: RigModel,
    press: Press,
    travel_mm: float = float("inf"),
    prior: Prior | None = None,
    loop_closed: bool = False,
) -> str:
    """Describe what `find_drift` finds in one line; empty if nothing has changed."""
    return find_drift(rig, press, travel_mm, prior, loop_closed).summary


@dataclass(frozen=True)
class RigDrift:
    """What one press shows of a change.

    Attributes
    ----------
    summary : in one line; empty if nothing has changed. part : of which the likeliest change is; "rig" if
        none is likely.
    unexplained : the known rig leaves far more of the press than of those it was identified from.
    """

    summary: str
    unexplained: bool
    part: str = "rig"


def find_drift(
    rig: RigModel,
    press: Press,
    travel_mm: float = float("inf"),
    prior: Prior | None = None,
    loop_closed: bool = False,
) -> RigDrift:
    """Find what has changed on a rig since its identification, from one press, the most significant first.

    travel_mm : position of the bottom stop; the end of the press if not given.
    loop_closed : the press was made with the force loop closed. Its record holds the loop's estimates, of the
        place without lag and of the force at the finger.
    The press must hold its rig's own columns. Raises FitError if it is not informative enough.
    """
    prior = prior or Prior()
    if loop_closed:
        rig, prior = replace(rig, position_lag_s=0.0), replace(prior, sensor=ESTIMATED)
    problem = RigEstimation([ticks_of(press, "the press", prior.tick_s)], travel_mm, prior)
    problem.mean = numbers = parameter_vector(rig, problem.own_step_mm)
    runs = problem.runs(numbers)
    gradient, matrix = problem.normal(numbers, runs)
    outlier_cN = max(OUTLIER_RESIDUAL_ratio * rig.residual_cN, rig.residual_cN + OUTLIER_RESIDUAL_cN)
    outlier = residual_cN(problem, numbers, runs) > outlier_cN
    slopes = gradient, matrix - np.eye(numbers.size)
    possible = [c for c in _changes(rig, problem.own_step_mm) if not (loop_closed and c.name == POSITION_LAG)]
    changes = _largest_changes(problem.unroot, possible, _doubt(rig), slopes, outlier)
    messages = [_message(change, size) for change, size in changes]
    left = residual_cN(problem, numbers + sum(size * change.along for change, size in changes), runs)
    if left > outlier_cN:
        messages.append(
            f"{force_text(left, '.1f')} rms unexplained, {force_number(rig.residual_cN, '.1f')} before; "
            "identify the rig again"
        )
    return RigDrift(", ".join(messages), outlier, PARTS[changes[0][0].name] if changes else "rig")


def _largest_changes(
    unroot: FloatArray,
    changes: list[_Change],
    errors: FloatArray,
    slopes: tuple[FloatArray, FloatArray],
    outlier: bool,
) -> list[tuple[_Change, float]]:
    """Find changes one by one, the most significant first; gradient and matrix in roots of the prior.

    errors : that count against a change. For an outlier the likeliest change is returned even if it is not
    significant.
    """
    selected: list[tuple[_Change, float]] = []
    gradient, matrix = slopes
    doubt = unroot @ np.diag(errors**2) @ unroot.T
    while len(selected) < MOST_changes:
        shrunk = np.linalg.inv(np.eye(gradient.size) + matrix @ doubt)
        slope, curve = shrunk @ gradient, shrunk @ matrix
        sized = [(change, *_size(unroot @ change.along, slope, curve)) for change in changes]
        possible = [s for s in sized if s[0].was + s[1] >= min(s[0].lowest, s[0].was)]
        if not possible:
            break
        change, size, z = max(possible, key=lambda s: s[2])
        if z < DRIFT_Z_THRESHOLD and (selected or not outlier):
            break
        if abs(size) >= change.least:
            selected.append((change, size))
        changes.remove(change)
        reported = unroot @ change.along
        doubt = doubt + UNINFORMATIVE_VARIANCE * np.outer(reported, reported)
    return selected


def _size(along: FloatArray, slope: FloatArray, curve: FloatArray) -> tuple[float, float]:
    """Return the most likely size of a change, and that in standard deviations."""
    weight = max(float(along @ curve @ along), 1e-12)
    size = float(along @ slope) / weight
    return size, abs(size) * weight**0.5


def _changes(rig: RigModel, own_step_mm: float) -> list[_Change]:
    """List the possible changes: gain and drag relative to their old values, the rest in their units."""
    numbers = parameter_vector(rig, own_step_mm)
    places = own_step_mm * (np.arange(NODES, dtype=np.float64) - 0.5 * (NODES - 1))
    stiffness = float(np.polyfit(places, numbers[OWN], 1)[0])
    # a warm coil pushes and brakes less, and braking counts at gain 1 with the square of the gain
    coil = along((GAIN, numbers[GAIN]), (BACK_EMF, -numbers[BACK_EMF]))
    least_drag = max(LEAST_drag_ratio * rig.drag_N_s_m, LEAST_drag_N_s_m)
    return [
        _Change("gain", "", coil, 0.0, 0.03, -1.0),
        _Change("drag", "N s/m", along((VISCOUS, 1.0)), rig.drag_N_s_m, least_drag),
        _Change("friction", "cN", along((FRICTION, 1.0)), rig.friction_cN, 1.5),
        _Change("weight", "cN", along((WEIGHT, 1.0)), rig.weight_cN, 3.0, -np.inf),
        _Change("spring", "cN/mm", along((OWN, places)), stiffness, LEAST_spring_cN_mm, -np.inf),
        _Change("mass", "g", along((MASS, 1.0)), rig.mass_g, 2.0),
        _Change("play", "cN", along((PLAY, 0.5)), rig.play_cN, 2.0),
        _Change(POSITION_LAG, "ms", along((LAG, 1e-3)), 1e3 * rig.position_lag_s, LEAST_lag_ms),
        _Change("delay", "ms", along((DELAY, 1e-3)), 1e3 * rig.delay_s, LEAST_lag_ms),
    ]


def _doubt(rig: RigModel) -> FloatArray:
    """Return the part of the standard errors that counts against a change, (COUNT,).

    The gain's is that of its first coefficient.
    """
    errors = along(*((place, rig.error.get(name, 0.0)) for place, name in ERRORS.items()))
    errors[PLAY] *= 0.5
    errors[OWN] = rig.error.get("own_cN", 0.0)
    return SHARED_ratio * errors


def _message(change: _Change, size: float) -> str:
    moved = "rose" if size > 0 else "fell"
    if not change.unit:
        return f"{change.name} {moved} {abs(size):.0%}"
    digits = 2 if change.unit == "ms" else 1
    to = change.was + size
    share = f" ({size / change.was:+.0%})" if change.was > 0.1 * abs(size) else ""
    unit = change.unit.replace("cN", force_unit())
    write = force_number if "cN" in change.unit else format
    was, now = (write(value, f".{digits}f") for value in (change.was, to))
    return f"{change.name} {moved} from {was} to {now} {unit}{share}"
