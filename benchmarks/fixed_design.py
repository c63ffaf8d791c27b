"""Which one design is best for a whole group, if nobody tries anything? Simulated.

Run as ``python -m benchmarks.fixed_design [PROCESSES]`` (default 2): writes
``packages/fdvv-people/src/fdvv_people/optimize/people/fixed_designs.json``, which ``fdvv optimize run``
plays beside what it recommends.
Designs of the paper's space that are buttons are scored by expected asynchrony, without chance. An even net
and what is nearest to the shipped switches come first; the best go on to more people, then to steps around
them. The first CHOOSE people of SEED choose; those after them, whom the choice has not seen, say what it is
worth. With 12 people to choose, the best design lost to a switch with others. Nobody of the seeds that judge
engines takes part. Half an hour.
"""

from __future__ import annotations

import sys
from concurrent.futures import ProcessPoolExecutor
from pathlib import Path

import numpy as np

from benchmarks.optimize_people import expected_ms
from fdvv.io.documents import pretty
from fdvv.io.files import write_atomic
from fdvv.model.file import load_builtin
from fdvv_people.optimize.button_constraints import button_constraints
from fdvv_people.optimize.engines.registry import engine_of
from fdvv_people.optimize.paper_space import paper_design_like, paper_model, paper_space
from fdvv_people.optimize.people.groups import GROUPS, group_named
from fdvv_people.optimize.people.user import SimulatedUser, draw_users
from fdvv_people.optimize.problem import Problem
from fdvv_people.optimize.run.rivals import SWITCHES
from fdvv_people.optimize.space import Design
from fdvv_people.task.pointing import LEVELS_px_s, TemporalPointing
from fdvv_people.task.score import Objective

FILE = Path(__file__).parents[1] / "packages/fdvv-people/src/fdvv_people/optimize/people/fixed_designs.json"
SEED, CHOOSE, JUDGE = 700, 48, 24
NET, FIRST, SECOND, LEADERS = 96, 16, 16, 3
"""Designs of the net, people who score them all, designs that all people score, and those stepped from."""
STEPS = (0.08, 0.04)
"""Standard deviations of the steps around the leaders, round by round, in parts of a range."""
AROUND = 8
"""Steps around each leader in a round."""
SPACE = paper_space(button_constraints())


class Score:
    """Scores a design by everybody; users : who they are."""

    def __init__(self, level: str, users: tuple[SimulatedUser, ...]) -> None:
        self.task, self.users = TemporalPointing(level), users

    def __call__(self, design: Design) -> list[float]:
        model = paper_model(design)
        return [expected_ms(self.task, model, user, 1) for user in self.users]


def people_of(group: str, judging: bool) -> tuple[SimulatedUser, ...]:
    """Return who chooses the design of a group, or who judges it."""
    people = draw_users(CHOOSE + JUDGE, SEED, group_named(group))
    return people[CHOOSE:] if judging else people[:CHOOSE]


def first_designs(objectives: tuple[Objective, ...]) -> list[dict[str, float]]:
    """Return an even net, and what is nearest to the switches."""
    near = [paper_design_like(load_builtin(name)) for name in SWITCHES]
    net = engine_of("sobol").suggest(Problem(SPACE, objectives), (), NET)
    return [*net, *(design for design in near if not SPACE.broken(design))]


def best_of(designs: list[dict[str, float]], scores: list[list[float]], count: int) -> list[dict[str, float]]:
    """Return the designs with the best means, the best first."""
    return [designs[at] for at in np.argsort([np.mean(row) for row in scores])[:count]]


def searched(level: str, users: tuple[SimulatedUser, ...], executor: ProcessPoolExecutor) -> dict[str, float]:
    """Return the best design there is for all, in the rounded numbers that are kept."""
    random, score, few = np.random.default_rng(SEED), Score(level, users), Score(level, users[:FIRST])
    designs = first_designs(score.task.objectives)
    designs = best_of(designs, list(executor.map(few, designs, chunksize=2)), SECOND)
    scores = list(executor.map(score, designs))
    for step in STEPS:
        moved = np.repeat(SPACE.to_unit(best_of(designs, scores, LEADERS)), AROUND, axis=0)
        moved = np.clip(moved + step * random.standard_normal(moved.shape), 0.0, 1.0)
        tried = [design for design in SPACE.of_unit(moved) if not SPACE.broken(design)]
        designs += tried
        scores += executor.map(score, tried)
    return {name: round(value, 3) for name, value in best_of(designs, scores, 1)[0].items()}


def found(group: str, level: str, executor: ProcessPoolExecutor) -> dict[str, object]:
    """Return the record of a group and a level."""
    design = searched(level, people_of(group, judging=False), executor)
    judges = people_of(group, judging=True)
    judged = np.array(Score(level, judges)(design))
    task = TemporalPointing(level)
    switches = [[expected_ms(task, load_builtin(name), user, 1) for user in judges] for name in SWITCHES]
    means = ", ".join(f"{name} {np.mean(row):.1f}" for name, row in zip(SWITCHES, switches, strict=True))
    print(f"{group}, {level}: {judged.mean():.1f} ms with people who had no part in it; {means}", flush=True)
    return {
        "group": group,
        "level": level,
        "design": design,
        "judged_ms": [round(value, 2) for value in judged.tolist()],
    }


def main() -> None:
    """Write the file."""
    with ProcessPoolExecutor(int(sys.argv[1]) if len(sys.argv) > 1 else 2) as executor:
        designs = [found(group, level, executor) for group in GROUPS for level in LEVELS_px_s]
    record = {
        "format": "fdvv-fixed-designs",
        "version": 1,
        "simulated": True,
        "command": "python -m benchmarks.fixed_design",
        "people": f"of seed {SEED} the first {CHOOSE} have chosen, the next {JUDGE} judge",
        "designs": designs,
    }
    write_atomic(FILE, pretty(record) + "\n")


if __name__ == "__main__":
    main()
