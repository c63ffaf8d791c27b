"""All jobs of a project: started, cancelled, resumed, watched."""

from __future__ import annotations

import dataclasses
import re
import threading
import time
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

import msgspec

from fdvv.errors import FdvvError, InputError
from fdvv.eventlog import Journal
from fdvv.io.files import write_atomic
from fdvv_studio.studio.contract import Watchers, error_line, message_of
from fdvv_studio.studio.devices import DeviceLocks, require_listed
from fdvv_studio.studio.jobs.check import lock_name, simulates
from fdvv_studio.studio.jobs.events import JobEnded, JobEvent
from fdvv_studio.studio.jobs.file import (
    JOBS,
    JobFolder,
    JobRecord,
    JobRow,
    publish,
    require_own_folders,
    utc_now,
)
from fdvv_studio.studio.jobs.inputs import Inputs, inputs_of
from fdvv_studio.studio.jobs.orders import Order, kind_of
from fdvv_studio.studio.jobs.process import CONNECT, JobStart
from fdvv_studio.studio.jobs.progress import JobProgress
from fdvv_studio.studio.jobs.time_left import remaining_s
from fdvv_studio.studio.studio import Studio

Heard = Callable[[int, Sequence[JobEvent]], None]
"""Is given the number of the first event, and events."""

UNFINISHED = ("waiting", "running", "needs you")
BROKEN_OFF = "the studio ended meanwhile; what was made is kept"


class LiveJob:
    """A job of this studio. Any thread may ask; all changes are made under the lock.

    name : of the job. folder, record : of it. refusal : why it can never run; None of what was ordered.
    """

    def __init__(self, name: str, folder: JobFolder, record: JobRecord) -> None:
        self.name, self.folder, self.record = name, folder, record
        self.lock = threading.RLock()
        self.start: JobStart | None = None
        self.refusal: InputError | None = None
        self.progress = JobProgress(record.state, record.line, record.done, record.total)
        self._events: list[JobEvent] | None = None
        self._began_s = time.monotonic()
        self._journal: Journal | None = None
        self._listeners: list[Heard] = []

    @property
    def events(self) -> list[JobEvent]:
        """Return all events, read on first use. InputError."""
        with self.lock:
            if self._events is None:
                self._events = self.folder.events()
            return self._events

    @property
    def row(self) -> JobRow:
        with self.lock:
            record, progress = self.record, self.progress
            return message_of(
                JobRow,
                record,
                job=self.name,
                kind=kind_of(record.order),
                device=record.order.device,
                simulated=simulates(record.order),
                state=progress.state if record.state in UNFINISHED else record.state,
                now=progress.now,
                done=progress.done,
                total=progress.total,
                events=record.events if self._events is None else len(self._events),
                resumable=record.state in ("cancelled", "failed") and self.refusal is None,
                button=getattr(record.order, "button", ""),
                stage=progress.stage,
                left_s=self._remaining_s(),
            )

    def _remaining_s(self) -> float | None:
        if self.record.state not in UNFINISHED:
            return None
        progress, elapsed_s = self.progress, time.monotonic() - self._began_s
        # events of the disk may count anything
        done = max(0, min(progress.done, progress.total))
        ratio = done / progress.total if progress.total else 0.0
        return round(remaining_s(self.record.order, progress.stage, ratio, elapsed_s), 1)

    def refuse(self, error: InputError) -> None:
        """Show why a job can never run; on the disk it stays as it is."""
        self.refusal = error
        if self.record.state != "done":
            self.record = msgspec.structs.replace(self.record, state="failed", line=error_line(error))

    def begin(self) -> None:
        """Open the journal to append to it. InputError if another process is at work on the job, OSError."""
        with self.lock:
            self._began_s = time.monotonic()
            self._journal = self.folder.open_journal()
            self._events = self.folder.events()

    def add_event(self, event: JobEvent) -> None:
        """Keep an event and send it to all listeners."""
        with self.lock:
            if self._journal:
                self._journal.write({"event": msgspec.to_builtins(event)})
            number = len(self.events)
            self.events.append(event)
            if not isinstance(event, JobEnded):
                self.progress = self.progress.after(event)
            for listener in self._listeners:
                listener(number, (event,))

    def settle(self, **changed: Any) -> None:
        """Save the record of the job with changes; the journal is closed with the end of a start. OSError."""
        with self.lock:
            counts = {"done": self.progress.done, "total": self.progress.total, "events": len(self.events)}
            self.record = msgspec.structs.replace(self.record, **changed, **counts)
            self.folder.save(self.record)
            if self.record.state not in UNFINISHED and self._journal:
                self._journal.close()
                self._journal = None

    def listen(self, from_event: int, heard: Heard) -> Callable[[], None]:
        """Send events from a number on, and then as they come; the returned function ends it. InputError."""
        with self.lock:
            from_event = max(0, from_event)
            if from_event < len(self.events):
                heard(from_event, self.events[from_event:])
            self._listeners.append(heard)

        def end() -> None:
            with self.lock:
                if heard in self._listeners:
                    self._listeners.remove(heard)

        return end


