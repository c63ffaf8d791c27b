"""The force a known rig can put under a finger: what it needs, where it saturates, what its lag takes."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from fdvv.compensate._feasible_limits import RigLimits
from fdvv.compensate._feasible_motion import Motion
from fdvv.compensate._known_rig import KnownRig
from fdvv.compensate._lag import late
from fdvv.compensate._strokes import FROM_mm, STOP_GUARD_mm
from fdvv.errors import ModelError
from fdvv.model import find_bump
from fdvv.units import FloatArray

BoolArray = npt.NDArray[np.bool_]
NOTICED_cN = 1.0
"""A command cut by less is no saturation that a finger could tell."""
LEAST_GAIN = 0.05
NEAR_mm = 0.2
"""How far beyond its peak and valley a smeared bump is looked for."""


@dataclass(frozen=True, eq=False)
class Reach:
    """One stroke as a rig could render it.

    Attributes
    ----------
    displacement_mm, intended_cN, achievable_cN : (n,) on the places asked for.
    command_cN : (n,) what the motor would have to be told.
    saturated, slewed : (n,) whether a limit of force or duty, or the slew limit, cuts that.
    lag_mm : how far the cap goes, at its fastest, until a command is felt: what learning must lead by.
    drop_cN, kept_ratio : the bump's drop, and the part of it that is left, at most 1; None without a bump.
    """

    displacement_mm: FloatArray
    intended_cN: FloatArray
    achievable_cN: FloatArray
    command_cN: FloatArray
    saturated: BoolArray
    slewed: BoolArray
    lag_mm: float
    drop_cN: float | None
    kept_ratio: float | None

    @property
    def missed_cN(self) -> float:
        """Give the mean of |intended - achievable| where a probe judges."""
        return float(np.abs(self.intended_cN - self.achievable_cN)[self.judged].mean())

    @property
    def judged(self) -> BoolArray:
        """Give the rows, (n,), that a probe judges: beyond contact, ahead of the impact at the stop."""
        x = self.displacement_mm
        return np.asarray((x >= min(FROM_mm, 0.3 * x[-1])) & (x <= x[-1] - min(STOP_GUARD_mm, 0.1 * x[-1])))


def opposed_cN(known: KnownRig, motion: Motion) -> FloatArray:
    """Give what the rig adds by itself along a motion, (n,): drag v + friction way - weight + mass a.

    Friction keeps the stroke's sign where the cap rests at the ends: it is about to move.
    """
    v, rub = motion.velocity_mm_s, known.friction_cN
    told = known.opposing_cN(v, motion.acceleration_m_s2, motion.displacement_mm)
    return np.asarray(told + rub * (motion.way - np.sign(v)))


def needed_cN(known: KnownRig, motion: Motion, intended_cN: FloatArray) -> FloatArray:
    """Give the command that a force needs, all (n,).

    (intended - drag v - friction way + weight - mass a) / gain: KnownRig's equation at a steady force.
    Raises ModelError where the coil has no gain to push with.
    """
    gain = known.gain_at(motion.displacement_mm)
    if gain.min() < LEAST_GAIN:
        raise ModelError(
            f"the known rig's gain falls to {gain.min():.2g} within this travel; identify it again"
        )
    return np.asarray((intended_cN - opposed_cN(known, motion)) / gain)


def slew(command_cN: FloatArray, most_cN: float) -> FloatArray:
    """Let a command, (n,), change by at most most_cN per row, as the firmware does."""
    if np.abs(np.diff(command_cN)).max() <= most_cN:
        return command_cN
    out = np.empty_like(command_cN)
    now = float(command_cN[0])
    for i, wanted in enumerate(command_cN.tolist()):
        now += min(max(wanted - now, -most_cN), most_cN)
        out[i] = now
    return out


def held(signal: FloatArray, step_s: float, tick_s: float) -> FloatArray:
    """Average a signal, (n,), over one tick around each row: a held command, over every phase of the tick."""
    count = max(1, round(tick_s / step_s))
    padded = np.pad(signal, (count // 2, count - 1 - count // 2), mode="edge")
    return np.asarray(np.convolve(padded, np.full(count, 1.0 / count), mode="valid"))


def smeared(signal: FloatArray, lag_s: float, step_s: float, tick_s: float) -> FloatArray:
    """Hold a signal, (n,), for a tick, pass it through a first-order lag, and advance it by both mean delays.

    What is left is what a known delay cannot explain away: narrow features, in time, get lower and wider.
    """
    # the last value stands while the lag runs out
    lag_s = max(0.0, lag_s)
    more = 1 + int(np.ceil(lag_s / step_s))
    lagged = late(np.pad(held(signal, step_s, tick_s), (0, more), mode="edge"), lag_s, step_s)
    rows = np.arange(signal.size) + lag_s / step_s
    return np.asarray(np.interp(rows, np.arange(lagged.size), lagged))


def rendered_cN(known: KnownRig, motion: Motion, command_cN: FloatArray, tick_s: float) -> FloatArray:
    """Give the force on the finger, (n,), of a command that leads by the chain's delay.

    gain command + what the rig adds, held for a tick and passed through the coil's first-order lag. A table
    is a function of the place, so learning leads a known delay, and what the rig adds changes slowly. A
    finger is not glued to the cap: below zero it loses it, and the force is zero. Source: KnownRig.
    """
    felt = known.gain_at(motion.displacement_mm) * command_cN + opposed_cN(known, motion)
    lagged = smeared(felt, known.electric_lag_s, motion.step_s, tick_s)
    return np.asarray(np.maximum(0.0, lagged), dtype=np.float64)


def reach(
    known: KnownRig,
    limits: RigLimits,
    motion: Motion,
    displacement_mm: FloatArray,
    intended_cN: FloatArray,
) -> Reach:
    """Tell what a rig makes of a curve, (n,) over rising places, in one motion.

    The command needed is cut by the force and duty limits, then by the slew limit, then smeared by holding
    and lag. Raises ModelError where the rig has no gain.
    """
    along = np.interp(motion.displacement_mm, displacement_mm, intended_cN)
    wanted = needed_cN(known, motion, along)
    most = limits.force_limit_cN
    limited = np.clip(wanted, -most, most)
    slewed = slew(limited, limits.slew_cN_tick * motion.step_s / limits.tick_s)
    felt = rendered_cN(known, motion, slewed, limits.tick_s)
    cut, late_by = (
        motion.at_places((np.abs(lost) > NOTICED_cN).astype(np.float64), displacement_mm) > 0.5
        for lost in (wanted - limited, limited - slewed)
    )
    achievable = motion.at_places(felt, displacement_mm)
    drop_cN, kept_ratio = _bump_left(displacement_mm, intended_cN, achievable)
    return Reach(
        displacement_mm,
        intended_cN,
        achievable,
        motion.at_places(wanted, displacement_mm),
        cut,
        late_by,
        float(np.abs(motion.velocity_mm_s).max()) * (known.delay_s + known.position_lag_s),
        drop_cN,
        kept_ratio,
    )


def _bump_left(
    x: FloatArray, intended_cN: FloatArray, achievable_cN: FloatArray
) -> tuple[float | None, float | None]:
    """Give the bump's drop and the part of it that is left near its place; Nones without a bump."""
    bump = find_bump(x, intended_cN)
    if bump is None:
        return None, None
    near = (x >= bump.peak_mm - NEAR_mm) & (x <= bump.valley_mm + NEAR_mm)
    left = find_bump(x[near], achievable_cN[near], least_drop_cN=0.0)
    return bump.drop_cN, min(1.0, left.drop_cN / bump.drop_cN) if left else 0.0
