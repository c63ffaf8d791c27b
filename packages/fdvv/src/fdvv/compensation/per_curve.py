"""Compensation per curve: every stroke and velocity on its own, both strokes from the same presses."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import ClassVar

import numpy as np

from fdvv.compensation.identification.balance import acting_at_mm, observe
from fdvv.compensation.method import CompensationJob, CurveOutcome, Outcome, PressCount, Trial
from fdvv.compensation.paper import PaperLaw
from fdvv.compensation.presses import rig_columns, split_strokes
from fdvv.compensation.tables import CurveState
from fdvv.errors import ModelError
from fdvv.force_text import force_text
from fdvv.model.curve import Stroke
from fdvv.model.press import Press
from fdvv.model.surface import ForceSurface

Pair = tuple[CurveState, CurveState]
"""Press and release of one velocity."""


@dataclass(frozen=True, eq=False)
class JobState:
    """The curves per velocity, the presses learned from, and what the last one changed."""

    job: CompensationJob
    pairs: tuple[Pair, ...]
    presses: int = 0
    message: str = ""


@dataclass(frozen=True)
class PerCurve:
    """Run a law of one curve over all velocities of a job.

    Attributes
    ----------
    law : applied to each curve.
    whole_surface : upload all rows and press the velocities in turn, so that a table is learned with the
        neighbours that the controller interpolates it with, at the speed it estimates. Else upload one row
        at a time, one velocity after the other, as the paper's text suggests.
    """

    law: PaperLaw = field(default_factory=PaperLaw)
    whole_surface: bool = True
    learned_rig: ClassVar[None] = None

    @property
    def name(self) -> str:
        added = self.law.additions
        whole = ("all speeds in turn",) if self.whole_surface else ()
        parts = "; ".join((*added, *whole))
        return "paper law" + (f" with {parts}" if parts else "")

    @property
    def bin_mm(self) -> float:
        return self.law.bin_mm

    def init(self, job: CompensationJob) -> JobState:
        grid = job.target.displacement_mm
        tables = zip(job.target.press_cN, job.target.release_cN, strict=True)
        pairs = tuple(
            (self.law.init(press, grid, job.force_limit_cN), self.law.init(release, grid, job.force_limit_cN))
            for press, release in tables
        )
        return JobState(job, pairs)

    def count(self, state: JobState) -> PressCount:
        each = self.law.rounds * self.law.presses_per_round
        return PressCount(state.presses, len(state.pairs) * each, len(state.pairs) * (each,))

    def trial(self, state: JobState) -> Trial | None:
        """Return the current commands of the velocity to press next; None when all are finished."""
        at = self._at(state)
        if at is None:
            return None
        rows = range(len(state.pairs)) if self.whole_surface else [at]
        tables = [np.stack([state.pairs[row][j].command_cN for row in rows]) for j in range(2)]
        target = state.job.target
        surface = ForceSurface(target.displacement_mm, target.velocity_mm_s[list(rows)], *tables)
        return Trial(surface, float(target.velocity_mm_s[at]))

    def step(self, press: Press, state: JobState) -> JobState:
        """Learn both strokes from one press. Raises ModelError if a stroke has no sample."""
        at = self._at(state)
        if at is None:
            raise ModelError("the job is finished; no press is needed")
        pair = self._learn(press, state.job, state.pairs[at])
        pairs = (*state.pairs[:at], pair, *state.pairs[at + 1 :])
        message = self._message(state.pairs[at], pair)
        return replace(state, pairs=pairs, presses=state.presses + 1, message=message)

    def explain(self, state: JobState) -> str:
        return state.message

    def done(self, state: JobState) -> Outcome:
        learned = [[self.law.done(curve) for curve in pair] for pair in state.pairs]
        speeds = state.job.target.velocity_mm_s
        curves = tuple(
            CurveOutcome(stroke, float(speeds[i]), c.errors_cN, c.mean_error_cN, c.max_error_cN, c.sentence)
            for j, stroke in enumerate(Stroke)
            for i, c in enumerate(pair[j] for pair in learned)
        )
        tables = [np.stack([pair[j].command_cN for pair in learned]) for j in range(2)]
        surface = ForceSurface(state.job.target.displacement_mm, speeds, *tables)
        complete = self._at(state) is None
        sentence = f"{state.presses} presses" if complete else f"stopped after {state.presses} presses"
        return Outcome(surface, curves, state.presses, complete, sentence)

    def rig_after(self, state: JobState) -> None:
        """Nothing is learned of the rig."""

    def _at(self, state: JobState) -> int | None:
        """Return the row to press next: the first unfinished one, or the one with the fewest presses."""
        left = [i for i, pair in enumerate(state.pairs) if not self.law.is_finished(pair[0])]
        if not self.whole_surface:
            return next(iter(left), None)
        return min(left, key=lambda i: len(state.pairs[i][0].errors_cN), default=None)

    def _learn(self, press: Press, job: CompensationJob, pair: Pair) -> Pair:
        t_s, sensed, force = rig_columns(press)
        acting = acting_at_mm(t_s, sensed, self.law.delays)
        measured = [
            observe(t_s, sensed, force, span, c.target_cN, c.grid_mm, self.law.delays)
            for span, c in zip(split_strokes(acting, job.travel_mm), pair, strict=True)
        ]
        for stroke, column in zip(Stroke, measured, strict=True):
            if not np.isfinite(column).any():
                raise ModelError(f"no sample of the {stroke} fell within the guards")
        press_state, release_state = (self.law.step(m, c)[1] for m, c in zip(measured, pair, strict=True))
        return press_state, release_state

    def _message(self, before: Pair, after: Pair) -> str:
        done = len(after[0].rounds)
        if done > len(before[0].rounds):
            rest = "the tables are averaged" if done == self.law.rounds else "the next round begins"
            return f"round {done} of {self.law.rounds} is over; {rest}"
        moved = [float(np.abs(a.command_cN - b.command_cN).max()) for a, b in zip(after, before, strict=True)]
        return (
            f"moved the press by up to {force_text(moved[0], '.1f')}, the release by up to "
            f"{force_text(moved[1], '.1f')}"
        )
