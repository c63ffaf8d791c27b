"""A session that shows trials, opened: its state, and every record on the disk before it counts."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

from fdvv.errors import InputError, ModelError
from fdvv.study.admin.study import Study
from fdvv.study.files.chained_log import read_chained
from fdvv.study.files.people import SealedTrial
from fdvv.study.files.seal import KeyHolder
from fdvv.study.plan.events import Event, SessionResumed, SessionStarted, event_of, face_of
from fdvv.study.plan.plan import StudyPlan
from fdvv.study.plan.session import ENDS, SessionState, next_step, state_of
from fdvv.study.session.logs import SessionLogs

REMEDY = "fdvv study verify lists all that is wrong with the study's folder"


class OpenedSession:
    """A session that is open: every record is on the disk before it counts. For one process at a time.

    Opening it logs that it starts, or is resumed; nothing is logged of a session that is done. code : the
    person's, or the key holder in its place. InputError, OSError.

    Attributes
    ----------
    trials : of its schedule. **Secret.** state : after all events.
    """

    def __init__(self, study: Study, name: str, code: str | KeyHolder, at_s: float) -> None:
        schedule = study.schedule(name, code)
        self.trials = schedule.trials
        self._logs = SessionLogs(study, schedule, code)
        try:
            state = _state(self._logs.path, study.plan, self._logs.records)
            if state is None:
                person = study.person(name)
                faces = tuple(face_of(study.plan, trial) for trial in schedule.trials)
                started = SessionStarted(at_s, name, person.language, faces, person.simulated)
                self.state = state_of(study.plan, [started])
                self._write(started, self.state)
            else:
                self.state = state
                if next_step(state, at_s).kind not in ENDS:
                    self.add(SessionResumed(at_s, "keeper" if isinstance(code, KeyHolder) else "code"))
        except BaseException:
            self._logs.abandon()
            raise

    def add(self, event: Event) -> SessionState:
        """Log an event and return the state after it. ModelError where it cannot follow."""
        after = self.state.after(event)
        self._write(event, after)
        self.state = after
        return after

    def _write(self, event: Event, after: SessionState) -> None:
        self._logs.write(event, len(after.answers))

    def seal(self, trial: SealedTrial) -> None:
        """Log what was rendered in a trial, for the key holder; of several of one number the last counts."""
        self._logs.seal(trial)

    def close(self) -> None:
        """Close the logs; idempotent."""
        self._logs.close()


def read_session(path: Path, plan: StudyPlan) -> SessionState | None:
    """Return the state of a session, while it runs or after; None where it did not start. InputError."""
    return _state(path, plan, read_chained(path).records)


def _state(path: Path, plan: StudyPlan, records: Sequence[dict[str, Any]]) -> SessionState | None:
    try:
        return state_of(plan, [event_of(record) for record in records]) if records else None
    except ModelError as error:
        raise InputError(path, "session", str(error), REMEDY) from error
