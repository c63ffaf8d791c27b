"""How a name is called, as it is written in the source: parameters, types, defaults."""

from __future__ import annotations

import enum
import inspect
from typing import Any

import msgspec

LONGEST_VALUE = 60
"""A longer value is shown as ``...``; so is one whose text changes from run to run."""
LONGEST_LINE = 80
UNITS = {
    "N_s_m": "N s/m",
    "N_m": "N/m",
    "N_A": "N/A",
    "K_W": "K/W",
    "m_s2": "m/s²",
    "mm_s2": "mm/s²",
    "g_m_s2": "g m/s²",
    "mm_s": "mm/s",
    "m_s": "m/s",
    "cN_mm": "cN/mm",
    "cN_s": "cN/s",
    "cN2": "cN²",
    "N_s": "N/s",
    "1_s": "1/s",
    "1_s2": "1/s²",
    "1_m": "1/m",
    "um16": "1/16 µm",
    "mm_s16": "1/16 mm/s",
    "cN64": "1/64 cN",
    "q15": "1/32768",
    "ratio": "1",
    "us": "µs",
    "um": "µm",
    "ohm": "Ω",
    "degC": "°C",
    "usd": "US$",
    **{
        unit: unit
        for unit in ("mm", "m", "cN", "N", "gf", "s", "ms", "Hz", "kHz", "kg", "g", "K", "W", "V", "mV")
    },
    **{
        unit: unit
        for unit in ("A", "J", "mJ", "dB", "rad", "lx", "Pa", "px", "percent", "kB", "bytes", "JND")
    },
}
"""A unit by the last part of a name."""


def unit_of(name: str) -> str:
    """Give the unit that a name ends in, "" if it has none."""
    pieces = name.split("_")
    ends = ("_".join(pieces[first:]) for first in range(1, len(pieces)))
    return next((UNITS[end] for end in ends if end in UNITS), "")


def plain(value: Any) -> Any:
    """Give the function behind a property, a class method or a static method."""
    if isinstance(value, property):
        return value.fget
    if isinstance(value, classmethod | staticmethod):
        return value.__func__
    return getattr(value, "func", value)  # functools.cached_property


def parameters(found: Any) -> list[inspect.Parameter]:
    """Give what a caller passes."""
    try:
        given = inspect.signature(found).parameters.values()
    except (TypeError, ValueError):
        return []
    return [p for p in given if p.name not in ("self", "cls") and not p.name.startswith("_")]


def annotation(found: Any) -> str:
    """Give a type as its source has it, "" if there is none."""
    if found is inspect.Parameter.empty:
        return ""
    if isinstance(found, str):
        text = found
    else:
        text = getattr(found, "__forward_arg__", "") or inspect.formatannotation(found)
    return " ".join(text.replace("npt.", "").replace("np.", "").replace("typing.", "").split())


def default(found: Any) -> str:
    """Give a default as code, "" if there is none."""
    if found is inspect.Parameter.empty or found is msgspec.NODEFAULT:
        return ""
    if isinstance(found, enum.Enum):
        return f"{type(found).__name__}.{found.name}"
    if inspect.isroutine(found) or inspect.isclass(found):
        return str(getattr(found, "__name__", "..."))
    return short(repr(found))


def short(text: str) -> str:
    """Give code in one line; ``...`` where it is long or tells an address."""
    line = " ".join(text.split())
    line = line if '"' in line else line.replace("'", '"')  # as the formatter has it
    return "..." if len(line) > LONGEST_VALUE or "<" in line else line


def returned(found: Any, mark: str = " -> ") -> str:
    """Give what a function gives back, after a mark; "" if its source does not say."""
    given = annotation(inspect.signature(plain(found)).return_annotation)
    return f"{mark}{given}" if given else ""


def call(found: Any, end: str) -> str:
    """Give the parameters of a call in brackets, in one line or one below the other."""
    shown: list[str] = []
    for p in parameters(found):
        if p.kind is p.KEYWORD_ONLY and not any(text.startswith("*") for text in shown):
            shown.append("*")
        star = "*" if p.kind is p.VAR_POSITIONAL else "**" if p.kind is p.VAR_KEYWORD else ""
        type_ = f": {annotation(p.annotation)}" if annotation(p.annotation) else ""
        given = f" = {default(p.default)}" if default(p.default) else ""
        shown.append(f"{star}{p.name}{type_}{given}")
    line = f"({', '.join(shown)}){end}"
    return line if len(line) <= LONGEST_LINE else "(\n    " + ",\n    ".join(shown) + f",\n){end}"
