"""A search in one line: words, and conditions as `peak_cN>=50`, `travel_mm=3..3.5`, `kind=dome`."""

from __future__ import annotations

import difflib
import re
from collections.abc import Sequence

import numpy as np

from fdvv.errors import InputError
from fdvv.workflow._shelf_row import NUMBERS, ButtonType
from fdvv.workflow._shelf_search import LABELS, ShelfQuery

_CONDITION = re.compile(r"(?P<name>[A-Za-z]\w*)(?P<sign><=|>=|<|>|=)(?P<value>\S+)")
Range = tuple[float | None, float | None]
FULL: Range = (None, None)
SORTED = ("match", *(name for name in LABELS if name != "origin"), *NUMBERS)


def library_query(text: str, sort: str = "match", descending: bool = False) -> ShelfQuery:
    """Read a search; every word and condition must hold.

    Conditions have no blanks; of one column several may be given. A kind is told with or without its question
    mark. sort : one of SORTED. InputError that says what was not understood.
    """
    words: list[str] = []
    kinds: list[ButtonType] = []
    ranges: dict[str, Range] = {}
    for part in text.split():
        found = _CONDITION.fullmatch(part)
        if found is None:
            _check_word(part)
            words.append(part)
        elif found["name"] == "kind":
            kinds += _kinds(part, found["sign"], found["value"])
        else:
            _check_name(found["name"])
            more = _range(part, found["sign"], found["value"])
            ranges[found["name"]] = _both(ranges.get(found["name"], FULL), more)
    if sort not in SORTED:
        raise InputError("--sort", sort, "no such column", f"use one of {', '.join(SORTED)}")
    return ShelfQuery(" ".join(words), tuple(kinds), ranges=ranges, sort=sort, descending=descending)


def _check_word(part: str) -> None:
    if any(sign in part for sign in "<>="):
        raise InputError(
            "search", part, "is neither a word nor a condition", "write it as peak_cN>=50, without blanks"
        )


def _check_name(name: str) -> None:
    if name in NUMBERS:
        return
    near = difflib.get_close_matches(name, NUMBERS, 1, 0.5)
    remedy = f"did you mean {near[0]}?" if near else f"use kind or one of {', '.join(NUMBERS)}"
    raise InputError("search", name, "no such column", remedy)


def _kinds(part: str, sign: str, value: str) -> Sequence[ButtonType]:
    known = {str(kind).rstrip("?"): kind for kind in ButtonType}
    names = [name.rstrip("?") for name in value.split(",")]
    if sign != "=" or any(name not in known for name in names):
        raise InputError("search", part, "no such kind", f"write kind= and one or more of {','.join(known)}")
    return [known[name] for name in names]


def _range(part: str, sign: str, value: str) -> Range:
    low, between, high = value.partition("..")
    if sign == "=" and between:
        return (_number(part, low) if low else None), (_number(part, high) if high else None)
    number = _number(part, value)
    if sign in (">", "<"):  # ranges hold their ends
        number = float(np.nextafter(number, np.inf if sign == ">" else -np.inf))
    return (None if "<" in sign else number), (None if ">" in sign else number)


def _number(part: str, text: str) -> float:
    try:
        value = float(text)
    except ValueError:
        value = float("nan")
    if not np.isfinite(value):
        raise InputError(
            "search", part, f"{text!r} is not a number", "write it as peak_cN>=50 or peak_cN=50..60"
        )
    return value


def _both(first: Range, second: Range) -> Range:
    """Give the range in which both hold."""
    lows = [low for low, _ in (first, second) if low is not None]
    highs = [high for _, high in (first, second) if high is not None]
    return max(lows, default=None), min(highs, default=None)
