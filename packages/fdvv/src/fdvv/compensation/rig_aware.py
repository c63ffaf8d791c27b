"""Model-based compensation: identify the rig, feed its forces forward, learn only the rest."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from fdvv.compensation.identification.balance import Sensor
from fdvv.compensation.identification.excitation import identification_surface
from fdvv.compensation.identification.identify import identify
from fdvv.compensation.identification.rig_file import LearnedRig
from fdvv.compensation.identification.rig_model import Prior, RigModel
from fdvv.compensation.method import UNTUNED, CompensationJob, Outcome, PressCount, Trial, Tuning
from fdvv.compensation.rig_learning import (
    Learning,
    Pair,
    PressError,
    PressErrors,
    best_rows,
    command_surface,
    curves_of,
    learn_stroke,
    minimum_lift_surface,
    press_error,
    press_summary,
    prior_table,
    tuning_of,
)
from fdvv.compensation.stroke_samples import StrokeSample, stroke_samples
from fdvv.errors import FitError, ModelError
from fdvv.force_text import force_number, force_text, force_unit
from fdvv.model.press import Press
from fdvv.model.surface import ForceSurface
from fdvv.protocol.tables import CellSpec

WEAK_ratio = 0.5
"""An estimate is weak if its standard error exceeds this part of it."""

QUANTITIES = {
    "gain": ("gain", ""),
    "drag_N_s_m": ("drag", "N s/m"),
    "friction_cN": ("friction", "cN"),
    "weight_cN": ("weight", "cN"),
    "mass_g": ("mass", "g"),
    "delay_s": ("command delay", "ms"),
    "position_lag_s": ("position lag", "ms"),
    "play_cN": ("sensor play", "cN"),
}
NOTICED_cN, NOTICED_errors = 2.0, 2.0
"""A rig's own force is reported from here on, over the travel and in standard errors."""


def explain_rig(rig: RigModel, middle_mm: float = 2.0) -> str:
    """Summarize a rig with standard errors; the gain at middle_mm.

    A number is not known if its error exceeds it or it rests on a bound, and weak if its error is large.
    """
    quantities, weak, unknown = [], [], []
    for name, (words, unit) in QUANTITIES.items():
        value = float(rig.gain_at(np.array(middle_mm))) if name == "gain" else float(getattr(rig, name))
        error = rig.error.get(name, 0.0)
        scale = 1000.0 if unit == "ms" else 1.0
        digits = 2 if unit in ("", "ms") else 1
        write = force_number if unit == "cN" else format
        end = f" {unit.replace('cN', force_unit())}" if unit else ""
        about, off = (write(scale * number, f".{digits}f") for number in (value, error))
        quantities.append(f"{words} {about} +- {off}{end}")
        if error > abs(value) or name in rig.at_bound:
            unknown.append(words)
        elif error > WEAK_ratio * abs(value):
            weak.append(words)
    quantities += _own_force(rig)
    text = (
        f"{', '.join(quantities)}, from {rig.presses} presses; {force_text(rig.residual_cN, '.1f')} rms "
        "unexplained"
    )
    text = f"{text}; not known: {', '.join(unknown)}" if unknown else text
    text = f"{text}; weak: {', '.join(weak)}" if weak else text
    return f"{text}; {rig.misfit}" if rig.misfit else text


def _own_force(rig: RigModel) -> list[str]:
    """Describe the rig's own force over displacement, if there is one."""
    span, error = float(np.ptp(rig.own_cN)) if rig.own_cN else 0.0, rig.error.get("own_cN", 0.0)
    if span < max(NOTICED_cN, NOTICED_errors * error):
        return []
    return [
        f"own force over displacement {force_number(span, '.1f')} +- {force_text(error, '.1f')} from least "
        "to most"
    ]


ANY_SPEED_ratio, LOOSE_SPEED_TOLERANCE_ratio = float("inf"), 0.6
"""Identification accepts any speed: on a heavy rig that is not compensated yet, no person can keep a pace."""
MAX_SPEED_DEVIATION_ratio = 0.5
"""A press further from its requested speed informs the rig model, but not the tables of that speed."""


