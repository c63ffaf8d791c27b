"""A simulated person as numbers; docs/explanation/simulated-users.md tells where they come from."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from types import MappingProxyType

import numpy as np

from fdvv.errors import ModelError

AT_LEAST_0 = (
    "motor_ms",
    "percept_ms",
    "block_ms",
    "lift_mm",
    "rest_spread_cN",
    "effort_noise_ratio",
    "learning_ratio",
    "fatigue_ratio",
    "strokes_Hz",
)
FREE = ("bias_ms", "anticipated_ms", "rest_cN")
RATIOS = (
    "aim_ratio",
    "anticipated_ratio",
    "isochrony_ratio",
    "adaptation_ratio",
    "pace_spread_ratio",
    "push_spread_ratio",
    "stiffness_spread_ratio",
)


@dataclass(frozen=True)
class SimulatedUser:
    """A person who plays tasks on the twin.

    Attributes
    ----------
    number : of the person in a draw.
    clock_ratio, cue_1_s, cue_delay_s, aim_ratio : of the click-timing model: c_sigma, nu, delta, c_mu.
    motor_ms : spread of a movement's onset about its plan.
    bias_ms : how late keys are reported and targets seen, alike for all buttons; the person cannot notice.
    block_ms : spread of a shift that all presses of a score share, from score to score.
    anticipated_ms, anticipated_ratio : time from the onset of movement to its felt event that is allowed for
        on a new button: a time, and a share of the stroke on the usual key.
    adaptation_ratio : share of the felt error that the next press makes up for.
    percept_ms : spread of the felt time of an event of salience 1.
    snap_cN, impact_mm_s, vibration_m_s2 : a fall of force, a speed at the stop, a vibration of salience 1.
    stiffness_N_m, damping_N_s_m, mass_kg : of the finger.
    push_cN : force beyond the bottom that is aimed at.
    rest_cN, rest_spread_cN : force of the resting finger, and how it differs from press to press.
    harder_ratio : how much harder the next press is after one that did not reach the stop.
    effort_noise_ratio : noise of the muscle, tremor with it, in proportion to its force.
    pace_mm_s : mean speed of the finger's referent on the usual key.
    isochrony_ratio : 1 where a stroke takes as long on every button, 0 where it takes in proportion to its
        length.
    lift_mm : height above the cap before a press; 0: resting.
    pace_spread_ratio, push_spread_ratio, stiffness_spread_ratio : from press to press.
    learning_ratio, learning_presses : extra spread of timing at first, and presses in which it falls to 1/e.
    fatigue_ratio : of spread added, and of force and pace lost, per thousand presses.
    strokes_Hz : most strokes a second, down and up, of rapid tapping; 0: as many as pace and length allow.

    ModelError on anything impossible.
    """

    number: int = 0
    clock_ratio: float = 0.09015
    cue_1_s: float = 19.931
    cue_delay_s: float = 0.399
    aim_ratio: float = 0.185
    motor_ms: float = 10.0
    bias_ms: float = 93.0
    block_ms: float = 0.0
    anticipated_ms: float = 0.0
    anticipated_ratio: float = 0.0
    adaptation_ratio: float = 0.05
    percept_ms: float = 20.0
    snap_cN: float = 10.0
    impact_mm_s: float = 200.0
    vibration_m_s2: float = 5.0
    stiffness_N_m: float = 450.0
    damping_N_s_m: float = 4.5
    mass_kg: float = 0.007
    push_cN: float = 150.0
    rest_cN: float = 10.0
    rest_spread_cN: float = 5.0
    harder_ratio: float = 1.5
    effort_noise_ratio: float = 0.03
    pace_mm_s: float = 100.0
    isochrony_ratio: float = 1.0
    lift_mm: float = 0.0
    pace_spread_ratio: float = 0.1
    push_spread_ratio: float = 0.15
    stiffness_spread_ratio: float = 0.15
    learning_ratio: float = 0.0
    learning_presses: float = 60.0
    fatigue_ratio: float = 0.0
    strokes_Hz: float = 0.0

    def __post_init__(self) -> None:
        for name, value in vars(self).items():
            low = -math.inf if name in FREE else 0
            high = 1 if name in RATIOS else math.inf
            # all but those listed must also be above 0
            some = value != 0 or name in (*RATIOS, *AT_LEAST_0, *FREE, "number")
            if not (math.isfinite(value) and low <= value <= high and some):
                raise ModelError(f"a simulated person cannot have {name} = {value}")


SPREADS: Mapping[str, float] = MappingProxyType(
    {
        "clock_ratio": 0.25,
        "motor_ms": 0.15,
        "adaptation_ratio": 0.4,
        "percept_ms": 0.25,
        "stiffness_N_m": 0.35,
        "damping_N_s_m": 0.15,
        "mass_kg": 0.2,
        "push_cN": 0.3,
        "rest_cN": 0.5,
        "pace_mm_s": 0.2,
        "bias_ms": 18.0,
        "anticipated_ms": 10.0,
    }
)
"""Between the people of the paper's experiment: of the logarithm, but of STRAIGHT in ms."""
STRAIGHT = ("bias_ms", "anticipated_ms")
DIFFERENT = (
    *SPREADS,
    "snap_cN",
    "impact_mm_s",
    "vibration_m_s2",
    "push_spread_ratio",
    "effort_noise_ratio",
    "harder_ratio",
    "learning_ratio",
    "fatigue_ratio",
    "block_ms",
    "strokes_Hz",
)
"""What people may differ in; new names go to the end, for a person's draws come in this order."""


