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
) -> Any:
    """Make a dataclass field for a number that nobody knows quite."""
    known = About(text, unit, plausible, bounds, source)
    return dataclasses.field(default=default, metadata={"about": known})


def setting(default: float, *about: Any) -> Any:
    """Make a dataclass field, as quantity() does, for a number that the builder chooses."""
    known = dataclasses.replace(About(*about), chosen=True)
    return dataclasses.field(default=default, metadata={"about": known})


def choice(default: str, text: str, choices: tuple[str, ...], source: str = "assumed") -> Any:
    """Make a dataclass field for a word."""
    return dataclasses.field(default=default, metadata={"about": About(text, source=source, choices=choices)})


def about(field: dataclasses.Field[Any]) -> About:
    """Return what is known of a field made here."""
    return cast(About, field.metadata["about"])


def check_value(name: str, value: object, known: About, kind: type[int | float]) -> str | None:
    """Say what is wrong with a value, or None: type, finiteness, bounds, words."""
    if known.choices:
        words = " or ".join(f'"{word}"' for word in known.choices)
        return None if value in known.choices else f"{name} must be {words}, got {value!r}"
    if not isinstance(value, (int, float)) or isinstance(value, bool) or (kind is int and value % 1):
        return f"{name} must be {'a whole number' if kind is int else 'a number'}, got {value!r}"
    low, high = known.bounds
    if not (math.isfinite(value) and low <= value <= high):
        unit = f" {known.unit}" if known.unit else ""
        return f"{name} must be {low:g} to {high:g}{unit}, got {value:g}"
    return None


@dataclass(frozen=True)
class Section:
    """Parameters that belong together, all made by quantity(), setting() and choice().

    Raises ModelError on the first that is out of bounds; numbers are then int or float as declared.
    """

    def __post_init__(self) -> None:
        for field in dataclasses.fields(self):
            value, known = getattr(self, field.name), about(field)
            kind: type[int | float] = int if field.type in (int, "int") else float
            if wrong := check_value(field.name, value, known, kind):
                raise ModelError(f"{type(self).__name__}: {wrong}")
            if not known.choices:
                object.__setattr__(self, field.name, kind(value))
