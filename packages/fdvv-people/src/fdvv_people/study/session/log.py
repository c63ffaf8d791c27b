"""A session of any kind, opened: its state, and every record on the disk before it counts."""

from __future__ import annotations

from collections.abc import Sequence
from contextlib import suppress
from pathlib import Path
from typing import Any, Literal, TypeVar

from fdvv.errors import InputError, ModelError
from fdvv_people.study.admin.study import Study
from fdvv_people.study.files.chained_log import read_chained
from fdvv_people.study.files.people import SealedTrial
from fdvv_people.study.files.seal import KeyHolder
from fdvv_people.study.plan.events import SessionEvent, SessionResumed, record_of
from fdvv_people.study.plan.sitting import ENDS, SittingState
from fdvv_people.study.session.trial import SEALED_BYTES, sealed_bytes

REMEDY = "fdvv study verify lists all that is wrong with the study's folder"
S = TypeVar("S", bound=SittingState[Any])


class OpenedSession:
    """A session that is open: every record is on the disk before it counts. For one process at a time.

    Two logs are held open: what happened, plain, and what was rendered, sealed. Opening them logs that the
    session starts, or is resumed; nothing is logged of a session that is done. code : the person's, or the
    key holder in its place. InputError, OSError.

    Attributes
    ----------
    schedule : of the person. **Secret.** state : after all events.
    """

    def __init__(self, study: Study, name: str, code: str | KeyHolder, at_s: float) -> None:
        self.schedule = study.schedule(name, code)
        self._seal, self._counter = study.seal, study.counter(self.schedule, code)
        self._sealed = study.sealed_log(self.schedule)
        try:
            self._log = study.session_log(self.schedule)
        except BaseException:
            self._sealed.close()
            raise
        try:
            self.state = self._begin(study, name, at_s, "keeper" if isinstance(code, KeyHolder) else "code")
        except BaseException:
            self._close_logs()
            raise

    def _begin(
        self, study: Study, name: str, at_s: float, by: Literal["code", "keeper"]
    ) -> SittingState[Any]:
        kind = study.kind
        state = _state(self._log.path, study.plan, self._log.records, kind.state)
        if state is None:
            started = kind.start(study, study.person(name), self.schedule, at_s)
            state = kind.state.of(study.plan, [started])
            self._write(started, state)
        elif state.step(at_s).kind not in ENDS:
            event = SessionResumed(at_s, by)
            state = state.after(event)
            self._write(event, state)
        return state

    def add(self, event: SessionEvent) -> SittingState[Any]:
        """Log an event and return the state after it. ModelError where it cannot follow."""
        after = self.state.after(event)
        self._write(event, after)
        self.state = after
        return after

    def _write(self, event: SessionEvent, after: SittingState[Any]) -> None:
        """Log an event, and count what is logged then."""
        self._log.write(record_of(event))
        if self._counter:
            heads = {log.path.name: log.head for log in (self._log, self._sealed)}
            self._counter.count(heads, after.count)

    def seal(self, trial: SealedTrial) -> None:
        """Log what was rendered in a trial, for the key holder; of several of one number the last counts."""
        # the lock adds four bytes of its own before it pads
        self._sealed.write({"sealed": self._seal.lock(sealed_bytes(trial), SEALED_BYTES + 4)})

    def close(self) -> None:
        """Close the logs, and note in the study's log how much was counted; idempotent."""
        self._close_logs()
        counter, self._counter = self._counter, None
        if counter:
            # where the study's log was changed a session still ends; it is reported when the next one begins
            with suppress(InputError):
                counter.note()

    def _close_logs(self) -> None:
        self._log.close()
        self._sealed.close()


def read_session(path: Path, plan: Any, kind: type[S]) -> S | None:
    """Return the state of a session, while it runs or after; None where it did not start. InputError."""
    return _state(path, plan, read_chained(path).records, kind)


def _state(path: Path, plan: Any, records: Sequence[dict[str, Any]], kind: type[S]) -> S | None:
    try:
        return kind.read(plan, records)
    except ModelError as error:
        raise InputError(path, "session", str(error), REMEDY) from error
