"""Engines against the plain GP-EI baseline, on simulated people with scores of 20 presses. Simulated; hours.

Run as ``python -m benchmarks.optimize_engines FOLDER [runs] [processes] [engine ...]``: every finished run is
kept in FOLDER, the same command goes on, and a table is printed of what is there. ``... FOLDER table [engine
...]`` only prints, ``... FOLDER figure FILE [engine ...]`` draws. Engines are those of VARIANTS, all by
default. Run i is one seed and one person at both levels; 600 runs are 20 seeds times 30 people, and any
multiple of 60 of the first ones has every person and every seed equally often. Engines that are not the
question stop earlier.

What is shown is the true value, the expected score of the person, of the design that an engine recommends
after so many evaluations: median and 5-95 %. Warm starts come from other simulated people who scored 512
designs: drawn as the judged ones are, or from a population that is wrong on purpose (SHIFTED).
"""

from __future__ import annotations

import json
import sys
from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cache
from itertools import product
from pathlib import Path
from typing import Any

from benchmarks.optimize_baselines import compared_engine
from benchmarks.optimize_people import FIRST_SEED, SHIFTED, Person
from benchmarks.optimize_tables import (
    BASELINE,
    BUDGET,
    LEVELS,
    LOOKS,
    PEOPLE,
    SEEDS,
    SMOOTHED,
    Run,
    common,
    draw,
    paired,
    table,
)
from fdvv.errors import InputError
from fdvv.eventlog import Journal, JournalKind, read_records
from fdvv.parallel.open import open_executor
from fdvv_people.optimize.button_constraints import button_constraints
from fdvv_people.optimize.paper_space import paper_space
from fdvv_people.optimize.people.groups import PAPER_GROUP
from fdvv_people.optimize.population.plan import PopulationPlan, optimise
from fdvv_people.optimize.population.population import read_population, run_population
from fdvv_people.optimize.problem import Engine, Problem, Trial
from fdvv_people.optimize.space import Design
from fdvv_people.task.score import Score

OTHERS: Mapping[str, tuple[int, Mapping[str, float]]] = {"usual": (24, {}), "shifted": (8, SHIFTED)}
"""Whose scores a warm start begins from: how many people, and how they differ from the judged ones."""
PRIOR_SEED = 11
"""Of the people whose scores others begin from; below FIRST_SEED, so none of them is judged."""
RUNS_FILE = "runs.jsonl"
KIND = JournalKind({"run": Any}, "begin anew in another folder")


@dataclass(frozen=True)
class Variant:
    """An engine with its options.

    Attributes
    ----------
    prior : "": none, "usual" or "shifted" people. budget : evaluations. runs : that it takes part in.
    """

    engine: str
    options: Mapping[str, Any] = field(default_factory=dict)
    prior: str = ""
    budget: int = BUDGET
    runs: int = 60


