"""Compensation that knows its rig: identify it, feed forward, learn only what is left."""

from __future__ import annotations

from dataclasses import dataclass, field, replace

import numpy as np

from fdvv.compensate._balance import Sensor
from fdvv.compensate._explain import explain as explain_rig
from fdvv.compensate._feed_forward import tuning_of
from fdvv.compensate._felt import Pass, passes
from fdvv.compensate._identification_surface import identification_surface
from fdvv.compensate._identify import identify
from fdvv.compensate._known_rig import KnownRig
from fdvv.compensate._method import Count, Job, Outcome, Trial
from fdvv.compensate._rig_learning import Felt, Learning, Pair, believed, commands, felt_off, learn_stroke
from fdvv.compensate._rig_memory import RigMemory
from fdvv.compensate._rig_outcome import curves_of, held_up, kept_rows, told_of
from fdvv.compensate._tuning import UNTUNED, Tuning
from fdvv.errors import FitError, ModelError
from fdvv.model import ForceSurface, Press

ANY_PACE_ratio, LOOSE_PACE_ratio = float("inf"), 0.6
"""A rig is known from presses of any pace; on a heavy one that is not learned yet no person can keep it."""
STRAY_ratio = 0.5
"""A press this far off the pace asked for tells the rig, but not what the tables of its speed need."""


@dataclass(frozen=True, eq=False)
class RigState:
    """Where a job stands.

    Attributes
    ----------
    known : the rig, once identified, or as it was known before.
    tables : what is learned beyond it, press and release; None while the rig is unknown.
    unknown : presses made before the rig was known.
    felt : per speed of the job, each press made on a table for the known rig: press and release.
    told : what the last press changed.
    """

    job: Job
    felt: tuple[tuple[tuple[Felt, Felt], ...], ...]
    known: KnownRig | None = None
    tables: Pair | None = None
    unknown: tuple[Press, ...] = ()
    told: str = ""

    @property
    def rig(self) -> tuple[KnownRig, Pair]:
        """Give rig and tables; ModelError while they are unknown."""
        if self.known is None or self.tables is None:
            raise ModelError("the rig is not known yet")
        return self.known, self.tables

    @property
    def turn(self) -> int:
        """Give the number of the speed with the fewest presses on a known rig."""
        return min(range(len(self.felt)), key=lambda i: len(self.felt[i]))


