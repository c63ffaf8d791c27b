"""A library of measured buttons, opened to be searched."""

from __future__ import annotations

import csv
import io
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import islice
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal

import msgspec
import numpy as np

from fdvv.errors import InputError
from fdvv.files import write_atomic
from fdvv.model import FDVVModel, builtin_names, load_builtin
from fdvv.workflow._kind import MODEL, own_kind
from fdvv.workflow._library_build import BUTTONS, REMEDY, LibraryManifest, read_manifest
from fdvv.workflow._library_columns import READ_NAMES, curves_of, rows_of
from fdvv.workflow._parquet import need_parquet, open_parquet
from fdvv.workflow._shelf_cache import CacheLine
from fdvv.workflow._shelf_read import row_of_file, row_of_model
from fdvv.workflow._shelf_row import Origin, ShelfRow
from fdvv.workflow._shelf_search import ShelfQuery, ShelfSearch

if TYPE_CHECKING:
    from pyarrow import Table

By = Literal["all", "curve", "landmarks"]
"""What likeness is told by: force, shape and landmarks; the first two; or landmarks alone."""
PARTS: dict[By, tuple[int, ...]] = {"all": (0, 1, 2), "curve": (0, 1), "landmarks": (2,)}
"""Which of the distances of force, shape and landmarks count."""
ASKED = "asked:"
"""Begins the id of a button that is not of the library and that others are to be like."""


@dataclass(frozen=True)
class LibraryHit:
    """A button of a library that was sought.

    Attributes
    ----------
    place : of its file, below the folder the library was built of.
    distance_JND, parts_JND : to the button that it was to be like, whole and by force, shape and landmarks;
        None if it was sought otherwise, or if nothing could be compared.
    """

    row: ShelfRow
    place: str
    distance_JND: float | None = None
    parts_JND: tuple[float | None, ...] = ()

    def to_dict(self) -> dict[str, Any]:
        """Give it as plain values, without the sketch."""
        told: dict[str, Any] = msgspec.to_builtins(self.row)
        for name in ("sketch", "origin"):
            del told[name]
        distance = {} if self.distance_JND is None else {"distance_JND": self.distance_JND}
        names = ("force_JND", "shape_JND", "landmarks_JND")
        return {**told, "place": self.place, **distance, **dict(zip(names, self.parts_JND, strict=False))}


