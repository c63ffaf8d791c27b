"""A session of any kind, opened: its state, and every record on the disk before it counts."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any, Generic, TypeVar

from fdvv.errors import InputError, ModelError
from fdvv_people.study.admin.kept import KeptStudy
from fdvv_people.study.files.chained_log import read_chained
from fdvv_people.study.files.people import SealedTrial
from fdvv_people.study.files.seal import KeyHolder
from fdvv_people.study.plan.events import SessionEvent, SessionResumed
from fdvv_people.study.plan.sitting import ENDS, SittingState
from fdvv_people.study.session.logs import SessionLogs

REMEDY = "fdvv study verify lists all that is wrong with the study's folder"
S = TypeVar("S", bound=SittingState[Any])


class OpenedSession(Generic[S]):
    """A session that is open: every record is on the disk before it counts. For one process at a time.

    Opening it logs that it starts, or is resumed; nothing is logged of a session that is done. code : the
    person's, or the key holder in its place. kind : of the session's state. InputError, OSError.

    Attributes
    ----------
    schedule : of the person. **Secret.** state : after all events.
    """

    def __init__(
        self, study: KeptStudy[Any], name: str, code: str | KeyHolder, at_s: float, kind: type[S]
    ) -> None:
        self.schedule = study.schedule(name, code)
        self._logs = SessionLogs(study, self.schedule, code)
        try:
            state = _state(self._logs.path, study.plan, self._logs.records, kind)
            if state is None:
                started = study.start(study.person(name), self.schedule, at_s)
                self.state = kind.of(study.plan, [started])
                self._write(started, self.state)
            else:
                self.state = state
                if state.step(at_s).kind not in ENDS:
                    self.add(SessionResumed(at_s, "keeper" if isinstance(code, KeyHolder) else "code"))
        except BaseException:
            self._logs.abandon()
            raise

    def add(self, event: SessionEvent) -> S:
        """Log an event and return the state after it. ModelError where it cannot follow."""
        after = self.state.after(event)
        self._write(event, after)
        self.state = after
        return after

    def _write(self, event: SessionEvent, after: S) -> None:
        self._logs.write(event, after.count)

    def seal(self, trial: SealedTrial) -> None:
        """Log what was rendered in a trial, for the key holder; of several of one number the last counts."""
        self._logs.seal(trial)

    def close(self) -> None:
        """Close the logs; idempotent."""
        self._logs.close()


def read_session(path: Path, plan: Any, kind: type[S]) -> S | None:
    """Return the state of a session, while it runs or after; None where it did not start. InputError."""
    return _state(path, plan, read_chained(path).records, kind)


def _state(path: Path, plan: Any, records: Sequence[dict[str, Any]], kind: type[S]) -> S | None:
    try:
        return kind.read(plan, records)
    except ModelError as error:
        raise InputError(path, "session", str(error), REMEDY) from error
