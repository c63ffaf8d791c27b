"""The setup of an optimisation, written before its first trial: enough to continue and replay it."""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Annotated, Any, ClassVar, Literal

import msgspec
from msgspec import Meta, Struct

from fdvv.errors import InputError
from fdvv.io.documents import Kind, pretty, read_record
from fdvv.model.file import model_from_json, model_to_json
from fdvv.model.model import FDVVModel
from fdvv.rendering.rig_catalog import RigCatalog
from fdvv.rendering.session import now, versions
from fdvv_people.optimize.button_constraints import button_constraints
from fdvv_people.optimize.engines.gp import GPEngine
from fdvv_people.optimize.model_space import model_of, model_space
from fdvv_people.optimize.paper_space import paper_model, paper_space
from fdvv_people.optimize.problem import PREFERENCE, Problem, Trial
from fdvv_people.optimize.realistic import realistic_bounds, realistic_cN
from fdvv_people.optimize.rig_constraints import rig_constraints
from fdvv_people.optimize.run.rivals import Rival
from fdvv_people.optimize.run.settings import Budget
from fdvv_people.optimize.space import LENGTH, Design, DesignSpace, Parameter
from fdvv_people.task.pointing import ASYNCHRONY, MORE, TemporalPointing
from fdvv_people.task.questionnaire import LIKING
from fdvv_people.task.score import Objective

SETUP_FILE = "optimize.json"
KIND = Kind("fdvv-optimize", 1, "an optimisation", "name the folder of an optimisation, or one that is new")
LARGEST_bytes = 16_000_000  # a prior trial of eight parameters takes 0.4 kB: tens of thousands of them fit


class SpaceSetup(Struct, frozen=True, forbid_unknown_fields=True):
    """Which designs there are.

    Attributes
    ----------
    kind : paper, its eight parameters; model, variations of a button; own, numbers of another program.
    base : that button, as its file says. names, bounds : what of it is varied, see `model_space`.
    most_cN : no force of a variation is larger; None: what a motor gives.
    rig : id of a rig that must be able to render a design; velocities_mm_s : at which.
    parameters : of the kind own. buttons : of the kind paper only designs that are buttons.
    """

    kind: Literal["paper", "model", "own"] = "paper"
    base: dict[str, Any] | None = None
    names: tuple[str, ...] = ("FDV",)
    bounds: dict[str, tuple[float, float]] = {}
    most_cN: float | None = None
    rig: str | None = None
    velocities_mm_s: tuple[float, ...] = (100.0,)
    parameters: tuple[Parameter, ...] | msgspec.UnsetType = msgspec.UNSET
    buttons: bool = False


WISHES = (*MORE, LIKING.name)
"""What temporal pointing may be optimised for beside its asynchrony."""


def wished(names: Sequence[str]) -> tuple[Objective, ...]:
    """Return the objectives of WISHES, each once. InputError on an unknown one."""
    for name in names:
        if name not in WISHES:
            raise InputError("objectives", name, "is not known", f"use {', '.join(WISHES)}")
    return tuple(LIKING if name == LIKING.name else Objective(name) for name in dict.fromkeys(names))


class OptimizeSetup(Struct, frozen=True, forbid_unknown_fields=True, kw_only=True):
    """An optimisation.

    Attributes
    ----------
    engine, options : name and options of an engine.
    task, level : what a person does, as tasks are named; level None where there is one only.
    budget : trials, or comparisons, that may be asked; failed ones count, abandoned ones do not.
    start : a person's own design, tried first. prior : finished trials of others to begin from.
    rivals : what is played beside start and result at the end, their names differ.
    about : whatever else belongs to a run: who presses, on what, how many PRESSES make a score, how many
        blocks of trials RETEST the result, the NAME of the button it starts from, and by which WEIGHTS of
        several objectives a compromise is recommended.
    """

    PRESSES: ClassVar[str] = "presses"
    RETEST: ClassVar[str] = "retest"
    NAME: ClassVar[str] = "start_name"
    WEIGHTS: ClassVar[str] = "weights"

    format: Literal["fdvv-optimize"] = "fdvv-optimize"
    version: Literal[1] = 1
    space: SpaceSetup = SpaceSetup()
    engine: str = "gp"
    options: dict[str, Any] = {}
    task: str = "temporal-pointing"
    level: str | None = None
    objectives: Annotated[tuple[Objective, ...], Meta(min_length=1)] = (ASYNCHRONY,)
    seed: Annotated[int, Meta(ge=0)] = 0
    budget: Budget = 30
    start: dict[str, float] | None = None
    prior: tuple[Trial, ...] = ()
    rivals: tuple[Rival, ...] = ()
    simulated: bool = False
    about: dict[str, Any] = {}
    versions: dict[str, str] = msgspec.field(default_factory=versions)
    created: str = msgspec.field(default_factory=now)

    @property
    def title(self) -> str:
        """What is played, for people: the task, and its level where it has one."""
        return f"{self.task}, {self.level}" if self.level else self.task

    @property
    def preference(self) -> bool:
        """Whether designs are compared, not scored."""
        return self.task == PREFERENCE

    @property
    def presses(self) -> int:
        """How many presses of a person make a score; by default as in the paper."""
        presses = self.about.get(self.PRESSES)
        return presses if isinstance(presses, int) else TemporalPointing.rounds

    @property
    def several(self) -> bool:
        """Whether there is a front of compromises, not one best design."""
        return len(self.objectives) > 1 and not self.preference

    @property
    def asks_liking(self) -> bool:
        """Whether a person answers the questionnaire after every trial."""
        return LIKING in self.objectives

    @property
    def task_also(self) -> tuple[str, ...]:
        """What the task scores beside its first objective."""
        return tuple(one.name for one in self.objectives[1:] if one != LIKING)

    @property
    def weights(self) -> dict[str, float]:
        """By which a compromise is recommended, by objective; empty: the knee of the front."""
        return dict(self.about.get(self.WEIGHTS) or {})

    @property
    def retest_pairs(self) -> int:
        """How many blocks of trials, or comparisons, retest the result; 0 in runs of an earlier fdvv."""
        pairs = self.about.get(self.RETEST)
        return pairs if isinstance(pairs, int) else 0

    @property
    def start_name(self) -> str:
        """Name of the button that the result is compared with."""
        # runs of an earlier fdvv hold the button's id alone
        name = self.about.get(self.NAME) or (self.space.base or {}).get("name") or self.about.get("start")
        return str(name) if name and self.start is not None else "the first design"


