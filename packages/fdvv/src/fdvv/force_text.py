"""Forces as people read them, in cN, gf or N; figures in JSON and files stay in cN.

The unit is that of FDVV_FORCE_UNIT: worker processes inherit it, and a program that uses the package may
set it.
"""

from __future__ import annotations

import os
import re
from collections.abc import Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from fdvv.units import Value

VARIABLE = "FDVV_FORCE_UNIT"
UNITS = ("cN", "gf", "N")
MORE_DIGITS = {"cN": 0, "gf": 0, "N": 2}


def force_unit() -> str:
    """Return the unit in which forces are shown; cN where the variable names none."""
    unit = os.environ.get(VARIABLE, "cN")
    return unit if unit in UNITS else "cN"


@contextmanager
def shown_in(unit: str) -> Iterator[None]:
    """Show forces in a unit, in this process and in those that it starts."""
    before = os.environ.get(VARIABLE)
    os.environ[VARIABLE] = unit
    try:
        yield
    finally:
        if before is None:
            del os.environ[VARIABLE]
        else:
            os.environ[VARIABLE] = before


def in_cN(unit: str) -> float:
    """Return the centinewtons in one of a unit."""
    # the units bring NumPy, which help does without
    from fdvv.units import cN_from_gf, cN_from_N

    return {"cN": 1.0, "gf": cN_from_gf(1.0), "N": cN_from_N(1.0)}[unit]


def shown_force(force_cN: Value) -> Value:
    """Return a force, or an array of them, in the unit shown."""
    unit = force_unit()
    return force_cN if unit == "cN" else force_cN / in_cN(unit)


def force_number(force_cN: float, spec: str = "g") -> str:
    """Write a force without its unit.

    spec : of the figure in cN; in another unit it has as many decimals as say the same.
    """
    text, unit = format(force_cN, spec), force_unit()
    if unit == "cN" or not text.strip(" +-").replace(".", "").isdigit():
        return text if unit == "cN" else format(shown_force(force_cN), spec)
    digits = len(text.strip().partition(".")[2]) + MORE_DIGITS[unit]
    sign = "+" if "+" in spec else ""
    return f"{shown_force(force_cN):{sign}.{digits}f}".rjust(len(text))


def force_text(force_cN: float, spec: str = "g", per: str = "") -> str:
    """Write a force with its unit; per : what divides it in a slope, as "/mm"."""
    return f"{force_number(force_cN, spec)} {force_unit()}{per}"


def force_of(text: str) -> float:
    """Return a force in cN: a number of cN, or one with its unit, as 50gf or 0.5 N. ValueError."""
    found = re.fullmatch(r"\s*(.*?)\s*(cN|gf|N)?\s*", text)
    assert found is not None
    return float(found[1]) * in_cN(found[2] or "cN")


class ForceTitle(str):
    """The title of a column or a row of forces: its cells hold cN and are printed in the unit shown.

    digits : decimals of the cells.
    """

    digits: int

    def __new__(cls, title: str, digits: int = 2) -> ForceTitle:
        """Put the unit into the braces of a title, as "mean {}". digits : decimals in cN."""
        made = super().__new__(cls, title.format(force_unit()))
        made.digits = digits + MORE_DIGITS[force_unit()]
        return made


def force_name(name: str, digits: int = 2) -> str:
    """Return the name of a figure as a title: peak_cN becomes peak_gf; one without a force stays."""
    found = re.fullmatch(r"(.*_)cN(_mm)?", name)
    return ForceTitle(f"{found[1]}{{}}{found[2] or ''}", digits) if found else name
