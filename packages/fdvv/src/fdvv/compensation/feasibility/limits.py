"""Limits of a rig, motion of a stroke, and the force that is achievable along it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from fdvv.compensation.identification.balance import first_order_lag
from fdvv.compensation.identification.rig_model import RigModel
from fdvv.compensation.presses import FROM_mm, STOP_GUARD_mm
from fdvv.errors import ModelError
from fdvv.model.bump import find_bump
from fdvv.model.curve import Stroke
from fdvv.protocol.messages import CN64_PER_cN, UM16_PER_mm
from fdvv.protocol.tables import Settings
from fdvv.units import FloatArray


def full_duty_cN(settings: Settings) -> float:
    """Return the force of the motor at full duty and nominal supply, as the settings say."""
    return 32768 * 65536 / settings.duty_gain_q16 / CN64_PER_cN


@dataclass(frozen=True)
class RigLimits:
    """The settings of a rig that limit what it can render.

    Attributes
    ----------
    tick_s : period of the loop.
    force_limit_cN : largest command of either sign, the lower of force limit and duty limit.
    slew_cN_tick : largest change of the command from tick to tick.
    full_duty_cN : command at full duty.
    reversal_mm : upward distance that turns press into release.
    grain_mm : resolution of one position reading.
    heat_s : thermal time constant of the coil.
    full_duty_rise_K : steady-state temperature rise at full duty.
    derate_start_K : rise above which the force limit falls.
    """

    tick_s: float
    force_limit_cN: float
    slew_cN_tick: float
    full_duty_cN: float
    reversal_mm: float
    grain_mm: float
    heat_s: float
    full_duty_rise_K: float
    derate_start_K: float

    def __post_init__(self) -> None:
        values = list(vars(self).values())
        if not np.isfinite(values).all() or min(values) <= 0:
            raise ModelError(f"limits of a rig must be finite and above 0, got {self}")

    @classmethod
    def of_settings(cls, settings: Settings) -> RigLimits:
        """Return the limits that firmware settings imply, at the nominal supply.

        The firmware turns a force into duty without regard to speed, so both limits bound the command; what
        the coil's braking takes or adds at speed is part of the rig's own force (``inverse_dynamics_cN``).
        """
        full_cN = full_duty_cN(settings)
        duty_cN = full_cN * settings.duty_limit_q15 / 32768
        return cls(
            tick_s=1e-6 * settings.tick_us,
            force_limit_cN=min(settings.force_limit_cN64 / CN64_PER_cN, duty_cN),
            slew_cN_tick=settings.slew_cN64_tick / CN64_PER_cN,
            full_duty_cN=full_cN,
            reversal_mm=settings.reversal_um16 / UM16_PER_mm,
            grain_mm=settings.reads * abs(settings.position_gain_q14) / 2**14 / UM16_PER_mm,
            heat_s=1e-3 * settings.heat_time_ms,
            full_duty_rise_K=settings.full_duty_rise_K,
            derate_start_K=settings.derate_start_K,
        )


FINEST = 8
"""Time steps per tick."""
MOST_STEPS = 20_000
FULL_SPEED = 30.0
"""Speed of a minimum jerk is 30 s^2 (1 - s)^2 of its mean: 1.875 times it at the middle."""


@dataclass(frozen=True, eq=False)
class Motion:
    """One stroke on even times.

    Attributes
    ----------
    stroke : its direction.
    t_s, displacement_mm : (n,); the displacement never turns back.
    velocity_mm_s, acceleration_m_s2 : (n,), positive into the button.
    """

    stroke: Stroke
    t_s: FloatArray
    displacement_mm: FloatArray
    velocity_mm_s: FloatArray
    acceleration_m_s2: FloatArray

    def __post_init__(self) -> None:
        if np.any(self.direction * np.diff(self.displacement_mm) < 0) or self.t_s.size < 2:
            raise ModelError(f"a {self.stroke} needs a displacement that never turns back")

    @property
    def direction(self) -> float:
        """1 into the button, -1 out of it."""
        return 1.0 if self.stroke is Stroke.PRESS else -1.0

    @property
    def step_s(self) -> float:
        return float(self.t_s[1] - self.t_s[0])

    def at_places(self, values: FloatArray, displacement_mm: FloatArray) -> FloatArray:
        """Interpolate a column of this motion, (n,), at rising displacements."""
        order = slice(None, None, int(self.direction))
        return np.interp(displacement_mm, self.displacement_mm[order], values[order])


def minimum_jerk(stroke: Stroke, travel_mm: float, velocity_mm_s: float, tick_s: float) -> Motion:
    """Return a minimum-jerk stroke over the travel at a mean speed, at rest at both ends.

    x = travel (10 s^3 - 15 s^4 + 6 s^5), s = t velocity / travel. Eight steps per tick, 20 000 at most.
    Source: Flash and Hogan 1985. Raises ModelError unless travel and speed are above 0.
    """
    if not (travel_mm > 0 and velocity_mm_s > 0):
        raise ModelError(f"a stroke needs travel and speed above 0, got {travel_mm:g}, {velocity_mm_s:g}")
    lasts_s = travel_mm / velocity_mm_s
    count = min(MOST_STEPS, max(200, round(FINEST * lasts_s / tick_s)))
    s = np.linspace(0.0, 1.0, count + 1)
    direction = 1.0 if stroke is Stroke.PRESS else -1.0
    x = travel_mm * s**3 * (10 - 15 * s + 6 * s**2)
    v = direction * velocity_mm_s * FULL_SPEED * s**2 * (1 - s) ** 2
    a = direction * 1e-3 * velocity_mm_s / lasts_s * 2 * FULL_SPEED * s * (1 - s) * (1 - 2 * s)
    return Motion(stroke, s * lasts_s, x if direction > 0 else travel_mm - x, v, a)


BoolArray = npt.NDArray[np.bool_]
NOTICED_cN = 1.0
"""A smaller saturation is imperceptible."""
LEAST_GAIN = 0.05
NEAR_mm = 0.2
"""A smeared bump is searched this far beyond its peak and valley."""


@dataclass(frozen=True, eq=False)
class AchievableStroke:
    """One stroke as a rig can render it.

    Attributes
    ----------
    displacement_mm, intended_cN, achievable_cN : (n,) at the requested displacements.
    command_cN : (n,) the command needed.
    saturated, slewed : (n,) whether the force or duty limit, or the slew limit, cuts it.
    lag_mm : displacement during the delay, at peak speed: the lead that learning needs.
    drop_cN, kept_ratio : the bump's drop, and the part of it that remains, at most 1; None without a bump.
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
    def shortfall_cN(self) -> float:
        """Mean of |intended - achievable| over the inner rows."""
        return float(np.abs(self.intended_cN - self.achievable_cN)[self.inner_rows].mean())

    @property
    def inner_rows(self) -> BoolArray:
        """Rows, (n,), that a probe judges: after contact, before the impact at the stop."""
        x = self.displacement_mm
        return np.asarray((x >= min(FROM_mm, 0.3 * x[-1])) & (x <= x[-1] - min(STOP_GUARD_mm, 0.1 * x[-1])))


