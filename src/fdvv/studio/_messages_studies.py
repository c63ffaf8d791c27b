"""Messages of the operator's screen: people, how far they are, and never what a label hides."""

from __future__ import annotations

from typing import Annotated, Literal

from msgspec import Meta, Struct

Name = Annotated[str, Meta(max_length=60)]
Line = Annotated[str, Meta(max_length=1000)]
Secret = Annotated[str, Meta(min_length=1, max_length=200)]
Text = Annotated[str, Meta(max_length=200_000)]
StudyState = Literal["draft", "frozen", "unsealed", "broken"]


class StudiesOffersAsk(Struct, frozen=True, forbid_unknown_fields=True):
    """Ask what a study can be made from."""


class StudiesOffer(Struct, frozen=True):
    """A template. told : what it is for."""

    name: str
    told: str


class StudiesOffers(Struct, frozen=True):
    """All templates."""

    templates: list[StudiesOffer]


class StudiesListAsk(Struct, frozen=True, forbid_unknown_fields=True):
    """Ask for the studies there are."""


class StudiesRow(Struct, frozen=True):
    """A study in short. problem : why it cannot be read; empty if it can."""

    name: str
    title: str
    kind: str
    state: StudyState
    people: int
    planned: int
    problem: str


class StudiesRows(Struct, frozen=True):
    """All studies by name."""

    rows: list[StudiesRow]


class StudiesCreate(Struct, frozen=True, forbid_unknown_fields=True):
    """Declare a study from a template."""

    name: Name
    template: Name


class StudiesAsk(Struct, frozen=True, forbid_unknown_fields=True):
    """Name a study."""

    study: Name


class StudiesTable(Struct, frozen=True):
    """A table of a preview."""

    heads: list[str]
    rows: list[list[str]]


class StudiesSection(Struct, frozen=True):
    """A part of a preview."""

    title: str
    paragraphs: list[str]
    tables: list[StudiesTable]


class StudiesPlan(Struct, frozen=True):
    """The declaration.

    problems : what is wrong with it. preview : what it comes to; nothing where it has
        problems, or is not kept.
    """

    study: str
    text: str
    problems: list[str]
    preview: list[StudiesSection]


class StudiesWrite(Struct, frozen=True, forbid_unknown_fields=True):
    """Check a declaration, and keep it if that is asked for and the study is not frozen."""

    study: Name
    text: Text
    keep: bool


class StudiesFreeze(Struct, frozen=True, forbid_unknown_fields=True):
    """Freeze a study. passphrase : the keeper's, kept nowhere."""

    study: Name
    passphrase: Secret


class StudiesPerson(Struct, frozen=True):
    """A person's way so far. here : at a screen now. answered, trials : of those that count."""

    person: str
    language: str
    state: str
    answered: int
    trials: int
    here: bool
    paused: bool
    told: str


class StudiesDevicesAsk(Struct, frozen=True, forbid_unknown_fields=True):
    """Ask what may render a study; serial ports are looked for."""


class StudiesDevice(Struct, frozen=True):
    """Something that may render a study. name : as calls name it. about : for people."""

    name: str
    about: str


class StudiesDevices(Struct, frozen=True):
    """All that may render a study now."""

    devices: list[StudiesDevice]


class StudiesDetail(Struct, frozen=True):
    """A study for the operator.

    history : what was done with it, one line each. waiting : free seats.
    device : what renders it, one of those that `studies.devices` tells.
    """

    row: StudiesRow
    fingerprint: str
    frozen: str
    people: list[StudiesPerson]
    waiting: int
    paused: bool
    history: list[str]
    device: str


class StudiesUse(Struct, frozen=True, forbid_unknown_fields=True):
    """Have a study rendered by a device of the list."""

    study: Name
    device: Annotated[str, Meta(max_length=200)]


class StudiesSeat(Struct, frozen=True):
    """A free seat: what the address of the participant's screen holds."""

    study: str
    seat: str


class StudiesPause(Struct, frozen=True, forbid_unknown_fields=True):
    """Have all screens wait, or that of one person."""

    study: Name
    person: Name | None
    on: bool


class StudiesWithdraw(Struct, frozen=True, forbid_unknown_fields=True):
    """Take a person out. delete : and their answers off the disk."""

    study: Name
    person: Name
    delete: bool


class StudiesVerified(Struct, frozen=True):
    """What a check of the frozen files and journals found; nothing if all is as it was."""

    problems: list[str]


class StudiesUnseal(Struct, frozen=True, forbid_unknown_fields=True):
    """Open what the labels hid, for good and on record."""

    study: Name
    passphrase: Secret
    who: Line
    why: Line


class StudiesUnsealed(Struct, frozen=True):
    """How much was unsealed, and where it lies below the study's folder."""

    rows: int
    excluded: int
    folder: str


class StudiesReport(Struct, frozen=True):
    """The report as a page to keep."""

    name: str
    html: str


class StudiesWatch(Struct, frozen=True, forbid_unknown_fields=True, tag="watch"):
    """Tell of every change of any study from now on."""


class StudiesWatching(Struct, frozen=True, tag="watching"):
    """The watch is in force."""


class StudiesChanged(Struct, frozen=True, tag="changed"):
    """A study is not what it was."""

    study: str
