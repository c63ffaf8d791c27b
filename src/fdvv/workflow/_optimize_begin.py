"""A run as a command begins it: its space, the rig it must suit, what others did before."""

from __future__ import annotations

import shutil
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

from fdvv.errors import InputError
from fdvv.optimize import Trial, model_space, neutral_design
from fdvv.workflow._open import open_model
from fdvv.workflow._optimize_player import POINTING, about_player, task_named
from fdvv.workflow._optimize_session import OptimizeSession
from fdvv.workflow._optimize_setup import ObjectiveSetup, OptimizeSetup, SpaceSetup, model_space_setup
from fdvv.workflow._others import read_grid
from fdvv.workflow._rig_shelf import SHIPPED_RIGS, SUFFIX

PAPER = "paper"


@dataclass(frozen=True)
class RunAsked:
    """What a person asks for.

    Attributes
    ----------
    space, vary : paper, or a button and what of it is varied. within : a rig that must be able to render
        every design: a shipped one's name, or a *.rig.json. prior : folder of a finished grid of others.
    task, level, presses : what is played. engine, options, budget, seed : of the run.
    person, rig : the simulated one, and what is pressed; person None: a human plays.
    """

    space: str = PAPER
    vary: Sequence[str] = ("FDV",)
    within: str | None = None
    prior: Path | None = None
    task: str = POINTING
    level: str | None = "easy"
    presses: int = 20
    engine: str = "gp"
    options: dict[str, Any] = field(default_factory=dict)
    budget: int = 30
    seed: int = 0
    person: int | None = 0
    rig: str = "ideal"


def begin_run(folder: Path, asked: RunAsked) -> OptimizeSession:
    """Begin a run in a folder that is new or empty. InputError, BuildError, OSError."""
    with _shelf_of(asked.within) as (project, rig_id):
        space, start = _space(asked, rig_id)
        task = task_named(asked.task, asked.level, asked.presses)
        first = task.objectives[0]
        setup = OptimizeSetup(
            space=space,
            engine=asked.engine,
            options=asked.options,
            task=asked.task,
            level=asked.level if asked.task == POINTING else None,
            objectives=(ObjectiveSetup(first.name, first.larger_is_better),),
            seed=asked.seed,
            budget=asked.budget,
            start=start,
            prior=_prior(asked),
            simulated=asked.person is not None,
            about=_about(asked),
        )
        return OptimizeSession.create(folder, setup, project)


def _space(asked: RunAsked, rig_id: str | None) -> tuple[SpaceSetup, dict[str, float] | None]:
    """Give the space, and the design a run starts from: a button that is varied is tried as it is first."""
    if asked.space == PAPER:
        return SpaceSetup(rig=rig_id), None
    base = open_model(asked.space)
    setup = model_space_setup(base, asked.vary, rig=rig_id)
    return setup, neutral_design(model_space(base, asked.vary), base)


def _about(asked: RunAsked) -> dict[str, Any]:
    """Give what is kept of who plays."""
    if asked.person is None:
        return {OptimizeSetup.PRESSES: asked.presses}
    return about_player(asked.person, asked.rig, asked.presses)


def _prior(asked: RunAsked) -> tuple[Trial, ...]:
    if asked.prior is None:
        return ()
    found = read_grid(asked.prior)
    if asked.space != PAPER or asked.task != POINTING:
        reason = f"others played {POINTING} with designs of the space {PAPER}"
        raise InputError("--prior", str(asked.prior), reason, "leave it out, or play the same")
    return found.prior()


@contextmanager
def _shelf_of(within: str | None) -> Iterator[tuple[Path | None, str | None]]:
    """Give a project whose shelf has the rig, and the rig's id there. InputError."""
    if within is None:
        yield None, None
        return
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