def opposing_force_cN(rig: RigModel, motion: Motion, load_cN: FloatArray | float = 0.0) -> FloatArray:
    """Return the rig's own force along a motion, (n,): drag v + friction direction + own(x) + mass a.

    Friction keeps the stroke's sign where the cap rests at the ends, about to move. load_cN : the finger's
    force, whose side load rubs.
    """
    v, rub = motion.velocity_mm_s, rig.rub_at(motion.velocity_mm_s, load_cN)
    own_cN = rig.opposing_cN(v, motion.acceleration_m_s2, motion.displacement_mm, load_cN)
    return np.asarray(own_cN + rub * (motion.direction - np.sign(v)))


def inverse_dynamics_cN(rig: RigModel, motion: Motion, intended_cN: FloatArray) -> FloatArray:
    """Return the command that a force needs, all (n,).

    (intended - drag v - friction direction - own(x) - mass a) / gain: RigModel's equation at a steady force.
    Raises ModelError if the coil's gain vanishes.
    """
    gain = rig.gain_at(motion.displacement_mm)
    if gain.min() < LEAST_GAIN:
        raise ModelError(f"the rig's gain falls to {gain.min():.2g} within this travel; identify it again")
    return np.asarray((intended_cN - opposing_force_cN(rig, motion, intended_cN)) / gain)


