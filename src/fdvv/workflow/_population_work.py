"""The work of a population run's chunk: people who optimise, or cells of a grid. Simulated."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from fdvv.model import FDVVModel, load_builtin
from fdvv.optimize import (
    Design,
    DesignSpace,
    Engine,
    Problem,
    Score,
    SimulatedUser,
    TemporalPointing,
    Trial,
    TrialState,
    engine_of,
    paper_model,
    paper_space,
)
from fdvv.units import FloatArray
from fdvv.workflow._play import score_design
from fdvv.workflow._population_plan import PopulationPlan, seed_of

Evaluate = Callable[[Design, int], Mapping[str, Score]]
"""Scores a design in a trial of that number."""
JUDGE, ENGINE, GRID = 1, 2, 3
"""Purposes of random numbers: they never meet those of a trial."""


def optimise(engine: Engine, problem: Problem, evaluate: Evaluate, budget: int) -> tuple[Trial, ...]:
    """Ask, score and tell so many times; nothing is kept on the way."""
    trials: list[Trial] = []
    for number in range(budget):
        (design,) = engine.suggest(problem, trials)
        scores = dict(evaluate(design, number))
        trials.append(Trial(number, design, TrialState.DONE, scores, origin=engine.name))
    return tuple(trials)


@dataclass(frozen=True)
class PopulationWork:
    """Works on a chunk of a plan, by number; the same number gives the same columns."""

    plan: PopulationPlan
    prior: tuple[Trial, ...] = ()

    def __call__(self, chunk: int) -> dict[str, FloatArray]:
        """Give the columns of a chunk, one row per person or cell."""
        return self._person(chunk) if self.plan.kind == "optimize" else self._grid(chunk)

    @property
    def task(self) -> TemporalPointing:
        """Get what people do."""
        return TemporalPointing(self.plan.level, self.plan.rounds)

    def _person(self, number: int) -> dict[str, FloatArray]:
        plan, user = self.plan, self.plan.user(number)
        objective = self.task.objectives[0]
        problem = Problem(
            paper_space(), self.task.objectives[:1], seed_of(plan.seed, number, ENGINE), self.prior
        )
        engine = engine_of(plan.engine, plan.options)

        def evaluate(design: Design, trial: int) -> Mapping[str, Score]:
            return self._scores(paper_model(design), user, seed_of(plan.seed, number, 0, trial))

        trials = optimise(engine, problem, evaluate, plan.budget)
        best = engine.best(problem, trials)
        rows = {
            "designs": problem.space.to_unit([trial.design for trial in trials]),
            "values": np.array([trial.scores[objective.name].value for trial in trials]),
            "best": problem.space.to_unit([best])[0],
            "judged": self._judged(paper_model(best), user),
            "against": self._judged(load_builtin(plan.against), user),
        }
        return {name: np.asarray(row)[None] for name, row in rows.items()}

    def _judged(self, model: FDVVModel, user: SimulatedUser) -> float:
        seeds = [seed_of(self.plan.seed, user.number, JUDGE, i) for i in range(self.plan.judged)]
        name = self.task.objectives[0].name
        return float(np.mean([self._scores(model, user, seed)[name].value for seed in seeds]))

    def _grid(self, chunk: int) -> dict[str, FloatArray]:
        plan, name = self.plan, self.task.objectives[0].name
        designs = grid_designs(paper_space(), plan.designs)
        found = []
        for cell in plan.cells(chunk):
            number, person = divmod(cell, plan.people)
            seed = seed_of(plan.seed, person, GRID, number)
            found.append(self._scores(paper_model(designs[number]), plan.user(person), seed)[name])
        errors = [np.nan if score.error is None else score.error for score in found]
        return {"values": np.array([score.value for score in found]), "errors": np.array(errors)}

    def _scores(self, model: FDVVModel, user: SimulatedUser, seed: int) -> dict[str, Score]:
        return score_design(self.task, model, user, seed, rig=self.plan.rig)


@lru_cache(maxsize=4)
def grid_designs(space: DesignSpace, count: int) -> tuple[dict[str, float], ...]:
    """Give the first designs of an even net that hold the space's constraints."""
    problem = Problem(space, TemporalPointing().objectives)
    return tuple(engine_of("sobol").suggest(problem, (), count))
