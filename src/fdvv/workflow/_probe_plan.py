"""Which presses a probe needs."""

from __future__ import annotations

from dataclasses import dataclass

from fdvv.compensate import UNTUNED, Count, Trial, Tuning
from fdvv.errors import ModelError
from fdvv.model import ForceSurface, Press

Found = tuple[tuple[Press, ...], ...]
"""Presses of every velocity, in the order of the plan."""


@dataclass(frozen=True, eq=False)
class ProbePlan:
    """So many presses of one surface under one tuning at every velocity, one velocity after the other."""

    surface: ForceSurface
    velocities_mm_s: tuple[float, ...]
    presses: int
    tuning: Tuning = UNTUNED

    def init(self) -> Found:
        """Begin."""
        return ((),) * len(self.velocities_mm_s)

    def trial(self, found: Found) -> Trial | None:
        """Press the first velocity that lacks presses; None when none does."""
        at = self._at(found)
        return None if at is None else Trial(self.surface, self.velocities_mm_s[at], self.tuning)

    def step(self, press: Press, found: Found) -> Found:
        """Add a press to those of the velocity that was asked for. ModelError if none was."""
        at = self._at(found)
        if at is None:
            raise ModelError("the probe is finished; no press was asked for")
        return (*found[:at], (*found[at], press), *found[at + 1 :])

    def count(self, found: Found) -> Count:
        """Count presses."""
        wanted = (self.presses,) * len(self.velocities_mm_s)
        return Count(sum(map(len, found)), sum(wanted), wanted)

    def explain(self, found: Found) -> str:
        """Say nothing: a probe changes nothing."""
        return ""

    def _at(self, found: Found) -> int | None:
        return next((i for i, presses in enumerate(found) if len(presses) < self.presses), None)
