"""Which buttons a line of words means: every word must match; one that matches nothing may have a typo."""

from __future__ import annotations

import re
from collections.abc import Sequence

import numpy as np
import numpy.typing as npt

from fdvv.workflow._shelf_row import ShelfRow

Mask = npt.NDArray[np.bool_]
TYPO_letters = 4
"""Shorter words are taken as they stand: with a letter changed they would match nearly everything."""

_WORD = re.compile(r"[^\s/_,;()\-]+")


class TextTable:
    """The words of many buttons: name, collection, origin and what is stated. Positions count from 0."""

    def __init__(self) -> None:
        self._names: list[str] = []
        self._others: list[str] = []
        self._words: set[str] = set()

    def extend(self, rows: Sequence[ShelfRow]) -> None:
        """Add buttons at the end."""
        for row in rows:
            name = row.name.casefold()
            other = " ".join([row.collection, row.origin, *row.stated]).casefold()
            self._names.append(name)
            self._others.append(_spaced(other))
            self._words.update(_WORD.findall(f"{name} {other}"))

    def match(self, text: str) -> tuple[Mask, npt.NDArray[np.float64], tuple[str, ...]]:
        """Find the buttons that match every word.

        Gives the mask (n,), how well each matches (n,): words at the start of the name count most, and the
        words that were read with a typo.
        """
        mask, score = np.ones(len(self._names), bool), np.zeros(len(self._names))
        mended = []
        for word in text.casefold().split():
            found = self._score([word])
            if not found.any() and len(word) >= TYPO_letters:
                found = self._score([w for w in self._words if _nearly(word, w)])
                mended += [word] if found.any() else []
            mask &= found > 0
            score += found
        return mask, score, tuple(mended)

    def _score(self, words: Sequence[str]) -> npt.NDArray[np.float64]:
        """Give 4 where a name begins so, 3 where a word of it does, 2 within the name, 1 elsewhere, (n,).

        Elsewhere a word must begin so: "red" is no measured button.
        """
        score = [0] * len(self._names)  # single places of an array take longer to read and write
        for word in words:
            begun = _spaced(word)
            for i, name in enumerate(self._names):
                at = name.find(word)
                if at >= 0:
                    score[i] = max(score[i], 4 if at == 0 else 3 if not name[at - 1].isalnum() else 2)
                elif begun in self._others[i]:
                    score[i] = max(score[i], 1)
        return np.array(score, dtype=np.float64)


def _spaced(text: str) -> str:
    """Put one blank before every word."""
    return "".join(f" {word}" for word in _WORD.findall(text))


def _nearly(typed: str, word: str) -> bool:
    """Tell whether the beginning of a word is one letter off: added, left out, another, or two swapped."""
    n = len(typed)
    if typed[0] not in word[:2]:
        return False  # hardly anyone mistakes the first letter, and other words would often be near
    return any(_one_off(typed, word[:size]) for size in (n - 1, n, n + 1) if len(word) >= size)


def _one_off(a: str, b: str) -> bool:
    if abs(len(a) - len(b)) > 1:
        return False
    start = next((i for i, (p, q) in enumerate(zip(a, b, strict=False)) if p != q), min(len(a), len(b)))
    if a[start + 1 :] == b[start + 1 :] or a[start + 1 :] == b[start:] or a[start:] == b[start + 1 :]:
        return True
    return a[start : start + 2] == b[start : start + 2][::-1] and a[start + 2 :] == b[start + 2 :]
