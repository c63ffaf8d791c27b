"""Compensation on a rig with a load cell: identify it, close the force loop, learn what the loop leaves.

The table is the loop's target. Added to it are what the loop's response foresees, and then what repeats from
press to press (iterative learning control on the reference): the error of a press over time, through the
inverse of that response.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from fdvv.compensation.force_loop.gains import design_controller, force_loop_gains, plant_of_rig
from fdvv.compensation.force_loop.response import LoopResponse, StrokeCorrection
from fdvv.compensation.identification.balance import Sensor
from fdvv.compensation.identification.rig_file import LearnedRig
from fdvv.compensation.identification.rig_model import Prior, RigModel
from fdvv.compensation.method import UNTUNED, CompensationJob, Outcome, PressCount, Trial, Tuning
from fdvv.compensation.presses import split_strokes
from fdvv.compensation.rig_aware import (
    LOOSE_SPEED_TOLERANCE_ratio,
    RigAware,
    RigState,
    explain_rig,
    identification_trial,
    press_count,
    prior_of,
    try_identification,
)
from fdvv.compensation.rig_learning import PressError, PressErrors, better_press, curves_of, tuning_of
from fdvv.errors import ModelError
from fdvv.force_text import force_number, force_text
from fdvv.model.press import Press
from fdvv.model.surface import ForceSurface
from fdvv.protocol.tables import CellSpec, ForceLoopGains
from fdvv.units import FloatArray

LEARNED_ratios = (0.9, 0.7, 0.5)
"""Part of a press's error that is learned in each round; later rounds as the last."""
LIFT_cN, LIFT_mm, LIFTED_mm = 40.0, 0.2, 0.03
"""Just under the top stop the target rises to LIFT_cN, so that the cap follows a finger that leaves."""
SETTLED_cN, SETTLED_MAX_cN = 0.5, 1.5
"""A press that leaves less, on average and at most, has nothing left to learn: its speed is finished."""
BANDWIDTH_Hz, RUB_mm_s = 120.0, 10.0
"""Of the tables' look-ahead and friction, which render if the cell fails."""

Rows = tuple[FloatArray, FloatArray]


@dataclass(frozen=True, eq=False)
class LoopState:
    """State of a job.

    Attributes
    ----------
    rig, gains, response : once identified. identification : presses before that.
    corrections : of the target, press and release, (speeds, bins) each.
    pressed : per speed, of each press with the loop closed: press and release.
    message : what the last press changed.
    tables : state of the method that renders by tables, where no gain of the loop is stable.
    """

    job: CompensationJob
    corrections: Rows
    pressed: PressErrors
    rig: RigModel | None = None
    gains: ForceLoopGains | None = None
    response: LoopResponse | None = None
    identification: tuple[Press, ...] = ()
    message: str = ""
    tables: RigState | None = None


