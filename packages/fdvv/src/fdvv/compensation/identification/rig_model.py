"""The model of a rig, which turns a command into the force on the finger, and its prior."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import astuple, dataclass, field, fields

import numpy as np

from fdvv.compensation.identification.balance import (
    PARAMETERS,
    DRAG_cN,
    Sensor,
    STRIBECK_mm_s,
    cN_PER_g_m_s2,
    first_order_lag,
)
from fdvv.errors import ModelError
from fdvv.units import FloatArray


@dataclass(frozen=True)
class RigModel:
    """A rig as identified from its own presses; the finger's force at time t is

        rendered(t) = coil(t) + viscous v + rub sign(v) + own(x) - weight + mass a
        rub = friction + stick exp(-|v| / 25 mm/s) + side rendered
        coil(t) + lag coil'(t) = gain(x) command(t - delay_s + lag) + back_emf gain(x)^2 v

    with x, v, a the cap's true motion, positive into the button, and lag the electric one. To first order a
    command acts after delay_s, and the coil's delayed braking cancels some inertia. The host never sees the
    twin's parameters: every number is estimated from what a rig senses and commands, in the units of the
    finger's sensor, whose calibration it shares.

    Attributes
    ----------
    gain : (c0, c1, c2) of c0 + c1 x + c2 x^2, x in mm: force on the finger per command, with calibration,
        the coil's droop over its stroke and its resistance.
    delay_s : from the tick that commands a force to the coil's force: computing, half
        a tick of holding, and the coil's inductance.
    electric_lag_s : the part of delay_s that is a first-order lag, the coil's inductance over its resistance.
    position_lag_s : age of the sensed displacement.
    drag_N_s_m : viscous friction and, with a voltage drive, back-EMF where the gain is 1.
    back_emf_N_s_m : the coil's part of drag_N_s_m, proportional to the square of the gain.
    friction_cN : dry friction, half of the loop between both directions.
    weight_cN : mean over the travel of what pulls the cap down: the mover's weight, less the mean of springs
        and cables; negative if it hangs.
    mass_g : of all that moves with the cap.
    play_cN : hysteresis of the finger's force sensor, whole loop.
    stick_cN : friction at rest beyond friction_cN; it fades with speed (Stribeck).
    side_ratio : friction per force of the finger, from the side load on the bushing.
    own_cN : the rig's own force over displacement beside its weight, at even steps from 0, linear between
        them, held beyond; empty for none. Flexures, cables and detents make it.
    own_step_mm : between two values of own_cN.
    position_noise_mm, force_noise_cN : rms, as sensed from tick to tick.
    residual_cN : rms residual of the presses it was identified from, averaged over 8 ms.
    presses : it was identified from.
    error : standard error of every estimated number above, by its name; of ``gain`` at mid travel, of
        ``own_cN`` the rms over the travel.
    at_bound : names of the numbers that rest on a bound of their prior: the presses do not show them.
    misfit : what the presses show that the model lacks, in one sentence; empty if nothing.
    """

    gain: tuple[float, float, float] = (1.0, 0.0, 0.0)
    delay_s: float = 0.0
    electric_lag_s: float = 0.0
    position_lag_s: float = 0.0
    drag_N_s_m: float = 0.0
    back_emf_N_s_m: float = 0.0
    friction_cN: float = 0.0
    weight_cN: float = 0.0
    mass_g: float = 0.0
    play_cN: float = 0.0
    stick_cN: float = 0.0
    side_ratio: float = 0.0
    own_cN: tuple[float, ...] = ()
    own_step_mm: float = 0.25
    position_noise_mm: float = 0.0
    force_noise_cN: float = 0.0
    residual_cN: float = 0.0
    presses: int = 0
    error: Mapping[str, float] = field(default_factory=dict)
    at_bound: tuple[str, ...] = ()
    misfit: str = ""

    def __post_init__(self) -> None:
        numbers = [value for f in fields(self) if isinstance(value := getattr(self, f.name), (int, float))]
        if not np.isfinite([*numbers, *self.gain, *self.own_cN, *self.error.values()]).all():
            raise ModelError(f"a rig model needs finite numbers, got {self}")
        if not (self.own_step_mm > 0 and abs(self.side_ratio) < 1):
            raise ModelError(f"a rig model needs own_step_mm above 0 and side_ratio within 1, got {self}")

    def gain_at(self, displacement_mm: FloatArray) -> FloatArray:
        """Return the gain, force on the finger per command, the shape of displacement_mm."""
        c0, c1, c2 = self.gain
        return np.asarray(c0 + displacement_mm * (c1 + displacement_mm * c2))

    def drag_at(self, displacement_mm: FloatArray) -> FloatArray:
        """Return the drag in N s/m, the shape of displacement_mm."""
        braking = self.back_emf_N_s_m * self.gain_at(displacement_mm) ** 2
        return np.asarray(self.drag_N_s_m - self.back_emf_N_s_m + braking)

    def own_at(self, displacement_mm: FloatArray) -> FloatArray:
        """Return the rig's own force against the finger at rest, weight included, of any shape."""
        if not self.own_cN:
            return np.full(np.shape(displacement_mm), -self.weight_cN)
        steps = self.own_step_mm * np.arange(len(self.own_cN))
        return np.asarray(np.interp(displacement_mm, steps, self.own_cN) - self.weight_cN)

    def rub_at(self, velocity_mm_s: FloatArray, load_cN: FloatArray | float = 0.0) -> FloatArray:
        """Return the dry friction at a speed of either sign under a finger's force, without direction."""
        stick = self.stick_cN * np.exp(-np.abs(velocity_mm_s) / STRIBECK_mm_s)
        return np.asarray(self.friction_cN + stick + self.side_ratio * load_cN)

    def opposing_cN(
        self,
        velocity_mm_s: FloatArray,
        acceleration_m_s2: FloatArray,
        displacement_mm: FloatArray,
        load_cN: FloatArray | float = 0.0,
    ) -> FloatArray:
        """Return the force on the finger that the rig itself adds in a motion at zero command, all (n,).

        load_cN : the finger's force, whose side load rubs.
        """
        drag = self.drag_at(displacement_mm)
        emf = drag - (self.drag_N_s_m - self.back_emf_N_s_m)
        rub = self.rub_at(velocity_mm_s, load_cN) * np.sign(velocity_mm_s)
        late_g = 1000.0 * emf * self.electric_lag_s
        inertia = cN_PER_g_m_s2 * (self.mass_g - late_g) * acceleration_m_s2
        return np.asarray(DRAG_cN * drag * velocity_mm_s + rub + self.own_at(displacement_mm) + inertia)

    def coil_cN(
        self,
        t_s: FloatArray,
        displacement_mm: FloatArray,
        velocity_mm_s: FloatArray,
        commanded_cN: FloatArray,
    ) -> FloatArray:
        """Return the force of the coil, including its braking, (n,) as every column, on even times.

        commanded_cN : as decided at t_s, interpolated linearly; the zero-order hold is part of delay_s.
        """
        pushed = np.interp(t_s - self.delay_s + self.electric_lag_s, t_s, commanded_cN)
        emf = DRAG_cN * self.back_emf_N_s_m * self.gain_at(displacement_mm) ** 2
        coil = self.gain_at(displacement_mm) * pushed + emf * velocity_mm_s
        return first_order_lag(coil, self.electric_lag_s, float(t_s[1] - t_s[0]))

    def finger_force_cN(
        self,
        t_s: FloatArray,
        displacement_mm: FloatArray,
        velocity_mm_s: FloatArray,
        acceleration_m_s2: FloatArray,
        commanded_cN: FloatArray,
    ) -> FloatArray:
        """Return the force on the finger between the stops, (n,) as every column; see coil_cN()."""
        coil = self.coil_cN(t_s, displacement_mm, velocity_mm_s, commanded_cN)
        viscous = DRAG_cN * (self.drag_N_s_m - self.back_emf_N_s_m) * velocity_mm_s
        way = np.sign(velocity_mm_s)
        rest = viscous + self.rub_at(velocity_mm_s) * way + self.own_at(displacement_mm)
        rest = rest + cN_PER_g_m_s2 * self.mass_g * acceleration_m_s2
        return np.asarray((coil + rest) / (1.0 - self.side_ratio * way))