@dataclass(frozen=True)
class RigAware:
    """Settings of the method; docs/explanation/rig-aware.md tells it.

    Attributes
    ----------
    rounds : presses per speed once the rig is known; with a memory 0 are enough.
    memory : of an earlier job on this rig: then nothing is identified.
    meet : presses to know a rig by, at the job's speeds in turn; meet_most : when they tell too little.
    sensor : of the finger.
    bandwidth_Hz : of the controller's look-ahead. friction_mm_s : speed from which friction is fed whole.
    learning : how presses enter the tables. bin_mm : step of the tables.
    """

    rounds: int = 3
    memory: RigMemory | None = None
    meet: int = 4
    meet_most: int = 8
    sensor: Sensor = field(default_factory=Sensor)
    bandwidth_Hz: float = 120.0
    friction_mm_s: float = 10.0
    learning: Learning = field(default_factory=Learning)
    bin_mm: float = 0.05

    def __post_init__(self) -> None:
        if self.rounds < 0 or not 1 <= self.meet <= self.meet_most:
            raise ModelError(f"needs no rounds below 0, and 1 <= meet <= meet_most, got {self}")
        if not (self.bandwidth_Hz > 0 and self.friction_mm_s > 0 and self.bin_mm > 0):
            raise ModelError(f"bandwidth_Hz, friction_mm_s and bin_mm must be above 0, got {self}")

    @property
    def name(self) -> str:
        """Name the method."""
        met = "a rig known before" if self.memory else f"a rig identified from {self.meet} presses"
        rounds = "1 round" if self.rounds == 1 else f"{self.rounds} rounds"
        return f"rig-aware: {met}, look-ahead and feed-forward, {rounds} of learning what is left"

    def init(self, job: Job) -> RigState:
        """Begin a job; with a memory, from what is known."""
        state = RigState(job, ((),) * job.target.velocity_mm_s.size)
        if self.memory is None:
            return state
        known, target = self.memory.known, job.target
        fresh = believed(job, known, self.learning)
        rows = self.memory.rows_cN(target.displacement_mm, target.velocity_mm_s, job.travel_mm)
        # what was learned holds for this button up to what a speed has for itself
        alone = np.diag(fresh.covariance_cN2) * self.learning.alone_ratio**2
        press, release = (replace(fresh, rows_cN=r, covariance_cN2=np.diag(alone)) for r in rows)
        return replace(state, known=known, tables=(press, release))

    def trial(self, state: RigState) -> Trial | None:
        """Press to know the rig, then the speed with the fewest presses; None when finished."""
        speeds = state.job.target.velocity_mm_s
        if state.known is None:
            surface = identification_surface(state.job.target, limit_cN=state.job.force_limit_cN)
            speed = float(speeds[len(state.unknown) % speeds.size])
            return Trial(surface, speed, pace_ratio=ANY_PACE_ratio)
        at = state.turn
        if len(state.felt[at]) >= self.rounds:
            return None
        return Trial(
            self._surface(state, state.rig[1]), float(speeds[at]), self._tuning(state), LOOSE_PACE_ratio
        )

    def step(self, press: Press, state: RigState) -> RigState:
        """Know the rig, or learn from a press on it. ModelError on a press that tells nothing."""
        if state.known is None:
            return self._meet(press, state)
        at = state.turn
        pair, tables = self._learn(self._passes(press, state), state, at)
        felt = (*state.felt[:at], (*state.felt[at], pair), *state.felt[at + 1 :])
        after = replace(state, felt=felt, tables=tables)
        told = told_of(after.rig[0], (state.rig[1], tables), pair, at)
        return replace(after, told=told)

    def explain(self, state: RigState) -> str:
        """Tell what the last press changed; empty before the first."""
        return state.told

    def count(self, state: RigState) -> Count:
        """Count presses; those to know the rig by belong to the speeds they are asked at."""
        size = state.job.target.velocity_mm_s.size
        meet = 0 if self.memory else max(self.meet, len(state.unknown) + (state.known is None))
        first = [meet // size + (i < meet % size) for i in range(size)]
        made = len(state.unknown) + sum(map(len, state.felt))
        return Count(made, meet + size * self.rounds, tuple(n + self.rounds for n in first))

    def done(self, state: RigState) -> Outcome:
        """Give the tables, for every speed and stroke the best that was pressed if the last got worse."""
        made = self.count(state).made
        if state.known is None:
            start = held_up(state.job)
            return Outcome(start, (), made, False, f"{made} presses, the rig is not known yet")
        _, tables = state.rig
        complete = self.trial(state) is None
        sentence = explain_rig(state.known, 0.5 * state.job.travel_mm)
        surface = self._surface(state, kept_rows(tables, state.felt))
        curves = curves_of(state.job, state.felt, self.memory)
        return Outcome(surface, curves, made, complete, sentence, self._tuning(state))

    def remembered(self, state: RigState) -> RigMemory:
        """Give what the rig has taught, for other buttons. ModelError while it is unknown."""
        known, tables = state.rig
        press, release = (table.rows_cN for table in kept_rows(tables, state.felt))
        target, job = state.job.target, state.job
        errors = np.array([[c.mean_error_cN for c in curves_of(job, state.felt, self.memory)]])
        errors = np.nan_to_num(errors.reshape(2, -1), nan=known.residual_cN)
        residual = ForceSurface(target.displacement_mm, target.velocity_mm_s, press, release)
        return RigMemory(known, residual, job.travel_mm, errors)

    def _meet(self, press: Press, state: RigState) -> RigState:
        """Keep a press of an unknown rig; identify it once they are enough, and learn from them all."""
        unknown = (*state.unknown, press)
        if len(unknown) < self.meet:
            told = f"{len(unknown)} of {self.meet} presses to know the rig by"
            return replace(state, unknown=unknown, told=told)
        try:
            known = identify(unknown, state.job.travel_mm)
        except FitError as error:
            if len(unknown) >= self.meet_most:
                raise ModelError(f"the rig cannot be identified: {error}") from error
            return replace(state, unknown=unknown, told=f"one more press is needed: {error}")
        table = believed(state.job, known, self.learning)
        met = replace(state, known=known, unknown=unknown, tables=(table, table))
        speeds = state.job.target.velocity_mm_s
        for i, one in enumerate(unknown):
            met = replace(met, tables=self._from_meeting(one, met, i % speeds.size))
        return replace(met, told=explain_rig(known, 0.5 * state.job.travel_mm))

    def _from_meeting(self, press: Press, state: RigState, at: int) -> Pair:
        """Take a press made before the rig was known into the tables, if it tells what they need."""
        asked = float(state.job.target.velocity_mm_s[at])
        try:
            strokes = self._passes(press, state)
            if abs(strokes[0].speed_mm_s - asked) <= STRAY_ratio * asked:
                return self._learn(strokes, state, at)[1]
        except ModelError:
            pass  # it told the rig, that is enough
        return state.rig[1]

    def _passes(self, press: Press, state: RigState) -> tuple[Pass, Pass]:
        try:
            return passes(press, state.job.travel_mm, state.rig[0], self.sensor)
        except FitError as error:
            raise ModelError(str(error)) from error

    def _learn(self, strokes: tuple[Pass, Pass], state: RigState, at: int) -> tuple[tuple[Felt, Felt], Pair]:
        """Tell how a press made for speed number ``at`` felt, and take it into the tables."""
        known, tables = state.rig
        job, rig = state.job, (known, self._tuning(state))
        targets = (job.target.press_cN[at], job.target.release_cN[at])
        each = tuple(zip(tables, strokes, targets, strict=True))
        down, up = (felt_off(stroke, force, table, at, job.travel_mm) for table, stroke, force in each)
        press_table, release_table = (
            learn_stroke(table, stroke, force, at, rig, self.learning) for table, stroke, force in each
        )
        return (down, up), (press_table, release_table)

    def _tuning(self, state: RigState) -> Tuning:
        if state.known is None:
            return UNTUNED
        return tuning_of(state.known, state.job.travel_mm, self.bandwidth_Hz, self.friction_mm_s)

    def _surface(self, state: RigState, tables: Pair) -> ForceSurface:
        return commands(state.job, state.rig[0], tables, self.friction_mm_s)