VARIANTS: Mapping[str, Variant] = {
    BASELINE: Variant("gp-ei", runs=SEEDS * PEOPLE),
    "gp-ei, tuned": Variant("gp-ei", {"startup": 10}, runs=240),
    "gp, warm": Variant("gp", prior="usual", budget=BUDGET // 2, runs=SEEDS * PEOPLE),
    "gp, wrong warm": Variant("gp", prior="shifted", budget=BUDGET // 2),
    "gp": Variant("gp", runs=240),
    "tpe": Variant("tpe"),
    "tpe, warm": Variant("tpe", prior="usual", budget=BUDGET // 2),
    "random": Variant("random"),
    "sobol": Variant("sobol"),
}


@dataclass(frozen=True)
class Runner:
    """Makes runs: what an engine recommends after every evaluation, and what that is worth."""

    folder: Path
    first_seed: int = FIRST_SEED
    variants: Mapping[str, Variant] = field(default_factory=lambda: dict(VARIANTS))
    group: str = PAPER_GROUP
    buttons: bool = False

    def engine(self, variant: Variant) -> Engine:
        """Make the engine of a variant."""
        return compared_engine(variant.engine, variant.options)

    def prior(self, variant: Variant, level: str) -> tuple[Trial, ...]:
        """Return what others scored, of a variant that begins from it."""
        return prior_of(self.folder, variant.prior, level) if variant.prior else ()

    def __call__(self, run: Run) -> dict[str, list[float]]:
        """Return true values (ms) after LOOKS evaluations, by variant: the baseline answers in two ways."""
        variant = self.variants[run.variant]
        person = Person(self.first_seed, run.person, run.level, self.group)
        seed, space = self.first_seed + run.seed, paper_space(button_constraints() if self.buttons else ())
        problem = Problem(space, person.task.objectives, seed, self.prior(variant, run.level))
        engine = self.engine(variant)

        def evaluate(design: Design, trial: int) -> dict[str, Score]:
            return person.score(design, 1000 * seed + trial)

        trials = optimise(engine, problem, evaluate, variant.budget)
        answers = {run.variant: engine}
        if run.variant == BASELINE:
            answers[SMOOTHED] = compared_engine("gp-ei", {"smoothed": True})
        known: dict[tuple[float, ...], float] = {}
        return {
            name: [
                self._worth(one.best(problem, trials[:n]), person, known) for n in LOOKS if n <= len(trials)
            ]
            for name, one in answers.items()
        }

    @staticmethod
    def _worth(design: Design, person: Person, known: dict[tuple[float, ...], float]) -> float:
        key = tuple(design.values())
        if key not in known:
            known[key] = person.expected_ms(design)
        return known[key]


@cache
def prior_of(folder: Path, who: str, level: str) -> tuple[Trial, ...]:
    """Return the trials of others, from their finished grid."""
    return read_population(folder / f"{who}-{level}").prior()


def make_priors(folder: Path, processes: int, whose: Collection[str] = tuple(OTHERS)) -> None:
    """Let other people score a grid; what is there already is kept."""
    with open_executor(processes) as executor:
        for who, level in product(OTHERS, LEVELS):
            if who in whose:
                people, shifts = OTHERS[who]
                plan = PopulationPlan(
                    kind="grid", people=people, designs=512, seed=PRIOR_SEED, level=level, shifts=dict(shifts)
                )
                run_population(folder / f"{who}-{level}", plan, executor)


def runs_of(count: int, variants: Mapping[str, Variant]) -> list[Run]:
    """List the runs, those of one number together, so that a part of them is already a comparison."""
    return [
        Run(name, number, level)
        for number in range(count)
        for level in LEVELS
        for name, variant in variants.items()
        if number < variant.runs
    ]


def compare(folder: Path, runs: Sequence[Run], runner: Runner, processes: int) -> dict[Run, list[float]]:
    """Make the runs that are not yet in the folder; give all."""
    folder.mkdir(parents=True, exist_ok=True)
    path = folder / RUNS_FILE
    journal = Journal(path, InputError(folder, "folder", "another process is at work in it", "wait"))
    try:
        found = dict(_kept(path))
        left = [run for run in runs if run not in found]
        with open_executor(processes) as executor:
            for place, values in executor.run(runner, left):
                run = left[place]
                # the run that was asked for comes last: while it is not there, all of it is made again
                for name in sorted(values, key=lambda name: name == run.variant):
                    one = Run(name, run.number, run.level)
                    record = {"variant": name, "number": run.number, "level": run.level}
                    journal.write({"run": {**record, "values": values[name]}})
                    found[one] = values[name]
    finally:
        journal.close()
    return found


def kept_runs(folder: Path) -> dict[Run, list[float]]:
    """Read the runs in a folder."""
    return dict(_kept(folder / RUNS_FILE))


def _kept(path: Path) -> Iterator[tuple[Run, list[float]]]:
    for record, _ in read_records(path, KIND):
        one = record["run"]
        yield Run(one["variant"], one["number"], one["level"]), one["values"]


def _chosen(folder: Path, names: Sequence[str]) -> dict[Run, list[float]]:
    """Read what is there of named engines, of all if none is named, and of the baseline."""
    kept = kept_runs(folder)
    chosen = {BASELINE, SMOOTHED, *names} if names else {run.variant for run in kept}
    return common({run: values for run, values in kept.items() if run.variant in chosen})


def main(arguments: Sequence[str]) -> None:
    """Make what is missing and print what is there."""
    folder = Path(arguments[0])
    if arguments[1:2] == ["figure"]:
        draw(_chosen(folder, arguments[3:]), Path(arguments[2]))
        return
    if arguments[1:2] == ["table"]:
        names = arguments[2:]
    else:
        count, processes = (*map(int, arguments[1:3]), SEEDS * PEOPLE, 2)[:2]
        names = arguments[3:]
        chosen = {name: VARIANTS[name] for name in names or VARIANTS}
        make_priors(folder, processes, {variant.prior for variant in chosen.values()})
        compare(folder, runs_of(count, chosen), Runner(folder), processes)
    found = _chosen(folder, names)
    print(table(found))
    for level in LEVELS:
        for name in dict.fromkeys(run.variant for run in found):
            if name != BASELINE:
                print(paired(found, name, level))
    print(json.dumps({"runs": len(found), "simulated": True}))


if __name__ == "__main__":
    main(sys.argv[1:])