@dataclass(frozen=True)
class ForceLoop:
    """Settings of the method, which docs/explanation/force-loop.md explains.

    Attributes
    ----------
    cell : the load cell in the cap, from its data sheet. tick_s : period of the loop.
    rounds : presses per speed with the loop closed; with learned_rig 0 is enough.
    learned_rig : from an earlier job; then nothing is identified. Corrections of another button do not help:
        on three drawn rigs they raised the error of three more from 1.9 to 3.5 cN at 100 mm/s.
    identification_presses : with the loop open, at the job's speeds in turn; more, up to
        max_identification_presses, if they are not informative enough.
    bin_mm : step of the tables.
    prior : what is known of the rig before any press; None: what its force at full duty says.
    """

    cell: CellSpec
    tick_s: float
    rounds: int = 3
    learned_rig: LearnedRig | None = None
    identification_presses: int = 4
    max_identification_presses: int = 8
    bin_mm: float = 0.05
    prior: Prior | None = None

    def __post_init__(self) -> None:
        if self.rounds < 0 or not 1 <= self.identification_presses <= self.max_identification_presses:
            raise ModelError(
                "rounds must be at least 0, and 1 <= identification_presses <= max_identification_presses, "
                f"got {self}"
            )

    @property
    def name(self) -> str:
        rounds = "1 round" if self.rounds == 1 else f"{self.rounds} rounds"
        return f"force-loop: the loop at the finger closed on an identified rig, {rounds} of learning"

    def init(self, job: CompensationJob) -> LoopState:
        size = job.target.velocity_mm_s.size
        zero = np.zeros_like(job.target.press_cN)
        state = LoopState(job, (zero, zero), ((),) * size)
        if self.learned_rig is None:
            return state
        return self._close_loop(state, self.learned_rig.rig)

    def trial(self, state: LoopState) -> Trial | None:
        """Return the next press: first identification, then the speed with the fewest; None when finished."""
        if state.tables is not None:
            return self._by_tables.trial(state.tables)
        if state.gains is None:
            return identification_trial(state.job, len(state.identification), self.prior)
        if (at := self._at(state)) is None:
            return None
        surface = _surface(state.job, state.corrections)
        speed = float(state.job.target.velocity_mm_s[at])
        return Trial(surface, speed, self._tuning(state), LOOSE_SPEED_TOLERANCE_ratio)

    def step(self, press: Press, state: LoopState) -> LoopState:
        """Identify the rig, or learn from a press. Raises ModelError on an uninformative press."""
        if state.tables is not None:
            tables = self._by_tables.step(press, state.tables)
            return replace(state, tables=tables, message=tables.message)
        if state.response is None:
            return self._identify_step(press, state)
        if (at := self._at(state)) is None:
            raise ModelError("the method is finished; no press was asked for")
        strokes = _strokes(state.job, state.response, self.tick_s, at)
        pair, corrections = _learn(press, state, strokes, at)
        pressed = (*state.pressed[:at], (*state.pressed[at], pair), *state.pressed[at + 1 :])
        message = (
            f"mean error {force_text(pair[0].mean_cN, '.1f')} on the press, "
            f"{force_number(pair[1].mean_cN, '.1f')} on the release"
        )
        return replace(state, corrections=corrections, pressed=pressed, message=message)

    def explain(self, state: LoopState) -> str:
        """Return what the last press changed; empty before the first."""
        return state.message

    def count(self, state: LoopState) -> PressCount:
        if state.tables is not None:
            return self._by_tables.count(state.tables)
        made = len(state.identification)
        needed = 0 if self.learned_rig else max(self.identification_presses, made + (state.gains is None))
        count = press_count(state.pressed, self.rounds, made, needed)
        spared = [max(0, self.rounds - len(pairs)) * _is_settled(pairs) for pairs in state.pressed]
        wanted = tuple(w - s for w, s in zip(count.wanted, spared, strict=True))
        return replace(count, total=count.total - sum(spared), wanted=wanted)

    def done(self, state: LoopState) -> Outcome:
        """Return the tables, each as it was pressed: no table is kept that no press has judged."""
        if state.tables is not None:
            outcome = self._by_tables.done(state.tables)
            return replace(outcome, sentence=f"rendered by tables, not by the loop: {outcome.sentence}")
        made = self.count(state).made
        surface = _surface(state.job, _best_corrections(state))
        if state.rig is None:
            return Outcome(surface, (), made, False, f"{made} presses, the rig is not identified yet")
        complete = self.trial(state) is None
        sentence = explain_rig(state.rig, 0.5 * state.job.travel_mm)
        curves = curves_of(state.job, state.pressed, self.learned_rig)
        return Outcome(surface, curves, made, complete, sentence, self._tuning(state))

    def rig_after(self, state: LoopState) -> LearnedRig:
        """Return the rig and what the loop alone leaves. ModelError before identification."""
        if state.tables is not None:
            return self._by_tables.rig_after(state.tables)
        if state.rig is None:
            raise ModelError("the rig is not identified yet")
        target, zero = state.job.target, np.zeros_like(state.job.target.press_cN)
        alone = [[pairs[0][j].mean_cN if pairs else np.nan for pairs in state.pressed] for j in (0, 1)]
        residual = ForceSurface(target.displacement_mm, target.velocity_mm_s, zero, zero)
        known = self.learned_rig
        errors = np.array(alone) if known is None else known.error_at_cN(target.velocity_mm_s)
        return LearnedRig(
            state.rig, residual, state.job.travel_mm, np.nan_to_num(errors, nan=state.rig.residual_cN)
        )

    def _at(self, state: LoopState) -> int | None:
        """Return which speed is pressed next: the one with the fewest presses that has something to learn."""
        open_ = [
            i for i, pairs in enumerate(state.pressed) if len(pairs) < self.rounds and not _is_settled(pairs)
        ]
        return min(open_, key=lambda i: len(state.pressed[i]), default=None)

    @property
    def _sensor(self) -> Sensor:
        """The cell; it reads what its plate, which lies before it, leaves. A cone lies behind its sensor."""
        return Sensor(filter_s=self.cell.filter_s, cone_g=-1e3 * self.cell.plate_kg)

    @property
    def _by_tables(self) -> RigAware:
        """The method that renders by tables."""
        presses = self.identification_presses, self.max_identification_presses
        return RigAware(
            self.rounds, self.learned_rig, *presses, self._sensor, bin_mm=self.bin_mm, prior=self.prior
        )

    def _identify_step(self, press: Press, state: LoopState) -> LoopState:
        presses = (*state.identification, press)
        limits = self.identification_presses, self.max_identification_presses
        prior = prior_of(self.prior, state.job, self._sensor)
        answer = try_identification(presses, state.job.travel_mm, limits, prior)
        after = replace(state, identification=presses)
        return replace(after, message=answer) if isinstance(answer, str) else self._close_loop(after, answer)

    def _close_loop(self, state: LoopState, rig: RigModel) -> LoopState:
        plant = plant_of_rig(rig, self.cell)
        try:
            response = LoopResponse(plant, design_controller(plant))
        except ModelError as error:
            return self._fall_back(state, rig, str(error))
        gains = force_loop_gains(rig, self.cell, self.tick_s, response.controller)
        return replace(
            state,
            rig=rig,
            gains=gains,
            response=response,
            corrections=_foreseen(state.job, response, self.tick_s, self.learned_rig is not None),
            message=explain_rig(rig, 0.5 * state.job.travel_mm),
        )

    def _fall_back(self, state: LoopState, rig: RigModel, why: str) -> LoopState:
        """Return a state that goes on by tables on the rig of these presses."""
        law = self._by_tables
        tables = law.init(state.job)
        if self.learned_rig is None:
            tables = law.adopt_rig(tables, rig, state.identification)
        return replace(state, rig=rig, tables=tables, message=why)

    def _tuning(self, state: LoopState) -> Tuning:
        if state.rig is None:
            return UNTUNED
        fallback = tuning_of(state.rig, state.job.travel_mm, BANDWIDTH_Hz, RUB_mm_s)
        return replace(fallback, loop=state.gains)


