"""What a sweep tries: lists or ranges of values, every combination of them a cell. A TOML file."""

from __future__ import annotations

import dataclasses
import itertools
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, Literal, TypeVar

import msgspec
import numpy as np
from msgspec import Meta, Struct

from fdvv.button.fit import one_line
from fdvv.button.open import open_button
from fdvv.errors import InputError, ModelError, did_you_mean
from fdvv.io.documents import read_toml
from fdvv.io.files import read_limited
from fdvv.model.file import builtin_names
from fdvv.model.model import FDVVModel
from fdvv.twin.button import ButtonPhysics
from fdvv.twin.draw import draw_finger, draw_rig
from fdvv.twin.files import button_names, load_button, load_finger, load_rig
from fdvv.twin.finger import Finger
from fdvv.twin.rig import Rig
from fdvv_campaigns.sweep.measure import MEASURES, METHODS, Figures, Measure, Subjects
from fdvv_people.optimize.population.plan import seed_of

if TYPE_CHECKING:
    from pyarrow import Schema


FORMAT = "fdvv-sweep"
REMEDY = "correct it; docs/reference/sweep-files.md tells what a plan holds"
LARGEST_bytes = 1_000_000
MOST_cells = 10_000_000
REPEAT = "repeat"
"""The factor that every plan may have: how often each combination is tried with fresh noise."""
Value = str | float | int
FactorValues = list[Value] | dict[str, Value] | int
"""How a plan states the values of a factor: one by one, as a Range or a Draw, or as a count of repeats."""


class Range(Struct, frozen=True, forbid_unknown_fields=True):
    """Numbers from one end to the other, both of them, in even steps or even ratios."""

    start: float
    end: float
    count: Annotated[int, Meta(ge=2, le=100_000)]
    spacing: Literal["even", "ratio"] = "even"

    def values(self) -> tuple[float, ...]:
        """Return the numbers. Raises ValueError on a ratio from or to 0 or below."""
        if self.spacing == "even":
            return tuple(np.linspace(self.start, self.end, self.count).tolist())
        if min(self.start, self.end) <= 0:
            raise ValueError("ends of an even ratio must be above 0")
        return tuple(np.geomspace(self.start, self.end, self.count).tolist())


class Draw(Struct, frozen=True, forbid_unknown_fields=True):
    """So many rigs or fingers drawn over what is plausible, see fdvv.twin.draw.draw_rig."""

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
    factors: dict[str, FactorValues] = {}
    seed: Annotated[int, Meta(ge=0, lt=2**32)] = 0
    settings: dict[str, Any] = {}

    @property
    def measured(self) -> Measure:
        return MEASURES[self.measure]

    def levels(self) -> dict[str, tuple[Value, ...]]:
        """Return the values of every factor, those the plan leaves out too, in the order of the cells."""
        given = {name: _values(value) for name, value in self.factors.items() if name != REPEAT}
        left = {name: (first,) for name, first in self.measured.factors.items() if name not in given}
        repeats = self.factors.get(REPEAT, 1)
        assert isinstance(repeats, int)
        return {**given, **left, REPEAT: tuple(range(repeats))}

    @property
    def count(self) -> int:
        return int(np.prod([len(values) for values in self.levels().values()], dtype=object))

    def cells(self) -> Iterator[dict[str, Value]]:
        """Return every cell, the last factor changing fastest."""
        levels = self.levels()
        return (dict(zip(levels, values, strict=True)) for values in itertools.product(*levels.values()))


def read_sweep_plan(path: Path) -> SweepPlan:
    """Read a plan. Raises InputError that names the place and what is allowed there."""
    data = read_toml(read_limited(path, LARGEST_bytes, REMEDY), path, REMEDY)
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
    """Refuse a plan that cannot be carried out, but for the files it names. Raises InputError."""
    if plan.measure not in MEASURES:
        raise _bad_name(source, "measure", plan.measure, list(MEASURES))
    for name, value in plan.factors.items():
        _check_factor(plan, source, name, value)
    for name in plan.settings:
        if name not in plan.measured.settings:
            raise _bad_name(source, "settings", name, list(plan.measured.settings))
    if plan.count > MOST_cells:
        reason = f"{plan.count} cells, at most {MOST_cells} are tried"
        raise InputError(source, "factors", reason, "split the plan")


