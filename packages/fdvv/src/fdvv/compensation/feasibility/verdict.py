"""The feasibility of a curve on a rig: a verdict, its reasons with remedies, and the expected error."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from enum import StrEnum

import numpy as np

from fdvv.compensation.feasibility.limits import AchievableStroke, BoolArray, Motion, RigLimits
from fdvv.compensation.feasibility.stability import BUZZES, ENOUGH, HUNTS, SPAN_mm, Stability
from fdvv.compensation.feasibility.thermal import ThermalDose
from fdvv.compensation.identification.balance import DRAG_cN, cN_PER_g_m_s2, true_runs
from fdvv.compensation.identification.rig_model import RigModel
from fdvv.force_text import force_number, force_text
from fdvv.units import FloatArray

KEPT_RATIO, LOST_RATIO = 0.9, 0.5
"""Parts of the bump's drop: below the first the rig follows in part, below the second it cannot."""
MISSED_RATIO = 0.25
"""A mean error by limits and lag beyond this part of the curve's mean force means "cannot"."""
MISSED_cN = 2.0
"""A larger mean error means "follows in part"."""
BUSY_1_min, HELD_s = 120.0, 10.0
"""A button should withstand two presses a second, and a finger resting on it for this long."""


class Following(StrEnum):
    """How far a rig follows a curve."""

    FOLLOWS = "can follow"
    PARTLY = "follows in part"
    CANNOT = "cannot"


@dataclass(frozen=True)
class InfeasibilityReason:
    """One reason why a rig does not follow a curve, with remedy; cannot : this alone rules the curve out."""

    cannot: bool
    reason: str


@dataclass(frozen=True)
class FollowVerdict:
    """The verdict on one curve; the gravest reasons come first."""

    following: Following
    reasons: tuple[str, ...]

    def __str__(self) -> str:
        return f"{self.following}: {'; '.join(self.reasons)}" if self.reasons else str(self.following)


def follow_verdict(
    reached: AchievableStroke,
    limits: RigLimits,
    stable: Stability,
    dose: ThermalDose,
    travel_limit_mm: float | None = None,
) -> FollowVerdict:
    """Combine achievable force, stability, heating and travel into the verdict on one curve."""
    reasons = [*_force(reached, limits), *_bump(reached), *_stability(stable), *_warmth(dose)]
    travel_mm = float(reached.displacement_mm[-1])
    if travel_limit_mm is not None and travel_mm > travel_limit_mm:
        text = f"its travel is {travel_mm:g} mm, the stop allows {travel_limit_mm:g}: shorten the button"
        reasons.append(InfeasibilityReason(True, text))
    if not reasons and reached.shortfall_cN > MISSED_cN:
        text = f"holding and lag smear {force_text(reached.shortfall_cN, '.1f')} of it on average"
        reasons.append(InfeasibilityReason(False, f"{text}: press slower, or use a faster loop"))
    reasons.sort(key=lambda reason: not reason.cannot)
    worst = Following.FOLLOWS if not reasons else Following.CANNOT if reasons[0].cannot else Following.PARTLY
    return FollowVerdict(worst, tuple(reason.reason for reason in reasons))


def _force(reached: AchievableStroke, limits: RigLimits) -> Iterator[InfeasibilityReason]:
    x, lost = reached.displacement_mm, np.abs(reached.intended_cN - reached.achievable_cN)
    grave = reached.shortfall_cN > MISSED_RATIO * float(np.abs(reached.intended_cN).mean())
    if reached.saturated.any():
        rows = np.flatnonzero(reached.saturated)
        at = int(rows[np.argmax(np.abs(reached.command_cN[rows]))])
        missing, most = f"up to {force_text(lost[rows].max(), '.0f')} are missing", limits.force_limit_cN
        yield InfeasibilityReason(
            grave,
            f"needs a command of {force_text(reached.command_cN[at], '.0f')} at {x[at]:.2f} mm, the limit is "
            f"{force_number(most, '.0f')}: "
            f"{missing} {_between(x, reached.saturated)}; lower the force there, or press slower",
        )
    if reached.slewed.any():
        yield InfeasibilityReason(
            grave,
            f"changes faster than {force_text(limits.slew_cN_tick, '.0f')} per tick "
            f"{_between(x, reached.slewed)}: "
            f"up to {force_text(lost[reached.slewed].max(), '.0f')} are missing; soften the flank there, or "
            "raise the "
            "slew limit",
        )


def _bump(reached: AchievableStroke) -> Iterator[InfeasibilityReason]:
    if reached.drop_cN is None or reached.kept_ratio is None or reached.kept_ratio >= KEPT_RATIO:
        return
    yield InfeasibilityReason(
        reached.kept_ratio < LOST_RATIO,
        f"{100 * reached.kept_ratio:.0f} % of the bump's drop of {force_text(reached.drop_cN, '.0f')} are "
        "left: "
        "widen its flank, press slower, or use a faster loop and coil",
    )


