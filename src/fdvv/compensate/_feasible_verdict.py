"""Can this rig follow this curve: one verdict, and for every reason one line that says what to do."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from enum import StrEnum

import numpy as np

from fdvv.compensate._balance import spans
from fdvv.compensate._feasible_force import BoolArray, Reach
from fdvv.compensate._feasible_limits import RigLimits
from fdvv.compensate._stability import BUZZES, ENOUGH, HUNTS, SPAN_mm, Stability
from fdvv.compensate._thermal import ThermalDose
from fdvv.units import FloatArray

KEPT_RATIO, LOST_RATIO = 0.9, 0.5
"""Of the bump's drop: less than the first follows in part, less than the second cannot."""
MISSED_RATIO = 0.25
"""A mean error by limits and lag beyond this part of the curve's mean force cannot."""
MISSED_cN = 2.0
"""And from this on it follows in part."""
BUSY_1_min, HELD_s = 120.0, 10.0
"""A button should bear two presses a second, and a finger that rests on it for so long."""


class Following(StrEnum):
    """How far a rig follows a curve."""

    FOLLOWS = "can follow"
    PARTLY = "follows in part"
    CANNOT = "cannot"


@dataclass(frozen=True)
class Hindrance:
    """One reason why a rig does not follow: number, place, remedy; cannot : it alone spoils the curve."""

    cannot: bool
    reason: str


@dataclass(frozen=True)
class FollowVerdict:
    """What is told of one curve; the gravest reasons come first."""

    following: Following
    reasons: tuple[str, ...]

    def __str__(self) -> str:
        return f"{self.following}: {'; '.join(self.reasons)}" if self.reasons else str(self.following)


def follow_verdict(
    reached: Reach,
    limits: RigLimits,
    stable: Stability,
    dose: ThermalDose,
    travel_limit_mm: float | None = None,
) -> FollowVerdict:
    """Judge one curve by everything that is known of it."""
    found = [*_force(reached, limits), *_bump(reached), *_stability(stable), *_warmth(dose)]
    travel_mm = float(reached.displacement_mm[-1])
    if travel_limit_mm is not None and travel_mm > travel_limit_mm:
        told = (
            f"its travel is {travel_mm:g} mm, the stop sets {travel_limit_mm:g} at most: shorten the button"
        )
        found.append(Hindrance(True, told))
    if not found and reached.missed_cN > MISSED_cN:
        told = f"holding and lag smear {reached.missed_cN:.1f} cN of it on average"
        found.append(Hindrance(False, f"{told}: press slower, or a faster loop"))
    found.sort(key=lambda hindrance: not hindrance.cannot)
    worst = Following.FOLLOWS if not found else Following.CANNOT if found[0].cannot else Following.PARTLY
    return FollowVerdict(worst, tuple(h.reason for h in found))


def _force(reached: Reach, limits: RigLimits) -> Iterator[Hindrance]:
    """Tell what force, duty and slew limits cut."""
    x, lost = reached.displacement_mm, np.abs(reached.intended_cN - reached.achievable_cN)
    grave = reached.missed_cN > MISSED_RATIO * float(np.abs(reached.intended_cN).mean())
    if reached.saturated.any():
        rows = np.flatnonzero(reached.saturated)
        at = int(rows[np.argmax(np.abs(reached.command_cN[rows]))])
        missing, most = f"up to {lost[rows].max():.0f} cN are missing", limits.force_limit_cN
        yield Hindrance(
            grave,
            f"needs a command of {reached.command_cN[at]:.0f} cN at {x[at]:.2f} mm, the limit is {most:.0f}: "
            f"{missing} {_between(x, reached.saturated)}; lower the force there, or press slower",
        )
    if reached.slewed.any():
        yield Hindrance(
            grave,
            f"changes faster than {limits.slew_cN_tick:.0f} cN per tick {_between(x, reached.slewed)}: "
            f"up to {lost[reached.slewed].max():.0f} cN are missing; soften the flank there, or raise the "
            "slew limit",
        )


def _bump(reached: Reach) -> Iterator[Hindrance]:
    """Tell how much of the bump is left."""
    if reached.drop_cN is None or reached.kept_ratio is None or reached.kept_ratio >= KEPT_RATIO:
        return
    yield Hindrance(
        reached.kept_ratio < LOST_RATIO,
        f"{100 * reached.kept_ratio:.0f} % of the bump's drop of {reached.drop_cN:.0f} cN are left: "
        "widen its flank, press slower, or a faster loop and coil",
    )


def _stability(stable: Stability) -> Iterator[Hindrance]:
    """Tell what the sampled loop does not bear."""
    slope = stable.slope
    if stable.margin < ENOUGH:
        how = "buzzes" if stable.margin < BUZZES else "may buzz"
        near = f"between {max(0.0, slope.rise_mm - SPAN_mm):.2f} and {slope.rise_mm + SPAN_mm:.2f} mm"
        yield Hindrance(
            stable.margin < BUZZES,
            f"{how} under a finger: it rises by {slope.rise_cN_mm:.0f} cN/mm, stable up to "
            f"{stable.finger_cN_mm:.0f}: shorten the loop, or soften the rise {near}",
        )
    if stable.step_margin < HUNTS:
        yield Hindrance(
            False,
            f"may buzz under a finger that pauses: release lies {stable.step_cN:.0f} cN below press at "
            f"{stable.step_mm:.2f} mm, surely quiet up to {stable.step_limit_cN:.0f}: narrow the gap, or "
            "lengthen the reversal distance",
        )


def _warmth(dose: ThermalDose) -> Iterator[Hindrance]:
    """Tell when the coil gets too warm."""
    often, held = dose.presses_per_min, dose.held_s
    if often is not None and often < BUSY_1_min:
        yield Hindrance(
            often <= 0,
            f"the coil derates at more than {often:.0f} presses a minute "
            f"({dose.rms_cN:.0f} cN rms): lower the forces, or cool the coil",
        )
    if held is not None and held < HELD_s:
        yield Hindrance(
            False,
            f"the coil derates after {held:.1f} s held at the bottom ({dose.dwell_cN:.0f} cN): "
            "lower the force at the bottom",
        )


def _between(displacement_mm: FloatArray, rows: BoolArray) -> str:
    """Name the ranges where rows, (n,) bool, hold."""
    ranges = [(float(displacement_mm[a]), float(displacement_mm[b - 1])) for a, b in spans(rows)]
    told = [
        f"between {low:.2f} and {high:.2f} mm" if high > low else f"at {low:.2f} mm" for low, high in ranges
    ]
    return " and ".join(told)
