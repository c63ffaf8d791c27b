"""The operator's page: people and their progress, and never what a label hides."""

from __future__ import annotations

import time
from collections.abc import Mapping
from typing import Annotated, Any

from msgspec import Meta, field

from fdvv.errors import FdvvError, InputError
from fdvv.studio.api.study_steps import text_in
from fdvv.studio.contract import Empty, Message, call, error_line, message_of, watch_channel
from fdvv.studio.devices import available_devices, device_names
from fdvv.studio.studies import TRIED, TWIN, Studies, StudiesChanged, StudyState, state_of
from fdvv.studio.studio import Studio
from fdvv.studio.timing_admin import people_of, report_html, standing_text, timing_sentence
from fdvv.study.admin.operator_view import PersonView, operator_view
from fdvv.study.admin.review import review_study
from fdvv.study.admin.standing import Kind, draft_sentence, standing
from fdvv.study.analysis.analyse import analyse
from fdvv.study.analysis.jnds import standards_of
from fdvv.study.analysis.read_answers import read_answers
from fdvv.study.analysis.report import study_html
from fdvv.study.files.counts import COUNTED
from fdvv.study.files.people import EVERYBODY
from fdvv.timing.analysis.unseal import unseal_timing
from fdvv.timing.files.progress import PersonProgress
from fdvv.timing.files.study import AnyStudy, TimingStudy

Name = Annotated[str, Meta(max_length=60)]
Line = Annotated[str, Meta(max_length=1000)]
Secret = Annotated[str, Meta(min_length=1, max_length=200)]
Text = Annotated[str, Meta(max_length=200_000)]


class StudiesRow(Message):
    """A study in short. problem : why it cannot be read; empty if it can."""

    name: str
    title: str
    kind: str
    state: StudyState
    people: int
    planned: int
    problem: str


class StudiesRows(Message):
    """All studies by name."""

    rows: list[StudiesRow]


class StudiesAsk(Message):
    """Name a study."""

    study: Name


class StudiesFreeze(StudiesAsk):
    """Freeze a study. passphrase : the key holder's, stored nowhere."""

    passphrase: Secret


class StudiesOpen(StudiesAsk):
    """Let sessions run until the studio ends, for the record.

    passphrase : the key holder's, stored nowhere. keeper : keeper.json's text if it was moved, else empty.
    """

    passphrase: Secret
    keeper: Annotated[str, Meta(max_length=10_000)] = ""


class StudiesPerson(Message):
    """A person's progress. here : at a screen now. answered, trials : that count. note : may be empty."""

    person: str
    language: str
    state: str
    answered: int
    trials: int
    here: bool
    paused: bool
    note: str = field(name="told")


class StudiesDevice(Message):
    """Something that may render a study. name : as calls name it. about : for people."""

    name: str
    about: str


class StudiesDevices(Message):
    """All that may render a study now."""

    devices: list[StudiesDevice]


class StudiesDetail(Message):
    """A study for the operator.

    history : what was done with it, one line each. waiting : open invitations.
    device : what renders it, one of those that `studies.devices` tells.
    open : people can begin and come back; else the key holder opens the sessions first.
    code_alone : people whose code alone opens the blind, for an earlier fdvv enrolled them.
    """

    row: StudiesRow
    fingerprint: str
    frozen: str
    people: list[StudiesPerson]
    waiting: int
    paused: bool
    history: list[str]
    device: str
    open: bool
    code_alone: list[str]


class StudiesUse(StudiesAsk):
    """Choose the device that renders a study."""

    device: Annotated[str, Meta(max_length=200)]


class StudiesSeat(Message):
    """An invitation. seat : the word in the address of the participant's screen, which opens nothing else."""

    study: str
    seat: str


class StudiesStanding(Message):
    """How far a study is, or what it found, in a sentence."""

    sentence: str
    kind: Kind


class StudiesPause(StudiesAsk):
    """Pause all screens, or that of one person."""

    person: Name | None
    on: bool


class StudiesWithdraw(StudiesAsk):
    """Take a person out. delete : and their answers off the disk."""

    person: Name
    delete: bool


class StudiesVerified(Message):
    """What a check of the frozen files and journals found; nothing if all is as it was."""

    problems: list[str]


class StudiesUnseal(StudiesAsk):
    """Open what the labels hid, for good and on record."""

    passphrase: Secret
    who: Line
    why: Line


class StudiesUnsealed(Message):
    """How much was unsealed, and where it lies below the study's folder."""

    rows: int
    excluded: int
    folder: str


class StudiesReport(Message):
    """The report as a page to keep."""

    name: str
    html: str


SIMULATED = "simulated"
ON_THE_TABLE = ("host", "serial:")
"""How devices are called that keep the labels of a trial ready side by side."""


def study_row(name: str, study: AnyStudy) -> StudiesRow:
    plan = study.plan
    title = text_in(plan.title, plan.languages[0])
    return StudiesRow(name, title, plan.kind, state_of(study), len(study.people()), plan.people, "")


@call("studies.detail")
def detail(studies: Studies, ask: StudiesAsk) -> StudiesDetail:
    return study_detail(studies, ask.study)


def study_detail(studies: Studies, name: str) -> StudiesDetail:
    study = studies.study(name)
    frozen = study.frozen
    paused = study.paused
    return StudiesDetail(
        study_row(name, study),
        study.fingerprint,
        when(frozen.when) if frozen else "",
        _people(studies, name, study) if frozen else [],
        studies.waiting(name),
        EVERYBODY in paused,
        [history_line(record) for record in study.history() if COUNTED not in record],
        studies.device(name),
        frozen is not None and (study.sessions_open or not study.needs_run_key),
        list(study.code_alone) if frozen else [],
    )


