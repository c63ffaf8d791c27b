"""Compensation that knows the rig: identify, feed forward, learn what is left; zero presses where both are known."""

from __future__ import annotations

from dataclasses import dataclass, field, replace

import numpy as np

from fdvv.compensate._balance import Sensor
from fdvv.compensate._bins import bin_force
from fdvv.compensate._explain import explain
from fdvv.compensate._feed_forward import (
    HOME_mm,
    LIFT_cN,
    command_cN,
    inertia_cN,
    tuning_of,
    unrepeatable_cN,
    wanted_cN,
)
from fdvv.compensate._felt import Pass, passes
from fdvv.compensate._foresee import NominalFinger, foresee
from fdvv.compensate._identification_surface import identification_surface
from fdvv.compensate._identify import identify
from fdvv.compensate._known_rig import KnownRig
from fdvv.compensate._method import NOTHING, Count, CurveOutcome, Job, Outcome, Trial
from fdvv.compensate._shared_table import SharedTable
from fdvv.errors import FitError, ModelError
from fdvv.model import ForceSurface, Press, Stroke
from fdvv.units import FloatArray

Pair = tuple[SharedTable, SharedTable]


@dataclass(frozen=True, eq=False)
class Try:
    """One press as the rig felt it: at which of the job's speeds, on which rows, and how far off, press, release."""

    at: int
    rows_cN: tuple[FloatArray, FloatArray]
    mean_cN: tuple[float, float]
    max_cN: tuple[float, float]


@dataclass(frozen=True, eq=False)
class RigState:
    """Where it stands.

    Attributes
    ----------
    known : the rig, once identified. tables : what is learned beyond it, press and release.
    unknown : presses made before the rig was known. tries : presses made on tables of a known rig.
    told : what the last press changed.
    """

    job: Job
    known: KnownRig | None = None
    tables: Pair | None = None
    unknown: tuple[Press, ...] = ()
    tries: tuple[Try, ...] = ()
    told: str = ""


@dataclass(frozen=True)
class RigAware:
    """Settings of the method.

    Attributes
    ----------
    rounds : presses per speed once the rig is known.
    known, learned : of an earlier job on this rig; then nothing is identified, and with 0 rounds nothing pressed.
    sensor : of the finger. finger : a nominal one.
    bandwidth_Hz : of the controller's look-ahead. friction_mm_s : speed from which friction is taken off whole.
    """

    rounds: int = 2
    known: KnownRig | None = None
    learned: Pair | None = None
    sensor: Sensor = field(default_factory=Sensor)
    finger: NominalFinger = field(default_factory=NominalFinger)
    bandwidth_Hz: float = 100.0
    friction_mm_s: float = 10.0
    bin_mm: float = 0.05
    common_cN: float = 4.0
    alone_ratio: float = 0.3
    fading: float = 0.9
    smoothing_mm: float = 0.06
    smoothing_s: float = 8e-4
    trust: float = 0.7

    name = "rig-aware"

    def init(self, job: Job) -> RigState:
        state = RigState(job, self.known)
        return state if self.known is None else replace(state, tables=self._tables(job, self.known))

    def trial(self, state: RigState) -> Trial | None:
        speeds = state.job.target.velocity_mm_s
        if state.known is None:
            surface = identification_surface(state.job.target, limit_cN=state.job.force_limit_cN)
            return Trial(surface, float(speeds[len(state.unknown) % speeds.size]))
        if len(state.tries) >= self.rounds * speeds.size:
            return None
        at = len(state.tries) % speeds.size
        return Trial(self.surface(state), float(speeds[at]), self.tuning(state))

    def tuning(self, state):
        if state.known is None: return NOTHING
        return tuning_of(state.known, state.job.travel_mm, self.bandwidth_Hz, self.friction_mm_s)

    def step(self, press: Press, state: RigState) -> RigState:
        if state.known is None:
            return self._meet(press, state)
        return self._learn(press, state)

    def _meet(self, press, state):
        unknown = (*state.unknown, press)
        need = max(4, state.job.target.velocity_mm_s.size)
        if len(unknown) < need:
            return replace(state, unknown=unknown, told=f"press {len(unknown)} of {need} to know the rig by")
        known = identify(unknown, state.job.travel_mm)
        state = replace(state, known=known, unknown=unknown, told=explain(known))
        tables = self._tables(state.job, known)
        for p in unknown:
            tables = self._taken(p, replace(state, tables=tables))[0]
        return replace(state, tables=tables)

    def _learn(self, press, state):
        tables, tried = self._taken(press, state)
        return replace(state, tables=tables, tries=(*state.tries, tried), told="")

    def _tables(self, job, known):
        if self.learned is not None: return self.learned
        speeds = job.target.velocity_mm_s
        inertia = inertia_cN(known, speeds)
        one = SharedTable.believed(job.target.displacement_mm, speeds, self.common_cN, inertia, 1.0 + self.alone_ratio * inertia)
        return one, one

    def _taken(self, press, state):
        job, known = state.job, state.known
        grid = job.target.displacement_mm
        speeds = job.target.velocity_mm_s
        at = int(np.argmin(np.abs(speeds - press.velocity_mm_s)))
        tuning = tuning_of(known, job.travel_mm, self.bandwidth_Hz, self.friction_mm_s)
        new, means, maxs = [], [], []
        for table, stroke, target in zip(state.tables, passes(press, job.travel_mm, known, self.sensor), (job.target.press_cN[at], job.target.release_cN[at]), strict=True):
            change = foresee(stroke, target, grid, self.finger)
            change = tuple(self.trust * c for c in change)
            x, more = wanted_cN(known, tuning, stroke, change, (grid, target))
            seen = bin_force(x, more, grid)
            felt = bin_force(stroke.displacement_mm, stroke.felt_cN, grid)
            off = np.abs(felt - target)[(grid > 0.3) & (grid < job.travel_mm - 0.1)]
            means.append(float(np.nanmean(off))); maxs.append(float(np.nanmax(off)))
            v = float(speeds[at])
            new.append(table.learned(seen, v, unrepeatable_cN(known, v), self.smoothing_mm + self.smoothing_s * v, self.fading))
        rows = tuple(t.rows_cN[at] for t in state.tables)
        return tuple(new), Try(at, rows, tuple(means), tuple(maxs))

    def surface(self, state):
        target, known = state.job.target, state.known
        grid = target.displacement_mm
        limit = state.job.force_limit_cN
        tabs = []
        for force, table in zip((target.press_cN, target.release_cN), state.tables, strict=True):
            command = command_cN(known, grid, force) + np.stack([table.at(v) for v in target.velocity_mm_s])
            command = np.where(grid <= HOME_mm, np.maximum(command, (LIFT_cN + known.weight_cN) / known.gain_at(grid)), command)
            tabs.append(np.clip(command, -limit, limit))
        return ForceSurface(grid, target.velocity_mm_s, *tabs)