def _stability(stable: Stability) -> Iterator[InfeasibilityReason]:
    slope = stable.slope
    if stable.margin < ENOUGH:
        how = "buzzes" if stable.margin < BUZZES else "may buzz"
        near = f"between {max(0.0, slope.rise_mm - SPAN_mm):.2f} and {slope.rise_mm + SPAN_mm:.2f} mm"
        yield InfeasibilityReason(
            stable.margin < BUZZES,
            f"{how} under a finger: it rises by {force_text(slope.rise_cN_mm, '.0f', per='/mm')}, stable up "
            "to "
            f"{force_number(stable.finger_cN_mm, '.0f')}: shorten the loop, or soften the rise {near}",
        )
    if stable.step_margin < HUNTS:
        yield InfeasibilityReason(
            False,
            f"may buzz under a finger that pauses: release lies {force_text(stable.step_cN, '.0f')} below "
            "press at "
            f"{stable.step_mm:.2f} mm, stable up to {force_number(stable.step_limit_cN, '.0f')}: narrow the "
            "gap, or "
            "lengthen the reversal distance",
        )


def _warmth(dose: ThermalDose) -> Iterator[InfeasibilityReason]:
    often, held = dose.presses_per_min, dose.held_s
    if often is not None and often < BUSY_1_min:
        yield InfeasibilityReason(
            often <= 0,
            f"the coil derates at more than {often:.0f} presses a minute "
            f"({force_text(dose.rms_cN, '.0f')} rms): lower the forces, or cool the coil",
        )
    if held is not None and held < HELD_s:
        yield InfeasibilityReason(
            False,
            f"the coil derates after {held:.1f} s held at the bottom ({force_text(dose.dwell_cN, '.0f')}): "
            "lower the force at the bottom",
        )


def _between(displacement_mm: FloatArray, rows: BoolArray) -> str:
    ranges = [(displacement_mm[a], displacement_mm[b - 1]) for a, b in true_runs(rows)]
    return " and ".join(
        f"between {low:.2f} and {high:.2f} mm" if high > low else f"at {low:.2f} mm" for low, high in ranges
    )


SPREAD_SPEEDS_mm_s = (0.0, 50.0, 100.0, 150.0, 200.0)
SPREAD_m_s2 = (0.0, 1.0, 1.3, 3.0, 3.1)
"""Mean absolute difference of the acceleration at one displacement between presses at one requested speed;
medians over random fingers on the twin, simulated. Press and release are equal."""
PACE_RATIO = 0.1
"""Relative standard deviation of the speed between presses at one requested speed; assumed."""
MEAN_OF_RMS = float(np.sqrt(2 / np.pi))
"""Mean absolute value of a normal quantity, per its standard deviation."""
CALIBRATION_RATIO = 0.03
"""Calibration error of a class of finger force sensors, from data sheets: presses cannot reveal it."""


@dataclass(frozen=True)
class ExpectedError:
    """Estimated mean |error| of a learned curve, by its parts; cN.

    Attributes
    ----------
    limits_cN : by limits and lag: systematic, learning cannot remove it.
    inertia_cN : by accelerations that differ from press to press.
    pace_cN : by drag at speeds that differ from press to press.
    model_cN : by the residual of the rig model.
    mean_cN : total: the first plus the root sum of squares of the others.
    play_cN, calibration_cN : uncertainty of the sensor that learning relies on; not in mean_cN.
    """

    limits_cN: float
    inertia_cN: float
    pace_cN: float
    model_cN: float
    mean_cN: float
    play_cN: float
    calibration_cN: float


def acceleration_spread_m_s2(velocity_mm_s: float) -> float:
    """Interpolate SPREAD_m_s2; beyond 200 mm/s it is proportional to speed."""
    fastest = SPREAD_SPEEDS_mm_s[-1]
    spread = float(np.interp(velocity_mm_s, SPREAD_SPEEDS_mm_s, SPREAD_m_s2))
    return spread * max(1.0, velocity_mm_s / fastest)


def estimate_error(
    rig: RigModel, reached: AchievableStroke, motion: Motion, velocity_mm_s: float
) -> ExpectedError:
    """Estimate the mean error of a curve after learning.

    mean = mean|intended - achievable|
           + sqrt((mass spread(a))^2 + (drag 0.1 |v| 0.8)^2 + (0.8 residual)^2),
    0.8 turns a standard deviation into a mean absolute value. The parts are taken as independent.
    """
    inertia = cN_PER_g_m_s2 * abs(rig.mass_g) * acceleration_spread_m_s2(velocity_mm_s)
    braking: FloatArray = DRAG_cN * rig.drag_at(motion.displacement_mm) * np.abs(motion.velocity_mm_s)
    # averaged over displacement, not time, as a curve's error is
    by_place = motion.at_places(braking, reached.displacement_mm)
    pace = MEAN_OF_RMS * PACE_RATIO * float(np.abs(by_place).mean())
    model = MEAN_OF_RMS * rig.residual_cN
    chance = float(np.sqrt(inertia**2 + pace**2 + model**2))
    missed, play = reached.shortfall_cN, 0.5 * rig.play_cN
    calibration = CALIBRATION_RATIO * float(np.abs(reached.intended_cN).mean())
    return ExpectedError(missed, inertia, pace, model, missed + chance, play, calibration)