@dataclass(frozen=True)
class Plausible:
    """Prior of a parameter: mean, spread and bounds."""

    mean: float
    spread: float
    low: float = -np.inf
    high: float = np.inf

    def __post_init__(self) -> None:
        if not (self.spread > 0 and self.low <= self.mean <= self.high):
            raise ModelError(f"a prior needs a spread above 0 and a mean within its bounds, got {self}")


RANGES: Mapping[str, Plausible] = {
    "gain_0": Plausible(0.9, 0.15, 0.2, 3.0),
    "gain_1": Plausible(0.07, 0.06),
    "gain_2": Plausible(-0.011, 0.012),
    "viscous_N_s_m": Plausible(0.5, 0.3, 0.0),
    "back_emf_N_s_m": Plausible(3.0, 4.0),
    "friction_cN": Plausible(4.0, 3.0, 0.0),
    "weight_cN": Plausible(20.0, 20.0),
    "mass_g": Plausible(22.0, 8.0, 1.0),
    "half_play_cN": Plausible(1.5, 1.0, 0.0, 5.0),
    "stick_cN": Plausible(0.0, 1.5),
    "side_ratio": Plausible(0.0, 0.02),
    "position_lag_s": Plausible(9e-4, 4e-4, 5e-5, 4e-3),
    "electric_lag_s": Plausible(5e-4, 4e-4, 2e-5, 4e-3),
}
"""Priors for voice coils of CLASS_N at full duty with their transformers and bushings."""
CLASS_N = (5.0, 35.0)  # movers of 22 +- 8 g, friction of 4 +- 3 cN (docs: files.md); its ends are assumed
SIZED = ("viscous_N_s_m", "back_emf_N_s_m", "friction_cN", "weight_cN", "mass_g", "stick_cN")


