"""The loop of a session: upload a trial, have it pressed, judge, store, learn."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from dataclasses import dataclass, field
from typing import Any, Generic, NoReturn, Protocol, TypeVar

import numpy as np

from fdvv.compensation.method import CurveOutcome, Trial, TrialSource
from fdvv.compensation.parts.guard import Diagnosis, PartGuard
from fdvv.compensation.presses import PressAcceptance
from fdvv.device.contract import Device
from fdvv.errors import DeviceError, InputError, ModelError, PartFault, PartFaultError
from fdvv.io.files import defer_interrupt
from fdvv.model.press import Press
from fdvv.rendering.press_made import PressMade, attempt_press, clear_latched, lasting_part
from fdvv.rendering.session import now
from fdvv.rendering.session_log import REMEDY, PartRecord, PressEntry, PressLog, PressRecord, SessionFile
from fdvv.rendering.tuning import tune


@dataclass(frozen=True)
class VelocityProgress:
    """Progress at one velocity.

    Attributes
    ----------
    made, wanted : presses used and needed; None if unknown.
    curves : of both strokes, as far as available.
    """

    velocity_mm_s: float
    made: int
    wanted: int | None
    curves: tuple[CurveOutcome, ...] = ()


@dataclass(frozen=True, eq=False)
class PressDone:
    """A completed press, for displays of progress.

    Attributes
    ----------
    stage : "compensate" or "probe".
    presses_done, presses_total : used so far, and planned.
    press : None if the device faulted before reporting it.
    skipped : why the press was not used and the remedy; empty if it was.
    achieved_mm_s : its mean speed; NaN if undefined.
    message : what it changed, from the method.
    progress : returns the progress of every velocity, slowest first.
    """

    stage: str
    velocity_mm_s: float
    presses_done: int
    presses_total: int
    press: Press | None
    skipped: str
    achieved_mm_s: float
    message: str
    progress: Callable[[], tuple[VelocityProgress, ...]]


Progress = Callable[[PressDone], None]


@dataclass(frozen=True)
class PressRequest:
    """The press requested next from the person, the ``number``-th of ``total`` that are used."""

    velocity_mm_s: float
    travel_mm: float
    number: int
    total: int


@dataclass(frozen=True, eq=False)
class Guide:
    """Callbacks that guide the person through a session.

    Attributes
    ----------
    ask : called before every press.
    notice : called with notices: that a session is resumed, that a record was truncated.
    """

    ask: Callable[[PressRequest], None] = lambda _ask: None
    notice: Callable[[str], None] = lambda _text: None


S = TypeVar("S")
SAME_TABLE_cN = 1 / 64
"""Resolution of a device's commands: tables that differ by less are equal."""
SAME_TUNING_ratio = 1e-6
"""Tunings that differ by less are equal: another processor rounds the last digits otherwise."""


@dataclass(frozen=True, eq=False)
class SessionPlan(Generic[S]):
    """What a session runs, and its callbacks.

    Attributes
    ----------
    stage : "compensate" or "probe".
    judge : decides whether a press can be used, with a trial's own pace_ratio unless that is None.
    patience : the session stops after this many unusable presses in a row.
    velocity_progress : of a state.
    progress : called after every press; guide : called before it, and with notices.
    upload_vibrating : uploads a trial whose vibrations are played; None where no trial has any.
    parts : watches the parts of a real rig; None where there is nothing that can be wired wrongly.
    """

    stage: str
    source: TrialSource[S]
    travel_mm: float
    judge: Callable[[Press, float | None], PressAcceptance]
    patience: int
    velocity_progress: Callable[[S], tuple[VelocityProgress, ...]]
    progress: Progress = lambda _done: None
    guide: Guide = field(default_factory=Guide)
    upload_vibrating: Callable[[Device, Trial], None] | None = None
    parts: PartWatch | None = None


class PartWatch(Protocol):
    """Checks the parts of a rig before a session's first press, and looks at each press."""

    @property
    def guard(self) -> PartGuard:
        """What looks at presses."""

    def check(self, device: Device, guide: Guide, log: PressLog) -> None:
        """Check the parts, unless the log has a check of today. Raises PartFaultError."""

    def confirm(self, device: Device, diagnosis: Diagnosis) -> Diagnosis:
        """Return what was found, after a look at the rig at rest where a press cannot tell parts apart."""


