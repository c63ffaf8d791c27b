"""The library: every button there is to find, compare and open."""

from __future__ import annotations

from collections.abc import Sequence
from threading import Lock

import numpy as np
from msgspec import Struct

from fdvv.errors import FdvvError
from fdvv.studio._contract import Call, Channel, ChannelKind, Tell
from fdvv.studio._library_told import button_told, found_told, row_told, rows_told
from fdvv.studio._messages_library import (
    LibraryAlike,
    LibraryAlikes,
    LibraryButton,
    LibraryCurves,
    LibraryCurvesAsk,
    LibraryFind,
    LibraryFound,
    LibraryIndex,
    LibraryIndexAsk,
    LibraryLikeAsk,
    LibraryMissing,
    LibraryQuery,
    LibraryRefusal,
    LibraryRefused,
    LibraryRefusedAsk,
    LibraryRescanAsk,
    LibraryRows,
    LibraryStanding,
    LibraryWatch,
)
from fdvv.studio._studio import Studio
from fdvv.studio._told import told
from fdvv.studio._watchers import Watchers
from fdvv.workflow import (
    Origin,
    ShelfFound,
    ShelfIndex,
    ShelfQuery,
    ShelfRow,
    ShelfSearch,
    ShelfStand,
    builtin_rows,
    row_of_model,
    sample_strokes,
)


def prepare() -> None:
    """Read what a person sees first, before other parts are imported beside it."""
    builtin_rows()


class Library:
    """The index of a studio's shelf, ready to be searched, and the pages that watch it grow."""

    def __init__(self, studio: Studio) -> None:
        self._sources = len(studio.sources)
        self._watchers = Watchers[Struct]()
        self._lock = Lock()
        self._search, self._epoch = ShelfSearch(), 0
        cache = studio.project / "cache" / "shelf.jsonl"
        self.index = ShelfIndex(studio.shelf, cache, self._told, libraries=studio.libraries)
        self.index.start()

    def close(self) -> None:
        """Stop reading."""
        self.index.close()

    def standing(self) -> LibraryStanding:
        """Tell how far the index is."""
        s = self.index.stand
        rows, refused = len(s.rows), len(s.refused)
        return LibraryStanding(s.epoch, rows, refused, s.done, s.total, s.ended, self._sources, s.trouble)

    def find(self, query: ShelfQuery) -> tuple[ShelfFound, Sequence[ShelfRow], ShelfStand]:
        """Search the rows that were read so far; positions are of the rows given."""
        with self._lock:
            stand, search = self._ready()
            return search.find(query), search.rows, stand

    def row(self, button_id: str) -> ShelfRow | None:
        """Give the row of a button; None if the index has not come to it."""
        with self._lock:
            return self._ready()[1].row(button_id)

    def _ready(self) -> tuple[ShelfStand, ShelfSearch]:
        stand = self.index.stand
        if self._epoch != stand.epoch:
            self._search, self._epoch = ShelfSearch(), stand.epoch
        self._search.extend(stand.rows[len(self._search.rows) :])
        return stand, self._search

    def watch(self, tell: Tell) -> None:
        """Tell a page how far the index is, now and whenever that changes."""
        self._watchers.watch(tell)
        tell(self.standing())

    def forget(self, tell: Tell) -> None:
        """Stop telling a page."""
        self._watchers.forget(tell)

    def _told(self, _stand: ShelfStand) -> None:
        self._watchers.tell(self.standing())


class Watcher:
    """A page's end of the channel."""

    def __init__(self, library: Library, tell: Tell) -> None:
        self._library, self._tell = library, tell

    def receive(self, _ask: LibraryWatch) -> None:
        """Begin to tell; asked again, tell once more."""
        self._library.forget(self._tell)
        self._library.watch(self._tell)

    def close(self) -> None:
        """Stop telling."""
        self._library.forget(self._tell)


