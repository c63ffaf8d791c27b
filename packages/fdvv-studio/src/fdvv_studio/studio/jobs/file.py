"""The folder of a job: its order, state, events, inputs and results.

``job.json`` holds the order and the state; ``events.jsonl`` is the journal (`fdvv.eventlog`) of its events;
inputs are copies, so that an edit of a button does not change a job in progress.
"""

from __future__ import annotations

import os
from collections.abc import Iterable
from dataclasses import dataclass
from datetime import UTC, datetime
from itertools import chain, count
from pathlib import Path
from typing import Any, Literal

import msgspec

from fdvv.device.open import is_manual
from fdvv.errors import InputError
from fdvv.eventlog import Journal, JournalKind, read_records
from fdvv.io.documents import Kind, pretty, read_document
from fdvv.io.files import read_limited, write_atomic
from fdvv.model.jnd_file import FILE_NAME as JNDS_NAME
from fdvv.twin.files import current_rig_name
from fdvv_studio.studio.contract import Message
from fdvv_studio.studio.jobs.check import check_count, check_order
from fdvv_studio.studio.jobs.events import JobEvent
from fdvv_studio.studio.jobs.orders import CaptureOrder, CompensateOrder, KindName, Order, nest_settings

JOBS, JOB, EVENTS = "jobs", "job.json", "events.jsonl"
REMEDY = "put the job's folder elsewhere, or begin the work anew"
KIND = Kind("fdvv-job", 2, "a job", REMEDY, oldest=1)
JOURNAL = JournalKind({"event": Any}, REMEDY)
LARGEST_bytes, LARGEST_EVENTS_bytes = 1_000_000, 500_000_000
"""An order takes some kB; that of the events is assumed. Bounds, as a project may come from somebody else."""
COUNTED = ("run", "done", "total", "events")


class JobRecord(Message):
    """A job as its file keeps it.

    line : why it was not finished; empty otherwise. run : counts its starts.
    done, total : of presses, takes or questions. events : how many there are.
    created, ended : UTC; ended None while it lasts.
    """

    format: Literal["fdvv-job"]
    version: Literal[1, 2]
    order: Order
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


class JobFolder:
    """Where a job keeps everything.

    button : the model that is worked on. recording : the takes of a capture.
    actuation : the learned table that is worked on; absent where there is none.
    known_rig : what is known of the rig from before; absent where nothing is.
    rig : the simulated rig. session : the presses or answers.
    probe : the fresh presses that judge what was learned. baseline : the same without compensation.
    jnds : what people notice, as the project had it; absent where it had none.
    """

    def __init__(self, path: Path) -> None:
        self.path = path
        self.button = path / "button.fdvv.json"
        self.actuation = path / "given.actuation.json"
        self.known_rig = path / "known.rig.json"
        self.rig = path / "rig.toml"
        self.session = path / "session"
        self.probe = path / "probe-session"
        self.baseline = path / "baseline-session"
        self.recording = path / "capture.recording.jsonl"
        self.jnds = path / JNDS_NAME

    def result(self, kind: str) -> Path:
        """The file of a result, before it is put into its place in the project."""
        return self.path / f"result.{kind}.json"

    def save(self, record: JobRecord) -> None:
        write_atomic(self.path / JOB, pretty(msgspec.to_builtins(record)) + "\n")

    def read(self) -> JobRecord:
        """Read the job, unchecked. InputError on a damaged one, and on one whose folder holds a link."""
        require_own_files(self.path)
        path = self.path / JOB
        try:
            text = read_limited(path, LARGEST_bytes, REMEDY)
            return read_document(text, path, KIND, _decode, lambda _place: None)
        except InputError as error:
            raise InputError(error.source, self._place(error), error.reason, error.remedy) from error

    def check(self, record: JobRecord) -> None:
        """Refuse what could not have been ordered: anyone may have written the file. InputError."""
        try:
            check_order(record.order)
            for name in COUNTED:
                check_count(name, getattr(record, name))
        except InputError as error:
            remedy = f"begin the work anew, and {error.remedy}"
            raise InputError(self.path / JOB, self._place(error), error.reason, remedy) from error

    def load(self) -> JobRecord:
        """Read the job and check it. InputError."""
        record = self.read()
        self.check(record)
        return record

    def _place(self, error: InputError) -> str:
        """Name the file in the project beside the place in it: pages get no paths."""
        return f"{JOBS}/{self.path.name}/{JOB}, {error.place}"

    def open_journal(self) -> Journal:
        """Open the events to append to them; an incomplete last record is cut off. InputError, OSError."""
        path = self.path / EVENTS
        busy = InputError(path, "job", "another process is at work on it", "wait until it is done")
        journal = Journal(path, busy)
        journal.cut(max((end for _, end in read_records(path, JOURNAL)), default=0))
        return journal

    def events(self) -> list[JobEvent]:
        """Read all events; none if there is no file. InputError on a damaged one."""
        path = self.path / EVENTS
        if path.is_file() and path.stat().st_size > LARGEST_EVENTS_bytes:
            reason = f"larger than {LARGEST_EVENTS_bytes // 1_000_000} MB"
            raise InputError(path, f"{self.path.name}/{EVENTS}", reason, REMEDY)
        records = read_records(path, JOURNAL) if path.is_file() else ()
        try:
            return [msgspec.convert(record["event"], JobEvent) for record, _ in records]
        except msgspec.ValidationError as error:
            raise InputError(path, "event", str(error), REMEDY) from error


