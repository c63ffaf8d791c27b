"""What a sweep tries: lists or ranges of values, every combination of them a cell. A TOML file."""

from __future__ import annotations

import difflib
import itertools
import tomllib
from collections.abc import Iterator
from pathlib import Path
from typing import Annotated, Any, Literal

import msgspec
import numpy as np
from msgspec import Meta, Struct

from fdvv.errors import InputError
from fdvv.files import read_limited
from fdvv.workflow._sweep_measure import MEASURES, Measure

FORMAT = "fdvv-sweep"
REMEDY = "correct it; docs/reference/sweep-files.md tells what a plan holds"
LARGEST_bytes = 1_000_000
MOST_cells = 10_000_000
REPEAT = "repeat"
"""The factor that every plan may have: how often each combination is tried with fresh noise."""

Value = str | float | int
Told = list[Value] | dict[str, Value] | int
"""How a plan tells the values of a factor: one by one, as a Range or a Draw, or as a count of repeats."""


class Range(Struct, frozen=True, forbid_unknown_fields=True):
    """Numbers from one end to the other, both of them, in even steps or even ratios."""

    start: float
    end: float
    count: Annotated[int, Meta(ge=2, le=100_000)]
    spacing: Literal["even", "ratio"] = "even"

    def values(self) -> tuple[float, ...]:
        """Give the numbers. ValueError on a ratio from or to 0 or below."""
        if self.spacing == "even":
            return tuple(np.linspace(self.start, self.end, self.count).tolist())
        if min(self.start, self.end) <= 0:
            raise ValueError("ends of an even ratio must be above 0")
        return tuple(np.geomspace(self.start, self.end, self.count).tolist())


class Draw(Struct, frozen=True, forbid_unknown_fields=True):
    """So many rigs or fingers drawn over what is plausible, see fdvv.twin.draw_rig."""

    draw: Annotated[int, Meta(ge=1, le=100_000)]


class SweepPlan(Struct, frozen=True, forbid_unknown_fields=True, kw_only=True):
    """A sweep: everything that decides its result but the files it names.

    Attributes
    ----------
    measure : what is found out of each cell, see MEASURES.
    seed : of all that is random. Cells of one repeat share their seed: they differ by their factors alone.
    factors : values by the factor's name; a range or a draw stands for its values.
    settings : of the measure, the same for all cells.
    """

    format: Literal["fdvv-sweep"]
    version: Literal[1]
    measure: str
    factors: dict[str, Told] = {}
    seed: Annotated[int, Meta(ge=0, lt=2**32)] = 0
    settings: dict[str, Any] = {}

    @property
    def measured(self) -> Measure:
        """Get the measure itself."""
        return MEASURES[self.measure]

    def levels(self) -> dict[str, tuple[Value, ...]]:
        """Give the values of every factor, those the plan leaves out too, in the order of the cells."""
        told = {name: _values(value) for name, value in self.factors.items() if name != REPEAT}
        left = {name: (first,) for name, first in self.measured.factors.items() if name not in told}
        repeats = self.factors.get(REPEAT, 1)
        assert isinstance(repeats, int)
        return {**told, **left, REPEAT: tuple(range(repeats))}

    @property
    def count(self) -> int:
        """Count the cells."""
        return int(np.prod([len(values) for values in self.levels().values()], dtype=object))

    def cells(self) -> Iterator[dict[str, Value]]:
        """Give every cell, the last factor changing fastest."""
        levels = self.levels()
        return (dict(zip(levels, values, strict=True)) for values in itertools.product(*levels.values()))


def read_sweep_plan(path: Path) -> SweepPlan:
    """Read a plan. InputError that names the place and what may stand there."""
    text = read_limited(path, LARGEST_bytes, REMEDY)
    try:
        data = tomllib.loads(text.decode())
    except (UnicodeDecodeError, tomllib.TOMLDecodeError) as error:
        raise InputError(path, "TOML", str(error), REMEDY) from error
    if data.get("format") != FORMAT or data.get("version") != 1:
        reason = 'not a plan of a sweep (it begins with format = "fdvv-sweep" and version = 1)'
        raise InputError(path, "format", reason, REMEDY)
    try:
        plan = msgspec.convert(data, SweepPlan)
    except msgspec.ValidationError as error:
        reason, _, place = str(error).partition(" - at ")
        raise InputError(path, place.strip("`").removeprefix("$.") or "plan", reason, REMEDY) from error
    check_plan(plan, path)
    return plan


def check_plan(plan: SweepPlan, source: object) -> None:
    """Refuse a plan that cannot be carried out, but for the files it names. InputError."""
    if plan.measure not in MEASURES:
        raise _unknown(source, "measure", plan.measure, list(MEASURES))
    for name, value in plan.factors.items():
        _check_factor(plan, source, name, value)
    for name in plan.settings:
        if name not in plan.measured.settings:
            raise _unknown(source, "settings", name, list(plan.measured.settings))
    if plan.count > MOST_cells:
        reason = f"{plan.count} cells, at most {MOST_cells} are tried"
        raise InputError(source, "factors", reason, "split the plan")


def _check_factor(plan: SweepPlan, source: object, name: str, value: Told) -> None:
    place = f"factors.{name}"
    section, _, parameter = name.partition(".")
    known = [*plan.measured.factors, REPEAT]
    if name not in known and not (parameter and section in ("rig", "finger") and section in known):
        raise _unknown(source, "factors", name, [*known, *(f"{s}.SECTION.NAME" for s in ("rig", "finger"))])
    if (name == REPEAT) != isinstance(value, int):
        wanted = "a count" if name == REPEAT else "a list, a range or a draw"
        raise InputError(source, place, f"{wanted} is needed, got {value!r:.60}", REMEDY)
    if isinstance(value, int):
        if not 1 <= value <= 100_000:
            raise InputError(source, place, f"{value} repeats", "give 1 to 100000")
        return
    if isinstance(value, dict) and "draw" in value and name not in ("rig", "finger"):
        raise InputError(source, place, "only rigs and fingers can be drawn", "give a list or a range")
    try:
        values = _values(value)
    except ValueError as error:
        raise InputError(source, place, str(error), REMEDY) from error
    if not values or len(set(values)) != len(values):
        reason = "no values" if not values else "a value repeats"
        raise InputError(source, place, reason, "give each value once; fresh noise is repeat = COUNT")
    named = plan.measured.factors.get(name, values[0])
    if any(isinstance(value, str) != isinstance(named, str) for value in values):
        wanted = "names" if isinstance(named, str) else "numbers"
        raise InputError(source, place, f"{wanted} are needed, got {list(values)!r:.60}", REMEDY)


def _values(value: Told) -> tuple[Value, ...]:
    """Give the values that stand for a factor's. ValueError where they cannot be."""
    if isinstance(value, dict):
        if "draw" in value:
            return tuple(f"drawn:{number}" for number in range(msgspec.convert(value, Draw).draw))
        return msgspec.convert(value, Range).values()
    assert not isinstance(value, int)  # held by _check_factor
    return tuple(value)


def _unknown(source: object, place: str, name: str, known: list[str]) -> InputError:
    near = difflib.get_close_matches(name, known, 1, 0.6)
    remedy = f"did you mean {near[0]}?" if near else f"use one of {', '.join(known)}"
    return InputError(source, f"{place}.{name}" if place != "measure" else place, f"unknown: {name}", remedy)
