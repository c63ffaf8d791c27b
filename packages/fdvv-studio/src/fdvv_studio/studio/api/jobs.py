"""Jobs on the page: started, followed, answered; what their forms offer."""

from __future__ import annotations

from collections.abc import Callable, Sequence

from fdvv.device.open import is_manual
from fdvv.errors import FdvvError
from fdvv.model.file import builtin_names
from fdvv.twin.capture.participant import PARTICIPANTS
from fdvv.twin.files import button_names
from fdvv_studio.studio.contract import ChannelKind, Empty, Message, Tell, call
from fdvv_studio.studio.devices import DeviceLocks, available_devices, device_names
from fdvv_studio.studio.jobs.check import BENCH, RIGS
from fdvv_studio.studio.jobs.events import JobEvent
from fdvv_studio.studio.jobs.file import JobRow, result_names
from fdvv_studio.studio.jobs.jobs import Jobs
from fdvv_studio.studio.jobs.orders import Order
from fdvv_studio.studio.studio import Studio


class StartJob(Message):
    """Begin long work."""

    order: Order


class JobAsk(Message):
    """Name a job: to cancel or resume it, or to read its order."""

    job: str


class JobAnswer(JobAsk):
    """Answer the question that a job has asked.

    answer : "first", "second" or "neither"; a rating from "1" to "7"; or "again" to press once more.
    """

    number: int
    answer: str


class JobDetail(Message):
    """A job and what it was ordered with."""

    row: JobRow
    order: Order


class ButtonChoice(Message):
    """A button that work can be done on. vibrates : it has a vibration of the press."""

    button: str
    name: str
    vibrates: bool


class DeviceChoice(Message):
    """A device that there is. bench : a capture bench may be there; rig : a rig may be."""

    device: str
    about: str
    simulated: bool
    rig: bool
    bench: bool
    used_by: str


class WorkChoices(Message):
    """What forms offer.

    rigs : simulated. known_rigs, actuations : kept in the project, by name.
    switches, participants : of the simulated bench.
    note : why serial ports cannot be listed; empty if they can.
    """

    buttons: tuple[ButtonChoice, ...]
    devices: tuple[DeviceChoice, ...]
    rigs: tuple[str, ...]
    known_rigs: tuple[str, ...]
    actuations: tuple[str, ...]
    switches: tuple[str, ...]
    participants: tuple[str, ...]
    note: str


class JobRows(Message):
    """All jobs, newest first."""

    jobs: tuple[JobRow, ...]


class WatchJobs(Message, tag="watch_jobs"):
    """Send all jobs, and then each that changes."""


class WatchJob(Message, tag="watch_job"):
    """Send the events of one job from a number on, and then as they come; of one job at a time."""

    job: str
    from_event: int


class JobList(JobRows, tag="jobs"):
    """All jobs, newest first; sent when the page subscribes."""


class JobChanged(Message, tag="job"):
    """A job that is new or has changed."""

    row: JobRow


class JobEvents(Message, tag="events"):
    """Events of a job, the first of which bears the number from_event; they count from 0."""

    job: str
    from_event: int
    events: tuple[JobEvent, ...]


@call("jobs.choices")
def choices(studio: Studio, _ask: Empty) -> WorkChoices:
    known, note = available_devices()
    return WorkChoices(
        tuple(_buttons(studio)),
        tuple(_device(studio.part(DeviceLocks), name, about) for name, about in known),
        RIGS,
        result_names(studio.project, "rig"),
        result_names(studio.project, "actuation"),
        button_names(),
        tuple(PARTICIPANTS),
        note,
    )


def _device(locks: DeviceLocks, name: str, about: str) -> DeviceChoice:
    person = is_manual(name)
    used_by = locks.holder(name) or locks.holder(BENCH + name)
    return DeviceChoice(name, about, not person, rig=True, bench=person or name == "twin", used_by=used_by)


def _buttons(studio: Studio) -> list[ButtonChoice]:
    """List the person's own buttons, then the built-in ones; a file that cannot be read is passed over."""
    ids = [f"own:{name}" for name in result_names(studio.project, "button")]
    ids += [f"builtin:{name}" for name in builtin_names()]
    choices = []
    for button in ids:
        try:
            model = studio.catalog.model(button)
        except FdvvError:
            continue
        vibrates = any(v.stroke == "press" for v in model.vibrations)
        choices.append(ButtonChoice(button, button.partition(":")[2], vibrates))
    return choices


AT_ONCE = 50
"""So many events in one message: a press with its curve is some 3 kB."""


class JobsChannel:
    """One page that follows the jobs."""

    def __init__(self, studio: Studio, tell: Tell) -> None:
        self._jobs, self._tell = studio.part(Jobs), tell
        self._end_of_events: Callable[[], None] = lambda: None

    def receive(self, ask: WatchJobs | WatchJob) -> None:
        """Begin to follow all jobs, or the events of one. InputError."""
        if isinstance(ask, WatchJobs):
            self._jobs.watchers.watch(self._tell_changed)
            self._tell(JobList(self._jobs.rows()))
            return
        self._end_of_events()

        def forward(number: int, events: Sequence[JobEvent]) -> None:
            for first in range(0, len(events), AT_ONCE):
                self._tell(JobEvents(ask.job, number + first, tuple(events[first : first + AT_ONCE])))

        self._end_of_events = self._jobs.job(ask.job).listen(ask.from_event, forward)

    def close(self) -> None:
        self._jobs.watchers.forget(self._tell_changed)
        self._end_of_events()

    def _tell_changed(self, row: JobRow) -> None:
        self._tell(JobChanged(row))


@call("jobs.start")
def start(jobs: Jobs, ask: StartJob) -> JobRow:
    return jobs.start(ask.order, device_names())


@call("jobs.resume")
def resume(jobs: Jobs, ask: JobAsk) -> JobRow:
    return jobs.resume(ask.job, device_names())


@call("jobs.cancel")
def cancel(jobs: Jobs, ask: JobAsk) -> JobRow:
    return jobs.cancel(ask.job)


@call("jobs.answer")
def answer(jobs: Jobs, ask: JobAnswer) -> JobRow:
    return jobs.answer(ask.job, ask.number, ask.answer)


@call("jobs.detail")
def detail(jobs: Jobs, ask: JobAsk) -> JobDetail:
    job = jobs.job(ask.job)
    return JobDetail(job.row, job.record.order)


@call("jobs.list")
def rows(jobs: Jobs, _ask: Empty) -> JobRows:
    return JobRows(jobs.rows())


CHANNEL = ChannelKind("jobs", (WatchJobs, WatchJob), (JobList, JobChanged, JobEvents), JobsChannel)