def _people(studies: Studies, name: str, study: AnyStudy) -> list[StudiesPerson]:
    paused = study.paused
    here = {one.name for one in study.people() if studies.screen(name, one.name)}
    if isinstance(study, TimingStudy):
        return [_timed_person(one, one.person in here, one.person in paused) for one in people_of(study)]
    people = operator_view(study, time.time()).people
    return [_person(one, one.person in here, one.person in paused) for one in people]


def _timed_person(one: PersonProgress, here: bool, paused: bool) -> StudiesPerson:
    note = SIMULATED if one.simulated else ""
    where = standing_text(one)
    return StudiesPerson(one.person, one.language, where, one.done, one.trials, here, paused, note)


def history_line(record: Mapping[str, Any]) -> str:
    """Return a record of a study's log as one line, without keys and sums."""
    ((event, details),) = record.items()
    known = ("person", "language", "who", "why", "simulated", "deleted")
    more = ", ".join(f"{key} {details[key]}" for key in known if details.get(key))
    return f"{when(details.get('when', ''))} {event}{': ' if more else ''}{more}".strip()


def when(stamp: str) -> str:
    """Write a time of the log for people, to the minute."""
    return f"{stamp[:16].replace('T', ' ')} UTC" if stamp else ""


def _person(one: PersonView, here: bool, paused: bool) -> StudiesPerson:
    note = SIMULATED if one.simulated else ""
    return message_of(StudiesPerson, one, state=place_of(one), here=here, paused=paused, note=note)


def place_of(one: PersonView) -> str:
    if one.problem:
        return "not to be read"
    if one.state in ("withdrawn", "deleted"):
        return one.state
    return f"page {one.page}" if one.kind == "page" else (one.kind or one.state)


UNSEALED, ANSWERS = "unsealed", "answers.csv"
TEMPLATE_DESCRIPTIONS = {
    "realism": "which of two hidden renderings is closer to a named reference; the paper's",
    "abx": "X is A or B: which?",
    "2afc": "which of two has more of something",
    "2ac": "the same, or which has more?",
    "preference": "which of two is liked better",
    "mushra": "several are rated beside a reference, itself and anchors hidden among them",
    "staircase": "how small a difference is just felt",
    "thresholds": "how small a difference of force, snap and vibration is just felt, in few trials",
    "timing": "which button times a press best, after a search for one's own; the paper's",
    "tapping": "how fast one can tap on each",
}


@call("studies.list")
def rows(studies: Studies, _ask: Empty) -> StudiesRows:
    return StudiesRows([_row(studies, name) for name in studies.names()])


def _row(studies: Studies, name: str) -> StudiesRow:
    try:
        return study_row(name, studies.study(name))
    except FdvvError as error:
        return StudiesRow(name, name, "", "broken", 0, 0, error_line(error))


@call("studies.freeze")
def freeze(studies: Studies, ask: StudiesFreeze) -> StudiesDetail:
    studies.freeze(ask.study, ask.passphrase)
    return study_detail(studies, ask.study)


@call("studies.open")
def open_sessions(studies: Studies, ask: StudiesOpen) -> StudiesDetail:
    studies.open_sessions(ask.study, ask.passphrase, ask.keeper.encode() or None)
    return study_detail(studies, ask.study)


@call("studies.seat")
def seat(studies: Studies, ask: StudiesAsk) -> StudiesSeat:
    return StudiesSeat(ask.study, studies.invite(ask.study))


@call("studies.rehearse")
def rehearse(studies: Studies, ask: StudiesAsk) -> StudiesSeat:
    """Make a seat in a copy of the study that records nothing."""
    return StudiesSeat(f"{TRIED}{ask.study}", studies.rehearse(ask.study))


@call("studies.standing")
def study_standing(studies: Studies, ask: StudiesAsk) -> StudiesStanding:
    study = studies.study(ask.study)
    if isinstance(study, TimingStudy):
        return StudiesStanding(*timing_sentence(study))
    if study.frozen is None:
        return StudiesStanding(*draft_sentence(study.plan, review_study(study.folder).problems))
    return StudiesStanding(*standing(study))


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


@call("studies.verify")
def verify(studies: Studies, ask: StudiesAsk) -> StudiesVerified:
    return StudiesVerified(list(studies.study(ask.study).verify()))


@call("studies.unseal")
def unseal(studies: Studies, ask: StudiesUnseal) -> StudiesUnsealed:
    study, about = studies.study(ask.study), (ask.passphrase, ask.who, ask.why)
    if isinstance(study, TimingStudy):
        counts = [row.counts for row in unseal_timing(study, *about).rows]
    else:
        counts = study.unseal(*about).counts.tolist()
    studies.announce(ask.study)
    return StudiesUnsealed(len(counts), counts.count(False), UNSEALED)


@call("studies.report")
def report(studies: Studies, ask: StudiesAsk) -> StudiesReport:
    study = studies.study(ask.study)
    if state_of(study) != "unsealed":
        raise InputError("study", ask.study, "is sealed", "unseal it when the last person is done")
    if isinstance(study, TimingStudy):
        return StudiesReport(f"{ask.study}-report.html", report_html(study, ask.study))
    answers = read_answers(study.folder / UNSEALED / ANSWERS)
    found = analyse(answers, study.plan, standards=standards_of(study.plan, study.folder))
    footer = f"Study {ask.study}, frozen as {study.fingerprint}."
    return StudiesReport(f"{ask.study}-report.html", study_html(found, study.plan, footer))


CHANNEL = watch_channel("studies", Studies, StudiesChanged)
