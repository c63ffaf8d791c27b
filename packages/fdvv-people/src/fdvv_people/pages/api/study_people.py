"""What the operator does while people take part: seats, what renders the study, pauses, withdrawals."""

from __future__ import annotations

from typing import Annotated

from msgspec import Meta

from fdvv_people.pages.api.studies import Name, StudiesAsk, StudiesDetail, study_detail
from fdvv_people.pages.studies import TRIED, TWIN, Studies
from fdvv_studio.studio.contract import Empty, Message, call
from fdvv_studio.studio.devices import available_devices, device_names
from fdvv_studio.studio.studio import Studio


class StudiesUse(StudiesAsk):
    """Choose the device that renders a study."""

    device: Annotated[str, Meta(max_length=200)]


class StudiesSeat(Message):
    """An invitation. seat : the word in the address of the participant's screen, which opens nothing else."""

    study: str
    seat: str


class StudiesDevice(Message):
    """Something that may render a study. name : as calls name it. about : for people."""

    name: str
    about: str


class StudiesDevices(Message):
    """All that may render a study now."""

    devices: list[StudiesDevice]


class StudiesPause(StudiesAsk):
    """Pause all screens, or that of one person."""

    person: Name | None
    on: bool


class StudiesWithdraw(StudiesAsk):
    """Take a person out. delete : and their answers off the disk."""

    person: Name
    delete: bool


ON_THE_TABLE = ("host", "serial:")
"""How devices are called that keep the labels of a trial ready side by side."""


@call("studies.seat")
def seat(studies: Studies, ask: StudiesAsk) -> StudiesSeat:
    return StudiesSeat(ask.study, studies.invite(ask.study))


@call("studies.rehearse")
def rehearse(studies: Studies, ask: StudiesAsk) -> StudiesSeat:
    """Make a seat in a copy of the study that records nothing."""
    return StudiesSeat(f"{TRIED}{ask.study}", studies.rehearse(ask.study))


@call("studies.use")
def use(studies: Studies, ask: StudiesUse) -> StudiesDetail:
    studies.use_device(ask.study, ask.device, device_names())
    return study_detail(studies, ask.study)


@call("studies.devices")
def devices(_studio: Studio, _ask: Empty) -> StudiesDevices:
    """List what may render a study: the twin, and what keeps the labels of a trial ready side by side."""
    found = [
        StudiesDevice(name, f"{name}: {about}" if about else name)
        for name, about in available_devices()[0]
        if name.startswith(ON_THE_TABLE)
    ]
    return StudiesDevices([StudiesDevice(TWIN, "the twin, under a hand on the screen"), *found])


@call("studies.pause")
def pause(studies: Studies, ask: StudiesPause) -> StudiesDetail:
    studies.pause(ask.study, ask.person, ask.on)
    return study_detail(studies, ask.study)


@call("studies.withdraw")
def withdraw(studies: Studies, ask: StudiesWithdraw) -> StudiesDetail:
    studies.withdraw(ask.study, ask.person, ask.delete)
    return study_detail(studies, ask.study)
