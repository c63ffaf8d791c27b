"""The library page: the index of all buttons, its status, and searches."""

from __future__ import annotations

import base64
from collections.abc import Sequence
from threading import Lock
from typing import Annotated

import numpy as np
from msgspec import Meta, Struct, field, structs

from fdvv.button.kind import ButtonType
from fdvv.model.noticeable import LITERATURE, Jnds
from fdvv_studio.library.index import CatalogIndex, IndexStatus, RefusedFile, builtin_rows
from fdvv_studio.library.row import NUMBERS, ButtonRow, Origin
from fdvv_studio.library.search import CatalogSearch, SearchQuery, SearchResult
from fdvv_studio.studio.contract import Empty, Message, Watchers, call, message_of, watch_channel
from fdvv_studio.studio.studio import Studio

Number = float | None


class LibraryIndexAsk(Message):
    """Ask for rows: those from ``first`` on if ``epoch`` is still the index's, else all."""

    epoch: int = 0
    first: Annotated[int, Meta(ge=0)] = 0


class LibraryStatus(Message, tag_field="type", tag="standing"):
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


class LibraryIndex(Message):
    """Rows as columns, from position ``first`` on.

    numbers : by name, null where there is none. sketches : base64 of 16-bit integers, lowest byte first, 64
    of the press and 64 of the release for every row, in tenths of a centinewton from contact to the end of
    the travel; -32768 where there is no such stroke.
    """

    standing: LibraryStatus
    first: int
    ids: list[str]
    names: list[str]
    collections: list[str]
    origins: list[Origin]
    kinds: list[ButtonType]
    stated: list[tuple[str, ...]]
    speeds_mm_s: list[tuple[float, ...]]
    dates: list[str | None]
    simulated: list[bool]
    numbers: dict[str, list[Number]]
    sketches: str


class LibraryRange(Message):
    """A range of a figure; null has no end."""

    low: Number = None
    high: Number = None


class LibraryFind(Message):
    """What is sought; all of it must hold. Empty lists take every kind and origin.

    ranges : by the name of a number. like : id of the button that others are to feel like.
    sort : "match", "name", "kind", "origin", "date" or a number's name.
    """

    text: Annotated[str, Meta(max_length=200)] = ""
    kinds: tuple[ButtonType, ...] = ()
    origins: tuple[Origin, ...] = ()
    ranges: dict[str, LibraryRange] = field(default_factory=dict)
    like: str | None = None
    sort: str = "match"
    descending: bool = False


class LibraryHistogram(Message):
    """How the buttons that match everything else spread over equal bins from lowest to highest."""

    lowest: float
    highest: float
    counts: list[int]


class LibraryFound(Message):
    """Positions of the rows that match, in order.

    distances_jnd : to the button they are to be like, in that order. jnds : whose JNDs, in words.
    without : how many would match if a filter were dropped. mended : words that were read with a typo.
    """

    epoch: int
    positions: list[int]
    distances_jnd: list[float]
    jnds: str
    histograms: dict[str, LibraryHistogram]
    kinds: dict[str, int]
    origins: dict[str, int]
    without: dict[str, int]
    mended: tuple[str, ...]


class LibraryRefused(Message):
    """Files that cannot be used."""

    files: list[RefusedFile]


NO_STROKE = -32768
"""In place of every force of a stroke that is not there."""


COLUMNS = {
    "ids": "id",
    "names": "name",
    "collections": "collection",
    "origins": "origin",
    "kinds": "kind",
    "stated": "stated",
    "speeds_mm_s": "speeds_mm_s",
    "dates": "date",
    "simulated": "simulated",
}
"""What a column of LibraryIndex holds of every row."""


def index_columns(status: LibraryStatus, first: int, rows: Sequence[ButtonRow]) -> LibraryIndex:
    """Return rows as columns; first : position of the first of them."""
    columns = {column: [getattr(row, name) for row in rows] for column, name in COLUMNS.items()}
    numbers = {name: [getattr(row, name) for row in rows] for name in NUMBERS}
    return LibraryIndex(standing=status, first=first, numbers=numbers, sketches=_pack(rows), **columns)


