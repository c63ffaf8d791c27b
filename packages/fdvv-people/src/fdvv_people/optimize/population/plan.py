"""What a population run is about, and how it is cut into chunks. Simulated."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from functools import lru_cache
from pathlib import Path
from typing import Annotated, Any, Literal

import numpy as np
from msgspec import Meta, Struct

from fdvv.errors import InputError
from fdvv.io.documents import Kind, read_record
from fdvv.model.file import load_builtin
from fdvv.model.model import FDVVModel
from fdvv.units import FloatArray
from fdvv_people.optimize.button_constraints import button_constraints
from fdvv_people.optimize.engines.registry import engine_of
from fdvv_people.optimize.paper_space import paper_model, paper_space
from fdvv_people.optimize.people.groups import PAPER_GROUP, group_named
from fdvv_people.optimize.people.simulate import score_design
from fdvv_people.optimize.people.user import SimulatedUser, UserSettings, draw_user
from fdvv_people.optimize.problem import Engine, Problem, Trial, TrialState
from fdvv_people.optimize.space import Design, DesignSpace
from fdvv_people.task.pointing import TemporalPointing
from fdvv_people.task.score import Score

PLAN_FILE = "population.json"
KIND = Kind("fdvv-population", 1, "a population run", "name the folder of a population run, or a new one")
LARGEST_bytes = 1_000_000
CELLS = 40
"""Scores of a grid in a chunk, about 25 ms each."""
UNUSED = {"grid": {"engine", "options", "budget", "against", "judged"}, "optimize": {"designs"}}
"""What decides nothing in a run of that kind."""
Shift = Annotated[float, Meta(gt=0, le=100)]


class PopulationPlan(Struct, frozen=True, forbid_unknown_fields=True, kw_only=True):
    """A population run: everything that decides its result.

    Attributes
    ----------
    kind : "optimize": every person has a run of their own; "grid": everybody scores the same designs.
    people, seed : people 0, 1, ... of a draw with that seed, see fdvv_people.optimize.people.user.draw_user.
    group : of people, see fdvv_people.optimize.people.groups. buttons : only designs that are buttons.
    shifts : ratios by which the person in the middle differs from the usual one, by field of SimulatedUser.
    level, rounds : of temporal pointing. rig : shipped one that is pressed.
    engine, options, budget : of each person's run; unused in a grid.
    designs : scored by everybody in a grid, the first of an even net.
    against : built-in button that each person's design is judged beside.
    judged : scores that judge a design, on presses that no engine saw.
    """

    format: Literal["fdvv-population"] = "fdvv-population"
    version: Literal[1] = 1
    kind: Literal["optimize", "grid"] = "optimize"
    people: Annotated[int, Meta(ge=1, le=1_000_000)] = 100
    seed: Annotated[int, Meta(ge=0, lt=2**32)] = 0
    group: str = PAPER_GROUP
    buttons: bool = False
    shifts: dict[str, Shift] = {}
    level: Literal["easy", "hard"] = "easy"
    rounds: Annotated[int, Meta(ge=1, le=1000)] = 20
    rig: str = "ideal"
    engine: str = "gp"
    options: dict[str, Any] = {}
    budget: Annotated[int, Meta(ge=1, le=1000)] = 30
    designs: Annotated[int, Meta(ge=1, le=100_000)] = 100
    against: str = "mx-clear"
    judged: Annotated[int, Meta(ge=1, le=100)] = 5

    @property
    def space(self) -> DesignSpace:
        """The designs there are."""
        return paper_space(button_constraints() if self.buttons else ())

    @property
    def chunks(self) -> int:
        """Into how many chunks the run is cut, whoever works on them."""
        return self.people if self.kind == "optimize" else -(-self.people * self.designs // CELLS)

    def differs(self, other: PopulationPlan) -> list[str]:
        """List what the results of another plan would differ by, by field."""
        names = [name for name in self.__struct_fields__ if name not in UNUSED[self.kind]]
        return [name for name in names if getattr(self, name) != getattr(other, name)]

    def cells(self, chunk: int) -> range:
        """Return the grid cells of a chunk: cell i is person i % people and design i // people."""
        return range(chunk * CELLS, min((chunk + 1) * CELLS, self.people * self.designs))

    def user(self, number: int) -> SimulatedUser:
        """Draw a person. Raises InputError on a shift of what people do not have, and an unknown group."""
        return draw_user(number, self.seed, settings_of(self.shifts, self.group))


def settings_of(shifts: Mapping[str, float], group: str = PAPER_GROUP) -> UserSettings:
    """Shift the person in the middle of a group. Raises InputError on what people do not have."""
    people = group_named(group)
    middle = people.middle
    for name in shifts:
        if name == "number" or not hasattr(middle, name):
            fields = ", ".join(n for n in middle.__dataclass_fields__ if n != "number")
            raise InputError("--shift", name, "people have no such number", f"use one of: {fields}")
    shifted = {name: getattr(middle, name) * ratio for name, ratio in shifts.items()}
    return replace(people, middle=replace(middle, **shifted))


def seed_of(*numbers: int) -> int:
    """Mix numbers into a seed of 32 bits: neighbours share nothing."""
    return int(np.random.SeedSequence(numbers).generate_state(1)[0])


def read_plan(path: Path) -> PopulationPlan:
    """Read a plan. Raises InputError."""
    return read_record(path, KIND, PopulationPlan, LARGEST_bytes)


Evaluate = Callable[[Design, int], Mapping[str, Score]]
"""Scores a design in a trial of that number."""
JUDGE, ENGINE, GRID = 1, 2, 3
"""Purposes of random numbers: they never repeat those of a trial."""


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
        """Return the columns of a chunk, one row per person or cell."""
        return self._person(chunk) if self.plan.kind == "optimize" else self._grid(chunk)

    @property
    def task(self) -> TemporalPointing:
        """What people do."""
        return TemporalPointing(self.plan.level, self.plan.rounds)

    def _person(self, number: int) -> dict[str, FloatArray]:
        plan, user = self.plan, self.plan.user(number)
        objective = self.task.objectives[0]
        problem = Problem(
            plan.space, self.task.objectives[:1], seed_of(plan.seed, number, ENGINE), self.prior
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
        designs = grid_designs(plan.buttons, plan.designs)
        found = []
        for cell in plan.cells(chunk):
            number, person = divmod(cell, plan.people)
            seed = seed_of(plan.seed, person, GRID, number)
            found.append(self._scores(paper_model(designs[number]), plan.user(person), seed)[name])
        # NumPy makes nan of an error that is None
        values, errors = np.array([(score.value, score.error) for score in found], dtype=np.float64).T
        return {"values": values, "errors": errors}

    def _scores(self, model: FDVVModel, user: SimulatedUser, seed: int) -> dict[str, Score]:
        return score_design(self.task, model, user, seed, rig=self.plan.rig)


@lru_cache(maxsize=4)
def grid_designs(buttons: bool, count: int) -> tuple[dict[str, float], ...]:
    """Return the first designs of an even net over the paper's space, or over what is a button in it."""
    problem = Problem(PopulationPlan(buttons=buttons).space, TemporalPointing().objectives)
    return tuple(engine_of("sobol").suggest(problem, (), count))