def index(studio: Studio, ask: LibraryIndexAsk) -> LibraryIndex:
    """Give the rows that the page does not have yet."""
    library = studio.part(Library)
    standing, stand = library.standing(), library.index.stand
    first = ask.first if ask.epoch == stand.epoch else 0
    return rows_told(standing, first, stand.rows[first:])


def find(studio: Studio, ask: LibraryFind) -> LibraryFound:
    """Search; positions are of library.index."""
    found, _, stand = studio.part(Library).find(
        ShelfQuery(
            text=ask.text,
            kinds=tuple(ask.kinds),
            origins=tuple(ask.origins),
            ranges={name: (r.low, r.high) for name, r in ask.ranges.items()},
            like=ask.like,
            sort=ask.sort,
            descending=ask.descending,
        )
    )
    return found_told(found, stand.epoch)


def search(studio: Studio, ask: LibraryQuery) -> LibraryRows:
    """Give the best matches as rows, for pickers."""
    query = ShelfQuery(text=ask.text, kinds=tuple(ask.kinds), origins=tuple(ask.origins))
    found, rows, stand = studio.part(Library).find(query)
    best = [row_told(rows[at]) for at in found.positions[: ask.limit]]
    return LibraryRows(best, len(found.positions), stand.ended)


def like(studio: Studio, ask: LibraryLikeAsk) -> LibraryAlikes:
    """Give the buttons that feel most like one."""
    found, rows, _ = studio.part(Library).find(ShelfQuery(like=ask.id))
    alike = [
        LibraryAlike(row_told(rows[at]), round(float(distance), 3), *np.round(parts, 3).tolist())
        for at, distance, parts in zip(found.positions, found.distances, found.parts, strict=True)
        if np.isfinite(distance)
    ]
    return LibraryAlikes(alike[: ask.limit])


def curves(studio: Studio, ask: LibraryCurvesAsk) -> LibraryCurves:
    """Give curves and landmarks; a button that cannot be had keeps no other back."""
    library = studio.part(Library)
    buttons, missing = [], []
    for button_id in ask.ids:
        try:
            buttons.append(button_of(studio, library, button_id))
        except FdvvError as error:
            missing.append(LibraryMissing(button_id, told(error)))
    return LibraryCurves(buttons, missing)


def button_of(studio: Studio, library: Library, button_id: str) -> LibraryButton:
    """Give a button with its curves; one that the index has not come to is read for it. InputError."""
    model = studio.shelf.curves(button_id)
    row = library.row(button_id) or row_of_model(model, button_id, Origin(button_id.partition(":")[0]))
    return button_told(row, sample_strokes(model))


def refused(studio: Studio, _ask: LibraryRefusedAsk) -> LibraryRefused:
    """List the files that cannot be used."""
    found = studio.part(Library).index.stand.refused
    return LibraryRefused([LibraryRefusal(one.place, one.reason) for one in tuple(found)])


def rescan(studio: Studio, _ask: LibraryRescanAsk) -> LibraryStanding:
    """Look through project and folders again, in the background."""
    library = studio.part(Library)
    library.index.rescan()
    return library.standing()


def opened(studio: Studio, tell: Tell) -> Channel:
    """Open a page's end of the channel."""
    return Watcher(studio.part(Library), tell)


CALLS = (
    Call("library.index", LibraryIndexAsk, LibraryIndex, index),
    Call("library.find", LibraryFind, LibraryFound, find),
    Call("library.search", LibraryQuery, LibraryRows, search),
    Call("library.like", LibraryLikeAsk, LibraryAlikes, like),
    Call("library.curves", LibraryCurvesAsk, LibraryCurves, curves),
    Call("library.refused", LibraryRefusedAsk, LibraryRefused, refused),
    Call("library.rescan", LibraryRescanAsk, LibraryStanding, rescan),
)
CHANNELS = (ChannelKind("library", (LibraryWatch,), (LibraryStanding,), opened),)
