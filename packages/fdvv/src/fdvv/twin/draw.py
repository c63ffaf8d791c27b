"""Random rigs and fingers, over the plausible ranges of their parameters."""

from __future__ import annotations

import dataclasses
from typing import Any, TypeVar

import numpy as np

from fdvv.twin.finger import Finger
from fdvv.twin.quantity import About, about
from fdvv.twin.rig import Rig
from fdvv.twin.rig_moves import Coil

Record = TypeVar("Record")
STEEPEST_H_m = about(next(f for f in dataclasses.fields(Coil) if f.name == "reluctance_H_m")).bounds[1]


def draw_rig(random: np.random.Generator) -> Rig:
    """Draw a rig: every uncertain parameter uniform over its plausible range, what a builder chooses kept."""
    return draw_parts(Rig(), random)


def draw_around(rig: Rig, random: np.random.Generator) -> Rig:
    """Draw a rig like one of another size: numbers go by their draw for the default rig over its default.

    What a builder chooses stays, and so does the force at full duty: the coil's resistance follows from its
    force constant.
    """
    drawn = draw_rig(random)
    sections = {
        f.name: _around(*(getattr(r, f.name) for r in (rig, Rig(), drawn))) for f in dataclasses.fields(rig)
    }
    return Rig(**sections)


def _around(own: Any, usual: Any, drawn: Any) -> Any:
    """Return a section with every number in proportion to its draw; what is 0 by default as it is drawn."""
    numbers = {}
    for name, was in vars(usual).items():
        now = getattr(drawn, name)
        if isinstance(was, float) and was != now:
            numbers[name] = getattr(own, name) * now / was if was else now
    return dataclasses.replace(own, **(_as_strong(own, numbers) if isinstance(own, Coil) else numbers))


def _as_strong(own: Coil, numbers: dict[str, Any]) -> dict[str, Any]:
    """Return a coil's numbers, with a resistance that keeps its force and a slope that it bears."""
    ratio = numbers.get("force_constant_N_A", own.force_constant_N_A) / own.force_constant_N_A
    numbers |= {"resistance_ohm": ratio * own.resistance_ohm, "bridge_ohm": ratio * own.bridge_ohm}
    flat = dataclasses.replace(own, **{**numbers, "reluctance_H_m": 0.0})
    slope_H_m = numbers.get("reluctance_H_m", own.reluctance_H_m)
    return numbers | {"reluctance_H_m": min(slope_H_m, flat.steepest_H_m, STEEPEST_H_m)}


def draw_finger(random: np.random.Generator) -> Finger:
    """Draw a finger: impedance, pulp and habit, each parameter uniform over its plausible range."""
    return draw_parts(Finger(), random)


def draw_parts(record: Record, random: np.random.Generator) -> Record:
    """Draw every section of a record afresh; what is not fitted stays. Fields are drawn in order."""
    whole: Any = record
    sections = {f.name: getattr(whole, f.name) for f in dataclasses.fields(whole)}
    fitted = {name: part for name, part in sections.items() if getattr(part, "fitted", "yes") == "yes"}
    parts = sections | {name: draw_section(part, random) for name, part in fitted.items()}
    return type(record)(**parts)


def draw_section(section: Record, random: np.random.Generator) -> Record:
    """Draw one section: words and choices of the builder stay as they are.

    A coil of little inductance gets no slope that would turn it negative within the stroke.
    """
    whole: Any = section
    fields = [f for f in dataclasses.fields(whole) if _uncertain(about(f))]
    drawn = {f.name: _draw(about(f), f.type in (int, "int"), random) for f in fields}
    if isinstance(section, Coil):
        flat = dataclasses.replace(section, **{**drawn, "reluctance_H_m": 0.0})  # type: ignore[arg-type]
        drawn["reluctance_H_m"] = min(drawn["reluctance_H_m"], flat.steepest_H_m)
    return dataclasses.replace(whole, **drawn)  # type: ignore[no-any-return]


def _uncertain(known: About) -> bool:
    return known.plausible is not None and not known.chosen


def _draw(known: About, whole: bool, random: np.random.Generator) -> float:
    assert known.plausible is not None  # held by _uncertain
    low, high = known.plausible
    return int(random.integers(int(low), int(high), endpoint=True)) if whole else random.uniform(low, high)
