"""One name for the three kinds, and how a design is changed a little."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace
from typing import Any, TypeAlias

from fdvv.errors import ModelError
from fdvv_switch.design_dome import design_dome
from fdvv_switch.design_leaf import design_leaf
from fdvv_switch.dome import DomeMechanism
from fdvv_switch.leaf import LeafMechanism
from fdvv_switch.making import Making
from fdvv_switch.spring import SpringMechanism, design_spring
from fdvv_switch.target import Target

Mechanism: TypeAlias = SpringMechanism | LeafMechanism | DomeMechanism
"""A mechanism of any kind."""

KINDS = ("spring", "leaf", "dome")
"""From the simplest to the one with most to tune."""
_DESIGNERS: dict[str, Callable[[Target, Making], Mechanism]] = {
    "spring": design_spring,
    "leaf": design_leaf,
    "dome": design_dome,
}


def design(target: Target, kind: str, making: Making) -> Mechanism:
    """Design a mechanism of one kind; the same target and limits give the same design.

    Raises ModelError if the kind is unknown, or nothing of it can be made within the limits: the reason says
    what stands in the way.
    """
    if kind not in _DESIGNERS:
        raise ModelError(f"a mechanism is one of {', '.join(KINDS)}, got {kind!r}")
    return _DESIGNERS[kind](target, making)


def varied(mechanism: Mechanism, changes: Mapping[str, float]) -> Mechanism:
    """Copy a mechanism with numbers added to some of its fields, each named by its path ("coil.wire_mm")."""
    for path, change in changes.items():
        mechanism = _changed(mechanism, path.split("."), change)
    return mechanism


def _changed(record: Any, path: list[str], change: float) -> Any:
    held = getattr(record, path[0])
    return replace(record, **{path[0]: held + change if len(path) == 1 else _changed(held, path[1:], change)})