def _pack(rows: Sequence[ButtonRow]) -> str:
    none = (NO_STROKE,) * 64
    sketches = [(row.sketch.press_dcN or none) + (row.sketch.release_dcN or none) for row in rows]
    return base64.b64encode(np.array(sketches, dtype="<i2").tobytes()).decode()


def search_message(result: SearchResult, epoch: int, jnds: str) -> LibraryFound:
    """Return a search result; epoch : of the rows that its positions count. jnds : whose JNDs, in words."""
    return message_of(
        LibraryFound,
        result,
        epoch=epoch,
        positions=result.positions.tolist(),
        distances_jnd=np.round(result.distances, 3).tolist(),
        jnds=jnds,
        histograms={
            name: LibraryHistogram(h.lowest, h.highest, h.counts.tolist())
            for name, h in result.histograms.items()
        },
    )


def prepare() -> None:
    """Read what a person sees first, before other parts are imported beside it."""
    builtin_rows()


class Library:
    """The index of a studio's catalogue, ready to be searched, and the pages that watch it grow."""

    def __init__(self, studio: Studio) -> None:
        self._studio, self._sources = studio, len(studio.sources)
        self.watchers = Watchers[Struct]()
        self._lock = Lock()
        self._search, self._epoch = CatalogSearch(), 0
        cache = studio.project / "cache" / "shelf.jsonl"
        self.index = CatalogIndex(
            studio.catalog, cache, lambda _: self.watchers.tell(self.status()), libraries=studio.libraries
        )
        self.index.start()

    def close(self) -> None:
        self.index.close()

    @property
    def jnds(self) -> Jnds:
        return self._studio.jnds

    def status(self) -> LibraryStatus:
        now = self.index.status
        counts = {"rows": len(now.rows), "refused": len(now.refused), "sources": self._sources}
        return message_of(LibraryStatus, now, **counts)

    def find(self, query: SearchQuery) -> tuple[SearchResult, Sequence[ButtonRow], IndexStatus]:
        """Search the rows that were read so far; positions are of the rows given."""
        with self._lock:
            indexed, search = self._ready()
            return search.find(query), search.rows, indexed

    def row(self, button_id: str) -> ButtonRow | None:
        """Return the row of a button; None if it is not indexed yet."""
        with self._lock:
            return self._ready()[1].row(button_id)

    def _ready(self) -> tuple[IndexStatus, CatalogSearch]:
        indexed = self.index.status
        if self._epoch != indexed.epoch:
            self._search, self._epoch = CatalogSearch(), indexed.epoch
        self._search.extend(indexed.rows[len(self._search.rows) :])
        return indexed, self._search


@call("library.index")
def index(library: Library, ask: LibraryIndexAsk) -> LibraryIndex:
    status, indexed = library.status(), library.index.status
    first = ask.first if ask.epoch == indexed.epoch else 0
    return index_columns(status, first, indexed.rows[first:])


@call("library.find")
def find(library: Library, ask: LibraryFind) -> LibraryFound:
    """Search; positions are of library.index."""
    ranges = {name: (r.low, r.high) for name, r in ask.ranges.items()}
    jnds = library.jnds if ask.like else LITERATURE
    result, _, indexed = library.find(SearchQuery(**{**structs.asdict(ask), "ranges": ranges, "jnds": jnds}))
    return search_message(result, indexed.epoch, jnds.origin)


@call("library.refused")
def list_refused(library: Library, _ask: Empty) -> LibraryRefused:
    return LibraryRefused(list(library.index.status.refused))


@call("library.rescan")
def rescan(library: Library, _ask: Empty) -> LibraryStatus:
    library.index.rescan()
    return library.status()


CHANNEL = watch_channel("library", Library, LibraryStatus, first=Library.status)
