"""What the page asks of long work, and what it is told."""

from __future__ import annotations

from typing import Literal

import msgspec

from fdvv.studio._messages_events import JobEvent
from fdvv.studio._messages_orders import CaptureOrder, CompensateOrder, KindName, ProbeOrder, TuneOrder

JobState = Literal["waiting", "running", "needs you", "done", "cancelled", "failed"]


class JobResult(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """Something that a job left in the project: by its kind and name there."""

    kind: Literal["actuation", "measured", "rig", "button", "recording"]
    name: str


class JobRow(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """A job as a list shows it.

    Attributes
    ----------
    line : why it failed or was cancelled; empty otherwise. now : what is being done.
    done, total : of its presses, takes or questions; total 0 where that is not known yet.
    events : so far. resumable : it can go on where it stopped.
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


class StartJob(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """Begin long work."""

    order: CompensateOrder | ProbeOrder | CaptureOrder | TuneOrder


class JobAsk(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """Name a job: to cancel it, to go on with it, to be told its order, or to put it away."""

    job: str


class JobAnswer(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """Answer the question that a job has asked.

    answer : "first", "second" or "neither"; a rating from "1" to "7"; or "again" to press once more.
    """

    job: str
    number: int
    answer: str


class JobDetail(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """A job and what it was ordered with."""

    row: JobRow
    order: CompensateOrder | ProbeOrder | CaptureOrder | TuneOrder


class ButtonChoice(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """A button that work can be done on. vibrates : it has a vibration of the press."""

    button: str
    name: str
    vibrates: bool


class DeviceChoice(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """A device that there is. bench : a capture bench may be there; rig : a rig may be."""

    device: str
    about: str
    simulated: bool
    rig: bool
    bench: bool
    used_by: str


class WorkChoices(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """What forms offer.

    Attributes
    ----------
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


class JobsAsk(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """Ask for all there is."""


class JobRows(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """All jobs, newest first."""

    jobs: tuple[JobRow, ...]


class WatchJobs(msgspec.Struct, frozen=True, forbid_unknown_fields=True, tag="watch_jobs"):
    """Be told all jobs, and then each that changes."""


class WatchJob(msgspec.Struct, frozen=True, forbid_unknown_fields=True, tag="watch_job"):
    """Be told the events of one job from a number on, and then as they come; of one job at a time."""

    job: str
    from_event: int


class JobsTold(msgspec.Struct, frozen=True, forbid_unknown_fields=True, tag="jobs"):
    """All jobs, newest first; told when the page begins to listen."""

    jobs: tuple[JobRow, ...]


class JobChanged(msgspec.Struct, frozen=True, forbid_unknown_fields=True, tag="job"):
    """A job that is new or has changed."""

    row: JobRow


class EventsTold(msgspec.Struct, frozen=True, forbid_unknown_fields=True, tag="events"):
    """Events of a job, the first of which bears the number from_event; they count from 0."""

    job: str
    from_event: int
    events: tuple[JobEvent, ...]
