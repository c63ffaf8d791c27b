"""A run as a command begins it: its space, the rig it must suit, what others did before."""

from __future__ import annotations

import shutil
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager, suppress
from dataclasses import dataclass, field, replace
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

from fdvv.button.open import open_button
from fdvv.errors import InputError
from fdvv.rendering.rig_catalog import SHIPPED_RIGS, SUFFIX
from fdvv.twin.files import current_rig_name
from fdvv_people.optimize.engines.multi_objective import check_weights
from fdvv_people.optimize.engines.registry import check_engine
from fdvv_people.optimize.experiment.setup import LEVELS
from fdvv_people.optimize.model_space import model_space, neutral_design
from fdvv_people.optimize.paper_space import paper_space
from fdvv_people.optimize.people.groups import PAPER_GROUP
from fdvv_people.optimize.people.press_simulator import IDEAL
from fdvv_people.optimize.population.population import RESULT_FILE, PopulationResult, read_population
from fdvv_people.optimize.problem import PREFERENCE, Trial
from fdvv_people.optimize.run.player import (
    POINTING,
    SIMULATED_BLOCKS,
    SIMULATED_PAIRS,
    about_player,
    task_named,
)
from fdvv_people.optimize.run.rivals import NONE, PEOPLE, SWITCHES, Rival, fixed_rivals, switch_rivals
from fdvv_people.optimize.run.session import Optimization
from fdvv_people.optimize.run.setup import OptimizeSetup, SpaceSetup, model_space_setup, wished
from fdvv_people.task.pointing import ASYNCHRONY
from fdvv_people.task.questionnaire import LIKING
from fdvv_people.task.score import Objective

OPTION = "--prior"
GRID = "name the folder of a finished fdvv optimize population --grid"
EACH = "name one grid per level: --prior EASY --prior HARD"
FOLDER = "others"
"""Of a project: every folder in it that holds a finished grid can be begun from."""


def offered_grids(project: Path) -> dict[str, PopulationResult]:
    """Return the finished grids in a project's folder, by name; what is unfinished or broken is left out."""
    found, folder = {}, project / FOLDER
    for path in sorted(folder.iterdir()) if folder.is_dir() else []:
        with suppress(InputError, OSError):
            found[path.name] = read_grid(path)
    return found


def offered_grid(project: Path, name: str) -> PopulationResult:
    """Return a grid that is offered. Raises InputError on any other."""
    if grid := offered_grids(project).get(name):
        return grid
    reason = f"is no finished grid in the project's folder {FOLDER}"
    raise InputError("optimise", name, reason, "choose one that is offered, or finish it")


def read_grid(folder: Path) -> PopulationResult:
    """Read a finished grid of others. Raises InputError on anything else."""
    if not (folder / RESULT_FILE).is_file():
        raise InputError(OPTION, str(folder), "holds no grid that is finished", GRID)
    found = read_population(folder)
    if found.plan.kind != "grid":
        raise InputError(OPTION, str(folder), "holds runs of many people, not a grid", GRID)
    return found


def experiment_prior(folders: Sequence[Path], seed: int) -> dict[str, tuple[Trial, ...]]:
    """Return what everybody's training begins from, by level, of a grid per level; nothing of no folder.

    folders : of finished grids, in any order.
    seed : of the experiment; its people are drawn with it, so the others must be of another one.

    Raises InputError on a level without or with two grids, and on others who are the same people.
    """
    grids: dict[str, PopulationResult] = {}
    for folder in folders:
        found = read_grid(folder)
        level = found.plan.level
        if level in grids:
            raise InputError(OPTION, str(folder), f"is a second grid of the level {level}", EACH)
        if found.plan.seed == seed:
            same = f"its people are those of the experiment: both are drawn with seed {seed}"
            raise InputError(OPTION, str(folder), same, "give the experiment another --seed")
        grids[level] = found
    missing = [level for level in LEVELS if level not in grids]
    if grids and missing:
        raise InputError(OPTION, missing[0], "is a level without a grid", EACH)
    return {level: grids[level].prior() for level in LEVELS if level in grids}


PAPER, BUTTON = "paper", "mx-clear"


@dataclass(frozen=True)
class RunRequest:
    """What a person asks for.

    Attributes
    ----------
    space, vary : paper, or a button and what of it is varied; None: paper with a prior, else BUTTON.
    wide : bounds are those of `model_space`, not of real buttons. buttons : of the paper's space only designs
        that are buttons, see `button_constraints`. within : a rig that must be able to render
        every design: a shipped one's name, or a *.rig.json. prior : folder of a finished grid of others.
    retest : blocks of trials that end the run; None: SIMULATED_PAIRS, with switches
        SIMULATED_BLOCKS. switches : played in them beside start and result, built in or files, and with them
        the best fixed design where the space has one; None: SWITCHES where the person is simulated, else
        none, since each takes a real person minutes.
    task, level, presses : what is played; of PREFERENCE designs are compared, without presses. engine,
        options, budget, seed : of the run; engine None: gp, or preference-line where designs are compared.
    person, group, rig : the simulated one, of which group, and what is pressed; person None: a human plays.
    also : objectives beside the task's first, of WISHES. weights : of objectives, by which a compromise of
        several is recommended; empty: the knee of the front.
    """

    space: str | None = None
    wide: bool = False
    buttons: bool = False
    retest: int | None = None
    switches: Sequence[str] | None = None
    vary: Sequence[str] = ("FDV",)
    within: str | None = None
    prior: Path | None = None
    task: str = POINTING
    level: str | None = "easy"
    presses: int = 20
    engine: str | None = None
    options: dict[str, Any] = field(default_factory=dict)
    budget: int = 30
    seed: int = 0
    person: int | None = 0
    group: str = PAPER_GROUP
    rig: str = IDEAL
    also: Sequence[str] = ()
    weights: Mapping[str, float] = field(default_factory=dict)