GUESSED_cN = 20.0
"""Weight of a mover of which nothing is known."""


def identification_trial(job: CompensationJob, made: int, known: Prior | None = None) -> Trial:
    """Return the next press of an identification after so many, at the job's speeds in turn.

    known : of the rig; a heavy mover must be lifted before it is identified.
    """
    weight = (known or Prior()).ranges.get("weight_cN")
    guess_cN = GUESSED_cN if weight is None else max(GUESSED_cN, weight.mean + weight.spread)
    speeds = job.target.velocity_mm_s
    turn, at = divmod(made, speeds.size)
    surface = identification_surface(job.target, guess_cN, limit_cN=job.force_limit_cN, turn=turn)
    # the announced speed chooses the row, and with it the level
    speed_mm_s = float(speeds[at])
    return Trial(surface, speed_mm_s, Tuning(paced=True), ANY_SPEED_ratio)


def try_identification(
    presses: Sequence[Press], travel_mm: float, limits: tuple[int, int], prior: Prior | None = None
) -> RigModel | str:
    """Return the rig, or why another press is needed.

    limits : presses before the first try, and the most. Raises ModelError if the most do not suffice.
    """
    fewest, most = limits
    if len(presses) < fewest:
        return f"{len(presses)} of {fewest} identification presses"
    try:
        return identify(presses, travel_mm, prior)
    except FitError as error:
        if len(presses) >= most:
            raise ModelError(f"the rig cannot be identified: {error}") from error
        return f"one more press is needed: {error}"


def prior_of(known: Prior | None, job: CompensationJob, sensor: Sensor) -> Prior:
    """Return the prior of a job's rig under this sensor, with what is known of it."""
    return replace(known or Prior(), sensor=sensor, full_duty_N=job.full_duty_N)


def least_pressed(presses: Sequence[Sequence[object]]) -> int:
    """Return the index of the speed with the fewest presses; the first of several."""
    return min(range(len(presses)), key=lambda i: len(presses[i]))