@dataclass(frozen=True)
class UserSettings:
    """Who is drawn.

    Attributes
    ----------
    middle : the person in the middle of all. spreads : standard deviations between people by field of
        DIFFERENT, of the logarithm or in ms (STRAIGHT); a field that is left out does not differ.
    """

    middle: SimulatedUser = field(default_factory=SimulatedUser)
    spreads: Mapping[str, float] = field(default_factory=lambda: dict(SPREADS))

    def __post_init__(self) -> None:
        for name, spread in self.spreads.items():
            if name not in DIFFERENT or not 0 <= spread < 1e3:
                raise ModelError(f"people may differ in {', '.join(DIFFERENT)}, not in {name} by {spread}")


def draw_users(count: int, seed: int = 0, settings: UserSettings | None = None) -> tuple[SimulatedUser, ...]:
    """Draw people, two spreads either way at most; each is the same whatever count is."""
    return tuple(draw_user(number, seed, settings) for number in range(count))


def draw_user(number: int, seed: int = 0, settings: UserSettings | None = None) -> SimulatedUser:
    """Draw one person by number."""
    settings = settings or UserSettings()
    random = np.random.default_rng([seed, number])
    normal = np.clip(random.standard_normal(len(DIFFERENT)), -2, 2)
    draws = dict(zip(DIFFERENT, normal.tolist(), strict=True))
    changed = {
        name: _moved(settings.middle, name, spread * draws[name]) for name, spread in settings.spreads.items()
    }
    return replace(settings.middle, number=number, **changed)


def _moved(middle: SimulatedUser, name: str, by: float) -> float:
    value: float = getattr(middle, name)
    if name in STRAIGHT:
        return value + by
    moved = value * float(np.exp(by))
    return min(1.0, moved) if name in RATIOS else moved


def timing_spread_s(user: SimulatedUser, cue_s: float, period_s: float) -> float:
    """Return the standard deviation of a click on a target that is seen for cue_s and comes every period_s.

    The clock of the rhythm alone has a spread in proportion to the period; what is seen has one that falls
    with the time it is seen; both are weighed by their precision (Lee et al. 2018, constants as published
    with Park and Lee 2020).
    """
    clock = math.expm1(min(700.0, user.cue_1_s * cue_s))
    seen_s = (1.0 / clock if clock > 0 else math.inf) + user.cue_delay_s
    return user.clock_ratio * period_s / math.sqrt(1.0 + (period_s / seen_s) ** 2)


def aim_s(user: SimulatedUser, zone_s: float) -> float:
    """Return where a person aims from the centre of a zone that lasts zone_s: at a share of it (ibid.)."""
    return (user.aim_ratio - 0.5) * zone_s


def spread_factor(user: SimulatedUser, presses_before: int) -> float:
    """Return by what timing scatters more after so many presses: unpractised at first, tired later."""
    unpractised = user.learning_ratio * math.exp(-presses_before / user.learning_presses)
    return 1.0 + unpractised + tiredness(user, presses_before)


def tiredness(user: SimulatedUser, presses_before: int) -> float:
    """Return the share that fatigue has added to spread, and taken from force and pace, growing evenly."""
    return user.fatigue_ratio * presses_before / 1000.0