def slew(command_cN: FloatArray, most_cN: float) -> FloatArray:
    """Limit the change of a command, (n,), to most_cN per row, as the firmware does."""
    if np.abs(np.diff(command_cN)).max() <= most_cN:
        return command_cN
    out = np.empty_like(command_cN)
    now = float(command_cN[0])
    for i, needed in enumerate(command_cN.tolist()):
        now += min(max(needed - now, -most_cN), most_cN)
        out[i] = now
    return out


def zero_order_hold(signal: FloatArray, step_s: float, tick_s: float) -> FloatArray:
    """Average a signal, (n,), over one tick around each row: a zero-order hold, averaged over its phase."""
    count = max(1, round(tick_s / step_s))
    padded = np.pad(signal, (count // 2, count - 1 - count // 2), mode="edge")
    return np.asarray(np.convolve(padded, np.full(count, 1.0 / count), mode="valid"))


def hold_and_lag(signal: FloatArray, lag_s: float, step_s: float, tick_s: float) -> FloatArray:
    """Apply a zero-order hold and a first-order lag to a signal, (n,), and advance it by both mean delays.

    What remains is the smearing that a known delay cannot compensate.
    """
    lag_s = max(0.0, lag_s)
    # hold the last value until the lag has settled
    more = 1 + int(np.ceil(lag_s / step_s))
    held = np.pad(zero_order_hold(signal, step_s, tick_s), (0, more), mode="edge")
    lagged = first_order_lag(held, lag_s, step_s)
    rows = np.arange(signal.size) + lag_s / step_s
    return np.asarray(np.interp(rows, np.arange(lagged.size), lagged))


def finger_force_cN(rig: RigModel, motion: Motion, command_cN: FloatArray, tick_s: float) -> FloatArray:
    """Return the force on the finger, (n,), of a command that leads by the chain's delay.

    gain command + the rig's own force, held for a tick and passed through the coil's first-order lag. A table
    is a function of displacement, so learning leads a known delay, and the rig's own force changes slowly.
    The finger cannot pull: the force is at least zero. Source: RigModel.
    """
    rendered = rig.gain_at(motion.displacement_mm) * command_cN + opposing_force_cN(rig, motion)
    rendered = rendered / (1.0 - rig.side_ratio * motion.direction)
    lagged = hold_and_lag(rendered, rig.electric_lag_s, motion.step_s, tick_s)
    return np.asarray(np.maximum(0.0, lagged), dtype=np.float64)


def achievable_stroke(
    rig: RigModel, limits: RigLimits, motion: Motion, displacement_mm: FloatArray, intended_cN: FloatArray
) -> AchievableStroke:
    """Return what a rig renders of a curve, (n,) over rising displacement, in one motion.

    The needed command is cut by the force and duty limits, then by the slew limit, then smeared by hold
    and lag. Raises ModelError if the rig has no gain.
    """
    along = np.interp(motion.displacement_mm, displacement_mm, intended_cN)
    needed = inverse_dynamics_cN(rig, motion, along)
    most = limits.force_limit_cN
    limited = np.clip(needed, -most, most)
    slewed = slew(limited, limits.slew_cN_tick * motion.step_s / limits.tick_s)
    rendered = finger_force_cN(rig, motion, slewed, limits.tick_s)
    cut, late_by = (
        motion.at_places((np.abs(lost) > NOTICED_cN).astype(np.float64), displacement_mm) > 0.5
        for lost in (needed - limited, limited - slewed)
    )
    achievable, command = (motion.at_places(c, displacement_mm) for c in (rendered, needed))
    forces = displacement_mm, intended_cN, achievable
    lag_mm = float(np.abs(motion.velocity_mm_s).max()) * (rig.delay_s + rig.position_lag_s)
    return AchievableStroke(*forces, command, cut, late_by, lag_mm, *_bump_left(*forces))


def _bump_left(
    x: FloatArray, intended_cN: FloatArray, achievable_cN: FloatArray
) -> tuple[float | None, float | None]:
    """Return the bump's drop and the part of it that remains; Nones without a bump."""
    bump = find_bump(x, intended_cN)
    if bump is None:
        return None, None
    near = (x >= bump.peak_mm - NEAR_mm) & (x <= bump.valley_mm + NEAR_mm)
    left = find_bump(x[near], achievable_cN[near], least_drop_cN=0.0)
    return bump.drop_cN, min(1.0, left.drop_cN / bump.drop_cN) if left else 0.0
