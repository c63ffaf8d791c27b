"""What opens and closes the blind: freezing, the key holder's passphrase, checks, unsealing, the report."""

from __future__ import annotations

from typing import Annotated

from msgspec import Meta

from fdvv.errors import InputError
from fdvv_people.pages.api.studies import StudiesAsk, StudiesDetail, study_detail
from fdvv_people.pages.studies import Studies, state_of
from fdvv_people.pages.timing_admin import report_html
from fdvv_people.study.analysis.analyse import analyse
from fdvv_people.study.analysis.jnds import standards_of
from fdvv_people.study.analysis.read_answers import read_answers
from fdvv_people.study.analysis.report import study_html
from fdvv_people.study.files.layout import UNSEALED
from fdvv_people.timing.analysis.unseal import unseal_timing
from fdvv_people.timing.files.study import TimingStudy
from fdvv_studio.studio.contract import Message, call

Line = Annotated[str, Meta(max_length=1000)]
Secret = Annotated[str, Meta(min_length=1, max_length=200)]


class StudiesFreeze(StudiesAsk):
    """Freeze a study. passphrase : the key holder's, stored nowhere."""

    passphrase: Secret


class StudiesOpen(StudiesAsk):
    """Let sessions run until the studio ends, for the record.

    passphrase : the key holder's, stored nowhere. keeper : keeper.json's text if it was moved, else empty.
    """

    passphrase: Secret
    keeper: Annotated[str, Meta(max_length=10_000)] = ""


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


@call("studies.freeze")
def freeze(studies: Studies, ask: StudiesFreeze) -> StudiesDetail:
    studies.freeze(ask.study, ask.passphrase)
    return study_detail(studies, ask.study)


@call("studies.open")
def open_sessions(studies: Studies, ask: StudiesOpen) -> StudiesDetail:
    studies.open_sessions(ask.study, ask.passphrase, ask.keeper.encode() or None)
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
    answers = read_answers(study.folder / UNSEALED)
    found = analyse(answers, study.plan, standards=standards_of(study.plan, study.folder))
    footer = f"Study {ask.study}, frozen as {study.fingerprint}."
    return StudiesReport(f"{ask.study}-report.html", study_html(found, study.plan, footer))
