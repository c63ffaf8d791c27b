"""Compensation on a rig with a load cell: identify it, close the force loop, learn what the loop leaves.

The table is the loop's target. What repeats from press to press is added to it: the loop follows its target
nearly at once, so the error of a press is the correction (iterative learning control on the reference).
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from fdvv.compensation.force_loop.constants import CellSpec, ForceLoopGains
from fdvv.compensation.force_loop.gains import force_loop_gains
from fdvv.compensation.identification.balance import Sensor
from fdvv.compensation.identification.rig_file import LearnedRig
from fdvv.compensation.identification.rig_model import Prior, RigModel
from fdvv.compensation.method import (
    UNTUNED,
    CompensationJob,
    Outcome,
    PressCount,
    Trial,
    Tuning,
    error_cN,
)
from fdvv.compensation.presses import split_strokes
from fdvv.compensation.rig_aware import (
    LOOSE_SPEED_TOLERANCE_ratio,
    explain_rig,
    identification_trial,
    least_pressed,
    press_count,
    try_identification,
)
from fdvv.compensation.rig_learning import (
    PressError,
    PressErrors,
    better_press,
    curves_of,
    tuning_of,
)
from fdvv.compensation.tables import bin_force, smooth
from fdvv.errors import ModelError
from fdvv.model.press import Press
from fdvv.model.surface import ForceSurface
from fdvv.units import FloatArray

LEARNED_ratios = (0.7, 0.5, 0.4)
"""Part of a press's error that is learned in each round; later rounds as the last."""
SMOOTHED_mm = 0.06
LARGEST_STEP_cN = 15.0
ENTRY_mm, ENTRY_s = 0.15, 1.2e-3
"""After contact the loop needs this way, and this long, to hold the force: nothing is learned there."""
STOP_mm = 0.08
LIFT_cN, LIFT_mm, LIFTED_mm = 40.0, 0.2, 0.03
"""Just under the top stop the target rises to LIFT_cN, so that the cap follows a finger that leaves."""
BANDWIDTH_Hz, RUB_mm_s = 120.0, 10.0
"""Of the tables' look-ahead and friction, which render if the cell fails."""

Rows = tuple[FloatArray, FloatArray]


