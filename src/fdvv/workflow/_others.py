"""What others did before: finished grids that a run, or everybody's training, begins from. Simulated."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from fdvv.errors import InputError
from fdvv.optimize import Trial
from fdvv.workflow._experiment_setup import LEVELS
from fdvv.workflow._population_result import RESULT_FILE, PopulationResult, read_population

OPTION = "--prior"


def read_grid(folder: Path) -> PopulationResult:
    """Read a finished grid of others. InputError on anything else."""
    if not (folder / RESULT_FILE).is_file():
        raise InputError(OPTION, str(folder), "holds no grid that is finished", _REMEDY)
    found = read_population(folder)
    if found.plan.kind != "grid":
        raise InputError(OPTION, str(folder), "holds runs of many people, not a grid", _REMEDY)
    return found


def experiment_prior(folders: Sequence[Path], seed: int) -> dict[str, tuple[Trial, ...]]:
    """Give what everybody's training begins from, by level, of a grid per level; nothing of no folder.

    folders : of finished grids, in any order.
    seed : of the experiment; its people are drawn with it, so the others must be of another one.

    Raises InputError on a level without or with two grids, and on others who are the same people.
    """
    grids: dict[str, PopulationResult] = {}
    for folder in folders:
        found = read_grid(folder)
        level = found.plan.level
        if level in grids:
            raise InputError(OPTION, str(folder), f"is a second grid of the level {level}", _EACH)
        if found.plan.seed == seed:
            same = f"its people are those of the experiment: both are drawn with seed {seed}"
            raise InputError(OPTION, str(folder), same, "give the experiment another --seed")
        grids[level] = found
    missing = [level for level in LEVELS if level not in grids]
    if grids and missing:
        raise InputError(OPTION, missing[0], "is a level without a grid", _EACH)
    return {level: grids[level].prior() for level in LEVELS if level in grids}


_REMEDY = "name the folder of a finished fdvv optimize population --grid"
_EACH = "name one grid per level: --prior EASY --prior HARD"