def press_count(
    presses: Sequence[Sequence[object]], rounds: int, identifying: int, needed: int
) -> PressCount:
    """Count presses per speed, and those of identification for the speed they are requested at.

    identifying, needed : presses of identification made, and needed.
    """
    size = len(presses)
    wanted = tuple(needed // size + (i < needed % size) + rounds for i in range(size))
    return PressCount(identifying + sum(map(len, presses)), needed + size * rounds, wanted)


@dataclass(frozen=True, eq=False)
class RigState:
    """State of a job.

    Attributes
    ----------
    rig : its model, once identified, or from an earlier job.
    tables : learned corrections, press and release; None while the rig is not identified.
    identification : presses made before the rig was identified.
    errors : per speed of the job, of each press after that: press and release.
    message : what the last press changed.
    """

    job: CompensationJob
    errors: PressErrors
    rig: RigModel | None = None
    tables: Pair | None = None
    identification: tuple[Press, ...] = ()
    message: str = ""

    @property
    def rig_and_tables(self) -> tuple[RigModel, Pair]:
        """Rig and tables. Raises ModelError while they are unknown."""
        if self.rig is None or self.tables is None:
            raise ModelError("the rig is not identified yet")
        return self.rig, self.tables


@dataclass(frozen=True)
class RigAware:
    """Settings of the method, which docs/explanation/rig-aware.md explains.

    Attributes
    ----------
    rounds : presses per speed after identification; with learned_rig 0 is enough.
    learned_rig : from an earlier job on this rig: then nothing is identified.
    identification_presses : at the job's speeds in turn; more, up to max_identification_presses, if they
        are not informative enough.
    sensor : of the finger. prior : what is known of the rig before any press; None: what its force at
        full duty says.
    bandwidth_Hz : of the controller's look-ahead.
    friction_mm_s : speed above which friction is compensated in full.
    learning : settings of learning. bin_mm : step of the tables.
    cell : the load cell in the cap, from its data sheet; None: as the device says.

    Sessions on file know some fields by an older name, the "key" of their metadata.
    """

    rounds: int = 3
    learned_rig: LearnedRig | None = field(default=None, metadata={"key": "memory"})
    identification_presses: int = field(default=4, metadata={"key": "meet"})
    max_identification_presses: int = field(default=8, metadata={"key": "meet_most"})
    sensor: Sensor = field(default_factory=Sensor)
    bandwidth_Hz: float = 120.0
    friction_mm_s: float = 10.0
    learning: Learning = field(default_factory=Learning)
    bin_mm: float = 0.05
    prior: Prior | None = None
    cell: CellSpec | None = None

    def __post_init__(self) -> None:
        if self.rounds < 0 or not 1 <= self.identification_presses <= self.max_identification_presses:
            raise ModelError(
                "rounds must be at least 0, and 1 <= identification_presses <= max_identification_presses, "
                f"got {self}"
            )
        if not (self.bandwidth_Hz > 0 and self.friction_mm_s > 0 and self.bin_mm > 0):
            raise ModelError(f"bandwidth_Hz, friction_mm_s and bin_mm must be above 0, got {self}")

    @property
    def name(self) -> str:
        # part of session.json: a session is resumed only under the same name
        met = "known before" if self.learned_rig else f"identified from {self.identification_presses} presses"
        rounds = "1 round" if self.rounds == 1 else f"{self.rounds} rounds"
        return f"rig-aware: a rig {met}, look-ahead and feed-forward, {rounds} of learning what is left"

    def init(self, job: CompensationJob) -> RigState:
        state = RigState(job, ((),) * job.target.velocity_mm_s.size)
        if self.learned_rig is None:
            return state
        rig, target = self.learned_rig.rig, job.target
        fresh = prior_table(job, rig, self.learning)
        rows = self.learned_rig.rows_cN(target.displacement_mm, target.velocity_mm_s, job.travel_mm)
        # what was learned on another button is certain up to the spread of one speed alone
        alone = np.diag(fresh.covariance_cN2) * self.learning.alone_ratio**2
        press, release = (replace(fresh, rows_cN=r, covariance_cN2=np.diag(alone)) for r in rows)
        return replace(state, rig=rig, tables=(press, release))

    def trial(self, state: RigState) -> Trial | None:
        """Return the next press: first identification, then the speed with the fewest; None when finished."""
        if state.rig is None:
            return identification_trial(state.job, len(state.identification), self.prior)
        at = least_pressed(state.errors)
        if len(state.errors[at]) >= self.rounds:
            return None
        surface = self._surface(state, state.rig_and_tables[1])
        speed = float(state.job.target.velocity_mm_s[at])
        return Trial(surface, speed, self._tuning(state), LOOSE_SPEED_TOLERANCE_ratio)

    def step(self, press: Press, state: RigState) -> RigState:
        """Identify the rig, or learn from a press on it. Raises ModelError on an uninformative press."""
        if state.rig is None:
            return self._identify_step(press, state)
        at = least_pressed(state.errors)
        pair, tables = self._learn(self._strokes(press, state), state, at)
        errors = (*state.errors[:at], (*state.errors[at], pair), *state.errors[at + 1 :])
        message = press_summary(state.rig, (state.rig_and_tables[1], tables), pair, at)
        return replace(state, errors=errors, tables=tables, message=message)

    def explain(self, state: RigState) -> str:
        return state.message

    def count(self, state: RigState) -> PressCount:
        made = len(state.identification)
        needed = 0 if self.learned_rig else max(self.identification_presses, made + (state.rig is None))
        return press_count(state.errors, self.rounds, made, needed)

    def done(self, state: RigState) -> Outcome:
        """Return the tables, with the best ones pressed wherever the last press was far worse."""
        made = self.count(state).made
        if state.rig is None:
            start = minimum_lift_surface(state.job)
            return Outcome(start, (), made, False, f"{made} presses, the rig is not identified yet")
        _, tables = state.rig_and_tables
        complete = self.trial(state) is None
        sentence = explain_rig(state.rig, 0.5 * state.job.travel_mm)
        surface = self._surface(state, best_rows(tables, state.errors))
        curves = curves_of(state.job, state.errors, self.learned_rig)
        return Outcome(surface, curves, made, complete, sentence, self._tuning(state))

    def rig_after(self, state: RigState) -> LearnedRig:
        """Return the rig with its learned residual, for other buttons. ModelError before identification."""
        rig, tables = state.rig_and_tables
        press, release = (table.rows_cN for table in best_rows(tables, state.errors))
        target, job = state.job.target, state.job
        errors = np.array([[c.mean_error_cN for c in curves_of(job, state.errors, self.learned_rig)]])
        errors = np.nan_to_num(errors.reshape(2, -1), nan=rig.residual_cN)
        residual = ForceSurface(target.displacement_mm, target.velocity_mm_s, press, release)
        return LearnedRig(rig, residual, job.travel_mm, errors)

    def _identify_step(self, press: Press, state: RigState) -> RigState:
        """Collect identification presses; once they suffice, identify the rig and learn from them all."""
        presses = (*state.identification, press)
        limits = self.identification_presses, self.max_identification_presses
        prior = prior_of(self.prior, state.job, self.sensor)
        rig = try_identification(presses, state.job.travel_mm, limits, prior)
        if isinstance(rig, str):
            return replace(state, identification=presses, message=rig)
        return self.adopt_rig(state, rig, presses)

    def adopt_rig(self, state: RigState, rig: RigModel, presses: tuple[Press, ...]) -> RigState:
        """Return the state once a rig is identified from presses, learned from them all."""
        table = prior_table(state.job, rig, self.learning)
        after = replace(state, rig=rig, identification=presses, tables=(table, table))
        speeds = state.job.target.velocity_mm_s
        for i, earlier in enumerate(presses):
            after = replace(after, tables=self._from_identification(earlier, after, i % speeds.size))
        return replace(after, message=explain_rig(rig, 0.5 * state.job.travel_mm))

    def _from_identification(self, press: Press, state: RigState, at: int) -> Pair:
        """Return the tables after an identification press, if it is near enough to its requested speed."""
        requested = float(state.job.target.velocity_mm_s[at])
        try:
            strokes = self._strokes(press, state)
            if abs(strokes[0].speed_mm_s - requested) <= MAX_SPEED_DEVIATION_ratio * requested:
                return self._learn(strokes, state, at)[1]
        except ModelError:
            pass  # it served the identification
        return state.rig_and_tables[1]

    def _strokes(self, press: Press, state: RigState) -> tuple[StrokeSample, StrokeSample]:
        try:
            return stroke_samples(press, state.job.travel_mm, state.rig_and_tables[0], self.sensor)
        except FitError as error:
            raise ModelError(str(error)) from error

    def _learn(
        self, strokes: tuple[StrokeSample, StrokeSample], state: RigState, at: int
    ) -> tuple[tuple[PressError, PressError], Pair]:
        """Return the errors of a press of speed number ``at``, and the tables after it."""
        rig, tables = state.rig_and_tables
        job, known = state.job, (rig, self._tuning(state))
        targets = (job.target.press_cN[at], job.target.release_cN[at])
        each = tuple(zip(tables, strokes, targets, strict=True))
        down, up = (press_error(stroke, force, table, at, job.travel_mm) for table, stroke, force in each)
        press, release = (learn_stroke(*parts, at, known, self.learning) for parts in each)
        return (down, up), (press, release)

    def _tuning(self, state: RigState) -> Tuning:
        if state.rig is None:
            return UNTUNED
        return tuning_of(state.rig, state.job.travel_mm, self.bandwidth_Hz, self.friction_mm_s)

    def _surface(self, state: RigState, tables: Pair) -> ForceSurface:
        return command_surface(state.job, state.rig_and_tables[0], tables, self.friction_mm_s)