class Library:
    """The buttons of a library's folder, in memory but for their curves.

    Raises InputError if there is none or it is not finished, BuildError without the extra `sweep`.
    """

    def __init__(self, folder: Path) -> None:
        need_parquet()
        self.folder = Path(folder)
        self.manifest: LibraryManifest = read_manifest(self.folder)
        if not self.manifest.finished:
            reason = "is not finished"
            raise InputError(self.folder, "library", reason, "run the same fdvv library build again")
        self._search = ShelfSearch()
        found = [pair for table in _tables(self.folder, READ_NAMES) for pair in rows_of(table)]
        self._places = {row.id: place for place, row in found}
        self._search.extend([row for _, row in found])

    @property
    def rows(self) -> Sequence[ShelfRow]:
        """Get the rows of all buttons, in the order of their places."""
        return [row for row in self._search.rows if row.id in self._places]

    def find(self, query: ShelfQuery) -> tuple[list[LibraryHit], tuple[str, ...]]:
        """Find buttons; give them and the words that were read with a typo. InputError."""
        found = self._search.find(query)
        rows = [self._search.rows[i] for i in found.positions]
        return [LibraryHit(row, self._places[row.id]) for row in rows if row.id in self._places], found.mended

    def like(self, spec: str, by: By = "all", count: int = 10) -> list[LibraryHit]:
        """Find the buttons that feel most like one; docs/explanation/library.md tells how that is decided.

        spec : the id or the place of one of the library, a built-in's name, a model file or a measured file.
        Raises InputError.
        """
        asked = self._asked(spec)
        if self._search.row(asked.id) is None:
            self._search.extend([asked])
        found = self._search.find(ShelfQuery(like=asked.id))
        parts = found.parts[:, PARTS[by]]
        distance = np.sqrt(np.mean(parts**2, axis=1))
        nearest = [i for i in np.argsort(distance, kind="stable") if np.isfinite(distance[i])]
        hits = (self._hit(found.positions[i], distance[i], found.parts[i]) for i in nearest)
        return list(islice((hit for hit in hits if hit.row.id in self._places), count))

    def refused(self) -> Iterator[tuple[str, str]]:
        """Give the files that were refused, each by its place with the reason."""
        for table in _tables(self.folder, ("place", "state", "reason")):
            for line in table.to_pylist():
                if line["state"] == "refused":
                    yield line["place"], line["reason"]

    def model(self, button_id: str) -> FDVVModel:
        """Give a button as its row was read: polylines of its means, without its file. InputError."""
        row = self._search.row(button_id)
        if row is None:
            raise InputError(self.folder, "button", f"no button is called {button_id!r:.80}", "search for it")
        for table in _tables(self.folder, ("id", "curves")):
            at = table.column("id").to_pylist()
            if button_id in at:
                line = table.slice(at.index(button_id), 1).to_pylist()[0]
                curves = tuple(curve.curve() for curve in curves_of(line))
                return FDVVModel(row.name, row.travel_mm, curves, row.actuation_mm, row.reset_mm)
        raise InputError(self.folder / BUTTONS, "button", f"{button_id} has no curves", REMEDY)

    def _hit(self, position: int, distance: float, parts: Any) -> LibraryHit:
        row = self._search.rows[position]
        told = tuple(round(float(part), 3) if np.isfinite(part) else None for part in parts)
        return LibraryHit(row, self._places.get(row.id, ""), round(float(distance), 3), told)

    def _asked(self, spec: str) -> ShelfRow:
        """Give the row of the button that others are to be like."""
        known = self._search.row(spec) or self._at_place(spec)
        if known is not None:
            return known
        if spec in builtin_names():
            return row_of_model(load_builtin(spec), f"{ASKED}{spec}", Origin.BUILTIN)
        path = Path(spec)
        if not path.is_file():
            reason = "is no button of the library, no built-in and no file"
            raise InputError(spec or "''", "argument", reason, "name a file, or the id of a search")
        kind = own_kind(path)
        if kind and kind != MODEL:
            raise InputError(
                path, "whole file", f"holds {kind}, no button", "name a model or a measured file"
            )
        return row_of_file(path, f"{ASKED}{spec}", "")

    def _at_place(self, place: str) -> ShelfRow | None:
        return next((self._search.row(i) for i, there in self._places.items() if there == place), None)


def known_lines(folder: Path) -> Iterator[CacheLine]:
    """Give what a library knows of its files as a shelf keeps it, so that a shelf need not read them.

    Raises InputError if there is no library or it is damaged, BuildError without the extra `sweep`.
    """
    need_parquet()
    read_manifest(folder)
    for table in _tables(folder, ("stamp", "reason", *READ_NAMES)):
        rows = dict(rows_of(table))
        told = (table.column(name).to_pylist() for name in ("place", "stamp", "reason"))
        for place, stamp, reason in zip(*told, strict=True):
            yield CacheLine(place, stamp, rows.get(place), reason or "")


def _tables(folder: Path, columns: Sequence[str]) -> Iterator[Table]:
    path = folder / BUTTONS
    try:
        found = open_parquet(path)
    except (OSError, ValueError) as error:
        raise _damaged(path, error) from error
    try:
        for group in range(found.num_row_groups):
            yield found.read_row_group(group, columns=list(columns))
    except (OSError, ValueError) as error:
        raise _damaged(path, error) from error
    finally:
        found.close()


def _damaged(path: Path, error: Exception) -> InputError:
    return InputError(path, "whole file", f"cannot be read ({error})", "build the library again")


def write_hits(path: Path, hits: Sequence[LibraryHit]) -> None:
    """Write hits as CSV, a row each, with the columns of the library; lists are joined by blanks. OSError."""
    lines = [hit.to_dict() for hit in hits]
    names = list(dict.fromkeys(name for line in lines for name in line)) or ["id", "name", "place"]
    buffer = io.StringIO()
    writer = csv.DictWriter(buffer, names, lineterminator="\n")
    writer.writeheader()
    writer.writerows({name: _cell(value) for name, value in line.items()} for line in lines)
    write_atomic(path, buffer.getvalue())


def _cell(value: Any) -> Any:
    return " ".join(map(str, value)) if isinstance(value, list | tuple) else value
