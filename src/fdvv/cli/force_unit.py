"""The unit in which commands show forces: cN, or what a person chose. JSON and files stay in cN."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence

UNITS = ("cN", "gf", "N")
MORE_DIGITS = {"cN": 0, "gf": 0, "N": 2}
chosen = {"unit": "cN"}
"""The unit of this run; the group of commands sets it."""

_NUMBER = r"[-+−]?\d+(?:\.\d+)?"
_FORCE = re.compile(rf"({_NUMBER}(?:(?: to |…|, | and | ± ){_NUMBER})*)( ?)cN(?!\w)")
_UNIT = re.compile(r"(?<![-\w])cN(?!\w)|(?<=_)cN(?=\Z|_mm\Z)")
_CELL = re.compile(rf"{_NUMBER}(?:(?:…| ± ){_NUMBER})*\Z")
Row = Sequence[object]


def _in_cN(unit: str) -> float:
    """Return the centinewtons in one of a unit."""
    # the units bring NumPy, which help does without
    from fdvv.units import cN_from_gf, cN_from_N

    return {"cN": 1.0, "gf": cN_from_gf(1.0), "N": cN_from_N(1.0)}[unit]


def force_of(text: str) -> float:
    """Return a force in cN: a number of cN, or one with its unit, as 50gf or 0.5 N. ValueError."""
    found = re.fullmatch(r"\s*(.*?)\s*(cN|gf|N)?\s*", text)
    assert found is not None
    return float(found[1]) * _in_cN(found[2] or "cN")


def in_unit(text: str) -> str:
    """Return a sentence with its forces in the unit chosen, each with as many digits as say the same."""
    if chosen["unit"] == "cN":
        return text
    text = _FORCE.sub(lambda m: f"{_numbers(m[1])}{m[2]}{chosen['unit']}", text)
    return _UNIT.sub(chosen["unit"], text)


def table_in_unit(
    columns: Sequence[str], rows: Sequence[Row], digits: Mapping[str, int]
) -> tuple[list[str], list[list[object]], dict[str, int]]:
    """Return a table with the columns, and the rows, that name cN in the unit chosen."""
    if chosen["unit"] == "cN":
        return list(columns), [list(row) for row in rows], dict(digits)
    forces = [bool(_UNIT.search(title)) for title in columns]
    found = []
    for row in rows:
        label = isinstance(row[0], str) and not forces[0] and bool(_UNIT.search(row[0]))
        cells = [_cell(c) if is_force or label else c for c, is_force in zip(row, forces, strict=True)]
        found.append([in_unit(row[0]) if isinstance(row[0], str) else cells[0], *cells[1:]])
    more = MORE_DIGITS[chosen["unit"]]
    wide = {t: digits.get(t, 2) + more for t, is_force in zip(columns, forces, strict=True) if is_force}
    return (
        [in_unit(title) for title in columns],
        found,
        {in_unit(t): n for t, n in {**digits, **wide}.items()},
    )


def _cell(value: object) -> object:
    if isinstance(value, tuple):
        return tuple(_cell(part) for part in value)
    if isinstance(value, str):
        return _numbers(value) if _CELL.match(value) else value
    if isinstance(value, bool) or not isinstance(value, (int, float)):
        return value
    return float(value) / _in_cN(chosen["unit"])


def _numbers(text: str) -> str:
    return re.sub(_NUMBER, lambda m: _number(m[0]), text)


def _number(text: str) -> str:
    digits = len(text.partition(".")[2]) + MORE_DIGITS[chosen["unit"]]
    found = f"{float(text.replace('−', '-')) / _in_cN(chosen['unit']):.{digits}f}"
    return found.replace("-", "−") if text.startswith("−") else found