def _check_factor(plan: SweepPlan, source: object, name: str, value: FactorValues) -> None:
    place = f"factors.{name}"
    section, _, parameter = name.partition(".")
    known = [*plan.measured.factors, REPEAT]
    if name not in known and not (parameter and section in ("rig", "finger") and section in known):
        raise _bad_name(source, "factors", name, [*known, *(f"{s}.SECTION.NAME" for s in ("rig", "finger"))])
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


def _values(value: FactorValues) -> tuple[Value, ...]:
    """Return the values that stand for a factor's. Raises ValueError where they cannot be."""
    if isinstance(value, dict):
        if "draw" in value:
            return tuple(f"drawn:{number}" for number in range(msgspec.convert(value, Draw).draw))
        return msgspec.convert(value, Range).values()
    assert not isinstance(value, int)  # held by _check_factor
    return tuple(value)


def _bad_name(source: object, place: str, name: str, known: list[str]) -> InputError:
    at = f"{place}.{name}" if place != "measure" else place
    return InputError(source, at, f"unknown: {name}", did_you_mean(name, known))


FIRST = (
    ("cell", "int64", "number of the cell, the last factor changing fastest"),
    ("measure", "string", "as in the plan"),
    ("simulated", "bool", "true: every figure comes from the twin"),
)
LAST = (
    ("seed", "int64", "of all that was random; cells of one repeat share it"),
    ("state", "string", "done or failed"),
    ("reason", "string", "why it failed, else null; the figures of a failed cell are null"),
)


def sweep_schema(plan: SweepPlan) -> Schema:
    """Return the schema of a plan's results."""
    import pyarrow as pa

    types = {"int64": pa.int64(), "double": pa.float64(), "string": pa.string(), "bool": pa.bool_()}
    factors = {
        name: "int64" if name == REPEAT else "string" if all(isinstance(v, str) for v in values) else "double"
        for name, values in plan.levels().items()
    }
    figures = [(figure.name, figure.type) for figure in plan.measured.figures]
    first, last = ([(name, kind) for name, kind, _ in columns] for columns in (FIRST, LAST))
    fields = [*first, *factors.items(), *last, *figures]
    said = {"format": "fdvv-sweep", "version": "1"}
    return pa.schema([(name, types[kind]) for name, kind in fields], metadata=said)


Record = TypeVar("Record", Rig, Finger)
RIGS, FINGERS = 11, 12
"""Purposes of the random numbers that rigs and fingers are drawn with."""
Row = dict[str, Any]


@dataclass(frozen=True, eq=False)
class SweepWork:
    """Works on the cells of a chunk. It holds every rig, finger and button itself: workers need no files.

    Attributes
    ----------
    settings : of the plan, whole.
    rigs, fingers, buttons : by the names that cells have for them.
    """

    plan: SweepPlan
    settings: Mapping[str, Any]
    rigs: Mapping[str, Rig]
    fingers: Mapping[str, Finger]
    buttons: Mapping[str, FDVVModel | ButtonPhysics]

    def __call__(self, cells: Sequence[tuple[int, Mapping[str, Value]]]) -> list[Row]:
        return [self._row(number, cell) for number, cell in cells]

    def _row(self, number: int, cell: Mapping[str, Value]) -> Row:
        row: Row = {"cell": number, **cell, "seed": seed_of(self.plan.seed, int(cell[REPEAT]))}
        try:
            figures: Figures = self.plan.measured.find(self.subjects(cell), self.settings)
        except Exception as error:
            # whatever is wrong with one cell must not end a sweep of hours
            reason = one_line(f"{type(error).__name__}: {error}")
            return {**row, "state": "failed", "reason": reason}
        return {**row, "state": "done", "reason": None, **figures}

    def subjects(self, cell: Mapping[str, Value]) -> Subjects:
        """Open what a cell is about. Raises ModelError on a parameter that cannot be."""
        rig, finger = cell.get("rig"), cell.get("finger")
        return Subjects(
            None if rig is None else _set_parameters(self.rigs[str(rig)], "rig", cell),
            None if finger is None else _set_parameters(self.fingers[str(finger)], "finger", cell),
            self.buttons[str(cell["button"])],
            str(cell.get("method", "")),
            float(cell.get("speed_mm_s", 0.0)),
            seed_of(self.plan.seed, int(cell[REPEAT])),
        )


