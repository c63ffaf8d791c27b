"""Heating of the coil by repeated presses, and held at the bottom."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from fdvv.compensation.feasibility.limits import RigLimits
from fdvv.units import FloatArray

DWELL_s = 0.05
"""Rest at the bottom of a press."""


@dataclass(frozen=True)
class ThermalDose:
    """Heating by presses at one speed, by the thermal model that the firmware derates with.

    Attributes
    ----------
    rms_cN : command over a press, its dwell and its release, root mean square.
    cycle_s : their duration.
    dwell_cN : command that holds the force at the bottom.
    rest_cN : command between presses.
    pressed_rise_K, held_rise_K : steady-state rise if pressed without a pause, and if held down.
    presses_per_min : the most that never reach derating; None if pressing without a pause does not.
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


def rise_K(limits: RigLimits, square_cN2: float) -> float:
    """Return the steady-state rise of a mean square command: full_duty_rise (command / full duty)^2.

    Source: the firmware's supervisor, heat' = (full_duty_rise duty^2 - heat) / heat_time: a model
    at the nominal supply of a coil with constant resistance. Duty is limited to 1.
    """
    return limits.full_duty_rise_K * min(1.0, square_cN2 / limits.full_duty_cN**2)


def derating_onset_s(limits: RigLimits, end_K: float) -> float | None:
    """Return the time from cold until derating begins: -heat ln(1 - start / end); None if it never does."""
    start = limits.derate_start_K
    return -limits.heat_s * math.log(1 - start / end_K) if end_K > start else None


def thermal_dose(
    limits: RigLimits, press_cN: FloatArray, release_cN: FloatArray, stroke_s: float, rest_cN: float
) -> ThermalDose:
    """Return the dose of commands on even times; each stroke lasts stroke_s, with DWELL_s between them.

    Presses are periodic and short against the thermal time constant: with a duty cycle p, the rise settles
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
    often = None if share is None else max(0.0, 60 * share / cycle_s)
    down = rise_K(limits, dwell**2)
    forces = math.sqrt(work / cycle_s), cycle_s, dwell, rest
    return ThermalDose(*forces, pressed, down, often, derating_onset_s(limits, down))
