"""The work of a sweep's chunk: cells, each with its rig, finger, button and seed. Simulated."""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, TypeVar

import numpy as np

from fdvv.errors import InputError, ModelError
from fdvv.model import FDVVModel, builtin_names
from fdvv.twin import (
    ButtonPhysics,
    Finger,
    Rig,
    button_names,
    draw_finger,
    draw_rig,
    load_button,
    load_finger,
    load_rig,
)
from fdvv.workflow._fit import one_line
from fdvv.workflow._open import open_model
from fdvv.workflow._population_plan import seed_of
from fdvv.workflow._sweep_measure import MEASURES, METHODS, Figures, Subjects
from fdvv.workflow._sweep_plan import REPEAT, SweepPlan, Value

Record = TypeVar("Record", Rig, Finger)
RIGS, FINGERS = 11, 12
"""Purposes of the random numbers that rigs and fingers are drawn with."""
Row = dict[str, Any]


@dataclass(frozen=True, eq=False)
class SweepWork:
    """Works on the cells of a chunk. It holds every rig, finger and button itself: workers need no files.

    Attributes
    ----------
    measure, settings, seed : as in the plan, settings whole.
    rigs, fingers, buttons : by the names that cells have for them.
    """

    measure: str
    settings: Mapping[str, Any]
    seed: int
    rigs: Mapping[str, Rig]
    fingers: Mapping[str, Finger]
    buttons: Mapping[str, FDVVModel | ButtonPhysics]

    def __call__(self, cells: Sequence[tuple[int, Mapping[str, Value]]]) -> list[Row]:
        """Give the row of every cell."""
        return [self.row(number, cell) for number, cell in cells]

    def row(self, number: int, cell: Mapping[str, Value]) -> Row:
        """Give a cell's row; one that fails is a row with its reason."""
        row: Row = {"cell": number, **cell, "seed": seed_of(self.seed, int(cell[REPEAT]))}
        try:
            figures: Figures = MEASURES[self.measure].find(self.subjects(cell), self.settings)
        except Exception as error:
            reason = one_line(f"{type(error).__name__}: {error}")
            return {**row, "state": "failed", "reason": reason}
        return {**row, "state": "done", "reason": None, **figures}

    def subjects(self, cell: Mapping[str, Value]) -> Subjects:
        """Open what a cell is about. ModelError on a parameter that cannot be."""
        rig, finger = cell.get("rig"), cell.get("finger")
        return Subjects(
            None if rig is None else _changed(self.rigs[str(rig)], "rig", cell),
            None if finger is None else _changed(self.fingers[str(finger)], "finger", cell),
            self.buttons[str(cell["button"])],
            str(cell.get("method", "")),
            float(cell.get("speed_mm_s", 0.0)),
            seed_of(self.seed, int(cell[REPEAT])),
        )


def sweep_work(plan: SweepPlan, folder: Path) -> SweepWork:
    """Open everything that a plan names, files from a folder on. InputError on the first that cannot be."""
    levels = plan.levels()
    names = {kind: [str(v) for v in levels.get(kind, ())] for kind in ("rig", "finger", "button", "method")}
    for method in names["method"]:
        if method not in METHODS:
            raise InputError(
                "plan", "factors.method", f"unknown: {method}", f"use one of {', '.join(METHODS)}"
            )
    work = SweepWork(
        plan.measure,
        _settings(plan),
        plan.seed,
        {name: _rig(name, plan.seed, folder) for name in names["rig"]},
        {name: _finger(name, plan.seed, folder) for name in names["finger"]},
        {name: _button(name, plan.measured.real, folder) for name in names["button"]},
    )
    _check_parameters(work, levels)
    return work


def _settings(plan: SweepPlan) -> dict[str, Any]:
    """Give the settings, the plan's own checked. InputError."""
    settings = {**plan.measured.settings, **plan.settings}
    for name, value in settings.items():
        place = f"settings.{name}"
        if name == "velocities_mm_s":
            good = isinstance(value, list) and value and all(_above_0(v) for v in value)
            if not good or len(set(value)) != len(value):
                raise InputError(
                    "plan", place, f"got {value!r:.60}", "give one or more different speeds above 0"
                )
            settings[name] = [float(v) for v in value]
        elif not (isinstance(value, int) and not isinstance(value, bool) and 1 <= value <= 200):
            raise InputError("plan", place, f"got {value!r:.60}", "give a count from 1 to 200")
    return settings


def _above_0(value: object) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool) and 0 < value < float("inf")


def _drawn(name: str) -> int | None:
    """Give the number of a rig or finger that is drawn; None for any other."""
    kind, _, number = name.partition(":")
    return int(number) if kind == "drawn" and number.isdecimal() else None


def _rig(name: str, seed: int, folder: Path) -> Rig:
    if (number := _drawn(name)) is not None:
        return draw_rig(np.random.default_rng((seed, RIGS, number)))
    return load_rig(name if name.isidentifier() else folder / name)


def _finger(name: str, seed: int, folder: Path) -> Finger:
    if name == "default":
        return Finger()
    if (number := _drawn(name)) is not None:
        return draw_finger(np.random.default_rng((seed, FINGERS, number)))
    return load_finger(name if name.isidentifier() else folder / name)


def _button(name: str, real: bool, folder: Path) -> FDVVModel | ButtonPhysics:
    if real:
        return load_button(name if name in button_names() else folder / name)
    return open_model(name if name in builtin_names() else str(folder / name))


def _check_parameters(work: SweepWork, levels: Mapping[str, Sequence[Value]]) -> None:
    """Refuse at once a value that no rig or finger of the plan can have: it would be every cell of it."""
    for name, values in levels.items():
        kind = name.partition(".")[0]
        if kind == name:
            continue
        records: Mapping[str, Any] = work.rigs if kind == "rig" else work.fingers
        for value in values:
            try:
                _changed(next(iter(records.values())), kind, {name: value})
            except ModelError as error:
                raise InputError(
                    "plan", f"factors.{name}", str(error), "docs/reference/rig.md lists all"
                ) from error


def _changed(record: Record, kind: str, cell: Mapping[str, Value]) -> Record:
    """Give a rig or finger with the parameters that a cell gives it. ModelError."""
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