def _decode(text: bytes) -> JobRecord:
    content = msgspec.json.decode(text)
    if content["version"] == 1 and isinstance(content.get("order"), dict):
        content["order"] = nest_settings(content["order"])
    return msgspec.convert(content, JobRecord)


def require_own_files(folder: Path) -> None:
    """Refuse a job's folder that is, or holds, a link or a pipe: work would read and write elsewhere.

    InputError, OSError.
    """
    project, inside = folder.parent.parent, [folder]
    _require_no_links(project, (folder.parent, folder))
    while inside:
        for entry in list(os.scandir(inside.pop())):
            if entry.is_dir(follow_symlinks=False):
                inside.append(Path(entry.path))
            elif not entry.is_file(follow_symlinks=False):
                raise _link_error(project, Path(entry.path))


def require_own_folders(project: Path) -> None:
    """Refuse links where a project keeps jobs, and what they make. InputError."""
    results = (place.folder for place in RESULT_FOLDERS.values())
    _require_no_links(project, [project / name for name in (JOBS, *results)])


def _require_no_links(project: Path, folders: Iterable[Path]) -> None:
    for folder in folders:
        if folder.is_symlink():
            raise _link_error(project, folder)


def _link_error(project: Path, path: Path) -> InputError:
    place, remedy = path.relative_to(project), "put what it stands for in its place, or delete it"
    return InputError(path, place.as_posix(), "is a link, or no file", remedy)


def utc_now() -> str:
    return datetime.now(UTC).isoformat(timespec="milliseconds")


JobState = Literal["waiting", "running", "needs you", "done", "cancelled", "failed"]


class JobResult(Message):
    """Something that a job left in the project: by its kind and name there."""

    kind: Literal["actuation", "measured", "rig", "button", "recording"]
    name: str


class JobRow(Message):
    """A job as a list shows it.

    line : why it failed or was cancelled; empty otherwise. now : what is being done.
    button : id of what is worked on; empty for a capture.
    stage : of the work, as its events name it; empty before the first. left_s : about so long it still takes;
        None where it is over.
    done, total : of its presses, takes or questions; total 0 where that is not known yet.
    events : so far. resumable : it can continue where it stopped.
    created, ended : UTC; ended None while it lasts.
    """

    job: str
    kind: KindName
    title: str
    device: str
    simulated: bool
    state: JobState
    line: str
    now: str
    done: int
    total: int
    events: int
    resumable: bool
    created: str
    ended: str | None
    results: tuple[JobResult, ...]
    button: str = ""
    stage: str = ""
    left_s: float | None = None


@dataclass(frozen=True)
class ResultFolder:
    """A folder of the project and how its files end; fresh: a name that is there already is not taken."""

    folder: str
    suffix: str
    fresh: bool

    def file(self, project: Path, name: str) -> Path:
        return project / self.folder / f"{name}{self.suffix}"


RESULT_FOLDERS = {
    "actuation": ResultFolder("actuations", ".actuation.json", False),
    "measured": ResultFolder("measured", ".json", False),
    "rig": ResultFolder("rigs", ".rig.json", False),
    "button": ResultFolder("buttons", ".fdvv.json", True),
    "recording": ResultFolder("recordings", ".recording.jsonl", True),
}


def result_names(project: Path, kind: str) -> tuple[str, ...]:
    place = RESULT_FOLDERS[kind]
    paths = (project / place.folder).glob(f"*{place.suffix}")
    return tuple(sorted(path.name.removesuffix(place.suffix) for path in paths if path.name[0] != "."))


def result_file(project: Path, kind: str, name: str) -> Path:
    """Return the file of a result by its name, looked up among those that are there. InputError."""
    if name not in result_names(project, kind):
        raise InputError(kind, name[:80], "there is none of this name in the project", "choose another")
    return RESULT_FOLDERS[kind].file(project, name)


def publish(project: Path, folder: JobFolder, order: Order) -> tuple[JobResult, ...]:
    """Copy what a job made into its places in the project. InputError where a link leads elsewhere, OSError.

    A table, what was measured of it and what a rig has taught replace those of the same name; buttons and
    recordings never do.
    """
    require_own_folders(project)
    require_own_files(folder.path)
    files = {kind: folder.result(kind) for kind in RESULT_FOLDERS} | {"recording": folder.recording}
    names = dict.fromkeys(RESULT_FOLDERS, order.name) | {"rig": rig_name(order)}
    made = {kind: file.read_bytes() for kind, file in files.items() if file.exists()}
    return tuple(_put(project, kind, names[kind], content) for kind, content in made.items())


def rig_name(order: Order) -> str:
    """Name the rig that an order works on, as what it has taught is kept."""
    if isinstance(order, CaptureOrder):
        return order.device
    simulated = isinstance(order, CompensateOrder) and not is_manual(order.device)
    where = order.device.rpartition("/")[2] if "/" in order.device else order.device.replace(":", "-")
    return f"{where}-{current_rig_name(order.rig)}" if simulated else where


def _put(project: Path, kind: str, name: str, content: bytes) -> JobResult:
    place = RESULT_FOLDERS[kind]
    names = chain((name,), (f"{name} {number}" for number in count(2)))
    free = next(n for n in names if not (place.fresh and place.file(project, n).exists()))
    write_atomic(place.file(project, free), content)
    return JobResult(kind, free)  # type: ignore[arg-type]  # the keys of RESULT_FOLDERS are its kinds
