"""One job: how it stands, what it told, who listens."""

from __future__ import annotations

import threading
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import msgspec

from fdvv.journal import Journal
from fdvv.studio._job_file import JobFolder, JobRecord
from fdvv.studio._job_start import JobStart
from fdvv.studio._messages_events import (
    JobEnded,
    JobEvent,
    JobOutcome,
    PressAsked,
    PressTold,
    QuestionAnswered,
    QuestionAsked,
    StageTold,
)
from fdvv.studio._messages_jobs import JobRow, JobState
from fdvv.studio._messages_orders import kind_of
from fdvv.studio._messages_takes import TakeAsked, TakeTold

Heard = Callable[[int, Sequence[JobEvent]], None]
"""Is given the number of the first event, and events."""

UNFINISHED = ("waiting", "running", "needs you")
BROKEN_OFF = "the studio ended meanwhile; what was made is kept"


@dataclass(frozen=True)
class Standing:
    """How far a job is, as its events tell.

    Attributes
    ----------
    question : number of the one that waits for an answer; 0 if none does.
    """

    state: JobState = "waiting"
    now: str = ""
    done: int = 0
    total: int = 0
    question: int = 0

    def after(self, event: JobEvent) -> Standing:
        """Give the standing once an event was told."""
        done, total = self.done, self.total
        if isinstance(event, StageTold):
            return Standing("running", event.text, 0, 0)
        if isinstance(event, PressTold):
            told = event.skipped or event.told
            return Standing(
                "running", f"{event.velocity_mm_s:g} mm/s: {told}".rstrip(": "), event.done, event.total
            )
        if isinstance(event, PressAsked):
            return Standing(
                "needs you", f"press at {event.velocity_mm_s:g} mm/s", event.number - 1, event.total
            )
        if isinstance(event, TakeAsked):
            return Standing("needs you", "follow the cue", event.number - 1, event.total)
        if isinstance(event, TakeTold):
            told = event.reason or "good"
            return Standing("running", f"take {event.number}: {told}", event.done, event.total)
        if isinstance(event, QuestionAsked):
            now = f"question {event.number} of {event.total} at most"
            return Standing("needs you", now, event.number - 1, event.total, event.number)
        if isinstance(event, QuestionAnswered):
            return Standing("running", f"answer {event.number} is kept", event.number, event.total)
        if isinstance(event, JobOutcome):
            return Standing("running", event.sentence, done, total)
        return self if self.state != "waiting" else Standing("running", self.now, done, total)


class LiveJob:
    """A job of this studio. Any thread may ask; all changes are made under the lock.

    Parameters
    ----------
    name : of the job. folder, record : of it.
    """

    def __init__(self, name: str, folder: JobFolder, record: JobRecord) -> None:
        self.name, self.folder, self.record = name, folder, record
        self.lock = threading.RLock()
        self.start: JobStart | None = None
        self.standing = Standing(record.state, record.line, record.done, record.total)
        self._events: list[JobEvent] | None = None
        self._journal: Journal | None = None
        self._listeners: list[Heard] = []

    @property
    def events(self) -> list[JobEvent]:
        """Get all that was told, read when it is first asked for. InputError."""
        with self.lock:
            if self._events is None:
                self._events = self.folder.events()
            return self._events

    @property
    def row(self) -> JobRow:
        """Give the job as a list shows it."""
        with self.lock:
            record, standing = self.record, self.standing
            over = record.state not in UNFINISHED
            return JobRow(
                self.name,
                kind_of(record.order),
                record.title,
                record.order.device,
                record.simulated,
                record.state if over else standing.state,
                record.line,
                standing.now,
                standing.done,
                standing.total,
                record.events if self._events is None else len(self._events),
                record.state in ("cancelled", "failed"),
                record.created,
                record.ended,
                record.results,
            )

    def begin(self) -> None:
        """Open the journal to go on with it. InputError if another process is at work on the job, OSError."""
        with self.lock:
            self._journal = self.folder.open_journal()
            self._events = self.folder.events()

    def heard(self, event: JobEvent) -> None:
        """Keep an event and tell it to whoever listens."""
        with self.lock:
            if self._journal:
                self._journal.write({"event": msgspec.to_builtins(event)})
            number = len(self.events)
            self.events.append(event)
            if not isinstance(event, JobEnded):
                self.standing = self.standing.after(event)
            for listener in self._listeners:
                listener(number, (event,))

    def settle(self, record: JobRecord) -> None:
        """Keep how the job stands now; with the end of a start its journal is closed. OSError."""
        with self.lock:
            counts = {"done": self.standing.done, "total": self.standing.total, "events": len(self.events)}
            self.record = msgspec.structs.replace(record, **counts)
            self.folder.save(self.record)
            if record.state not in UNFINISHED and self._journal:
                self._journal.close()
                self._journal = None

    def listen(self, from_event: int, heard: Heard) -> Callable[[], None]:
        """Tell events from a number on, and then as they come; what is given back ends it. InputError."""
        with self.lock:
            if from_event < len(self.events):
                heard(from_event, self.events[from_event:])
            self._listeners.append(heard)

        def end() -> None:
            with self.lock:
                if heard in self._listeners:
                    self._listeners.remove(heard)

        return end
