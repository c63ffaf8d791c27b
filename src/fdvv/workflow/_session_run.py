"""The loop of a session: put a trial on the device, have it pressed, judge, keep, learn."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any, Generic, NoReturn, Protocol, TypeVar, cast

import numpy as np

from fdvv.compensate import Count, Trial, Verdict
from fdvv.device import Device, FaultReport, ProgramDevice
from fdvv.errors import DeviceError, InputError, ModelError
from fdvv.model import Press
from fdvv.protocol import Fault
from fdvv.workflow._held_back import held_back
from fdvv.workflow._session_events import Ask, Guide, PressDone, Progress, Standing
from fdvv.workflow._session_log import REMEDY, Entry, Kept, PressLog
from fdvv.workflow._session_manifest import now
from fdvv.workflow._tuning import tune

S = TypeVar("S")

SAME_TABLE_cN = 1 / 64
"""What a device rounds commands to: tables that differ by less are the same."""


class Plan(Protocol[S]):
    """What the loop needs of a method, or of a probe."""

    def trial(self, state: S) -> Trial | None:
        """Tell what to press next; None when finished."""
        ...

    def step(self, press: Press, state: S) -> S:
        """Use the press; ModelError, whose text is the reason, if that cannot be."""
        ...

    def count(self, state: S) -> Count:
        """Tell how far it is."""
        ...

    def explain(self, state: S) -> str:
        """Tell what the last press changed."""
        ...


@dataclass(frozen=True, eq=False)
class Course(Generic[S]):
    """What a session runs.

    Attributes
    ----------
    stage : "compensate" or "probe".
    judge : tells whether a press may be used, by a trial's own bound of pace unless that is None.
    patience : so many in a row that may not end the session.
    standing : how far every velocity is.
    progress : called after every press; guide : before it, and with notices.
    """

    stage: str
    plan: Plan[S]
    travel_mm: float
    judge: Callable[[Press, float | None], Verdict]
    patience: int
    standing: Callable[[S], tuple[Standing, ...]]
    progress: Progress = lambda _done: None
    guide: Guide = field(default_factory=Guide)


def prepare(device: Device, trial: Trial, travel_mm: float, before: Trial | None) -> None:
    """Put a trial on the device; before is the one that is on it, of which only what differs is replaced.

    Settings are written before the table, only if the tuning changes them; they stay when the session ends.
    """
    fresh = before is None or before.surface is not trial.surface
    if before is None or before.tuning != trial.tuning:
        fresh |= tune(device, trial.tuning) or before is None or before.tuning.paced != trial.tuning.paced
    if fresh:
        device.upload(trial.surface, travel_mm, trial.tuning.paced)


def run(device: Device, course: Course[S], state: S, log: PressLog) -> S:
    """Go on from the presses of the log until the plan is finished; give the last state.

    Every press is in the log before it is used. Raises DeviceError if the device fails or too many presses in
    a row cannot be used, KeyboardInterrupt on Ctrl-C; both say how to go on, and the device is at zero force.
    """
    state = replayed(course, state, log)
    for text in (*(f"warning: {warning}" for warning in log.warnings), _standing_of(course, state, log)):
        if text:
            course.guide.notice(text)
    try:
        return _pressed(device, course, state, log)
    except KeyboardInterrupt:
        let_go(device)
        raise KeyboardInterrupt(f"interrupted; {_how_to_go_on(course, log)}") from None
    except DeviceError as error:
        let_go(device)
        raise DeviceError(f"{error}; {_how_to_go_on(course, log)}") from error
    except BaseException:
        let_go(device)
        raise


def replayed(course: Course[S], state: S, log: PressLog) -> S:
    """Rebuild the state from the presses that were used. InputError if they were made on other tables."""
    for kept in log.kept():
        if not kept.entry.used:
            continue
        trial = course.plan.trial(state)
        if trial is None or kept.press is None or not _same(trial, kept):
            _refuse(log, kept, "was made on another table or tuning than this method asks for")
        try:
            state = course.plan.step(kept.press, state)
        except ModelError as error:
            _refuse(log, kept, str(error))
    return state


def _standing_of(course: Course[S], state: S, log: PressLog) -> str:
    """Say that a session goes on, or was finished already; nothing of a fresh one."""
    if log.folder is None or not log.entries:
        return ""
    count = course.plan.count(state)
    if course.plan.trial(state) is None:
        rest = "is finished; this is its result again, name another folder for a new one"
    else:
        rest = "goes on"
    return f"the session in {log.folder}, with {count.made} of {count.total} presses, {rest}"


def _same(trial: Trial, kept: Kept) -> bool:
    """Tell whether a press was asked for, and made, on the tables and under the tuning of a trial."""
    if trial.velocity_mm_s != kept.entry.velocity_mm_s or trial.tuning != kept.tuning:
        return False
    names = ("displacement_mm", "velocity_mm_s", "press_cN", "release_cN")
    pairs = [(getattr(trial.surface, name), getattr(kept.surface, name)) for name in names]
    return all(a.shape == b.shape and np.allclose(a, b, rtol=0, atol=SAME_TABLE_cN) for a, b in pairs)


def _refuse(log: PressLog, kept: Kept, reason: str) -> NoReturn:
    why = f"{reason}; another version of fdvv made it"
    raise InputError(log.path, f"press {kept.entry.number}", why, REMEDY)


def _pressed(device: Device, course: Course[S], state: S, log: PressLog) -> S:
    """Press until the plan is finished."""
    before, in_a_row = None, 0
    clear_latched(device, course.guide.notice)
    while (trial := course.plan.trial(state)) is not None:
        prepare(device, trial, course.travel_mm, before)
        count = course.plan.count(state)
        course.guide.ask(Ask(trial.velocity_mm_s, course.travel_mm, count.made + 1, count.total))
        press, fault = _made(device, trial)
        with held_back():
            entry, state = _taken(course, state, trial, (press, fault), log)
        _tell(course, state, entry, press)
        before = trial
        if fault:
            _cleared(device)
            before = None  # it is given its program again
        in_a_row = 0 if entry.used else in_a_row + 1
        if in_a_row >= course.patience:
            name = device.info().name
            raise DeviceError(f"{name}: {in_a_row} presses in a row could not be used; the last {entry}")
    return state


def _made(device: Device, trial: Trial) -> tuple[Press | None, str]:
    """Have one press made; if the device faulted, no press and what it told of the fault."""
    try:
        return device.press(trial.velocity_mm_s), ""
    except DeviceError as error:
        if not _faulted(device):
            raise
        return None, str(error)


def clear_latched(device: Device, notice: Callable[[str], None]) -> None:
    """Clear a fault that was latched before, and tell of it. DeviceError while its cause lasts."""
    if _faulted(device):
        notice(f"warning: {device.info().name} had fallen to zero force, {_cleared(device)}; cleared")


def _faulted(device: Device) -> bool:
    """Tell whether the device is there and has fallen to zero force."""
    try:
        return hasattr(device, "fault") and device.fault().fault is not Fault.NONE
    except DeviceError:
        return False


def _cleared(device: Device) -> FaultReport:
    """Clear the fault of a device that has told of one; give it. DeviceError while its cause lasts."""
    board = cast(ProgramDevice, device)
    report = board.fault()
    board.clear_fault()
    return report


def _taken(
    course: Course[S], state: S, trial: Trial, made: tuple[Press | None, str], log: PressLog
) -> tuple[Entry, S]:
    """Judge a press, keep it, and use it if it may be used."""
    press, reason = made
    verdict = Verdict(reason, float("nan")) if press is None else course.judge(press, trial.pace_ratio)
    reason, after = verdict.reason, state
    if press is not None and not reason:
        try:
            after = course.plan.step(press, state)
        except ModelError as error:
            reason = str(error)
    achieved = verdict.achieved_mm_s if np.isfinite(verdict.achieved_mm_s) else None
    entry = Entry(len(log.entries) + 1, trial.velocity_mm_s, reason, achieved, now())
    log.add(Kept(entry, trial.surface, press, trial.tuning))
    return entry, after


def _tell(course: Course[S], state: S, entry: Entry, press: Press | None) -> None:
    count = course.plan.count(state)
    achieved = float("nan") if entry.achieved_mm_s is None else entry.achieved_mm_s
    told = course.plan.explain(state) if entry.used else ""
    course.progress(
        PressDone(
            course.stage,
            entry.velocity_mm_s,
            count.made,
            count.total,
            press,
            entry.reason,
            achieved,
            told,
            lambda: course.standing(state),
        )
    )


def let_go(device: Any) -> None:
    """Fall to zero force, if the device is there and holds any."""
    try:
        if hasattr(device, "stop"):
            device.stop()
    except DeviceError:
        pass  # it is gone, or at zero force already


def _how_to_go_on(course: Course[Any], log: PressLog) -> str:
    made = f"{log.used} {'press is' if log.used == 1 else 'presses are'}"
    if log.folder is None:
        return f"{made} lost; name a folder with --session to keep them"
    return f"{made} kept in {log.folder}; run the same command again to go on"
