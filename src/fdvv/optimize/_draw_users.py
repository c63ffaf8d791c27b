"""Many simulated people: what they have in common, and how they differ."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from types import MappingProxyType

import numpy as np

from fdvv.errors import ModelError
from fdvv.optimize._user import SimulatedUser

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
"""Between people: of the logarithm, but of bias_ms and anticipated_ms in ms."""
STRAIGHT = ("bias_ms", "anticipated_ms")


@dataclass(frozen=True)
class UserSettings:
    """Who is drawn.

    Attributes
    ----------
    middle : the person in the middle of all. spreads : standard deviations between people by field, of the
        logarithm or in ms (STRAIGHT); a field that is not told does not differ.
    """

    middle: SimulatedUser = field(default_factory=SimulatedUser)
    spreads: Mapping[str, float] = field(default_factory=lambda: dict(SPREADS))

    def __post_init__(self) -> None:
        for name, spread in self.spreads.items():
            if name not in SPREADS or not 0 <= spread < 1e3:
                raise ModelError(f"people may differ in {', '.join(SPREADS)}, not in {name} by {spread}")


def draw_users(count: int, seed: int = 0, settings: UserSettings | None = None) -> tuple[SimulatedUser, ...]:
    """Draw people, two spreads either way at most; each is the same whatever count is."""
    return tuple(draw_user(number, seed, settings) for number in range(count))


def draw_user(number: int, seed: int = 0, settings: UserSettings | None = None) -> SimulatedUser:
    """Draw one person by number."""
    settings = settings or UserSettings()
    random = np.random.default_rng([seed, number])
    draws = dict(zip(SPREADS, np.clip(random.standard_normal(len(SPREADS)), -2, 2).tolist(), strict=True))
    changed = {
        name: _moved(settings.middle, name, spread * draws[name]) for name, spread in settings.spreads.items()
    }
    return replace(settings.middle, number=number, **changed)


def _moved(middle: SimulatedUser, name: str, by: float) -> float:
    value: float = getattr(middle, name)
    if name in STRAIGHT:
        return value + by
    moved = value * float(np.exp(by))
    return min(1.0, moved) if name.endswith("_ratio") else moved