def prepare(
    device: Device,
    trial: Trial,
    travel_mm: float,
    before: Trial | None,
    upload_vibrating: Callable[[Device, Trial], None] | None = None,
) -> None:
    """Put a trial on the device, replacing only what differs from the trial before.

    Settings are written before the table, only if the tuning changes them, and persist after the session.
    """
    # a method that changed nothing gives the same object again, so identity is enough
    fresh = before is None or before.surface is not trial.surface or before.vibrating != trial.vibrating
    if before is None or before.tuning != trial.tuning:
        fresh |= tune(device, trial.tuning) or before is None or before.tuning.paced != trial.tuning.paced
    if fresh:
        if trial.vibrating and upload_vibrating:
            upload_vibrating(device, trial)
        else:
            device.upload(trial.surface, travel_mm, trial.tuning.paced)


def run(device: Device, plan: SessionPlan[S], state: S, log: PressLog) -> S:
    """Continue from the presses of the log until the plan is finished; return the last state.

    Every press is logged before the next is asked for. Raises DeviceError if the device fails or too many
    presses in a row cannot be used, KeyboardInterrupt on Ctrl-C; both say how to resume; the device is at
    zero force.
    """
    state = replay(plan, state, log)
    for text in (*(f"warning: {warning}" for warning in log.warnings), _resume_notice(plan, state, log)):
        if text:
            plan.guide.notice(text)
    with release_on_error(device, lambda: how_to_resume(log, log.used, "press", "presses")):
        return _press_until_done(device, plan, state, log)


@contextmanager
def release_on_error(device: Device, resume: Callable[[], str]) -> Iterator[None]:
    """Leave a device at zero force where the block fails; Ctrl-C and DeviceError then say how to resume."""
    try:
        yield
    except BaseException as error:
        release_force(device)
        if isinstance(error, KeyboardInterrupt):
            raise KeyboardInterrupt(f"interrupted; {resume()}") from None
        if isinstance(error, PartFaultError):
            raise PartFaultError(error.fault, f"{error}; {resume()}") from error
        if isinstance(error, DeviceError):
            raise DeviceError(f"{error}; {resume()}") from error
        raise


def replay(plan: SessionPlan[S], state: S, log: PressLog) -> S:
    """Rebuild the state from the used presses. Raises InputError if they were made on other tables."""
    for record in log.records():
        if not record.entry.used:
            continue
        trial = plan.source.trial(state)
        if trial is None or record.press is None or not _same(trial, record):
            _refuse(log, record, "was made on another table or tuning than this method asks for")
        try:
            state = plan.source.step(record.press, state)
        except ModelError as error:
            _refuse(log, record, str(error))
        if plan.parts:
            plan.parts.guard.learn(record.press)
    return state


def _resume_notice(plan: SessionPlan[S], state: S, log: PressLog) -> str:
    """Return a notice that a session is resumed or already finished; empty for a fresh one."""
    if log.folder is None or not log.entries:
        return ""
    count, finished = plan.source.count(state), plan.source.trial(state) is None
    over = "is finished; this is its result again, name another folder for a new one"
    rest = over if finished else "goes on"
    return f"the session in {log.folder}, with {count.made} of {count.total} presses, {rest}"


def _same(trial: Trial, record: PressRecord) -> bool:
    """Return whether a press was made with the tables and tuning of a trial."""
    if trial.velocity_mm_s != record.entry.velocity_mm_s or trial.vibrating != record.vibrating:
        return False
    numbers = trial.tuning.numbers(), record.tuning.numbers()
    if numbers[0].shape != numbers[1].shape or not np.allclose(*numbers, rtol=SAME_TUNING_ratio, atol=0):
        return False
    pairs = [(column, getattr(record.surface, name)) for name, column in vars(trial.surface).items()]
    return all(a.shape == b.shape and np.allclose(a, b, rtol=0, atol=SAME_TABLE_cN) for a, b in pairs)


def _refuse(log: PressLog, record: PressRecord, reason: str) -> NoReturn:
    why = f"{reason}; another version of fdvv made it"
    raise InputError(log.path, f"press {record.entry.number}", why, REMEDY)


def _press_until_done(device: Device, plan: SessionPlan[S], state: S, log: PressLog) -> S:
    before, in_a_row = None, 0
    clear_latched(device, plan.guide.notice)
    if plan.parts and plan.source.trial(state) is not None:
        _check(device, plan, log)
    last: PartFault | None = None
    while (trial := plan.source.trial(state)) is not None:
        prepare(device, trial, plan.travel_mm, before, plan.upload_vibrating)
        count = plan.source.count(state)
        plan.guide.ask(PressRequest(trial.velocity_mm_s, plan.travel_mm, count.made + 1, count.total))
        made = attempt_press(device, trial.velocity_mm_s)
        if made.error and not made.faulted:
            _stop_or_raise(device, plan, trial, made.press, made.error, log)
        # a person cannot repeat a press: Ctrl-C waits until it is on file
        with defer_interrupt():
            entry, state, diagnosis = _take_press(device, plan, state, trial, made, log)
        _report(plan, state, entry, made.press)
        if diagnosis:
            _stop_at(log, diagnosis, entry)
        before = trial
        if made.faulted:
            if lasting := lasting_part(device, made.part, last):
                _stop_at(log, Diagnosis(lasting), entry)
            before = None  # a cleared device needs its program again
        last = made.part
        in_a_row = 0 if entry.used else in_a_row + 1
        if in_a_row >= plan.patience:
            name = device.info().name
            raise DeviceError(f"{name}: {in_a_row} presses in a row could not be used; the last {entry}")
    return state


