"""What a finger tells of a press, and how well: the most salient event sets when the press is felt."""

from __future__ import annotations

import math
from dataclasses import dataclass
from enum import StrEnum

from fdvv.optimize._user import SimulatedUser

FAINTEST = 0.05
"""Salience that no press falls below: a finger knows about its movement without any event."""


class Cue(StrEnum):
    """Kinds of tactile events: the fall of force at a snap, the blow at the stop, the vibration."""

    SNAP = "snap"
    IMPACT = "impact"
    VIBRATION = "vibration"


@dataclass(frozen=True)
class TactileEvent:
    """Something that a finger may feel in a press.

    Attributes
    ----------
    cue : its kind. time_s : when, on the clock of the press.
    strength : fall of force (cN), speed at the stop (mm/s) or acceleration (m/s²).
    """

    cue: Cue
    time_s: float
    strength: float


@dataclass(frozen=True)
class Percept:
    """When a press is felt, and with what spread (s)."""

    time_s: float
    spread_s: float


def salience(user: SimulatedUser, event: TactileEvent) -> float:
    """Give how much an event stands out, 1 at the strength that the person has for its kind."""
    units = {Cue.SNAP: user.snap_cN, Cue.IMPACT: user.impact_mm_s, Cue.VIBRATION: user.vibration_m_s2}
    return max(0.0, event.strength) / units[event.cue]


def percept_of(user: SimulatedUser, events: tuple[TactileEvent, ...], end_s: float) -> Percept:
    """Give what is felt: the most salient event, spread by percept_ms / sqrt(salience), or the end."""
    best = max(events, key=lambda event: salience(user, event), default=None)
    clear = salience(user, best) if best else 0.0
    time_s = best.time_s if best and clear > FAINTEST else end_s
    return Percept(time_s, 1e-3 * user.percept_ms / math.sqrt(max(clear, FAINTEST)))
