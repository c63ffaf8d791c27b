"""Long work, as the page asks for it and follows it."""

from __future__ import annotations

from collections.abc import Callable, Sequence

from fdvv.studio._contract import Call, ChannelKind, Tell
from fdvv.studio._jobs import Jobs
from fdvv.studio._messages_events import JobEvent
from fdvv.studio._messages_jobs import (
    EventsTold,
    JobAnswer,
    JobAsk,
    JobChanged,
    JobDetail,
    JobRow,
    JobRows,
    JobsAsk,
    JobsTold,
    StartJob,
    WatchJob,
    WatchJobs,
    WorkChoices,
)
from fdvv.studio._studio import Studio
from fdvv.studio._work_choices import choices, device_names

AT_ONCE = 50
"""So many events in one message: a press with its curve is some 3 kB."""


class JobsChannel:
    """One page that follows the jobs."""

    def __init__(self, studio: Studio, tell: Tell) -> None:
        self._jobs, self._tell = studio.part(Jobs), tell
        self._ends: dict[str, Callable[[], None]] = {}

    def receive(self, ask: WatchJobs | WatchJob) -> None:
        """Begin to follow all jobs, or the events of one. InputError."""
        if isinstance(ask, WatchJobs):
            self._end("rows")
            self._ends["rows"] = self._jobs.watch(lambda row: self._tell(JobChanged(row)))
            self._tell(JobsTold(self._jobs.rows()))
            return
        self._end("events")

        def heard(number: int, events: Sequence[JobEvent]) -> None:
            for first in range(0, len(events), AT_ONCE):
                self._tell(EventsTold(ask.job, number + first, tuple(events[first : first + AT_ONCE])))

        self._ends["events"] = self._jobs.listen(ask.job, ask.from_event, heard)

    def close(self) -> None:
        """Follow nothing any more."""
        for name in tuple(self._ends):
            self._end(name)

    def _end(self, name: str) -> None:
        if name in self._ends:
            self._ends.pop(name)()


def start(studio: Studio, ask: StartJob) -> JobRow:
    """Begin long work."""
    return studio.part(Jobs).start(ask.order, device_names())


def resume(studio: Studio, ask: JobAsk) -> JobRow:
    """Go on with it."""
    return studio.part(Jobs).resume(ask.job)


def cancel(studio: Studio, ask: JobAsk) -> JobRow:
    """Stop it."""
    return studio.part(Jobs).cancel(ask.job)


def answer(studio: Studio, ask: JobAnswer) -> JobRow:
    """Answer its question."""
    return studio.part(Jobs).answer(ask.job, ask.number, ask.answer)


def detail(studio: Studio, ask: JobAsk) -> JobDetail:
    """Tell a job and its order."""
    job = studio.part(Jobs).job(ask.job)
    return JobDetail(job.row, job.record.order)


def rows(studio: Studio, _ask: JobsAsk) -> JobRows:
    """List all."""
    return JobRows(studio.part(Jobs).rows())


def offered(studio: Studio, _ask: JobsAsk) -> WorkChoices:
    """Tell what forms offer."""
    return choices(studio)


CALLS = (
    Call("jobs.start", StartJob, JobRow, start),
    Call("jobs.resume", JobAsk, JobRow, resume),
    Call("jobs.cancel", JobAsk, JobRow, cancel),
    Call("jobs.answer", JobAnswer, JobRow, answer),
    Call("jobs.detail", JobAsk, JobDetail, detail),
    Call("jobs.list", JobsAsk, JobRows, rows),
    Call("jobs.choices", JobsAsk, WorkChoices, offered),
)
CHANNELS = (ChannelKind("jobs", (WatchJobs, WatchJob), (JobsTold, JobChanged, EventsTold), JobsChannel),)