def size_of(full_duty_N: float) -> float:
    """Return how much weaker (below 1) or stronger a rig is than the class of RANGES; 1 within it."""
    weakest, strongest = CLASS_N
    return min(1.0, full_duty_N / weakest) * max(1.0, full_duty_N / strongest)


def ranges_of(full_duty_N: float | None) -> Mapping[str, Plausible]:
    """Return the priors of a rig of this force at full duty; None: of the class.

    Movers, friction and drag go with the force. How well is less known beyond the class: the spread of a
    weaker rig falls with the square root only, and that of a stronger one grows as its mean does.
    """
    size = 1.0 if full_duty_N is None else size_of(full_duty_N)
    spread = max(size, size**0.5)
    sized = {
        name: Plausible(size * known.mean, spread * known.spread, min(1.0, size) * known.low, known.high)
        for name, known in RANGES.items()
        if name in SIZED
    }
    return {**RANGES, **sized}


@dataclass(frozen=True)
class Prior:
    """Prior of a rig, before any press.

    Attributes
    ----------
    tick_s : period of its loop; from the record if None.
    sensor : the finger's force sensor.
    compute_ratio, compute_spread_ratio : from sample to drive, in ticks, without the half tick of holding.
    ranges : of the other parameters, by their names in RANGES; ranges_of supplies the missing ones.
    full_duty_N : force of the motor at full duty; None: within CLASS_N.
    spring_N_m : of the mover, its mean and spread; (0, 0): what the presses show.
    """

    tick_s: float | None = None
    sensor: Sensor = field(default_factory=Sensor)
    compute_ratio: float = 0.4
    compute_spread_ratio: float = 0.2
    ranges: Mapping[str, Plausible] = field(default_factory=dict)
    full_duty_N: float | None = None
    spring_N_m: tuple[float, float] = (0.0, 0.0)

    def __post_init__(self) -> None:
        unknown = set(self.ranges) - set(RANGES)
        if unknown:
            names, known = ", ".join(sorted(unknown)), ", ".join(RANGES)
            raise ModelError(f"no rig parameter is called {names}; choose from {known}")
        if not (0 <= self.compute_ratio <= 1 and self.compute_spread_ratio > 0):
            ratio = self.compute_ratio
            raise ModelError(f"compute_ratio must be in 0..1 and its spread above 0, got {ratio}")

    def vectors(self, tick_s: float) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray]:
        """Return means, spreads, lower and upper bounds, in the order of PARAMETERS."""
        mean_s, spread_s = (0.5 + self.compute_ratio) * tick_s, self.compute_spread_ratio * tick_s
        delay = Plausible(mean_s, spread_s, 0.5 * tick_s, 1.5 * tick_s)
        ranges = {**ranges_of(self.full_duty_N), **self.ranges, "command_delay_s": delay}
        rows = np.array([astuple(ranges[name]) for name in PARAMETERS])
        return rows[:, 0], rows[:, 1], rows[:, 2], rows[:, 3]