def _surface(job: CompensationJob, corrections: Rows) -> ForceSurface:
    """Return the corrected target, lifted just under the top stop and within the force limit."""
    target, limit = job.target, job.force_limit_cN
    x = target.displacement_mm
    rows = [
        np.clip(lift_target_cN(x, force, job.at_most_cN(LIFT_cN)) + correction, -limit, limit)
        for force, correction in zip((target.press_cN, target.release_cN), corrections, strict=True)
    ]
    return ForceSurface(x, target.velocity_mm_s, *rows)


def lift_target_cN(displacement_mm: FloatArray, force_cN: FloatArray, lift_cN: float = LIFT_cN) -> FloatArray:
    """Return a target, (..., n), that rises to lift_cN just under the top stop."""
    near = np.clip((LIFT_mm - displacement_mm) / (LIFT_mm - LIFTED_mm), 0.0, 1.0)
    return np.asarray(force_cN + np.maximum(lift_cN - force_cN, 0.0) * near)


def _strokes(
    job: CompensationJob, response: LoopResponse, tick_s: float, at: int
) -> tuple[StrokeCorrection, StrokeCorrection]:
    """Return press and release of speed number ``at``."""
    grid, speed = job.target.displacement_mm, float(job.target.velocity_mm_s[at])
    press, release = (
        StrokeCorrection(grid, rows[at], speed, downward, job.travel_mm, response, tick_s)
        for rows, downward in ((job.target.press_cN, True), (job.target.release_cN, False))
    )
    return press, release


def _foreseen(job: CompensationJob, response: LoopResponse, tick_s: float, with_hand: bool) -> Rows:
    """Return the corrections before any press. with_hand : for a usual hand, since no press may follow."""
    pairs = [_strokes(job, response, tick_s, at) for at in range(job.target.velocity_mm_s.size)]
    press, release = (
        np.stack([pair[j].foreseen_cN() + (pair[j].hand_cN() if with_hand else 0.0) for pair in pairs])
        for j in (0, 1)
    )
    return press, release


def _learn(
    press: Press, state: LoopState, strokes: tuple[StrokeCorrection, StrokeCorrection], at: int
) -> tuple[tuple[PressError, PressError], Rows]:
    """Return what a press of speed number ``at`` left, and the corrections after it."""
    if press.sensed_mm is None or press.sensed_cN is None:
        raise ModelError("the press holds no force and displacement of the rig's own")
    learned_ratio = LEARNED_ratios[min(len(state.pressed[at]), len(LEARNED_ratios) - 1)]
    ticks = slice(None) if press.tick is None else press.tick
    x_mm, force_cN = press.sensed_mm[ticks], press.sensed_cN[ticks]
    spans = split_strokes(x_mm, state.job.travel_mm)
    pressed, corrections = [], []
    for span, stroke, rows in zip(spans, strokes, state.corrections, strict=True):
        pressed.append(stroke.press_error(x_mm[span], force_cN[span], rows[at]))
        after = rows.copy()
        after[at] += learned_ratio * stroke.step_cN(x_mm[span], force_cN[span])
        corrections.append(after)
    return (pressed[0], pressed[1]), (corrections[0], corrections[1])


def _is_settled(pairs: Sequence[tuple[PressError, PressError]]) -> bool:
    return bool(pairs) and all(e.mean_cN <= SETTLED_cN and e.max_cN <= SETTLED_MAX_cN for e in pairs[-1])


def _best_corrections(state: LoopState) -> Rows:
    """Return the corrections of the last press at each speed, or of the best where the last was far worse."""
    press, release = (rows.copy() for rows in state.corrections)
    for at, pairs in enumerate(state.pressed):
        for j, rows in enumerate((press, release)):
            if errors := [pair[j] for pair in pairs]:
                rows[at] = (better_press(errors) or errors[-1]).row_cN
    return press, release
