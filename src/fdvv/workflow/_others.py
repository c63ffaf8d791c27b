"""What others did before: finished grids that a run, or everybody's training, begins from. Simulated."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from fdvv.errors import InputError
from fdvv.optimize import Trial
from fdvv.workflow._experiment_setup import LEVELS
from fdvv.workflow._population_result import RESULT_FILE, PopulationResult, read_population

OPTION = "--prior"
GRID = "name the folder of a finished fdvv optimize population --grid"
EACH = "name one grid per level: --prior EASY --prior HARD"
FOLDER = "others"
"""Of a project: every folder in it that holds a finished grid can be begun from."""


@dataclass(frozen=True)
class OthersEntry:
    """A finished grid of a project.

    Attributes
    ----------
    name : of its folder. level : that was played. people, designs : how many; each design has their mean.
    """

    name: str
    level: str
    people: int
    designs: int

    @property
    def about(self) -> str:
        """Get what it is, in a few words."""
        return f"{self.designs} designs scored by {self.people} simulated people, {self.level}"


class OthersShelf:
    """The finished grids of a project, in ``<project>/others``; what is unfinished or broken is not offered.

    Parameters
    ----------
    project : its folder.
    """

    def __init__(self, project: Path) -> None:
        self._folder = project / FOLDER

    def entries(self) -> tuple[OthersEntry, ...]:
        """List what a run may begin from, by name."""
        found = ((folder, _offered(folder)) for folder in self._folders())
        return tuple(_entry(folder, grid) for folder, grid in found if grid)

    def prior(self, name: str) -> tuple[OthersEntry, tuple[Trial, ...]]:
        """Give the trials of a grid that is offered, and what it is. InputError."""
        for folder in self._folders():
            if folder.name == name and (grid := _offered(folder)):
                return _entry(folder, grid), grid.prior()
        reason = f"is no finished grid in the project's folder {FOLDER}"
        raise InputError("optimise", name, reason, "choose one that is offered, or finish it")

    def _folders(self) -> list[Path]:
        return sorted(self._folder.iterdir()) if self._folder.is_dir() else []


def _offered(folder: Path) -> PopulationResult | None:
    try:
        return read_grid(folder)
    except (InputError, OSError):
        return None


def _entry(folder: Path, grid: PopulationResult) -> OthersEntry:
    return OthersEntry(folder.name, grid.plan.level, grid.plan.people, grid.plan.designs)


def read_grid(folder: Path) -> PopulationResult:
    """Read a finished grid of others. InputError on anything else."""
    if not (folder / RESULT_FILE).is_file():
        raise InputError(OPTION, str(folder), "holds no grid that is finished", GRID)
    found = read_population(folder)
    if found.plan.kind != "grid":
        raise InputError(OPTION, str(folder), "holds runs of many people, not a grid", GRID)
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
            raise InputError(OPTION, str(folder), f"is a second grid of the level {level}", EACH)
        if found.plan.seed == seed:
            same = f"its people are those of the experiment: both are drawn with seed {seed}"
            raise InputError(OPTION, str(folder), same, "give the experiment another --seed")
        grids[level] = found
    missing = [level for level in LEVELS if level not in grids]
    if grids and missing:
        raise InputError(OPTION, missing[0], "is a level without a grid", EACH)
    return {level: grids[level].prior() for level in LEVELS if level in grids}
