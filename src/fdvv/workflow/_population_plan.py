"""What a population run is about, and how it is cut into chunks. Simulated."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import Annotated, Any, Literal

import msgspec
import numpy as np
from msgspec import Meta, Struct

from fdvv.documents import Kind, pretty, read_document
from fdvv.errors import InputError
from fdvv.files import read_limited
from fdvv.optimize import SimulatedUser, UserSettings, draw_user

PLAN_FILE = "population.json"
KIND = Kind("fdvv-population", 1, "a population run", "name the folder of a population run, or a new one")
LARGEST_bytes = 1_000_000
CELLS = 40
"""Scores of a grid in a chunk, about 25 ms each."""

UNUSED = {"grid": {"engine", "options", "budget", "against", "judged"}, "optimize": {"designs"}}
"""What decides nothing in a run of that kind."""

Shift = Annotated[float, Meta(gt=0, le=100)]


class PopulationPlan(Struct, frozen=True, forbid_unknown_fields=True, kw_only=True):
    """A population run: everything that decides its result.

    Attributes
    ----------
    kind : "optimize": every person has a run of their own; "grid": everybody scores the same designs.
    people, seed : people 0, 1, ... of a draw with that seed, see fdvv.optimize.draw_user.
    shifts : ratios by which the person in the middle differs from the usual one, by field of SimulatedUser.
    level, rounds : of temporal pointing. rig : shipped one that is pressed.
    engine, options, budget : of each person's run; unused in a grid.
    designs : scored by everybody in a grid, the first of an even net.
    against : built-in button that each person's design is judged beside.
    judged : scores that judge a design, on presses that no engine saw.
    """

    format: Literal["fdvv-population"] = "fdvv-population"
    version: Literal[1] = 1
    kind: Literal["optimize", "grid"] = "optimize"
    people: Annotated[int, Meta(ge=1, le=1_000_000)] = 100
    seed: Annotated[int, Meta(ge=0, lt=2**32)] = 0
    shifts: dict[str, Shift] = {}
    level: Literal["easy", "hard"] = "easy"
    rounds: Annotated[int, Meta(ge=1, le=1000)] = 20
    rig: str = "ideal"
    engine: str = "gp"
    options: dict[str, Any] = {}
    budget: Annotated[int, Meta(ge=1, le=1000)] = 30
    designs: Annotated[int, Meta(ge=1, le=100_000)] = 100
    against: str = "mx-clear"
    judged: Annotated[int, Meta(ge=1, le=100)] = 5

    @property
    def chunks(self) -> int:
        """Get into how many chunks the run is cut, whoever works on them."""
        return self.people if self.kind == "optimize" else -(-self.people * self.designs // CELLS)

    def differs(self, other: PopulationPlan) -> list[str]:
        """List what the results of another plan would differ by, by field."""
        names = [name for name in self.__struct_fields__ if name not in UNUSED[self.kind]]
        return [name for name in names if getattr(self, name) != getattr(other, name)]

    def cells(self, chunk: int) -> range:
        """Give the cells of a grid that a chunk holds: cell i is person i % people and design i // people."""
        return range(chunk * CELLS, min((chunk + 1) * CELLS, self.people * self.designs))

    def user(self, number: int) -> SimulatedUser:
        """Draw a person. InputError on a shift of what people do not have."""
        return draw_user(number, self.seed, settings_of(self.shifts))


def settings_of(shifts: Mapping[str, float]) -> UserSettings:
    """Shift the person in the middle. InputError on what people do not have."""
    middle = SimulatedUser()
    for name in shifts:
        if name == "number" or not hasattr(middle, name):
            fields = ", ".join(n for n in middle.__dataclass_fields__ if n != "number")
            raise InputError("--shift", name, "people have no such number", f"use one of: {fields}")
    return UserSettings(replace(middle, **{name: getattr(middle, name) * r for name, r in shifts.items()}))


def seed_of(*numbers: int) -> int:
    """Mix numbers into a seed of 32 bits: neighbours share nothing."""
    return int(np.random.SeedSequence(numbers).generate_state(1)[0])


def read_plan(path: Path) -> PopulationPlan:
    """Read a plan. InputError."""
    text = read_limited(path, LARGEST_bytes, KIND.remedy)
    return read_document(
        text, path, KIND, lambda data: msgspec.json.decode(data, type=PopulationPlan), lambda _: None
    )


def plan_text(plan: PopulationPlan) -> str:
    """Write a plan."""
    return pretty(msgspec.to_builtins(plan)) + "\n"