@dataclass(frozen=True, eq=False)
class LoopState:
    """State of a job.

    Attributes
    ----------
    rig, gains : once identified. identification : presses before that.
    corrections : of the target, press and release, (speeds, bins) each.
    pressed : per speed, of each press with the loop closed: press and release.
    message : what the last press changed.
    """

    job: CompensationJob
    corrections: Rows
    pressed: PressErrors
    rig: RigModel | None = None
    gains: ForceLoopGains | None = None
    identification: tuple[Press, ...] = ()
    message: str = ""


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
    """

    cell: CellSpec
    tick_s: float
    rounds: int = 3
    learned_rig: LearnedRig | None = None
    identification_presses: int = 4
    max_identification_presses: int = 8
    bin_mm: float = 0.05

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
        return self._closed(state, self.learned_rig.rig)

    def trial(self, state: LoopState) -> Trial | None:
        """Return the next press: first identification, then the speed with the fewest; None when finished."""
        if state.gains is None:
            return identification_trial(state.job, len(state.identification))
        at = least_pressed(state.pressed)
        if len(state.pressed[at]) >= self.rounds:
            return None
        surface = _surface(state.job, state.corrections)
        speed = float(state.job.target.velocity_mm_s[at])
        return Trial(surface, speed, self._tuning(state), LOOSE_SPEED_TOLERANCE_ratio)

    def step(self, press: Press, state: LoopState) -> LoopState:
        """Identify the rig, or learn from a press. Raises ModelError on an uninformative press."""
        if state.gains is None:
            return self._identify_step(press, state)
        at = least_pressed(state.pressed)
        count = len(state.pressed[at])
        learned_ratio = LEARNED_ratios[min(count, len(LEARNED_ratios) - 1)]
        pair, corrections = _learn(press, state, at, learned_ratio)
        pressed = (*state.pressed[:at], (*state.pressed[at], pair), *state.pressed[at + 1 :])
        message = f"mean error {pair[0].mean_cN:.1f} cN on the press, {pair[1].mean_cN:.1f} on the release"
        return replace(state, corrections=corrections, pressed=pressed, message=message)

    def explain(self, state: LoopState) -> str:
        """Return what the last press changed; empty before the first."""
        return state.message

    def count(self, state: LoopState) -> PressCount:
        made = len(state.identification)
        needed = 0 if self.learned_rig else max(self.identification_presses, made + (state.gains is None))
        return press_count(state.pressed, self.rounds, made, needed)

    def done(self, state: LoopState) -> Outcome:
        """Return the tables, of each curve those that left the least error."""
        made = self.count(state).made
        surface = _surface(state.job, _best(state))
        if state.rig is None:
            return Outcome(surface, (), made, False, f"{made} presses, the rig is not identified yet")
        complete = self.trial(state) is None
        sentence = explain_rig(state.rig, 0.5 * state.job.travel_mm)
        curves = curves_of(state.job, state.pressed, self.learned_rig)
        return Outcome(surface, curves, made, complete, sentence, self._tuning(state))

    def learned(self, state: LoopState) -> LearnedRig:
        """Return the rig and what the loop alone leaves. ModelError before identification."""
        if state.rig is None:
            raise ModelError("the rig is not identified yet")
        target, zero = state.job.target, np.zeros_like(state.job.target.press_cN)
        alone = [[pairs[0][j].mean_cN if pairs else np.nan for pairs in state.pressed] for j in (0, 1)]
        residual = ForceSurface(target.displacement_mm, target.velocity_mm_s, zero, zero)
        known = self.learned_rig
        errors = np.array(alone) if known is None else known.expected_cN(target.velocity_mm_s)
        return LearnedRig(
            state.rig, residual, state.job.travel_mm, np.nan_to_num(errors, nan=state.rig.residual_cN)
        )

    def _identify_step(self, press: Press, state: LoopState) -> LoopState:
        presses = (*state.identification, press)
        sensor = Sensor(filter_s=self.cell.filter_s, cone_g=1e3 * self.cell.plate_kg)
        limits = self.identification_presses, self.max_identification_presses
        found = try_identification(presses, state.job.travel_mm, limits, Prior(sensor=sensor))
        after = replace(state, identification=presses)
        return replace(after, message=found) if isinstance(found, str) else self._closed(after, found)

    def _closed(self, state: LoopState, rig: RigModel) -> LoopState:
        gains = force_loop_gains(rig, self.cell, self.tick_s)
        return replace(state, rig=rig, gains=gains, message=explain_rig(rig, 0.5 * state.job.travel_mm))

    def _tuning(self, state: LoopState) -> Tuning:
        if state.rig is None:
            return UNTUNED
        fallback = tuning_of(state.rig, state.job.travel_mm, BANDWIDTH_Hz, RUB_mm_s)
        return replace(fallback, loop=state.gains)


def _surface(job: CompensationJob, corrections: Rows) -> ForceSurface:
    """Return the corrected target, lifted just under the top stop and within the force limit."""
    target, limit = job.target, job.force_limit_cN
    x = target.displacement_mm
    near = np.clip((LIFT_mm - x) / (LIFT_mm - LIFTED_mm), 0.0, 1.0)
    rows = [
        np.clip(force + np.maximum(LIFT_cN - force, 0.0) * near + correction, -limit, limit)
        for force, correction in zip((target.press_cN, target.release_cN), corrections, strict=True)
    ]
    return ForceSurface(x, target.velocity_mm_s, *rows)


def _learn(
    press: Press, state: LoopState, at: int, learned_ratio: float
) -> tuple[tuple[PressError, PressError], Rows]:
    """Return what a press of speed number ``at`` left, and the corrections after it."""
    job = state.job
    x, speed = job.target.displacement_mm, float(job.target.velocity_mm_s[at])
    held = (x >= ENTRY_mm + ENTRY_s * speed) & (x <= job.travel_mm - STOP_mm)
    if press.sensed_mm is None or press.sensed_cN is None:
        raise ModelError("the press holds no force and displacement of the rig's own")
    spans = split_strokes(press.sensed_mm, job.travel_mm)
    pressed, corrections = [], []
    targets = (job.target.press_cN[at], job.target.release_cN[at])
    for span, target, rows in zip(spans, targets, state.corrections, strict=True):
        rendered = bin_force(press.sensed_mm[span], press.sensed_cN[span], x)
        left = np.where(held & np.isfinite(rendered), target - rendered, 0.0)
        if not (held & np.isfinite(rendered)).any():
            raise ModelError("a stroke was not recorded")
        off, whole = np.abs(left[held]), error_cN(target[held], rendered[held])
        pressed.append(PressError(whole, float(off.mean()), float(off.max()), rows[at]))
        step = np.clip(smooth(left, SMOOTHED_mm, float(x[1] - x[0])), -LARGEST_STEP_cN, LARGEST_STEP_cN)
        after = rows.copy()
        after[at] += learned_ratio * step
        corrections.append(after)
    return (pressed[0], pressed[1]), (corrections[0], corrections[1])


def _best(state: LoopState) -> Rows:
    """Return the corrections, with those of the best press where the last press was far worse."""
    press, release = (rows.copy() for rows in state.corrections)
    for at, pairs in enumerate(state.pressed):
        for j, rows in enumerate((press, release)):
            better = better_press([pair[j] for pair in pairs])
            if better:
                rows[at] = better.row_cN
    return press, release
