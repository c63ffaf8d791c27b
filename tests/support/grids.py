"""Small finished grids of designs."""

from __future__ import annotations

from pathlib import Path
from typing import Literal

from fdvv_people.optimize.population.plan import PopulationPlan
from fdvv_people.optimize.population.population import run_population
from tests.support.executors import Here

SEED = 7


def grid(folder: Path, level: Literal["easy", "hard"], designs: int = 5) -> Path:
    run_population(
        folder,
        PopulationPlan(kind="grid", people=2, designs=designs, rounds=2, seed=SEED, level=level),
        Here(),
    )
    return folder
