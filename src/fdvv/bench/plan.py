"""The steps of a guided capture, and the cues that lead a person through one take."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from fdvv.errors import ModelError
from fdvv.recording.types import Stage

BETWEEN_s = 1.2
"""Time for a person to read the result of a press and to be ready again."""
COUNT_IN_s = 1.5
"""Before every press and probe."""
DWELL_s = 0.05
"""At the bottom, between down and up."""
REST_s = 1.0
"""Length of a take of the untouched bench."""
PROBE_mm_s = 0.5
"""Of the slow probe: the speed of force testers."""
CONTACT, BOTTOM = "cue contact", "cue bottom"
"""The moments of the beeps."""


@dataclass(frozen=True)
class Step:
    stage: Stage
    velocity_mm_s: float | None = None


@dataclass(frozen=True)
class CapturePlan:
    """The procedure of a capture.

    Attributes
    ----------
    paces_mm_s : mean velocities, in the order in which they are recorded.
    presses : at each velocity.
    probe : lead the cap slowly down and back first.
    shuffled : in blocks that hold each velocity once, in an order drawn from seed, not one after another.
    repeats : how often a bad press is repeated before the session continues without it.
    pace_ratio : largest relative error of a press's velocity.
    travel_mm : of the button, for the cue and to detect incomplete presses; None: as the probe measures.
    """

    paces_mm_s: tuple[float, ...] = (50.0, 100.0, 150.0, 200.0)
    presses: int = 15
    probe: bool = True
    shuffled: bool = False
    seed: int = 0
    repeats: int = 3
    pace_ratio: float = 0.35
    travel_mm: float | None = None

    def __post_init__(self) -> None:
        object.__setattr__(self, "paces_mm_s", tuple(float(v) for v in self.paces_mm_s))
        paces = self.paces_mm_s
        if not paces or not all(math.isfinite(v) and v > 0 for v in paces) or len(set(paces)) != len(paces):
            raise ModelError(f"paces_mm_s must be different speeds above 0, got {paces}")
        if self.presses < 1 or self.repeats < 0:
            raise ModelError(f"presses must be at least 1, repeats 0, got {self.presses} and {self.repeats}")
        if not 0 < self.pace_ratio <= 1:
            raise ModelError(f"pace_ratio must be above 0 and at most 1, got {self.pace_ratio}")
        if self.travel_mm is not None and not (math.isfinite(self.travel_mm) and self.travel_mm > 0):
            raise ModelError(f"travel_mm must be above 0, got {self.travel_mm}")

    def steps(self) -> tuple[Step, ...]:
        first = [Step(Stage.REST), *([Step(Stage.PROBE, PROBE_mm_s)] if self.probe else [])]
        if not self.shuffled:
            return (*first, *(Step(Stage.PRESS, v) for v in self.paces_mm_s for _ in range(self.presses)))
        random = np.random.default_rng(self.seed)
        blocks = [random.permutation(len(self.paces_mm_s)) for _ in range(self.presses)]
        return (*first, *(Step(Stage.PRESS, self.paces_mm_s[i]) for block in blocks for i in block))

    def duration_s(self, travel_mm: float, repeated: int = 0) -> float:
        """Estimate how long the capture takes, with ``repeated`` presses again at the slowest velocity."""
        steps = [*self.steps(), *[Step(Stage.PRESS, min(self.paces_mm_s))] * repeated]
        return sum(cue_length_s(step.velocity_mm_s, travel_mm) + BETWEEN_s for step in steps)


@dataclass(frozen=True)
class Outcome:
    """The takes of one step: how many were made, and whether the last was good or the repeats are used up."""

    step: Step
    tries: int = 0
    settled: bool = False


def settle(outcomes: Sequence[Outcome], step: Step, ok: bool, repeats: int) -> tuple[Outcome, ...]:
    """Count a take for the first open step of its kind; a take beyond the plan changes nothing."""
    found = list(outcomes)
    first = next((i for i, o in enumerate(found) if o.step == step and not o.settled), None)
    if first is not None:
        tries = found[first].tries + 1
        found[first] = Outcome(step, tries, ok or tries > repeats)
    return tuple(found)


def cue_length_s(velocity_mm_s: float | None, travel_mm: float) -> float:
    """Return the time from the start of a take's cue to its end."""
    if velocity_mm_s is None:
        return COUNT_IN_s + REST_s
    return COUNT_IN_s + 2 * (travel_mm / velocity_mm_s) + DWELL_s


def cue_events(velocity_mm_s: float | None, travel_mm: float) -> tuple[tuple[str, float], ...]:
    """Return the moments of the beeps, as fdvv.device.bench.Cue takes them."""
    if velocity_mm_s is None:
        return ()
    return (CONTACT, COUNT_IN_s), (BOTTOM, COUNT_IN_s + travel_mm / velocity_mm_s)
