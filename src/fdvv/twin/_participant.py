"""Somebody who takes part in a capture: how often a press goes wrong, and how. Simulated."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Literal

import numpy as np

from fdvv.errors import ModelError

WILD = ("pace", "double tap", "hesitation", "marker knocked", "sensor slipped", "marker hidden")
"""How a press can go wild: far off the pace, twice, halting midway, or the bench is hit."""


@dataclass(frozen=True)
class Participant:
    """How often presses of a session go wrong; how good ones vary is the finger's habit.

    Attributes
    ----------
    incomplete_ratio : presses that turn round before the bottom.
    wild_ratio : presses that go wrong otherwise, each in one of kinds, all equally often.
    kinds : out of WILD.
    """

    incomplete_ratio: float = 0.04
    wild_ratio: float = 0.10
    kinds: tuple[str, ...] = WILD

    def __post_init__(self) -> None:
        object.__setattr__(self, "kinds", tuple(self.kinds))
        ratios = (self.incomplete_ratio, self.wild_ratio, 1 - self.incomplete_ratio - self.wild_ratio)
        if not all(math.isfinite(r) and r >= 0 for r in ratios):
            raise ModelError(
                "incomplete_ratio and wild_ratio must be at least 0 and together at most 1, "
                f"got {self.incomplete_ratio} and {self.wild_ratio}"
            )
        if not self.kinds or not set(self.kinds) <= set(WILD):
            raise ModelError(f"kinds must be some of {', '.join(WILD)}, got {self.kinds}")


PARTICIPANTS = {
    "steady": Participant(0.0, 0.0),
    "careful": Participant(0.01, 0.02),
    "typical": Participant(),
    "clumsy": Participant(0.08, 0.25),
}
"""People by name; the ratios are assumed."""


@dataclass(frozen=True)
class Intent:
    """What becomes of one press.

    Attributes
    ----------
    outcome : in one word.
    kind : of a wild one, else empty.
    amount : part of the travel that is reached; times the asked pace; pause or gap s; jump mm; times the
        force; time hidden s.
    part : of the stroke (0 to 1) at which it happens.
    marker : which one it happens to.
    """

    outcome: Literal["good", "incomplete", "wild"] = "good"
    kind: str = ""
    amount: float = 0.0
    part: float = 0.0
    marker: int = 0


def draw_intent(participant: Participant, random: np.random.Generator) -> Intent:
    """Draw what becomes of the next press; always as many draws, so that what follows stays the same."""
    draw, amount, part, which, way, side = (float(value) for value in random.random(6))
    kind = participant.kinds[int(which * len(participant.kinds))]
    if draw < participant.incomplete_ratio:
        return Intent("incomplete", amount=0.5 + 0.4 * amount)
    if draw < participant.incomplete_ratio + participant.wild_ratio:
        return Intent("wild", kind, _amount(kind, amount, way < 0.5), 0.2 + 0.6 * part, int(2 * side))
    return Intent()


def _amount(kind: str, draw: float, fast: bool) -> float:
    ranges = {
        "pace": (1.7, 3.0) if fast else (0.3, 0.6),
        "double tap": (0.02, 0.08),
        "hesitation": (0.08, 0.3),
        "marker knocked": (0.5, 3.0),
        "sensor slipped": (0.6, 0.85),
        "marker hidden": (0.02, 0.06),
    }
    low, high = ranges[kind]
    return low + (high - low) * draw
