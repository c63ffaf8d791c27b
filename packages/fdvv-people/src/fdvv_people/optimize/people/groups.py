"""Groups of simulated people; docs/explanation/simulated-users.md says where their numbers come from."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType

from fdvv.errors import InputError
from fdvv_people.optimize.people.user import SPREADS, SimulatedUser, UserSettings

DIVERSE = UserSettings(
    SimulatedUser(
        bias_ms=-18.0,
        block_ms=15.0,
        anticipated_ratio=0.3,
        isochrony_ratio=0.0,
        adaptation_ratio=0.05,
        pace_mm_s=70.0,
        learning_ratio=0.2,
        fatigue_ratio=0.1,
    ),
    {
        **SPREADS,
        "motor_ms": 0.3,
        "adaptation_ratio": 0.75,
        "pace_mm_s": 0.35,
        "bias_ms": 42.0,
        "anticipated_ms": 25.0,
        "snap_cN": 0.7,
        "impact_mm_s": 0.7,
        "vibration_m_s2": 0.7,
        "push_spread_ratio": 0.3,
        "effort_noise_ratio": 0.25,
        "harder_ratio": 0.15,
        "learning_ratio": 0.5,
        "fatigue_ratio": 0.5,
        "block_ms": 0.3,
    },
)
"""People whose best buttons differ: early and late, quick and slow, each relies on a cue of their own."""

TAPPERS = UserSettings(SimulatedUser(strokes_Hz=6.0), {**SPREADS, "strokes_Hz": 0.08})
"""The paper's people with the limit of a finger that taps: 5.1 to 7.0 strokes a second."""

PAPER_GROUP = "paper"
GROUPS: Mapping[str, UserSettings] = MappingProxyType({PAPER_GROUP: UserSettings(), "diverse": DIVERSE})
"""By name: `paper` reproduces the means of CHI 2020, where everybody presses late."""


def group_named(name: str) -> UserSettings:
    """Return who is drawn in a group. Raises InputError on an unknown one."""
    if name not in GROUPS:
        raise InputError("people", name, "is no group of simulated people", f"use one of {', '.join(GROUPS)}")
    return GROUPS[name]
