"""What an optimisation is about: written before its first trial, enough to go on with it and to replay it."""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Annotated, Any, ClassVar, Literal

import msgspec
from msgspec import Meta, Struct

from fdvv.documents import Kind, pretty, read_document
from fdvv.errors import InputError
from fdvv.files import read_limited
from fdvv.model import FDVVModel, model_from_json, model_to_json
from fdvv.optimize import (
    Design,
    DesignSpace,
    Objective,
    Problem,
    TemporalPointing,
    Trial,
    model_of,
    model_space,
    paper_model,
    paper_space,
)
from fdvv.workflow._optimize_rig import rig_constraints
from fdvv.workflow._rig_shelf import RigShelf
from fdvv.workflow._session_manifest import now, versions

SETUP_FILE = "optimize.json"
KIND = Kind("fdvv-optimize", 1, "an optimisation", "name the folder of an optimisation, or one that is new")
LARGEST_bytes = 16_000_000


class ObjectiveSetup(Struct, frozen=True, forbid_unknown_fields=True):
    """One quantity to be made small, or large."""

    name: str
    larger_is_better: bool = False


class SpaceSetup(Struct, frozen=True, forbid_unknown_fields=True):
    """Which designs there are.

    Attributes
    ----------
    kind : paper, its eight parameters; model, variations of a button.
    base : that button, as its file says. names, bounds : what of it is varied, see `model_space`.
    rig : id of a rig that must be able to render a design; velocities_mm_s : at which.
    """

    kind: Literal["paper", "model"] = "paper"
    base: dict[str, Any] | None = None
    names: tuple[str, ...] = ("FDV",)
    bounds: dict[str, tuple[float, float]] = {}
    rig: str | None = None
    velocities_mm_s: tuple[float, ...] = (100.0,)


class OptimizeSetup(Struct, frozen=True, forbid_unknown_fields=True, kw_only=True):
    """An optimisation.

    Attributes
    ----------
    engine, options : name and options of an engine, or of a pair engine where the task is preference.
    task, level : what a person does, as tasks are named; level None where there is one only.
    budget : trials, or comparisons, that may be asked; failed ones count, abandoned ones do not.
    start : a person's own design, tried first. prior : finished trials of others to begin from.
    about : whatever else belongs to a run: who presses, on what, and how many PRESSES make a score.
    """

    PRESSES: ClassVar[str] = "presses"

    format: Literal["fdvv-optimize"] = "fdvv-optimize"
    version: Literal[1] = 1
    space: SpaceSetup = SpaceSetup()
    engine: str = "gp"
    options: dict[str, Any] = {}
    task: str = "temporal-pointing"
    level: str | None = None
    objectives: Annotated[tuple[ObjectiveSetup, ...], Meta(min_length=1)] = (ObjectiveSetup("asynchrony_ms"),)
    seed: Annotated[int, Meta(ge=0)] = 0
    budget: Annotated[int, Meta(ge=1, le=100_000)] = 30
    start: dict[str, float] | None = None
    prior: tuple[Trial, ...] = ()
    simulated: bool = False
    about: dict[str, Any] = {}
    versions: dict[str, str] = msgspec.field(default_factory=versions)
    created: str = msgspec.field(default_factory=now)

    @property
    def preference(self) -> bool:
        """Tell whether designs are compared, not scored."""
        return self.task == "preference"

    @property
    def presses(self) -> int:
        """Get how many presses of a person make a score; as in the paper unless it was said."""
        told = self.about.get(self.PRESSES)
        return told if isinstance(told, int) else TemporalPointing.rounds


def read_setup(path: Path) -> OptimizeSetup:
    """Read a setup. InputError."""
    text = read_limited(path, LARGEST_bytes, KIND.remedy)
    return read_document(
        text, path, KIND, lambda data: msgspec.json.decode(data, type=OptimizeSetup), lambda _: None
    )


def setup_text(setup: Struct) -> str:
    """Write a setup. InputError if it is too large to be read again."""
    text = pretty(msgspec.to_builtins(setup)) + "\n"
    if len(text) > LARGEST_bytes:
        reason = f"larger than {LARGEST_bytes // 1_000_000} MB"
        raise InputError("setup", "prior", reason, "begin from fewer trials of others")
    return text


def space_of(setup: SpaceSetup, rigs: RigShelf) -> DesignSpace:
    """Give the space of a setup, its constraints among it. InputError on what the button or shelf lacks."""
    free = _free_space(setup)
    if setup.rig is None:
        return free
    limits = rig_constraints(rigs.rig(setup.rig), designer_of(setup), setup.velocities_mm_s)
    return replace(free, constraints=(*free.constraints, *limits))


def _free_space(setup: SpaceSetup) -> DesignSpace:
    if setup.kind == "paper":
        return paper_space()
    return model_space(_base(setup), setup.names, setup.bounds)


def _base(setup: SpaceSetup) -> FDVVModel:
    if setup.base is None:
        raise InputError("setup", "$.space.base", "is missing", "give the button that is varied")
    return model_from_json(json.dumps(setup.base), "the button that is varied")


def designer_of(setup: SpaceSetup) -> Callable[[Design], FDVVModel]:
    """Give what turns a design of the space into a button."""
    if setup.kind == "paper":
        return paper_model
    base, space = _base(setup), _free_space(setup)
    return lambda design: model_of(space, base, design)


def model_space_setup(
    base: FDVVModel,
    names: Sequence[str] = ("FDV",),
    bounds: Mapping[str, tuple[float, float]] | None = None,
    rig: str | None = None,
) -> SpaceSetup:
    """Make the setup of variations of a button, the button in it."""
    record = json.loads(model_to_json(base))
    return SpaceSetup(kind="model", base=record, names=tuple(names), bounds=dict(bounds or {}), rig=rig)


def problem_of(setup: OptimizeSetup, space: DesignSpace) -> Problem:
    """Give what the engine is asked. ModelError on objectives of one name, InputError on an alien design."""
    for trial in setup.prior:
        space.checked(trial.design, "prior")
    if setup.start is not None:
        space.checked(setup.start, "start")
    objectives = tuple(Objective(one.name, one.larger_is_better) for one in setup.objectives)
    return Problem(space, objectives, setup.seed, setup.prior)
