"""What an experiment is about: who trains what, what is compared, and what a week does to a person."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Any, Literal

import msgspec
from msgspec import Meta, Struct

from fdvv.documents import Kind, read_document
from fdvv.errors import InputError
from fdvv.files import read_limited, write_atomic
from fdvv.optimize import Trial
from fdvv.workflow._optimize_setup import LARGEST_bytes, setup_text
from fdvv.workflow._session_manifest import now, versions

EXPERIMENT_FILE = "experiment.json"
KIND = Kind(
    "fdvv-experiment", 1, "an experiment", "name the folder of an experiment, or one that is new or empty"
)
LEVELS = ("easy", "hard")
OPTIMAL, RANDOM = "optimal", "random"
MX = ("mx-clear", "mx-brown", "mx-black", "mx-red")
MADE = ("versions", "created")
"""What may differ between an experiment and the same one gone on with."""


class WeekGap(Struct, frozen=True, forbid_unknown_fields=True):
    """What a week between training and validation does to a simulated person; all of it is assumed.

    Attributes
    ----------
    kept_ratio : share of the presses made in training that still count as practice.
    bias_ms, anticipated_ms : spread of what another day shifts in the person's lateness and anticipation.
    clock_ratio, pace_ratio : spread of the logarithm of timing noise and pace from day to day.
    """

    kept_ratio: Annotated[float, Meta(ge=0, le=1)] = 0.5
    bias_ms: Annotated[float, Meta(ge=0, le=100)] = 5.0
    anticipated_ms: Annotated[float, Meta(ge=0, le=100)] = 5.0
    clock_ratio: Annotated[float, Meta(ge=0, le=1)] = 0.1
    pace_ratio: Annotated[float, Meta(ge=0, le=1)] = 0.1


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
        """Get the conditions of the validation, what was optimised first."""
        return (OPTIMAL, *self.rivals, RANDOM)

    @property
    def observations(self) -> int:
        """Get how many mean scores the validation gives."""
        return self.people * len(LEVELS) * self.rounds * len(self.buttons)


def begin_experiment(folder: Path, setup: ExperimentSetup) -> ExperimentSetup:
    """Write a setup into a new or empty folder, or give the one in it if it is the same experiment.

    InputError where the folder holds something else, or another experiment. OSError.
    """
    path = folder / EXPERIMENT_FILE
    if path.exists():
        there = read_experiment_setup(folder)
        _check_same(path, there, setup)
        return there
    if folder.exists() and (not folder.is_dir() or any(folder.iterdir())):
        raise InputError(folder, "folder", "is not empty and holds no experiment", "name a new one")
    write_atomic(path, setup_text(setup))
    return setup


def read_experiment_setup(folder: Path) -> ExperimentSetup:
    """Read the setup of an experiment's folder. InputError."""
    path = folder / EXPERIMENT_FILE
    text = read_limited(path, LARGEST_bytes, KIND.remedy)
    return read_document(
        text, path, KIND, lambda data: msgspec.json.decode(data, type=ExperimentSetup), lambda _: None
    )


def _check_same(path: Path, there: ExperimentSetup, asked: ExperimentSetup) -> None:
    """Refuse to go on with an experiment that was begun with other settings."""
    for name in ExperimentSetup.__struct_fields__:
        if name not in MADE and getattr(there, name) != getattr(asked, name):
            begun = f"was begun with {name} {getattr(there, name)!r}, not {getattr(asked, name)!r}"
            if name == "prior":
                begun = "was begun from other trials of others"
            raise InputError(path, f"$.{name}", begun, "go on with the same, or name a new folder")
