"""The two journals of a session: what happened, plain, and what was rendered, under the seal."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from fdvv.errors import InputError, ModelError
from fdvv.study import (
    ENDS,
    Began,
    Event,
    Resumed,
    SessionState,
    StudyPlan,
    event_of,
    face_of,
    next_step,
    record_of,
    state_of,
)
from fdvv.workflow._sealed_trial import SEALED_BYTES, sealed_bytes
from fdvv.workflow._study import Study
from fdvv.workflow._study_chain import read_chained
from fdvv.workflow._study_log import ChainedLog
from fdvv.workflow._study_people import Schedule, SealedTrial
from fdvv.workflow._study_seal import Keeper, Seal

REMEDY = "fdvv study verify tells all that is wrong with the study's folder"


class SessionLog:
    """The events of a session, each on the disk before it counts; for one process at a time.

    Attributes
    ----------
    state : where they leave the session; None before it began.
    """

    def __init__(self, plan: StudyPlan, log: ChainedLog) -> None:
        self.plan, self._log = plan, log
        events = _events(log.path, log.records)
        self.state = _state(log.path, plan, events) if events else None

    def add(self, event: Event) -> SessionState:
        """Write down an event and give where it leads. ModelError where it cannot follow."""
        after = self.state.after(event) if self.state else state_of(self.plan, [event])
        self._log.write(record_of(event))
        self.state = after
        return after

    def close(self) -> None:
        """Let go of the file; a second time does nothing."""
        self._log.close()


class SealedLog:
    """What was rendered in each trial; it can be written and not read without the keeper."""

    def __init__(self, log: ChainedLog, seal: Seal) -> None:
        self._log, self._seal = log, seal

    def add(self, trial: SealedTrial) -> None:
        """Write down a trial; of those of one number the last one counts."""
        # the lock adds four bytes of its own before it pads
        self._log.write({"sealed": self._seal.lock(sealed_bytes(trial), SEALED_BYTES + 4)})

    def close(self) -> None:
        """Let go of the file; a second time does nothing."""
        self._log.close()


@dataclass(frozen=True, eq=False)
class OpenedSession:
    """A session that is open to go on. **Secret**: its schedule."""

    schedule: Schedule
    log: SessionLog
    sealed: SealedLog
    state: SessionState


def open_session(study: Study, person: str, code: str | Keeper, at_s: float) -> OpenedSession:
    """Open somebody's session with their code or the keeper's key; begin it, or note that it goes on.

    Of a session that is done nothing is noted. InputError, OSError.
    """
    if isinstance(code, Keeper):
        schedule = study.schedule_by_keeper(person, code)
    else:
        schedule = study.schedule(person, code)
    log = SessionLog(study.plan, study.session_log(schedule))
    try:
        state = log.state
        if state is None:
            state = log.add(_began(study, person, schedule, at_s))
        elif next_step(state, at_s).kind not in ENDS:
            state = log.add(Resumed(at_s, "keeper" if isinstance(code, Keeper) else "code"))
        return OpenedSession(schedule, log, SealedLog(study.sealed_log(schedule), study.seal), state)
    except BaseException:
        log.close()
        raise


def _began(study: Study, name: str, schedule: Schedule, at_s: float) -> Began:
    person = study.person(name)
    faces = tuple(face_of(study.plan, trial) for trial in schedule.trials)
    return Began(at_s, name, person.language, faces, person.simulated)


def read_session(path: Path, plan: StudyPlan) -> SessionState | None:
    """Read where a session stands, while it goes on or after; None where it did not begin. InputError."""
    events = _events(path, read_chained(path).records)
    return _state(path, plan, events) if events else None


def _events(path: Path, records: Sequence[dict[str, Any]]) -> list[Event]:
    try:
        return [event_of(record) for record in records]
    except ModelError as error:
        raise InputError(path, "session", str(error), REMEDY) from error


def _state(path: Path, plan: StudyPlan, events: list[Event]) -> SessionState:
    try:
        return state_of(plan, events)
    except ModelError as error:
        raise InputError(path, "session", str(error), REMEDY) from error
