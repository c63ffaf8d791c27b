"""The two logs of a session: what happened, plain, and what was rendered, sealed."""

from __future__ import annotations

from collections.abc import Sequence
from contextlib import suppress
from pathlib import Path
from typing import Any

from fdvv.errors import InputError, ModelError
from fdvv.study.admin.study import Study
from fdvv.study.files.chained_log import read_chained
from fdvv.study.files.people import SealedTrial
from fdvv.study.files.seal import KeyHolder
from fdvv.study.plan.events import Event, SessionResumed, SessionStarted, event_of, face_of, record_of
from fdvv.study.plan.plan import StudyPlan
from fdvv.study.plan.session import ENDS, SessionState, next_step, state_of
from fdvv.study.session.trial import SEALED_BYTES, sealed_bytes

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
        self.trials, self._seal = schedule.trials, study.seal
        self._counter = study.counter(schedule, code)
        self._sealed = study.sealed_log(schedule)
        try:
            self._log = study.session_log(schedule)
        except BaseException:
            self._sealed.close()
            raise
        try:
            state = _state(self._log.path, study.plan, self._log.records)
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
            self._log.close()
            self._sealed.close()
            raise

    def add(self, event: Event) -> SessionState:
        """Log an event and return the state after it. ModelError where it cannot follow."""
        after = self.state.after(event)
        self._write(event, after)
        self.state = after
        return after

    def _write(self, event: Event, after: SessionState) -> None:
        """Log an event, and count what is logged then."""
        self._log.write(record_of(event))
        if self._counter:
            heads = {log.path.name: log.head for log in (self._log, self._sealed)}
            self._counter.count(heads, len(after.answers))

    def seal(self, trial: SealedTrial) -> None:
        """Log what was rendered in a trial, for the key holder; of several of one number the last counts."""
        # the lock adds four bytes of its own before it pads
        self._sealed.write({"sealed": self._seal.lock(sealed_bytes(trial), SEALED_BYTES + 4)})

    def close(self) -> None:
        """Close both logs, and note in the study's log how much was counted; idempotent."""
        self._log.close()
        self._sealed.close()
        counter, self._counter = self._counter, None
        if counter:
            # where the study's log was changed a session still ends; it is reported when the next one begins
            with suppress(InputError):
                counter.note()


def read_session(path: Path, plan: StudyPlan) -> SessionState | None:
    """Return the state of a session, while it runs or after; None where it did not start. InputError."""
    return _state(path, plan, read_chained(path).records)


def _state(path: Path, plan: StudyPlan, records: Sequence[dict[str, Any]]) -> SessionState | None:
    try:
        return state_of(plan, [event_of(record) for record in records]) if records else None
    except ModelError as error:
        raise InputError(path, "session", str(error), REMEDY) from error
