"""The two logs of a session: what happened, plain, and what was rendered, sealed."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from fdvv.errors import InputError, ModelError
from fdvv.study.admin.study import Study
from fdvv.study.files.chained_log import ChainedLog, read_chained
from fdvv.study.files.people import Schedule, SealedTrial
from fdvv.study.files.seal import KeyHolder, SealingKey
from fdvv.study.plan.events import Event, SessionResumed, SessionStarted, event_of, face_of, record_of
from fdvv.study.plan.plan import StudyPlan
from fdvv.study.plan.session import ENDS, SessionState, next_step, state_of
from fdvv.study.session.trial import SEALED_BYTES, sealed_bytes

REMEDY = "fdvv study verify lists all that is wrong with the study's folder"


class SessionLog:
    """The events of a session, each on the disk before it counts; for one process at a time.

    Attributes
    ----------
    state : that they lead to; None before the session started.
    """

    def __init__(self, plan: StudyPlan, log: ChainedLog) -> None:
        self.plan, self._log = plan, log
        self.state = _state(log.path, plan, log.records)
        self.close = log.close

    def add(self, event: Event) -> SessionState:
        """Log an event and return the state after it. ModelError where it cannot follow."""
        after = self.state.after(event) if self.state else state_of(self.plan, [event])
        self._log.write(record_of(event))
        self.state = after
        return after


class SealedLog:
    """What was rendered in each trial; it can be written, and read by the key holder only."""

    def __init__(self, log: ChainedLog, seal: SealingKey) -> None:
        self._log, self._seal = log, seal
        self.close = log.close

    def add(self, trial: SealedTrial) -> None:
        """Log a trial; of several with one number the last one counts."""
        # the lock adds four bytes of its own before it pads
        self._log.write({"sealed": self._seal.lock(sealed_bytes(trial), SEALED_BYTES + 4)})


@dataclass(frozen=True, eq=False)
class OpenedSession:
    """A session that is open. **Secret**: its schedule."""

    schedule: Schedule
    log: SessionLog
    sealed: SealedLog
    state: SessionState


def open_session(study: Study, name: str, code: str | KeyHolder, at_s: float) -> OpenedSession:
    """Open a person's session with their code or the key holder; log that it starts, or is resumed.

    Nothing is logged of a session that is done. InputError, OSError.
    """
    schedule = study.schedule(name, code)
    log = SessionLog(study.plan, study.session_log(schedule))
    try:
        state = log.state
        if state is None:
            person = study.person(name)
            faces = tuple(face_of(study.plan, trial) for trial in schedule.trials)
            state = log.add(SessionStarted(at_s, name, person.language, faces, person.simulated))
        elif next_step(state, at_s).kind not in ENDS:
            state = log.add(SessionResumed(at_s, "keeper" if isinstance(code, KeyHolder) else "code"))
        return OpenedSession(schedule, log, SealedLog(study.sealed_log(schedule), study.seal), state)
    except BaseException:
        log.close()
        raise


def read_session(path: Path, plan: StudyPlan) -> SessionState | None:
    """Return the state of a session, while it runs or after; None where it did not start. InputError."""
    return _state(path, plan, read_chained(path).records)


def _state(path: Path, plan: StudyPlan, records: Sequence[dict[str, Any]]) -> SessionState | None:
    try:
        return state_of(plan, [event_of(record) for record in records]) if records else None
    except ModelError as error:
        raise InputError(path, "session", str(error), REMEDY) from error
