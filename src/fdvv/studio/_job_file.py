"""The folder of a job: what was ordered, how it stands, what it told, and what it works on.

``job.json`` holds the order and the state; ``events.jsonl`` is a journal (`fdvv.journal`) of what was told;
inputs are copies, so that an edit of a button does not change a job that goes on.
"""

from __future__ import annotations

from dataclasses import dataclass
from datetime import UTC, datetime
from pathlib import Path
from typing import Any, Literal

import msgspec

from fdvv.documents import Kind, pretty, read_document
from fdvv.errors import InputError
from fdvv.files import read_limited, write_atomic
from fdvv.journal import Journal, JournalKind, read_records
from fdvv.studio._messages_events import JobEvent
from fdvv.studio._messages_jobs import JobResult, JobState
from fdvv.studio._messages_orders import CaptureOrder, CompensateOrder, ProbeOrder, TuneOrder

JOB, EVENTS = "job.json", "events.jsonl"
REMEDY = "put the job's folder elsewhere, or begin the work anew"
KIND = Kind("fdvv-job", 1, "a job", REMEDY)
JOURNAL = JournalKind(frozenset({"event"}), REMEDY)
LARGEST_bytes = 1_000_000


class JobRecord(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """A job as its file keeps it.

    Attributes
    ----------
    line : why it was not finished; empty otherwise. run : counts its starts.
    done, total : of presses, takes or questions. events : that were told.
    created, ended : UTC; ended None while it lasts.
    """

    format: Literal["fdvv-job"]
    version: Literal[1]
    order: CompensateOrder | ProbeOrder | CaptureOrder | TuneOrder
    title: str
    simulated: bool
    created: str
    state: JobState = "waiting"
    line: str = ""
    run: int = 0
    ended: str | None = None
    done: int = 0
    total: int = 0
    events: int = 0
    results: tuple[JobResult, ...] = ()


@dataclass(frozen=True)
class JobFolder:
    """Where a job keeps everything, by name."""

    path: Path

    @property
    def button(self) -> Path:
        """The model that is worked on."""
        return self.path / "button.fdvv.json"

    @property
    def actuation(self) -> Path:
        """The learned table that is worked on; absent where there is none."""
        return self.path / "given.actuation.json"

    @property
    def known_rig(self) -> Path:
        """What the rig has taught before; absent where nothing is known."""
        return self.path / "known.rig.json"

    @property
    def rig(self) -> Path:
        """The simulated rig."""
        return self.path / "rig.toml"

    @property
    def session(self) -> Path:
        """The presses or answers."""
        return self.path / "session"

    @property
    def probe(self) -> Path:
        """The fresh presses that judge what was learned."""
        return self.path / "probe-session"

    @property
    def recording(self) -> Path:
        """The takes of a capture."""
        return self.path / "capture.recording.jsonl"

    def result(self, kind: str) -> Path:
        """The file of a result, before it is put into its place in the project."""
        return self.path / f"result.{kind}.json"

    def save(self, record: JobRecord) -> None:
        """Write how the job stands. OSError."""
        write_atomic(self.path / JOB, pretty(msgspec.to_builtins(record)) + "\n")

    def load(self) -> JobRecord:
        """Read how the job stands. InputError."""
        path = self.path / JOB
        text = read_limited(path, LARGEST_bytes, REMEDY)
        return read_document(text, path, KIND, _record, lambda _: None)

    def open_journal(self) -> Journal:
        """Open the events to go on with them; one that was cut short is cut off. InputError, OSError."""
        path = self.path / EVENTS
        busy = InputError(path, "job", "another process is at work on it", "wait until it is done")
        journal = Journal(path, busy)
        journal.cut(whole_bytes(path))
        return journal

    def events(self) -> list[JobEvent]:
        """Read all that was told; nothing if there is no file. InputError on a damaged one."""
        path = self.path / EVENTS
        if not path.is_file():
            return []
        return [_event(path, record) for record, _ in read_records(path, JOURNAL)]


def utc_now() -> str:
    """Give the time, UTC."""
    return datetime.now(UTC).isoformat(timespec="milliseconds")


def whole_bytes(path: Path) -> int:
    """Give the byte where the last whole record of a job's journal ends."""
    end = 0
    for _record_there, after in read_records(path, JOURNAL):
        end = after
    return end


def _record(data: bytes) -> JobRecord:
    return msgspec.json.decode(data, type=JobRecord)


def _event(path: Path, record: dict[str, Any]) -> JobEvent:
    try:
        found: JobEvent = msgspec.convert(record["event"], JobEvent)
        return found
    except msgspec.ValidationError as error:
        raise InputError(path, "event", str(error), REMEDY) from error