MOST_JOBS, NUMBER = 10_000, re.compile(r"[0-9]{4,9}")
ANSWERS = ("first", "second", "neither", "again", *map(str, range(1, 8)))


class Jobs:
    """Long work in a studio's project, each job in ``jobs/NUMBER``. Any thread may ask.

    A job is a process of its own; one that was in progress when the studio ended can be resumed.
    """

    def __init__(self, studio: Studio) -> None:
        self._studio = studio
        self._folder = studio.project / JOBS
        self._locks = studio.part(DeviceLocks)
        self._lock = threading.RLock()
        self.watchers = Watchers[JobRow]()
        self._jobs: dict[str, LiveJob] = {}
        self._damaged: dict[str, str] = {}
        for path in _folders(self._folder)[-MOST_JOBS:]:
            # one that is damaged stays on the disk, and is no reason to have none at all
            try:
                self._jobs[path.name] = _job_on_disk(path)
            except (FdvvError, OSError) as error:
                self._damaged[path.name] = error_line(error)

    def rows(self) -> tuple[JobRow, ...]:
        with self._lock:
            return tuple(job.row for job in reversed(self._jobs.values()))

    def job(self, name: str) -> LiveJob:
        """Find a job by its name. InputError where there is none, FdvvError that says what is damaged."""
        with self._lock:
            if name in self._damaged:
                raise FdvvError(self._damaged[name])
            if name not in self._jobs:
                raise InputError("job", "job", f"there is no job {name[:20]!r}", "choose one of the list")
            return self._jobs[name]

    def start(self, order: Order, devices: tuple[str, ...]) -> JobRow:
        """Begin a job. devices : that there are. InputError on an order that cannot be done; OSError."""
        inputs = inputs_of(order, self._studio.catalog, self._studio.project, devices)
        require_own_folders(self._studio.project)
        with self._lock:
            name = f"{max((int(path.name) for path in _folders(self._folder)), default=0) + 1:04d}"
            with self._locks.hold(lock_name(order), f"job {int(name)}, {inputs.title}"):
                job = self._jobs[name] = self._create(name, order, inputs)
        self._run(job)
        return job.row

    def resume(self, name: str, devices: tuple[str, ...]) -> JobRow:
        """Resume a job that was stopped or failed, checked as an order. devices : that there are.

        InputError if it cannot, OSError.
        """
        job = self.job(name)
        require_own_folders(self._studio.project)
        with self._lock:
            if not job.row.resumable:
                raise job.refusal or InputError("job", "job", f"is {job.row.state}", "begin another one")
            job.record = job.folder.load()
            require_listed("device", job.record.order.device, devices, CONNECT)
            self._locks.acquire(lock_name(job.record.order), f"job {int(name)}, {job.record.title}")
        self._run(job)
        return job.row

    def cancel(self, name: str) -> JobRow:
        """Stop a job that is under way: what was made is kept, the device lets go. InputError."""
        job = self.job(name)
        with job.lock:
            if job.record.state not in UNFINISHED or not job.start:
                raise InputError("job", "job", f"is {job.row.state} already", "there is nothing to stop")
            job.start.stop()
        return job.row

    def answer(self, name: str, number: int, answer: str) -> JobRow:
        """Answer the question that a job has asked. InputError if it has not."""
        job = self.job(name)
        with job.lock:
            if not job.start or job.progress.question != number:
                reason = f"question {number} does not wait for an answer"
                raise InputError("answer", "answer", reason, "answer the one that is shown")
            if answer not in ANSWERS:
                raise InputError("answer", "answer", f"cannot be {answer[:20]!r}", "use the keys shown")
            # a question is answered once, however fast the keys come
            job.progress = dataclasses.replace(job.progress, question=0)
            job.start.answer(number, answer)
        return job.row

    def close(self) -> None:
        """Stop all that is under way, and wait for it."""
        with self._lock:
            starts = [job.start for job in self._jobs.values() if job.start]
        for start in starts:
            start.stop()
        for start in starts:
            start.wait()

    def _create(self, name: str, order: Order, inputs: Inputs) -> LiveJob:
        folder = JobFolder(self._folder / name)
        folder.path.mkdir(parents=True)
        for file, content in inputs.files.items():
            write_atomic(folder.path / file, content)
        record = JobRecord("fdvv-job", 2, order, inputs.title, simulates(order), utc_now())
        folder.save(record)
        return LiveJob(name, folder, record)

    def _run(self, job: LiveJob) -> None:
        """Start a process for a job; its device stays locked until the process has ended."""
        device = lock_name(job.record.order)
        try:
            with job.lock:
                job.begin()
                run = job.record.run + 1
                job.settle(state="running", line="", run=run, ended=None)
                job.start = JobStart(
                    job.folder.path,
                    run,
                    lambda event: self._add_event(job, event),
                    lambda end: self._over(job, device, end),
                )
        except BaseException:
            self._locks.release(device)
            raise
        self.watchers.tell(job.row)

    def _add_event(self, job: LiveJob, event: JobEvent) -> None:
        job.add_event(event)
        self.watchers.tell(job.row)

    def _over(self, job: LiveJob, device: str, end: JobEnded) -> None:
        """Put what was made in its place, and keep how the job ended."""
        results = job.record.results
        if end.state == "done":
            try:
                results = publish(self._studio.project, job.folder, job.record.order)
            except (OSError, FdvvError) as error:
                line = f"what was made could not be kept in the project: {error_line(error)}"
                end = JobEnded("failed", line)
        job.add_event(end)
        with job.lock:
            job.start = None
            job.settle(state=end.state, line=end.line, ended=utc_now(), results=results)
        self._locks.release(device)
        self.watchers.tell(job.row)


def _folders(folder: Path) -> list[Path]:
    """List the folders of jobs, the oldest first; none where the whole is a link."""
    paths = folder.iterdir() if folder.is_dir() and not folder.is_symlink() else ()
    return sorted(path for path in paths if NUMBER.fullmatch(path.name))


def _job_on_disk(path: Path) -> LiveJob:
    """Open a job; one that was under way when its studio ended is over for now. InputError, OSError."""
    folder = JobFolder(path)
    job = LiveJob(path.name, folder, folder.read())
    try:
        folder.check(job.record)
    except InputError as error:
        job.refuse(error)
    if job.record.state in UNFINISHED:
        for event in job.events:
            job.progress = job.progress.after(event)
        job.settle(state="cancelled", line=BROKEN_OFF, ended=utc_now())
    return job
