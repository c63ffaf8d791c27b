"""What a capture takes: the steps, which of them are done, and what is missing."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from fdvv.errors import ModelError
from fdvv.recording import Stage
from fdvv.workflow._capture_cue import PROBE_mm_s, cue_length_s

BETWEEN_s = 1.2
"""A person takes this long to read what became of a press and to be ready again."""


@dataclass(frozen=True)
class Step:
    """One thing to be recorded."""

    stage: Stage
    velocity_mm_s: float | None = None


@dataclass(frozen=True)
class CapturePlan:
    """The procedure of a capture.

    Attributes
    ----------
    paces_mm_s : in the order in which they are asked.
    presses : of each pace.
    probe : lead the cap slowly down and back first.
    shuffled : ask in blocks that hold each pace once, in an order drawn from seed, instead of pace by pace.
    repeats : so often a bad press is asked for again before the session goes on without it.
    pace_ratio : part by which a press may miss its pace.
    travel_mm : of the button, for the cue and to tell incomplete presses; None: as the probe tells.
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
        """Give all steps in the order in which they are asked."""
        first = [Step(Stage.REST), *([Step(Stage.PROBE, PROBE_mm_s)] if self.probe else [])]
        if not self.shuffled:
            return (*first, *(Step(Stage.PRESS, v) for v in self.paces_mm_s for _ in range(self.presses)))
        random = np.random.default_rng(self.seed)
        blocks = [random.permutation(len(self.paces_mm_s)) for _ in range(self.presses)]
        return (*first, *(Step(Stage.PRESS, self.paces_mm_s[i]) for block in blocks for i in block))

    def duration_s(self, travel_mm: float, repeated: int = 0) -> float:
        """Tell how long the whole takes a person; repeated : presses made again, at the slowest pace."""
        again = [Step(Stage.PRESS, min(self.paces_mm_s))] * repeated
        return sum(
            cue_length_s(s.stage, s.velocity_mm_s, travel_mm) + BETWEEN_s for s in (*self.steps(), *again)
        )


@dataclass(frozen=True)
class Outcome:
    """What became of the takes of one step: how many were made, and the last was good or is done without."""

    step: Step
    tries: int = 0
    settled: bool = False


def settle(outcomes: Sequence[Outcome], step: Step, ok: bool, repeats: int) -> tuple[Outcome, ...]:
    """Count a take for the first step of its kind that is open; one beyond the plan changes nothing."""
    found = list(outcomes)
    for i, outcome in enumerate(found):
        if outcome.step == step and not outcome.settled:
            tries = outcome.tries + 1
            found[i] = Outcome(step, tries, ok or tries > repeats)
            break
    return tuple(found)
