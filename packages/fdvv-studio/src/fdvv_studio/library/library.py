"""A library of measured buttons, opened to be searched, and searches written in one line."""

from __future__ import annotations

import contextlib
import csv
import io
import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import islice
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal

import msgspec
import numpy as np

from fdvv.button.kind import ButtonType
from fdvv.button.like import distances
from fdvv.errors import InputError, did_you_mean
from fdvv.force_text import force_of
from fdvv.io.documents import MODEL, own_kind
from fdvv.io.files import write_atomic
from fdvv.io.part_store import need_parquet, read_groups
from fdvv.model.file import builtin_names, load_builtin
from fdvv.model.model import FDVVModel
from fdvv.model.noticeable import LITERATURE, Jnds
from fdvv_studio.library.build import BUTTONS, REMEDY, LibraryManifest, read_manifest
from fdvv_studio.library.figures import row_of_file, row_of_model
from fdvv_studio.library.row import NUMBERS, ButtonRow, CacheLine, Origin
from fdvv_studio.library.search import LABELS, CatalogSearch, SearchQuery
from fdvv_studio.library.table import READ_NAMES, curves_of, rows_of

if TYPE_CHECKING:
    from pyarrow import Table


By = Literal["all", "curve", "landmarks"]
"""What likeness is judged by: force, shape and landmarks; the first two; or landmarks alone."""

PARTS: dict[By, tuple[int, ...]] = {"all": (0, 1, 2), "curve": (0, 1), "landmarks": (2,)}
"""Which of the distances of force, shape and landmarks count."""

QUERY = "asked:"
"""Begins the id of a button that is not of the library and that others are to be like."""


@dataclass(frozen=True)
class LibraryHit:
    """A button of a library that was sought.

    place : of its file, below the folder the library was built of.
    distance_JND, parts_JND : to the button that it was to be like, whole and by force, shape and landmarks;
        None if it was sought otherwise, or if nothing could be compared.
    """

    row: ButtonRow
    place: str
    distance_JND: float | None = None
    parts_JND: tuple[float | None, ...] = ()

    def to_dict(self) -> dict[str, Any]:
        """Return plain values, without the sketch."""
        row: dict[str, Any] = msgspec.to_builtins(self.row)
        for name in ("sketch", "origin"):
            del row[name]
        distance = {} if self.distance_JND is None else {"distance_JND": self.distance_JND}
        names = ("force_JND", "shape_JND", "landmarks_JND")
        return {**row, "place": self.place, **distance, **dict(zip(names, self.parts_JND, strict=False))}


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
        self._search = CatalogSearch()
        pairs = [pair for table in _tables(self.folder, READ_NAMES) for pair in rows_of(table)]
        self._places = {row.id: place for place, row in pairs}
        self._search.extend([row for _, row in pairs])

    @property
    def rows(self) -> Sequence[ButtonRow]:
        """Return the rows of all buttons, in the order of their places."""
        return [row for row in self._search.rows if row.id in self._places]

    def find(self, query: SearchQuery) -> tuple[list[LibraryHit], tuple[str, ...]]:
        """Find buttons; give them and the words that were read with a typo. InputError."""
        hits = self._search.find(query)
        rows = [self._search.rows[i] for i in hits.positions]
        return [LibraryHit(row, self._places[row.id]) for row in rows if row.id in self._places], hits.mended

    def like(self, spec: str, by: By = "all", count: int = 10, jnds: Jnds = LITERATURE) -> list[LibraryHit]:
        """Find the buttons that feel most like one; docs/explanation/library.md tells how that is decided.

        spec : the id or the place of one of the library, a built-in's name, a model file or a measured file.
        jnds : what distances are counted in.
        Raises InputError.
        """
        row = self._query_row(spec)
        if self._search.row(row.id) is None:
            self._search.extend([row])
        result = self._search.find(SearchQuery(like=row.id, jnds=jnds))
        distance = distances(result.parts[:, PARTS[by]])
        nearest = [i for i in np.argsort(distance, kind="stable") if np.isfinite(distance[i])]
        hits = (self._hit(result.positions[i], distance[i], result.parts[i]) for i in nearest)
        return list(islice((hit for hit in hits if hit.row.id in self._places), count))

    def refused(self) -> Iterator[tuple[str, str]]:
        """Return the files that were refused, each by its place with the reason."""
        for table in _tables(self.folder, ("place", "state", "reason")):
            for line in table.to_pylist():
                if line["state"] == "refused":
                    yield line["place"], line["reason"]

    def model(self, button_id: str) -> FDVVModel:
        """Return a button as its row was read: polylines of its means, without its file. InputError."""
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
        rounded = tuple(round(float(part), 3) if np.isfinite(part) else None for part in parts)
        return LibraryHit(row, self._places.get(row.id, ""), round(float(distance), 3), rounded)

    def _query_row(self, spec: str) -> ButtonRow:
        known = self._search.row(spec) or self._at_place(spec)
        if known is not None:
            return known
        if spec in builtin_names():
            return row_of_model(load_builtin(spec), f"{QUERY}{spec}", Origin.BUILTIN)
        path = Path(spec)
        if not path.is_file():
            reason = "is no button of the library, no built-in and no file"
            raise InputError(spec or "''", "argument", reason, "name a file, or the id of a search")
        kind = own_kind(path)
        if kind and kind != MODEL:
            remedy = "name a model or a measured file"
            raise InputError(path, "whole file", f"holds {kind}, no button", remedy)
        return row_of_file(path, f"{QUERY}{spec}", "")

    def _at_place(self, place: str) -> ButtonRow | None:
        return next((self._search.row(i) for i, there in self._places.items() if there == place), None)