def begin_run(folder: Path, request: RunRequest) -> Optimization:
    """Begin a run in a folder that is new or empty. Raises InputError, BuildError, OSError."""
    request = replace(request, space=request.space or (PAPER if request.prior else BUTTON))
    if request.task == PREFERENCE:
        _check_compared(request)
    engine = request.engine or ("preference-line" if request.task == PREFERENCE else "gp")
    check_engine(engine, request.task)
    with _shelf_of(request.within) as (project, rig_id):
        space, start = _space(request, rig_id)
        objectives = _objectives(request)
        rivals = _rivals(request, space, start)
        setup = OptimizeSetup(
            space=space,
            engine=engine,
            options=request.options,
            task=request.task,
            level=request.level if request.task == POINTING else None,
            objectives=objectives,
            seed=request.seed,
            budget=request.budget,
            start=start,
            prior=_prior(request),
            rivals=rivals,
            simulated=request.person is not None,
            about=_about(request, SIMULATED_BLOCKS if rivals else SIMULATED_PAIRS),
        )
        return Optimization.create(folder, setup, project)


def _check_compared(request: RunRequest) -> None:
    """Refuse what has no meaning where designs are compared. Raises InputError."""
    scored = {"--also": request.also, "--weight": request.weights, "--switch": request.switches}
    if asked := next((name for name, value in scored.items() if value), None):
        raise InputError(asked, PREFERENCE, "designs are compared, not scored", "leave it out")
    if request.person is not None and request.rig != IDEAL:
        reason = "a simulated person compares designs as they are"
        raise InputError("--rig", request.rig, reason, f"leave it out, or play {POINTING}")


def _objectives(request: RunRequest) -> tuple[Objective, ...]:
    """Return what a run is about, the task's own foremost. Raises InputError."""
    if request.task == PREFERENCE:
        return (ASYNCHRONY,)  # nothing scores it
    wishes = wished(request.also)
    also = tuple(one.name for one in wishes if one != LIKING)
    task = task_named(request.task, request.level, request.presses, also)
    objectives = (task.objectives[0], *wishes)
    if request.weights:
        check_weights(objectives, request.weights)
    return objectives


def _space(request: RunRequest, rig_id: str | None) -> tuple[SpaceSetup, dict[str, float] | None]:
    """Return the space, and the design a run starts from: a button that is varied is tried as it is first."""
    if request.space in (PAPER, None):
        return SpaceSetup(rig=rig_id, buttons=request.buttons), None
    base = open_button(request.space)
    setup = model_space_setup(base, request.vary, {} if request.wide else None, rig_id)
    return setup, neutral_design(model_space(base, request.vary, setup.bounds), base)


def _rivals(request: RunRequest, space: SpaceSetup, start: dict[str, float] | None) -> tuple[Rival, ...]:
    """Return what is played at the end beside start and result; nothing where nothing is played."""
    wanted = request.switches
    if wanted is None:
        wanted = (NONE,) if request.person is None or request.task == PREFERENCE else SWITCHES
    switches = switch_rivals(wanted, (request.space or "", start))
    if request.retest == 0 or not switches:
        return ()
    fixed = space.kind == "paper" and request.task == POINTING
    group = request.group if request.person is not None else PEOPLE
    return switches + (fixed_rivals(paper_space(), request.level, group) if fixed else ())


def _about(request: RunRequest, blocks: int) -> dict[str, Any]:
    retest: dict[str, Any] = {OptimizeSetup.RETEST: blocks if request.retest is None else request.retest}
    if request.weights:
        retest[OptimizeSetup.WEIGHTS] = dict(request.weights)
    if request.person is None:
        return {OptimizeSetup.PRESSES: request.presses, **retest}
    return {**about_player(request.person, request.rig, request.presses, request.group), **retest}


def _prior(request: RunRequest) -> tuple[Trial, ...]:
    if request.prior is None:
        return ()
    found = read_grid(request.prior)
    if request.also:
        reason = "others scored asynchrony alone"
        raise InputError("--prior", str(request.prior), reason, "leave it out, or --also")
    if request.space != PAPER or request.task != POINTING:
        reason = f"others played {POINTING} with designs of the space {PAPER}"
        raise InputError("--prior", str(request.prior), reason, "leave it out, or play the same")
    return found.prior()


@contextmanager
def _shelf_of(within: str | None) -> Iterator[tuple[Path | None, str | None]]:
    """Return a project whose shelf has the rig, and the rig's id there. Raises InputError."""
    if within is None:
        yield None, None
        return
    within = str(current_rig_name(within))
    if within in SHIPPED_RIGS:
        yield None, f"shipped:{within}"
        return
    path = Path(within)
    if not path.name.endswith(SUFFIX) or not path.is_file():
        remedy = f"name a *{SUFFIX}, as fdvv compensate --save-rig writes it, or {', '.join(SHIPPED_RIGS)}"
        raise InputError("--within", within, "is no rig that is known", remedy)
    with TemporaryDirectory() as project:
        shelf = Path(project) / "rigs"
        shelf.mkdir()
        shutil.copy(path, shelf / path.name)
        yield Path(project), f"own:{path.name.removesuffix(SUFFIX)}"
