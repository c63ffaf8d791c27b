"""What is played beside the recommended design at the end of a run: switches, and the best fixed design."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from typing import Any, Literal

from msgspec import Struct

from fdvv.button.open import open_button
from fdvv.errors import InputError
from fdvv.model.file import model_to_json
from fdvv.model.model import FDVVModel
from fdvv_people.optimize.people.fixed import fixed_design
from fdvv_people.optimize.space import Design, DesignSpace

SWITCHES = ("mx-clear", "mx-brown", "mx-black", "mx-red")
"""Shipped switches that are played if nobody names others."""
NONE = "none"
PEOPLE = "diverse"
"""Whose fixed design real people play: those simulated ones whose best buttons differ."""
FIXED = "the fixed design"


class Rival(Struct, frozen=True, forbid_unknown_fields=True):
    """What the recommended design is compared with.

    Attributes
    ----------
    kind : a mechanical switch, or the best fixed design of simulated people. name : for people.
    model : a switch as its file says. design : of the run's space, of the fixed design, and of a switch that
        the run starts from: it is the start, and is played once.
    """

    kind: Literal["switch", "fixed"]
    name: str
    model: dict[str, Any] | None = None
    design: dict[str, float] | None = None


def switch_rivals(names: Sequence[str], start: tuple[str, Design | None] = ("", None)) -> tuple[Rival, ...]:
    """Return the switches of names, built in or files. Raises InputError.

    start : name of the button that the run starts from, and the design that it is in the run's space.
    """
    if NONE in names:
        if len(names) > 1:
            raise InputError("--switch", NONE, "is named beside others", "name switches, or none")
        return ()
    return tuple(switch_rival(open_button(name), name, start) for name in dict.fromkeys(names))


def switch_rival(model: FDVVModel, name: str, start: tuple[str, Design | None] = ("", None)) -> Rival:
    """Return a switch that is played; the start itself where a run starts from it."""
    if name == start[0] and start[1] is not None:
        return Rival("switch", model.name, design=dict(start[1]))
    return Rival("switch", model.name, json.loads(model_to_json(model)))


def fixed_rivals(space: DesignSpace, level: str | None, group: str) -> tuple[Rival, ...]:
    """Return the best fixed design of a group at a level, if there is one and the space has it."""
    found = fixed_design(group, level)
    if found is None or space.name != "paper":
        return ()
    design = space.nearest(found.design)
    return () if space.broken(design) else (Rival("fixed", FIXED, design=design),)


def named_rivals(rivals: Sequence[Rival]) -> Mapping[str, Rival]:
    """Return rivals by name. Raises InputError where two have one name."""
    for rival in rivals:
        if sum(rival.name == other.name for other in rivals) > 1:
            reason = "two switches have this name"
            raise InputError("setup", rival.name, reason, "leave one out, or rename its file's button")
    return {rival.name: rival for rival in rivals}