def cache_lines(folder: Path) -> Iterator[CacheLine]:
    """Return what a library knows of its files as lines of the cache, so that the index need not read them.

    Raises InputError if there is no library or it is damaged, BuildError without the extra `sweep`.
    """
    need_parquet()
    read_manifest(folder)
    for table in _tables(folder, ("stamp", "reason", *READ_NAMES)):
        rows = dict(rows_of(table))
        columns = (table.column(name).to_pylist() for name in ("place", "stamp", "reason"))
        for place, stamp, reason in zip(*columns, strict=True):
            yield CacheLine(place, stamp, rows.get(place), reason or "")


def _tables(folder: Path, columns: Sequence[str]) -> Iterator[Table]:
    path = folder / BUTTONS
    try:
        yield from read_groups(path, columns)
    except (OSError, ValueError) as error:
        reason = f"cannot be read ({error})"
        raise InputError(path, "whole file", reason, "build the library again") from error


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


_CONDITION = re.compile(r"(?P<name>[A-Za-z]\w*)(?P<sign><=|>=|<|>|=)(?P<value>\S+)")
Range = tuple[float | None, float | None]
FULL: Range = (None, None)
SORTED = ("match", *(name for name in LABELS if name != "origin"), *NUMBERS)


def library_query(text: str, sort: str = "match", descending: bool = False) -> SearchQuery:
    """Read a search; every word and condition must hold.

    Conditions have no blanks; several may name one column. A kind is written with or without its question
    mark. A force may carry its unit, or the column's name may: peak_cN>=50gf, peak_gf>=50. sort : one of
    SORTED. InputError that says what was not understood.
    """
    words: list[str] = []
    kinds: list[ButtonType] = []
    ranges: dict[str, Range] = {}
    for part in text.split():
        match = _CONDITION.fullmatch(part)
        if match is None and any(sign in part for sign in "<>="):
            remedy = "write it as peak_cN>=50, without blanks"
            raise InputError("search", part, "is neither a word nor a condition", remedy)
        if match is None:
            words.append(part)
        elif match["name"] == "kind":
            kinds += _kinds(part, match["sign"], match["value"])
        else:
            name, unit = _column(match["name"])
            _check_name(name)
            more = _range(part, match["sign"], match["value"], unit)
            ranges[name] = _both(ranges.get(name, FULL), more)
    sort, _ = _column(sort)
    if sort not in SORTED:
        raise InputError("--sort", sort, "no such column", f"use one of {', '.join(SORTED)}")
    return SearchQuery(" ".join(words), tuple(kinds), ranges=ranges, sort=sort, descending=descending)


def _column(name: str) -> tuple[str, str]:
    """Return the column of a name and the unit of its bare numbers: peak_gf is peak_cN in gf."""
    match = re.fullmatch(r"(\w+_)(cN|gf|N)(_mm)?", name)
    return (f"{match[1]}cN{match[3] or ''}", match[2]) if match else (name, "")


def _check_name(name: str) -> None:
    if name in NUMBERS:
        return
    remedy = did_you_mean(name, NUMBERS, f"use kind or one of {', '.join(NUMBERS)}")
    raise InputError("search", name, "no such column", remedy)


def _kinds(part: str, sign: str, value: str) -> Sequence[ButtonType]:
    known = {str(kind).rstrip("?"): kind for kind in ButtonType}
    names = [name.rstrip("?") for name in value.split(",")]
    if sign != "=" or any(name not in known for name in names):
        raise InputError("search", part, "no such kind", f"write kind= and one or more of {','.join(known)}")
    return [known[name] for name in names]


def _range(part: str, sign: str, value: str, unit: str) -> Range:
    low, between, high = value.partition("..")
    if sign == "=" and between:
        return (_number(part, low, unit) if low else None), (_number(part, high, unit) if high else None)
    number = _number(part, value, unit)
    if sign in (">", "<"):  # ranges hold their ends
        number = float(np.nextafter(number, np.inf if sign == ">" else -np.inf))
    return (None if "<" in sign else number), (None if ">" in sign else number)


def _number(part: str, text: str, unit: str) -> float:
    with contextlib.suppress(ValueError):
        bare = text[-1:].isdigit() or text.endswith(".")
        value = force_of(f"{text}{unit}" if bare else text) if unit else float(text)
        if np.isfinite(value):
            return value
    remedy = "write it as peak_cN>=50 or peak_cN=50..60"
    raise InputError("search", part, f"{text!r} is not a number", remedy)


def _both(first: Range, second: Range) -> Range:
    lows = [low for low, _ in (first, second) if low is not None]
    highs = [high for _, high in (first, second) if high is not None]
    return max(lows, default=None), min(highs, default=None)
