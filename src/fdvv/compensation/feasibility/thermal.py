"""How warm a curve makes the coil: in one press after another, and held at the bottom."""

from __future__ import annotations

import math
from dataclasses import asdict, dataclass

import numpy as np

from fdvv.compensate._feasible_limits import RigLimits
from fdvv.units import FloatArray

DWELL_s = 0.05
"""Rest at the bottom of a press."""


@dataclass(frozen=True)
class ThermalDose:
    """What pressing at one speed does to the coil, by the model that the firmware derates with.

    Attributes
    ----------
    rms_cN : command over a press, its dwell and its release, root mean square.
    cycle_s : how long these last.
    dwell_cN : command that holds the force at the bottom.
    rest_cN : command between presses.
    pressed_rise_K, held_rise_K : where the warmth ends if pressed without a pause, and if held down.
    presses_per_min : as many as never reach derating; None if even pressing without a pause does not.
    held_s : until derating begins from cold, held down; None if it never does.
    """

    rms_cN: float
    cycle_s: float
    dwell_cN: float
    rest_cN: float
    pressed_rise_K: float
    held_rise_K: float
    presses_per_min: float | None
    held_s: float | None

    def to_dict(self) -> dict[str, float | None]:
        """Give it as a document."""
        return asdict(self)


def rise_K(limits: RigLimits, square_cN2: float) -> float:
    """Give where the warmth ends under a mean square command: full_duty_rise (command / full duty)^2.

    Source: the firmware's supervisor, heat' = (full_duty_rise duty^2 - heat) / heat_time; so it is a model,
    at the nominal supply, of a coil whose resistance stays as it was when cold. A full duty draws no more.
    """
    return limits.full_duty_rise_K * min(1.0, square_cN2 / limits.full_duty_cN**2)


def held_until_s(limits: RigLimits, end_K: float) -> float | None:
    """Give the time from cold until derating begins: -heat ln(1 - start / end); None if it never does."""
    start = limits.derate_start_K
    return -limits.heat_s * math.log(1 - start / end_K) if end_K > start else None


def thermal_dose(
    limits: RigLimits, press_cN: FloatArray, release_cN: FloatArray, stroke_s: float, rest_cN: float
) -> ThermalDose:
    """Give the dose of commands on even times; each stroke lasts stroke_s, DWELL_s between them.

    Presses come evenly, much faster than the coil warms: with a share p of the time pressed, the rise ends
    at p times that of pressing without a pause plus 1 - p times that of rest.
    """
    most = limits.force_limit_cN
    press, release = (np.clip(c, -most, most) for c in (press_cN, release_cN))
    dwell, rest = float(press[-1]), float(np.clip(rest_cN, -most, most))
    cycle_s = 2 * stroke_s + DWELL_s
    work = stroke_s * float(np.mean(press**2) + np.mean(release**2)) + DWELL_s * dwell**2
    pressed, resting = rise_K(limits, work / cycle_s), rise_K(limits, rest**2)
    start = limits.derate_start_K
    share = (start - resting) / (pressed - resting) if pressed > start else None
    down = rise_K(limits, dwell**2)
    return ThermalDose(
        math.sqrt(work / cycle_s),
        cycle_s,
        dwell,
        rest,
        pressed,
        down,
        None if share is None else max(0.0, 60 * share / cycle_s),
        held_until_s(limits, down),
    )
