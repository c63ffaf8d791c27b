"""All jobs of a project: begun, stopped, gone on with, told."""

from __future__ import annotations

import contextlib
import dataclasses
import threading
from collections.abc import Callable
from pathlib import Path

import msgspec

from fdvv.errors import FdvvError, InputError
from fdvv.files import write_atomic
from fdvv.studio._job import BROKEN_OFF, UNFINISHED, Heard, LiveJob
from fdvv.studio._job_file import JOB, JobFolder, JobRecord, utc_now
from fdvv.studio._job_order import BENCH, Inputs, inputs_of
from fdvv.studio._job_results import publish
from fdvv.studio._job_start import JobStart
from fdvv.studio._leases import Leases
from fdvv.studio._messages_events import JobEnded, JobEvent
from fdvv.studio._messages_jobs import JobRow
from fdvv.studio._messages_orders import CaptureOrder, Order
from fdvv.studio._studio import Studio
from fdvv.studio._told import told as line_of
from fdvv.studio._watchers import Watchers

JOBS = "jobs"
MOST_JOBS = 10_000
ANSWERS = ("first", "second", "neither", "again", *map(str, range(1, 8)))


class Jobs:
    """Long work in a studio's project, each job in ``jobs/NUMBER``. Any thread may ask.

    A job is a process of its own; one that was under way when the studio ended can be gone on with.
    """

    def __init__(self, studio: Studio) -> None:
        self._studio = studio
        self._folder = studio.project / JOBS
        self._lock = threading.RLock()
        self._watchers = Watchers[JobRow]()
        self._jobs = {job.name: job for job in _found(self._folder)}

    @property
    def leases(self) -> Leases:
        """Get who uses which device."""
        return self._studio.part(SharedLeases)

    def rows(self) -> tuple[JobRow, ...]:
        """List all jobs, newest first."""
        with self._lock:
            return tuple(job.row for job in reversed(self._jobs.values()))

    def job(self, name: str) -> LiveJob:
        """Give a job by its name. InputError."""
        with self._lock:
            if name not in self._jobs:
                raise InputError("job", "job", f"there is no job {name[:20]!r}", "choose one of the list")
            return self._jobs[name]

    def start(self, order: Order, devices: tuple[str, ...]) -> JobRow:
        """Begin a job. devices : that there are. InputError on an order that cannot be done; OSError."""
        inputs = inputs_of(order, self._studio.shelf, self._studio.project, devices)
        with self._lock:
            name = f"{_last_number(self._folder) + 1:04d}"
            self.leases.take(inputs.device, f"job {int(name)}, {inputs.title}")
            try:
                job = self._made(name, order, inputs)
            except BaseException:
                self.leases.give_back(inputs.device)
                raise
            self._jobs[name] = job
        self._run(job, inputs.device)
        return job.row

    def resume(self, name: str) -> JobRow:
        """Go on with a job that was stopped or failed. InputError if it cannot, OSError."""
        job = self.job(name)
        with self._lock:
            if not job.row.resumable:
                raise InputError("job", "job", f"is {job.row.state}", "begin another one")
            device = _device_of(job.record)
            self.leases.take(device, f"job {int(name)}, {job.record.title}")
        self._run(job, device)
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
            if not job.start or job.standing.question != number:
                reason = f"question {number} does not wait for an answer"
                raise InputError("answer", "answer", reason, "answer the one that is shown")
            if answer not in ANSWERS:
                raise InputError("answer", "answer", f"cannot be {answer[:20]!r}", "use the keys shown")
            # a question is answered once, however fast the keys come
            job.standing = dataclasses.replace(job.standing, question=0)
            job.start.answer(number, answer)
        return job.row

    def watch(self, told: Callable[[JobRow], None]) -> Callable[[], None]:
        """Tell a job's row whenever it changes; what is given back ends it."""
        self._watchers.watch(told)
        return lambda: self._watchers.forget(told)

    def listen(self, name: str, from_event: int, heard: Heard) -> Callable[[], None]:
        """Tell a job's events from a number on; what is given back ends it. InputError."""
        return self.job(name).listen(max(0, from_event), heard)

    def close(self) -> None:
        """Stop all that is under way, and wait for it."""
        with self._lock:
            starts = [job.start for job in self._jobs.values() if job.start]
        for start in starts:
            start.stop()
        for start in starts:
            start.wait()

    def _made(self, name: str, order: Order, inputs: Inputs) -> LiveJob:
        folder = JobFolder(self._folder / name)
        folder.path.mkdir(parents=True)
        for file, content in inputs.files.items():
            write_atomic(folder.path / file, content)
        record = JobRecord("fdvv-job", 1, order, inputs.title, inputs.simulated, utc_now())
        folder.save(record)
        return LiveJob(name, folder, record)

    def _run(self, job: LiveJob, device: str) -> None:
        """Begin a process for a job; it holds the lease of the device until its end is told."""
        try:
            with job.lock:
                job.begin()
                run = job.record.run + 1
                job.settle(msgspec.structs.replace(job.record, state="running", line="", run=run, ended=None))
                job.start = JobStart(
                    job.folder.path,
                    run,
                    lambda event: self._heard(job, event),
                    lambda end: self._over(job, device, end),
                )
        except BaseException:
            self.leases.give_back(device)
            raise
        self._changed(job)

    def _heard(self, job: LiveJob, event: JobEvent) -> None:
        job.heard(event)
        self._changed(job)

    def _over(self, job: LiveJob, device: str, end: JobEnded) -> None:
        """Put what was made in its place, and keep how the job ended."""
        results = job.record.results
        if end.state == "done":
            try:
                results = publish(self._studio.project, job.folder, job.record.order)
            except (OSError, FdvvError) as error:
                end = JobEnded("failed", f"what was made could not be kept in the project: {line_of(error)}")
        job.heard(end)
        record = msgspec.structs.replace(
            job.record, state=end.state, line=end.line, ended=utc_now(), results=results
        )
        with job.lock:
            job.start = None
            job.settle(record)
        self.leases.give_back(device)
        self._changed(job)

    def _changed(self, job: LiveJob) -> None:
        self._watchers.tell(job.row)


class SharedLeases(Leases):
    """The leases of a studio."""

    def __init__(self, _studio: Studio) -> None:
        super().__init__()


def _found(folder: Path) -> list[LiveJob]:
    """Find the jobs of a project; one that was under way when its studio ended is over for now."""
    if not folder.is_dir():
        return []
    found = []
    for path in sorted(folder.iterdir())[-MOST_JOBS:]:
        if path.name.isdecimal() and (path / JOB).is_file():
            # one that is damaged stays on the disk, and is no reason to have none at all
            with contextlib.suppress(FdvvError):
                found.append(_known(path))
    return found


def _last_number(folder: Path) -> int:
    """Give the largest number among a project's jobs; 0 if there is none."""
    names = [path.name for path in folder.iterdir()] if folder.is_dir() else []
    return max((int(name) for name in names if name.isdecimal()), default=0)


def _known(path: Path) -> LiveJob:
    folder = JobFolder(path)
    job = LiveJob(path.name, folder, folder.load())
    if job.record.state in UNFINISHED:
        for event in job.events:
            job.standing = job.standing.after(event)
        job.settle(msgspec.structs.replace(job.record, state="cancelled", line=BROKEN_OFF, ended=utc_now()))
    return job


def _device_of(record: JobRecord) -> str:
    """Name the device of a job as leases know it."""
    bench = isinstance(record.order, CaptureOrder) and record.simulated
    return BENCH + record.order.device if bench else record.order.device
