"""The error that would be left if learning were perfect: what no table of displacement can know."""

from __future__ import annotations

from dataclasses import asdict, dataclass

import numpy as np

from fdvv.compensate._feasible_force import Reach
from fdvv.compensate._feasible_motion import Motion
from fdvv.compensate._known_rig import DRAG_cN, KnownRig, cN_PER_g_m_s2
from fdvv.units import FloatArray

SPREAD_SPEEDS_mm_s = (0.0, 50.0, 100.0, 150.0, 200.0)
SPREAD_m_s2 = (0.0, 1.0, 1.3, 3.0, 3.1)
"""Mean absolute difference of the acceleration at one place between presses of one asked speed, and its mean;
medians over random fingers on the twin, simulated. Press and release are alike."""
PACE_RATIO = 0.1
"""Spread of the speed between presses of one asked speed, one standard deviation; assumed."""
MEAN_OF_RMS = float(np.sqrt(2 / np.pi))
"""Mean absolute value of a normal quantity, per its standard deviation."""
CALIBRATION_RATIO = 0.03
"""Of a class of finger force sensors: a data sheet's bound, which no press tells."""


@dataclass(frozen=True)
class ExpectedError:
    """An estimate of the mean |error| of a learned curve, by its parts; cN.

    Attributes
    ----------
    limits_cN : what limits and lag keep from the curve: it repeats, and learning cannot mend it.
    inertia_cN : the mass in accelerations that differ from press to press.
    pace_cN : the drag at speeds that differ from press to press.
    model_cN : what the known rig does not explain of the presses it was made from.
    mean_cN : in all: the first, and the root of the squares of the others.
    play_cN, calibration_cN : uncertainty of the sensor that learning trusts; not in mean_cN.
    """

    limits_cN: float
    inertia_cN: float
    pace_cN: float
    model_cN: float
    mean_cN: float
    play_cN: float
    calibration_cN: float

    def to_dict(self) -> dict[str, float]:
        """Give it as a document."""
        return asdict(self)


def acceleration_spread_m_s2(velocity_mm_s: float) -> float:
    """Interpolate SPREAD_m_s2; beyond 200 mm/s it grows in proportion to speed."""
    fastest = SPREAD_SPEEDS_mm_s[-1]
    found = float(np.interp(velocity_mm_s, SPREAD_SPEEDS_mm_s, SPREAD_m_s2))
    return found * max(1.0, velocity_mm_s / fastest)


def expected_error(known: KnownRig, reached: Reach, motion: Motion, velocity_mm_s: float) -> ExpectedError:
    """Estimate the mean error of a curve after learning.

    mean = mean|intended - achievable|
           + sqrt((mass spread(a))^2 + (drag 0.1 |v| 0.8)^2 + (0.8 residual)^2),
    0.8 turns a standard deviation into a mean absolute value. The parts are taken as independent.
    """
    inertia = cN_PER_g_m_s2 * abs(known.mass_g) * acceleration_spread_m_s2(velocity_mm_s)
    braking: FloatArray = DRAG_cN * known.drag_at(motion.displacement_mm) * np.abs(motion.velocity_mm_s)
    # over places, not over time: a curve's error counts every place alike
    by_place = motion.at_places(braking, reached.displacement_mm)
    pace = MEAN_OF_RMS * PACE_RATIO * float(np.abs(by_place).mean())
    model = MEAN_OF_RMS * known.residual_cN
    chance = float(np.sqrt(inertia**2 + pace**2 + model**2))
    return ExpectedError(
        limits_cN=reached.missed_cN,
        inertia_cN=inertia,
        pace_cN=pace,
        model_cN=model,
        mean_cN=reached.missed_cN + chance,
        play_cN=0.5 * known.play_cN,
        calibration_cN=CALIBRATION_RATIO * float(np.abs(reached.intended_cN).mean()),
    )
