"""Messages of the library: rows, questions, curves."""

from __future__ import annotations

from typing import Annotated

from msgspec import Meta, Struct

from fdvv.workflow import ButtonType, Origin

Number = float | None


class LibraryIndexAsk(Struct, frozen=True, forbid_unknown_fields=True):
    """Ask for rows: those from ``first`` on if ``epoch`` is still the index's, else all."""

    epoch: int = 0
    first: Annotated[int, Meta(ge=0)] = 0


class LibraryStanding(Struct, frozen=True, forbid_unknown_fields=True, tag_field="type", tag="standing"):
    """How far the index is.

    epoch : counts what replaced the rows as a whole; positions hold within one. done, total : files.
    sources : folders of measured files that were given. trouble : why the cache cannot be written.
    """

    epoch: int
    rows: int
    refused: int
    done: int
    total: int
    ended: bool
    sources: int
    trouble: str


class LibraryWatch(Struct, frozen=True, forbid_unknown_fields=True, tag_field="type", tag="watch"):
    """Ask to be told how far the index is, now and whenever that changes."""


class LibraryIndex(Struct, frozen=True, forbid_unknown_fields=True):
    """Rows as columns, from position ``first`` on.

    numbers : by name, null where there is none. sketches : base64 of 16-bit integers, lowest byte first, 64
    of the press and 64 of the release for every row, in tenths of a centinewton from contact to the end of
    the travel; -32768 where there is no such stroke.
    """

    standing: LibraryStanding
    first: int
    ids: list[str]
    names: list[str]
    collections: list[str]
    origins: list[Origin]
    kinds: list[ButtonType]
    stated: list[list[str]]
    speeds_mm_s: list[list[float]]
    dates: list[str | None]
    simulated: list[bool]
    numbers: dict[str, list[Number]]
    sketches: str


class LibraryRange(Struct, frozen=True, forbid_unknown_fields=True):
    """A range of a figure; null has no end."""

    low: Number = None
    high: Number = None


class LibraryFind(Struct, frozen=True, forbid_unknown_fields=True):
    """What is sought; all of it must hold. Empty lists take every kind and origin.

    ranges : by the name of a number. like : id of the button that others are to feel like.
    sort : "match", "name", "kind", "origin", "date" or a number's name.
    """

    text: Annotated[str, Meta(max_length=200)] = ""
    kinds: list[ButtonType] = []
    origins: list[Origin] = []
    ranges: dict[str, LibraryRange] = {}
    like: str | None = None
    sort: str = "match"
    descending: bool = False


class LibraryHistogram(Struct, frozen=True, forbid_unknown_fields=True):
    """How the buttons that match everything else spread over equal bins from lowest to highest."""

    lowest: float
    highest: float
    counts: list[int]


class LibraryFound(Struct, frozen=True, forbid_unknown_fields=True):
    """Positions of the rows that match, in order.

    distances_jnd : to the button they are to be like, in that order. without : how many would match if a
    filter were dropped. mended : words that were read with a typo.
    """

    epoch: int
    positions: list[int]
    distances_jnd: list[float]
    histograms: dict[str, LibraryHistogram]
    kinds: dict[str, int]
    origins: dict[str, int]
    without: dict[str, int]
    mended: list[str]


class LibraryQuery(Struct, frozen=True, forbid_unknown_fields=True):
    """What a picker of buttons asks: as LibraryFind, with at most ``limit`` rows in the answer."""

    text: Annotated[str, Meta(max_length=200)] = ""
    kinds: list[ButtonType] = []
    origins: list[Origin] = []
    limit: Annotated[int, Meta(ge=1, le=1000)] = 50


class LibraryRow(Struct, frozen=True, forbid_unknown_fields=True):
    """One button with its main landmarks."""

    id: str
    name: str
    origin: Origin
    kind: ButtonType
    collection: str
    stated: list[str]
    peak_cN: Number
    drop_cN: Number
    actuation_mm: Number
    bottom_out_cN: Number
    travel_mm: float
    simulated: bool


class LibraryRows(Struct, frozen=True, forbid_unknown_fields=True):
    """The first rows that match, and how many match. ended : whether every file has been looked at."""

    rows: list[LibraryRow]
    total: int
    ended: bool


class LibraryLikeAsk(Struct, frozen=True, forbid_unknown_fields=True):
    """Ask for the buttons that feel most like one."""

    id: str
    limit: Annotated[int, Meta(ge=1, le=1000)] = 20


class LibraryAlike(Struct, frozen=True, forbid_unknown_fields=True):
    """A button and how far it is from the one asked for, in just noticeable differences."""

    row: LibraryRow
    distance_jnd: float
    force_jnd: float
    shape_jnd: float
    landmarks_jnd: float


class LibraryAlikes(Struct, frozen=True, forbid_unknown_fields=True):
    """The nearest first."""

    alike: list[LibraryAlike]


class LibraryCurvesAsk(Struct, frozen=True, forbid_unknown_fields=True):
    """Ask for the curves of some buttons."""

    ids: Annotated[list[str], Meta(max_length=100)]


class LibraryStroke(Struct, frozen=True, forbid_unknown_fields=True):
    """Force of a stroke at start + i step, contact at 0. velocity_mm_s : null if the source tells none."""

    stroke: str
    velocity_mm_s: Number
    start_mm: float
    step_mm: float
    force_cN: list[float]


class LibraryButton(Struct, frozen=True, forbid_unknown_fields=True):
    """All that is known of a button.

    numbers : its landmarks by name. why : reasons of what is null, each with its subject and a colon.
    cycles, used : presses in the source and in the mean. source, licence : empty if not stated.
    """

    id: str
    name: str
    origin: Origin
    kind: ButtonType
    kind_reason: str
    collection: str
    stated: list[str]
    numbers: dict[str, Number]
    why: list[str]
    cycles: int | None
    used: int | None
    date: str | None
    source: str
    licence: str
    simulated: bool
    strokes: list[LibraryStroke]


class LibraryMissing(Struct, frozen=True, forbid_unknown_fields=True):
    """A button that cannot be had, and why."""

    id: str
    reason: str


class LibraryCurves(Struct, frozen=True, forbid_unknown_fields=True):
    """Buttons in the order asked for, and those that cannot be had."""

    buttons: list[LibraryButton]
    missing: list[LibraryMissing]


class LibraryRefusedAsk(Struct, frozen=True, forbid_unknown_fields=True):
    """Ask which files cannot be used."""


class LibraryRefusal(Struct, frozen=True, forbid_unknown_fields=True):
    """A file by its place below its folder, and why it cannot be used."""

    place: str
    reason: str


class LibraryRefused(Struct, frozen=True, forbid_unknown_fields=True):
    """Files that cannot be used."""

    files: list[LibraryRefusal]


class LibraryRescanAsk(Struct, frozen=True, forbid_unknown_fields=True):
    """Ask to look through project and folders again."""
