"""What does a compromise cost and bring? Time and liking at once, against time alone. Simulated.

Run as ``python -m benchmarks.optimize_wishes [people] [processes] [seed]``; a few minutes. People are of the
group `diverse`, each with a taste, drawn with a seed that nothing was chosen on; designs are those of the
paper's space that are buttons; 30 trials of `gp`. What is shown are true values of the recommended designs:
the expected asynchrony, and the liking that many answers come to.
"""

from __future__ import annotations

import sys
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from benchmarks.optimize_people import Person, expected_ms
from fdvv.model.file import load_builtin
from fdvv.model.model import FDVVModel
from fdvv.parallel.open import open_executor
from fdvv.units import FloatArray
from fdvv_people.optimize.button_constraints import button_constraints
from fdvv_people.optimize.engines.multi_objective import believed_front, pareto_front
from fdvv_people.optimize.engines.registry import engine_of
from fdvv_people.optimize.paper_space import paper_model, paper_space
from fdvv_people.optimize.people.taste import draw_taste, expected_liking, rate
from fdvv_people.optimize.population.plan import optimise
from fdvv_people.optimize.problem import Problem
from fdvv_people.optimize.space import Design
from fdvv_people.task.pointing import ASYNCHRONY
from fdvv_people.task.questionnaire import LIKING, liking_score
from fdvv_people.task.score import Score

GROUP, SEED, LEVEL, BUDGET = "diverse", 4000, "easy", 30
START = "mx-clear"
ALONE, KNEE, MEASURED, FAST, LIKED = (
    "time alone",
    "compromise",
    "knee of the scores as measured",
    "fast end of the front",
    "liked end of the front",
)
ROWS = (START, ALONE, FAST, KNEE, MEASURED, LIKED)
SAID = {KNEE: "said of the compromise", MEASURED: "said of the knee as measured"}
"""What the run itself said of its knees: expected values, and scores."""
Worth = Mapping[str, tuple[float, float]]
"""True asynchrony (ms) and liking (points) by row, and what was SAID."""


@dataclass(frozen=True)
class Wisher:
    """Optimises for one person, by number; called in any process."""

    seed: int = SEED

    def __call__(self, number: int) -> Worth:
        """Return what is recommended to a person, and the start, in true values."""
        person, taste = Person(self.seed, number, LEVEL, GROUP), draw_taste(number, self.seed)
        space, engine = paper_space(button_constraints()), engine_of("gp")

        def evaluate(design: Design, trial: int) -> dict[str, Score]:
            seed = 1000 * (self.seed + number) + trial
            liked = liking_score(rate(paper_model(design), taste, seed))
            return {**person.score(design, seed), LIKING.name: liked}

        def worth(model: FDVVModel) -> tuple[float, float]:
            return expected_ms(person.task, model, person.user), expected_liking(model, taste)

        alone = Problem(space, (ASYNCHRONY,), self.seed + number)
        both = Problem(space, (ASYNCHRONY, LIKING), self.seed + number)
        trials = optimise(engine, both, evaluate, BUDGET)
        front = believed_front(both, trials)
        knees = {KNEE: front.knee(), MEASURED: pareto_front(both, trials).knee()}
        said = {
            SAID[name]: (one.scores[ASYNCHRONY.name].value, one.scores[LIKING.name].value)
            for name, one in knees.items()
        }
        designs = {
            ALONE: engine.best(alone, optimise(engine, alone, evaluate, BUDGET)),
            **{name: one.design for name, one in knees.items()},
            FAST: front.trials[0].design,
            LIKED: front.trials[-1].design,
        }
        found = {name: worth(paper_model(design)) for name, design in designs.items()}
        return {START: worth(load_builtin(START)), **found, **said}


def table(found: FloatArray) -> str:
    """Write true values as a Markdown table: medians and 5 to 95 %, of (people, rows, objectives)."""
    against = (ALONE, START)
    heads = (
        head
        for what in ("asynchrony, ms", "liking, of 7")
        for head in (what, *(f"against {name}" for name in against))
    )
    lines = [f"| recommended | {' | '.join(heads)} |", "|---" * 7 + "|"]
    more = [found - found[:, ROWS.index(name)][:, None] for name in against]
    for i, name in enumerate(ROWS):
        cells = (
            _middle(values[:, i, j], digits, values is not found)
            for j, digits in ((0, 1), (1, 2))
            for values in (found, *more)
        )
        lines.append(f"| {name} | {' | '.join(cells)} |")
    return "\n".join(lines)


def _middle(values: FloatArray, digits: int, signed: bool) -> str:
    low, middle, high = np.percentile(values, [5, 50, 95])
    sign = "+" if signed else ""
    return f"{middle:{sign}.{digits}f} ({low:.{digits}f} to {high:.{digits}f})".replace("-", "−")


def shares(found: FloatArray) -> str:
    """Say for how many people what is recommended is better than the start, in both wishes and in each."""
    lines = []
    for name in (ALONE, KNEE):
        better = (found[:, ROWS.index(name)] - found[:, ROWS.index(START)]) * [-1, 1] > 0
        time, liked, all_ = better[:, 0].mean(), better[:, 1].mean(), better.all(axis=1).mean()
        lines.append(
            f"{name}: faster than {START} for {100 * time:.0f} %, better liked for {100 * liked:.0f} %, "
            f"both for {100 * all_:.0f} % of {len(found)} people"
        )
    return "\n".join(lines)


def optimism(worths: Sequence[Worth]) -> str:
    """Say how much better the run said that its knees are than they are, in the mean over people."""
    lines = []
    for name, said in SAID.items():
        off = np.mean([np.subtract(one[said], one[name]) * [-1, 1] for one in worths], axis=0)
        lines.append(f"{said}: better than the truth by {off[0]:.1f} ms and {off[1]:.2f} points")
    return "\n".join(lines)


def main() -> None:
    """Print the table."""
    given = [int(word) for word in sys.argv[1:]]
    people, processes, seed = (*given, *(30, 2, SEED)[len(given) :])
    with open_executor(processes) as executor:
        worths = dict(executor.run(Wisher(seed), range(people)))
    found = np.array([[one[name] for name in ROWS] for _, one in sorted(worths.items())])
    print(f"simulated; {people} people of the group {GROUP}, {LEVEL}, {BUDGET} trials, seed {seed}\n")
    print(table(found))
    print()
    print(shares(found))
    print(optimism(list(worths.values())))


if __name__ == "__main__":
    main()
