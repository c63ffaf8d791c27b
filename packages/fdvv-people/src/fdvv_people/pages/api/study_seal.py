"""What opens and closes the blind: freezing, the key holder's passphrase, checks, unsealing, the report."""

from __future__ import annotations

from typing import Annotated

from msgspec import Meta

from fdvv.errors import InputError
from fdvv_people.pages.api.studies import StudiesAsk, StudiesDetail, study_detail
from fdvv_people.pages.studies import Studies, state_of
from fdvv_people.study.files.layout import UNSEALED
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
    reasons = study.unseal(*about).reasons
    studies.announce(ask.study)
    return StudiesUnsealed(len(reasons), len(reasons) - reasons.count(""), UNSEALED)


@call("studies.report")
def report(studies: Studies, ask: StudiesAsk) -> StudiesReport:
    study = studies.study(ask.study)
    if state_of(study) != "unsealed":
        raise InputError("study", ask.study, "is sealed", "unseal it when the last person is done")
    footer = f"Study {ask.study}, frozen as {study.fingerprint}."
    return StudiesReport(f"{ask.study}-report.html", study.kind.report(study, footer))
