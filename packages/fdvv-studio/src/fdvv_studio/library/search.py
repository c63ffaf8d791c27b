"""Searches of the catalogue: words, kinds and ranges together, or by similarity to one button."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np
import numpy.typing as npt

from fdvv.button.kind import ButtonType
from fdvv.button.like import LikeTable, distances
from fdvv.errors import InputError
from fdvv.model.noticeable import LITERATURE, Jnds
from fdvv.units import FloatArray
from fdvv_studio.library.row import NUMBERS, ButtonRow, Origin

Mask = npt.NDArray[np.bool_]
TYPO_letters = 4
"""Shorter words must match exactly: with a letter changed they would match nearly everything."""

_WORD = re.compile(r"[^\s/_,;()\-]+")


class TextTable:
    """The words of many buttons: name, collection, origin and what is stated. Positions count from 0."""

    def __init__(self) -> None:
        self._names: list[str] = []
        self._others: list[str] = []
        self._words: set[str] = set()

    def extend(self, rows: Sequence[ButtonRow]) -> None:
        for row in rows:
            name = row.name.casefold()
            other = " ".join([row.collection, row.origin, *row.stated]).casefold()
            self._names.append(name)
            self._others.append(_space_words(other))
            self._words.update(_WORD.findall(f"{name} {other}"))

    def match(self, text: str) -> tuple[Mask, npt.NDArray[np.float64], tuple[str, ...]]:
        """Find the buttons that match every word.

        Returns the mask (n,), how well each matches (n,): words at the start of the name count most, and the
        words that were read with a typo.
        """
        mask, score = np.ones(len(self._names), bool), np.zeros(len(self._names))
        mended = []
        for word in text.casefold().split():
            match = self._score([word])
            if not match.any() and len(word) >= TYPO_letters:
                match = self._score([w for w in self._words if _nearly(word, w)])
                mended += [word] if match.any() else []
            mask &= match > 0
            score += match
        return mask, score, tuple(mended)

    def _score(self, words: Sequence[str]) -> npt.NDArray[np.float64]:
        """Return 4 where a name begins so, 3 where a word of it does, 2 within the name, 1 elsewhere, (n,).

        Elsewhere a word must begin so: "red" is no measured button.
        """
        score = [0] * len(self._names)  # single places of an array take longer to read and write
        for word in words:
            prefix = _space_words(word)
            for i, name in enumerate(self._names):
                at = name.find(word)
                if at >= 0:
                    score[i] = max(score[i], 4 if at == 0 else 3 if not name[at - 1].isalnum() else 2)
                elif prefix in self._others[i]:
                    score[i] = max(score[i], 1)
        return np.array(score, dtype=np.float64)


def _space_words(text: str) -> str:
    return "".join(f" {word}" for word in _WORD.findall(text))


def _nearly(typed: str, word: str) -> bool:
    """Return whether the beginning of a word is one letter off: added, left out, another, or two swapped."""
    n = len(typed)
    if typed[0] not in word[:2]:
        return False  # hardly anyone mistakes the first letter, and other words would often be near
    return any(_differs_by_typo(typed, word[:size]) for size in (n - 1, n, n + 1) if len(word) >= size)


def _differs_by_typo(a: str, b: str) -> bool:
    if abs(len(a) - len(b)) > 1:
        return False
    start = next((i for i, (p, q) in enumerate(zip(a, b, strict=False)) if p != q), min(len(a), len(b)))
    if a[start + 1 :] == b[start + 1 :] or a[start + 1 :] == b[start:] or a[start:] == b[start + 1 :]:
        return True
    return a[start : start + 2] == b[start : start + 2][::-1] and a[start + 2 :] == b[start + 2 :]


Positions = npt.NDArray[np.intp]
BINS = 24
LABELS = ("name", "kind", "origin", "date")
"""Columns to sort by besides NUMBERS; "match" sorts by words, or by likeness where one is asked for."""


@dataclass(frozen=True)
class SearchQuery:
    """What is sought; all of it must hold.

    Attributes
    ----------
    text : words, every one of which must match.
    kinds, origins : any of these; empty for all.
    ranges : lowest and highest by name in NUMBERS, None for no end; what has no such figure is left out.
    like : the id of the button that others are to feel like. jnds : what distances to it are counted in.
    sort : "match", or a name in LABELS or NUMBERS; what has no such figure comes last.
    """

    text: str = ""
    kinds: tuple[ButtonType, ...] = ()
    origins: tuple[Origin, ...] = ()
    ranges: dict[str, tuple[float | None, float | None]] = field(default_factory=dict)
    like: str | None = None
    sort: str = "match"
    descending: bool = False
    jnds: Jnds = LITERATURE


@dataclass(frozen=True, eq=False)
class Histogram:
    """How many buttons that match everything but this range lie where, in BINS equal bins.

    lowest, highest : the ends of the bins; beyond them lie 1 % of all buttons on either side, counted in
        the outermost bins.
    """

    lowest: float
    highest: float
    counts: npt.NDArray[np.int64]


@dataclass(frozen=True, eq=False)
class SearchResult:
    """The answer.

    Attributes
    ----------
    positions : of the rows that match, in the order asked for.
    distances : in JND to the button they are to be like, in that order, parts too (n, 3); else empty.
    histograms : by name in NUMBERS.
    kinds, origins : how many match everything else.
    without : how many would match if a filter were dropped, by its name ("text", "kinds", "origins" or a
        range's).
    mended : words that were read with a typo.
    """

    positions: Positions
    distances: FloatArray
    parts: FloatArray
    histograms: dict[str, Histogram]
    kinds: dict[str, int]
    origins: dict[str, int]
    without: dict[str, int]
    mended: tuple[str, ...]


class CatalogSearch:
    """Rows made ready to be searched; more may be added at the end."""

    def __init__(self) -> None:
        self.rows: list[ButtonRow] = []
        self._at: dict[str, int] = {}
        self._text, self._like = TextTable(), LikeTable()
        self._numbers: FloatArray = np.empty((0, len(NUMBERS)))
        self._ends: FloatArray = np.empty((2, 0))
        self._bins: npt.NDArray[np.intp] = np.empty((0, len(NUMBERS)), dtype=np.intp)
        self._kinds = self._origins = np.empty(0, dtype=np.str_)

    def extend(self, rows: Sequence[ButtonRow]) -> None:
        if not rows:
            return
        self._at |= {row.id: len(self.rows) + i for i, row in enumerate(rows)}
        self.rows += rows
        self._text.extend(rows)
        self._like.extend(rows)
        table = [[getattr(row, name) for name in NUMBERS] for row in rows]
        self._numbers = np.vstack([self._numbers, np.array(table, dtype=np.float64)])
        self._ends = _ends(self._numbers)
        self._bins = _bins(self._numbers, self._ends)
        self._kinds = np.append(self._kinds, [str(row.kind) for row in rows])
        self._origins = np.append(self._origins, [str(row.origin) for row in rows])

    def row(self, button_id: str) -> ButtonRow | None:
        at = self._at.get(button_id)
        return None if at is None else self.rows[at]

    def _position(self, button_id: str) -> int:
        if button_id not in self._at:
            reason = f"no button is called {button_id!r:.80}"
            raise InputError("library", "button", reason, "choose one of the list, or wait for the index")
        return self._at[button_id]

    def find(self, query: SearchQuery) -> SearchResult:
        """Answer a question. Raises InputError on a name that is not there."""
        _check(query)
        matches, score, mended = self._text.match(query.text)
        kinds, origins = _among(self._kinds, query.kinds), _among(self._origins, query.origins)
        masks = {"text": matches, "kinds": kinds, "origins": origins, **self._ranges(query)}
        every = np.logical_and.reduce(list(masks.values())) if self.rows else np.zeros(0, bool)
        parts, distance = self._distances(query)
        keys = score if query.like is None else -distance
        positions = self._sort(query, np.flatnonzero(every), keys)
        if query.like is not None:
            positions = positions[positions != self._position(query.like)]
        others = {name: _all_but(masks, name) for name in masks}
        return SearchResult(
            positions=positions,
            distances=distance[positions] if query.like else np.empty(0),
            parts=parts[positions] if query.like else np.empty((0, 3)),
            histograms=self._histograms({name: others.get(name, every) for name in NUMBERS}),
            kinds=_counts(self._kinds, others["kinds"]),
            origins=_counts(self._origins, others["origins"]),
            without={name: int(others[name].sum()) for name in _active(query)},
            mended=mended,
        )

    def _ranges(self, query: SearchQuery) -> dict[str, Mask]:
        masks = {}
        for name, (low, high) in query.ranges.items():
            values = self._numbers[:, NUMBERS.index(name)]
            least, most = -np.inf if low is None else low, np.inf if high is None else high
            # an unknown figure is NaN, which no range holds
            masks[name] = (values >= least) & (values <= most)
        return masks

    def _distances(self, query: SearchQuery) -> tuple[FloatArray, FloatArray]:
        if query.like is None:
            return np.empty((0, 3)), np.empty(0)
        parts = self._like.parts(self._position(query.like), query.jnds)
        return parts, distances(parts)

    def _sort(
        self, query: SearchQuery, positions: npt.NDArray[np.intp], score: FloatArray
    ) -> npt.NDArray[np.intp]:
        """Sort positions; equal ones stay in the order of the catalogue, what is unknown comes last."""
        if query.sort == "match":
            return positions[np.argsort(-score[positions], kind="stable")]
        if query.sort in LABELS:
            labels = [str(getattr(self.rows[i], query.sort) or "").casefold() for i in positions]
            order = sorted(range(len(positions)), key=labels.__getitem__, reverse=query.descending)
            return positions[[i for i in order if labels[i]] + [i for i in order if not labels[i]]]
        values = self._numbers[positions, NUMBERS.index(query.sort)]
        return positions[np.argsort(-values if query.descending else values, kind="stable")]

    def _histograms(self, masks: dict[str, Mask]) -> dict[str, Histogram]:
        histograms = {}
        for i, name in enumerate(NUMBERS):
            low, high = self._ends[:, i] if self._ends.size else (np.nan, np.nan)
            if high > low:
                counts = np.bincount(self._bins[masks[name], i], minlength=BINS + 1)[:BINS]
                histograms[name] = Histogram(float(low), float(high), counts)
        return histograms


def _ends(numbers: FloatArray) -> FloatArray:
    """Return the 1st and the 99th percentile of every column, (2, k); NaN for a column without figures."""
    ends = np.full((2, numbers.shape[1]), np.nan)
    for i, column in enumerate(numbers.T):
        known = column[np.isfinite(column)]
        if known.size:
            ends[:, i] = np.percentile(known, (1, 99))
    return ends


def _bins(numbers: FloatArray, ends: FloatArray) -> npt.NDArray[np.intp]:
    """Return the bin of every figure, (n, k): the outermost beyond the ends, BINS where it is not known."""
    bins = np.full(numbers.shape, BINS, dtype=np.intp)
    for i, (low, high) in enumerate(ends.T):
        known = np.isfinite(numbers[:, i])
        inner = np.linspace(low, high, BINS + 1)[1:-1]
        bins[known, i] = np.searchsorted(inner, numbers[known, i], side="right")
    return bins


def _all_but(masks: dict[str, Mask], name: str) -> Mask:
    others = [mask for other, mask in masks.items() if other != name]
    return np.asarray(np.logical_and.reduce(others))


def _among(labels: npt.NDArray[np.str_], wanted: Sequence[str]) -> Mask:
    """Return which labels are wanted; all if none are named."""
    return np.isin(labels, [str(label) for label in wanted]) if wanted else np.ones(labels.size, bool)


def _counts(labels: npt.NDArray[np.str_], mask: Mask) -> dict[str, int]:
    """Count every label there is among those that the mask leaves."""
    there = set(labels.tolist())
    return {label: int(np.count_nonzero(mask & (labels == label))) for label in sorted(there)}


def _active(query: SearchQuery) -> list[str]:
    filters = {"text": query.text.strip(), "kinds": query.kinds, "origins": query.origins}
    return [name for name, value in filters.items() if value] + list(query.ranges)


def _check(query: SearchQuery) -> None:
    columns = ("match", *LABELS, *NUMBERS)
    for place, name, known in (
        ("sort", query.sort, columns),
        *(("ranges", name, NUMBERS) for name in query.ranges),
    ):
        if name not in known:
            raise InputError("library", place, f"no column {name!r:.40}", f"use one of {', '.join(known)}")