def sweep_work(plan: SweepPlan, folder: Path) -> SweepWork:
    """Open everything that a plan names, files from a folder on. InputError on the first that cannot be."""
    levels = plan.levels()
    names = {kind: [str(v) for v in levels.get(kind, ())] for kind in ("rig", "finger", "button", "method")}
    for method in names["method"]:
        if method not in METHODS:
            remedy = f"use one of {', '.join(METHODS)}"
            raise InputError("plan", "factors.method", f"unknown: {method}", remedy)
    work = SweepWork(
        plan,
        _settings(plan),
        {name: _rig(name, plan.seed, folder) for name in names["rig"]},
        {name: _finger(name, plan.seed, folder) for name in names["finger"]},
        {name: _button(name, plan.measured.real, folder) for name in names["button"]},
    )
    _check_parameters(work, levels)
    return work


def _settings(plan: SweepPlan) -> dict[str, Any]:
    """Return the settings, the plan's own checked. Raises InputError."""
    settings = {**plan.measured.settings, **plan.settings}
    for name, value in settings.items():
        place = f"settings.{name}"
        if name == "velocities_mm_s":
            good = isinstance(value, list) and value and all(_above_0(v) for v in value)
            if not good or len(set(value)) != len(value):
                remedy = "give one or more different speeds above 0"
                raise InputError("plan", place, f"got {value!r:.60}", remedy)
            settings[name] = [float(v) for v in value]
        elif not (isinstance(value, int) and not isinstance(value, bool) and 1 <= value <= 200):
            raise InputError("plan", place, f"got {value!r:.60}", "give a count from 1 to 200")
    return settings


def _above_0(value: object) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool) and 0 < value < float("inf")


def _draw_number(name: str) -> int | None:
    """Return the number of a rig or finger that is drawn; None for any other."""
    kind, _, number = name.partition(":")
    return int(number) if kind == "drawn" and number.isdecimal() else None


def _rig(name: str, seed: int, folder: Path) -> Rig:
    if (number := _draw_number(name)) is not None:
        return draw_rig(np.random.default_rng((seed, RIGS, number)))
    return load_rig(name if name.isidentifier() else folder / name)


def _finger(name: str, seed: int, folder: Path) -> Finger:
    if name == "default":
        return Finger()
    if (number := _draw_number(name)) is not None:
        return draw_finger(np.random.default_rng((seed, FINGERS, number)))
    return load_finger(name if name.isidentifier() else folder / name)


def _button(name: str, real: bool, folder: Path) -> FDVVModel | ButtonPhysics:
    if real:
        return load_button(name if name in button_names() else folder / name)
    return open_button(name if name in builtin_names() else str(folder / name))


def _check_parameters(work: SweepWork, levels: Mapping[str, Sequence[Value]]) -> None:
    """Refuse at once a value that no rig or finger of the plan can have: it would be every cell of it."""
    for name, values in levels.items():
        kind = name.partition(".")[0]
        if kind == name:
            continue
        records: Mapping[str, Any] = work.rigs if kind == "rig" else work.fingers
        for value in values:
            try:
                _set_parameters(next(iter(records.values())), kind, {name: value})
            except ModelError as error:
                remedy = "docs/reference/rig.md lists all"
                raise InputError("plan", f"factors.{name}", str(error), remedy) from error


def _set_parameters(record: Record, kind: str, cell: Mapping[str, Value]) -> Record:
    """Return a rig or finger with the parameters that a cell gives it. Raises ModelError."""
    for name, value in cell.items():
        whose, _, rest = name.partition(".")
        if whose != kind or not rest:
            continue
        section, _, parameter = rest.partition(".")
        part = getattr(record, section, None)
        known = {f.name for f in dataclasses.fields(part)} if dataclasses.is_dataclass(part) else set()
        if parameter not in known:
            raise ModelError(f"there is no parameter {name}")
        changed: Any = dataclasses.replace(part, **{parameter: value})  # type: ignore[type-var]
        record = dataclasses.replace(record, **{section: changed})
    return record
