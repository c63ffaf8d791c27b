"""The two logs of a session of whatever kind: what happened, plain, and what was rendered, sealed."""

from __future__ import annotations

from contextlib import suppress
from pathlib import Path
from typing import Any

from fdvv.errors import InputError
from fdvv_people.study.admin.kept import KeptStudy
from fdvv_people.study.files.people import Schedule, SealedTrial
from fdvv_people.study.files.seal import KeyHolder
from fdvv_people.study.plan.events import SessionEvent, record_of
from fdvv_people.study.session.trial import SEALED_BYTES, sealed_bytes


class SessionLogs:
    """The logs of a session that is open; every record is on the disk when it is written.

    code : the person's, or the key holder in its place. InputError, OSError.
    """

    def __init__(self, study: KeptStudy[Any], schedule: Schedule, code: str | KeyHolder) -> None:
        self._seal, self._counter = study.seal, study.counter(schedule, code)
        self._sealed = study.sealed_log(schedule)
        try:
            self._log = study.session_log(schedule)
        except BaseException:
            self._sealed.close()
            raise

    @property
    def path(self) -> Path:
        """Where what happened is logged."""
        return self._log.path

    @property
    def records(self) -> list[dict[str, Any]]:
        """What had happened when the logs were opened."""
        return self._log.records

    def write(self, event: SessionEvent, count: int) -> None:
        """Log an event, and count what is logged then. count : of answers, or rounds, that are kept."""
        self._log.write(record_of(event))
        if self._counter:
            heads = {log.path.name: log.head for log in (self._log, self._sealed)}
            self._counter.count(heads, count)

    def seal(self, trial: SealedTrial) -> None:
        """Log what was rendered in a trial, for the key holder; of several of one number the last counts."""
        # the lock adds four bytes of its own before it pads
        self._sealed.write({"sealed": self._seal.lock(sealed_bytes(trial), SEALED_BYTES + 4)})

    def abandon(self) -> None:
        """Close both logs; idempotent."""
        self._log.close()
        self._sealed.close()

    def close(self) -> None:
        """Close both logs, and note in the study's log how much was counted; idempotent."""
        self.abandon()
        counter, self._counter = self._counter, None
        if counter:
            # where the study's log was changed a session still ends; it is reported when the next one begins
            with suppress(InputError):
                counter.note()
