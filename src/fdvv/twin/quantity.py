"""Parameters that know their unit, their range and where they come from."""

from __future__ import annotations

import dataclasses
import math
from dataclasses import dataclass
from typing import Any, cast

from fdvv.errors import ModelError


@dataclass(frozen=True)
class About:
    """What is known of one parameter.

    Attributes
    ----------
    text : what it is.
    unit : as written after the number; "" for a pure number.
    plausible : the range to sweep.
    bounds : the range the equations and the step can bear; beyond it a value is refused.
    source : the tag of its source, "assumed" where there is none.
    choices : the words allowed, for a parameter that is a word.
    chosen : set by the builder, so known and not drawn at random.
    """

    text: str
    unit: str = ""
    plausible: tuple[float, float] | None = None
    bounds: tuple[float, float] = (-math.inf, math.inf)
    source: str = "assumed"
    choices: tuple[str, ...] = ()
    chosen: bool = False


def quantity(
    default: float,
    text: str,
    unit: str,
    plausible: tuple[float, float],
    bounds: tuple[float, float],
    source: str = "assumed",
    chosen: bool = False,
) -> Any:
    """Make a dataclass field for a number; chosen: by the builder, never drawn at random."""
    known = About(text, unit, plausible, bounds, source, chosen=chosen)
    return dataclasses.field(default=default, metadata={"about": known})


def choice(default: str, text: str, choices: tuple[str, ...], source: str = "assumed") -> Any:
    """Make a dataclass field for a word."""
    return dataclasses.field(default=default, metadata={"about": About(text, source=source, choices=choices)})


def about(field: dataclasses.Field[Any]) -> About:
    """Return what is known of a field made here."""
    return cast(About, field.metadata["about"])


def check_value(name: str, value: object, known: About, kind: type) -> str | None:
    """Say what is wrong with a value, or None: type, finiteness, bounds, words."""
    if known.choices:
        return None if value in known.choices else f"{name} must be {_either(known.choices)}, got {value!r}"
    if (
        isinstance(value, bool)
        or not isinstance(value, (int, float))
        or (kind is int and value != int(value))
    ):
        wanted = "a whole number" if kind is int else "a number"
        return f"{name} must be {wanted}, got {value!r}"
    low, high = known.bounds
    if not (math.isfinite(value) and low <= value <= high):
        unit = f" {known.unit}" if known.unit else ""
        return f"{name} must be {low:g} to {high:g}{unit}, got {value:g}"
    return None


def _either(words: tuple[str, ...]) -> str:
    return " or ".join(f'"{word}"' for word in words)


def check(record: Any) -> None:
    """Check every parameter of a dataclass; raise ModelError on the first that is out of bounds."""
    for field in dataclasses.fields(record):
        kind = int if field.type in (int, "int") else float
        wrong = check_value(field.name, getattr(record, field.name), about(field), kind)
        if wrong:
            raise ModelError(f"{type(record).__name__}: {wrong}")
        if kind is int:
            object.__setattr__(record, field.name, int(getattr(record, field.name)))
        elif not about(field).choices:
            object.__setattr__(record, field.name, float(getattr(record, field.name)))