def _check(device: Device, plan: SessionPlan[S], log: PressLog) -> None:
    assert plan.parts is not None
    try:
        plan.parts.check(device, plan.guide, log)
    except PartFaultError as error:
        log.set_apart(_part_record(error.fault, len(log.entries) + 1))
        raise


def _stop_or_raise(
    device: Device,
    plan: SessionPlan[S],
    trial: Trial,
    press: Press | None,
    error: DeviceError,
    log: PressLog,
) -> NoReturn:
    """End the session with the part that a failed press shows to be at fault, else with its own error."""
    diagnosis = None if press is None else _look(device, plan, press, used=False, sure=True)
    if diagnosis is None:
        raise error
    entry = PressEntry(len(log.entries) + 1, trial.velocity_mm_s, str(diagnosis.fault), None, now())
    log.add(PressRecord(entry, trial.surface, press, trial.tuning, trial.vibrating))
    _stop_at(log, diagnosis, entry)


def _stop_at(log: PressLog, diagnosis: Diagnosis, entry: PressEntry) -> NoReturn:
    """Set the presses of a rig that is another now apart, and end the session."""
    log.set_apart(_part_record(diagnosis.fault, max(1, entry.number - diagnosis.presses + 1)))
    raise PartFaultError(diagnosis.fault)


def _part_record(fault: PartFault, from_press: int) -> PartRecord:
    return PartRecord(from_press, fault.part, fault.seen, fault.remedy, now())


def _take_press(
    device: Device, plan: SessionPlan[S], state: S, trial: Trial, made: PressMade, log: PressLog
) -> tuple[PressEntry, S, Diagnosis | None]:
    """Judge and log a press, and use it if it is usable; return the part at fault, if it shows one."""
    press, diagnosis = made.press, None
    if press is None:
        verdict = PressAcceptance(made.reason, float("nan"))
    else:
        verdict = plan.judge(press, trial.pace_ratio)
        diagnosis = _look(device, plan, press, not verdict.reason)
    reason, after = str(diagnosis.fault) if diagnosis else verdict.reason, state
    if press is not None and not reason:
        try:
            after = plan.source.step(press, state)
        except ModelError as error:
            reason = str(error)
    achieved = verdict.achieved_mm_s if np.isfinite(verdict.achieved_mm_s) else None
    entry = PressEntry(len(log.entries) + 1, trial.velocity_mm_s, reason, achieved, now())
    log.add(PressRecord(entry, trial.surface, press, trial.tuning, trial.vibrating))
    return entry, after, diagnosis


def _look(
    device: Device, plan: SessionPlan[S], press: Press, used: bool, sure: bool = False
) -> Diagnosis | None:
    """Look at the parts before a person is blamed for a press."""
    if plan.parts is None:
        return None
    diagnosis = plan.parts.guard.look(press, used, sure)
    return plan.parts.confirm(device, diagnosis) if diagnosis else None


def _report(plan: SessionPlan[S], state: S, entry: PressEntry, press: Press | None) -> None:
    count = plan.source.count(state)
    achieved = float("nan") if entry.achieved_mm_s is None else entry.achieved_mm_s
    message = plan.source.explain(state) if entry.used else ""
    place = plan.stage, entry.velocity_mm_s, count.made, count.total
    outcome = press, entry.reason, achieved, message
    plan.progress(PressDone(*place, *outcome, lambda: plan.velocity_progress(state)))


def release_force(device: Any) -> None:
    """Set the device to zero force, if it is connected."""
    with suppress(DeviceError):  # disconnected, or at zero force already
        if hasattr(device, "stop"):
            device.stop()


def how_to_resume(log: SessionFile[Any], count: int, noun: str, nouns: str) -> str:
    made = f"{count} {f'{noun} is' if count == 1 else f'{nouns} are'}"
    if log.folder is None:
        return f"{made} lost; name a folder with --session to keep them"
    return f"{made} kept in {log.folder}; run the same command again to go on"
