"""What an experiment is about: who trains what, what is compared, and in which order."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Any, Literal

import msgspec
from msgspec import Meta, Struct

from fdvv.errors import InputError
from fdvv.io.documents import Kind, read_record
from fdvv.io.files import write_atomic
from fdvv.rendering.session import now, versions
from fdvv_people.optimize.people.week import WeekGap
from fdvv_people.optimize.problem import Trial
from fdvv_people.optimize.run.setup import LARGEST_bytes, setup_text
from fdvv_people.stats.orders import counterbalanced

EXPERIMENT_FILE = "experiment.json"
KIND = Kind(
    "fdvv-experiment", 1, "an experiment", "name the folder of an experiment, or one that is new or empty"
)
LEVELS = ("easy", "hard")
OPTIMAL, RANDOM = "optimal", "random"
MX = ("mx-clear", "mx-brown", "mx-black", "mx-red")
MADE = ("versions", "created")
"""What may differ when an experiment is continued."""


class ExperimentSetup(Struct, frozen=True, forbid_unknown_fields=True, kw_only=True):
    """An experiment after the paper's: training per person and level, a week, validation.

    Attributes
    ----------
    people : simulated, drawn with seed. trials : of each training. presses : that make a score.
    rounds : how often each button appears per level in validation.
    engine, options : what suggests designs. rig : what renders them.
    rivals : built-in buttons to compare with, a random design aside.
    gap : see WeekGap.
    prior : by level, finished trials of others that every training begins from; of none: from nothing.
    """

    format: Literal["fdvv-experiment"] = "fdvv-experiment"
    version: Literal[1] = 1
    people: Annotated[int, Meta(ge=3, le=1000)] = 10
    trials: Annotated[int, Meta(ge=1, le=1000)] = 27
    presses: Annotated[int, Meta(ge=2, le=1000)] = 20
    rounds: Annotated[int, Meta(ge=1, le=20)] = 2
    engine: str = "gp"
    options: dict[str, Any] = {}
    rig: str = "ideal"
    rivals: Annotated[tuple[str, ...], Meta(min_length=1)] = MX
    gap: WeekGap = WeekGap()
    prior: dict[str, tuple[Trial, ...]] = {}
    seed: Annotated[int, Meta(ge=0)] = 0
    versions: dict[str, str] = msgspec.field(default_factory=versions)
    created: str = msgspec.field(default_factory=now)

    @property
    def buttons(self) -> tuple[str, ...]:
        """The conditions of the validation, what was optimised first."""
        return (OPTIMAL, *self.rivals, RANDOM)

    @property
    def observations(self) -> int:
        """How many mean scores the validation gives."""
        return self.people * len(LEVELS) * self.rounds * len(self.buttons)


def begin_experiment(folder: Path, setup: ExperimentSetup) -> ExperimentSetup:
    """Write a setup into a new or empty folder, or give the one in it if it is the same experiment.

    InputError where the folder holds something else, or another experiment. OSError.
    """
    path = folder / EXPERIMENT_FILE
    if path.exists():
        there = read_record(path, KIND, ExperimentSetup, LARGEST_bytes)
        _check_same(path, there, setup)
        return there
    if folder.exists() and (not folder.is_dir() or any(folder.iterdir())):
        raise InputError(folder, "folder", "is not empty and holds no experiment", "name a new one")
    write_atomic(path, setup_text(setup))
    return setup


def _check_same(path: Path, there: ExperimentSetup, requested: ExperimentSetup) -> None:
    """Refuse to continue an experiment that was begun with other settings."""
    for name in ExperimentSetup.__struct_fields__:
        if name not in MADE and getattr(there, name) != getattr(requested, name):
            begun = f"was begun with {name} {getattr(there, name)!r}, not {getattr(requested, name)!r}"
            if name == "prior":
                begun = "was begun from other trials of others"
            raise InputError(path, f"$.{name}", begun, "go on with the same, or name a new folder")


@dataclass(frozen=True)
class Block:
    """One round of one person at one level: every button once, in an order of its own.

    Attributes
    ----------
    person, round : from 0. first : place of its first score among all of this person, from 0.
    """

    person: int
    level: str
    round: int
    buttons: tuple[str, ...]
    first: int


def level_order(person: int) -> tuple[str, ...]:
    """Return the order in which a person meets the levels: every second one the other way round."""
    return LEVELS if person % 2 == 0 else LEVELS[::-1]


def blocks_of(setup: ExperimentSetup, person: int) -> tuple[Block, ...]:
    """Return a person's validation: level after level, round after round, buttons in Williams' orders.

    Orders run through all people's blocks in turn, so that over the experiment every button is in every
    place, and follows every other, as equally often as the number of blocks allows.
    """
    each = len(LEVELS) * setup.rounds
    orders = counterbalanced(setup.buttons, each * setup.people)[each * person :]
    places = [(level, round_) for level in level_order(person) for round_ in range(setup.rounds)]
    return tuple(
        Block(person, level, round_, orders[i], i * len(setup.buttons))
        for i, (level, round_) in enumerate(places)
    )