def read_setup(path: Path) -> OptimizeSetup:
    """Read a setup. Raises InputError."""
    return read_record(path, KIND, OptimizeSetup, LARGEST_bytes)


def setup_text(setup: Struct) -> str:
    """Write a setup. Raises InputError if it is too large to be read again."""
    text = pretty(msgspec.to_builtins(setup)) + "\n"
    if len(text) > LARGEST_bytes:
        reason = f"larger than {LARGEST_bytes // 1_000_000} MB"
        raise InputError("setup", "prior", reason, "begin from fewer trials of others")
    return text


def space_of(setup: SpaceSetup, rigs: RigCatalog) -> DesignSpace:
    """Return the space of a setup with its constraints. Raises InputError."""
    if setup.kind == "own":
        return DesignSpace("own", setup.parameters or ())
    free = _variations(setup) if setup.kind == "model" else _paper(setup.buttons)
    if setup.rig is None:
        return free
    limits = rig_constraints(rigs.rig(setup.rig), designer_of(setup), setup.velocities_mm_s)
    return replace(free, constraints=(*free.constraints, *limits))


def _paper(buttons: bool) -> DesignSpace:
    return paper_space(button_constraints() if buttons else ())


def _variations(setup: SpaceSetup) -> DesignSpace:
    return model_space(_base(setup), setup.names, setup.bounds, most_cN=setup.most_cN)


def _base(setup: SpaceSetup) -> FDVVModel:
    if setup.base is None:
        raise InputError("setup", "$.space.base", "is missing", "give the button that is varied")
    return model_from_json(json.dumps(setup.base), "the button that is varied")


def designer_of(setup: SpaceSetup) -> Callable[[Design], FDVVModel]:
    """Return what turns a design of the space into a button."""
    if setup.kind == "paper":
        return paper_model
    if setup.kind == "own":
        return _no_button
    base = _base(setup)
    return lambda design: model_of(base, design)


def _no_button(_design: Design) -> FDVVModel:
    reason = "its designs are numbers of another program, no buttons"
    raise InputError("setup", "space", reason, "use the numbers, or begin with a button")


def model_space_setup(
    base: FDVVModel,
    names: Sequence[str] = ("FDV",),
    bounds: Mapping[str, tuple[float, float]] | None = None,
    rig: str | None = None,
) -> SpaceSetup:
    """Make the setup of variations of a button, the button in it; bounds None: as real buttons are."""
    record = json.loads(model_to_json(base))
    limits = realistic_bounds(base, names) if bounds is None else dict(bounds)
    most_cN = realistic_cN(base) if bounds is None else None
    return SpaceSetup("model", record, tuple(names), limits, most_cN, rig)


def problem_of(setup: OptimizeSetup, space: DesignSpace) -> Problem:
    """Return the problem of a setup. Raises ModelError on two objectives of one name, InputError."""
    for trial in setup.prior:
        space.checked(trial.design, "prior")
    if setup.start is not None:
        space.checked(setup.start, "start")
    return Problem(space, setup.objectives, setup.seed, setup.prior)


EARLIER: Mapping[str, Mapping[str, Any]] = {"gp": {"startup": 5, "length": LENGTH}}
"""Options, by engine, of runs that state none: an earlier fdvv began these, with these numbers."""


def stated(setup: OptimizeSetup, space: DesignSpace) -> OptimizeSetup:
    """Return the setup of a new run with all options whose defaults may change: it will be replayed."""
    if setup.engine not in EARLIER:
        return setup
    now = {"startup": GPEngine.startup, "length": space.length}
    return msgspec.structs.replace(setup, options={**now, **setup.options})


def options_of(setup: OptimizeSetup) -> dict[str, Any]:
    """Return the options of a run's engine, those of EARLIER where it states none."""
    return {**EARLIER.get(setup.engine, {}), **setup.options}
