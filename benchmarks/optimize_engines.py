"""Engines against the plain GP-EI baseline, on simulated people with scores of 20 presses. Simulated; hours.

Run as ``python -m benchmarks.optimize_engines FOLDER [runs] [processes] [engine ...]``: every finished run is
kept in FOLDER, the same command goes on, and a table is printed of what is there; ``... FOLDER table`` only
prints, ``... FOLDER figure FILE`` draws. Engines are those of VARIANTS, all by default. Run i is one seed and
one person at both levels; 600 runs are 20 seeds times 30 people, and any multiple of 60 of the first ones has
every person and every seed equally often. Engines that are not the question stop after the first 60.

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
from typing import Any, Literal

import numpy as np

from benchmarks.optimize_people import FIRST_SEED, SHIFTED, Person
from fdvv.errors import InputError
from fdvv.journal import Journal, JournalKind, read_records
from fdvv.optimize import Design, Problem, Score, Trial, engine_of, paper_space
from fdvv.units import FloatArray
from fdvv.workflow import (
    PopulationPlan,
    open_executor,
    optimise,
    read_population,
    run_population,
)

SEEDS, PEOPLE = 20, 30
Level = Literal["easy", "hard"]
LEVELS: tuple[Level, ...] = ("easy", "hard")
LOOKS = (1, 2, 3, 5, 8, 10, 12, 15, 18, 21, 25, 30)
"""After how many evaluations a recommendation is judged."""
OTHERS: Mapping[str, tuple[int, Mapping[str, float]]] = {"usual": (24, {}), "shifted": (8, SHIFTED)}
"""Whose scores a warm start begins from: how many people, and how they differ from the judged ones."""
BUDGET, BASELINE = 30, "gp-ei"
PRIOR_SEED = 11
"""Of the people whose scores others begin from; below FIRST_SEED, so none of them is judged."""
RUNS_FILE = "runs.jsonl"
KIND = JournalKind(frozenset({"run"}), "begin anew in another folder")


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
    "gp, warm": Variant("gp", prior="usual", budget=BUDGET // 2, runs=SEEDS * PEOPLE),
    "gp, wrong warm": Variant("gp", prior="shifted", budget=BUDGET // 2),
    "gp": Variant("gp"),
    "tpe": Variant("tpe"),
    "tpe, warm": Variant("tpe", prior="usual", budget=BUDGET // 2),
    "random": Variant("random"),
    "sobol": Variant("sobol"),
}
SMOOTHED = f"{BASELINE}, mean"
"""The baseline's own trials, its answer the design with the best posterior mean instead of the best score."""


@dataclass(frozen=True)
class Run:
    """A variant on one seed, person and level."""

    variant: str
    number: int
    level: str

    @property
    def seed(self) -> int:
        """Get the seed of the engine and of the presses."""
        return FIRST_SEED + self.number % SEEDS

    @property
    def person(self) -> int:
        """Get the person; over 60 runs seeds and people meet in pairs that do not come again within 600."""
        return (self.number + self.number // 60) % PEOPLE


@dataclass(frozen=True)
class Runner:
    """Makes runs: what an engine recommends after every evaluation, and what that is worth."""

    folder: Path
    people_seed: int = FIRST_SEED
    variants: Mapping[str, Variant] = field(default_factory=lambda: dict(VARIANTS))

    def __call__(self, run: Run) -> dict[str, list[float]]:
        """Give the true values (ms) after LOOKS evaluations, by variant: the baseline answers in two ways."""
        variant = self.variants[run.variant]
        person = Person(self.people_seed, run.person, run.level)
        prior = prior_of(self.folder, variant.prior, run.level) if variant.prior else ()
        problem = Problem(paper_space(), person.task.objectives, run.seed, prior)
        engine = engine_of(variant.engine, variant.options)

        def evaluate(design: Design, trial: int) -> dict[str, Score]:
            return person.score(design, 1000 * run.seed + trial)

        trials = optimise(engine, problem, evaluate, variant.budget)
        answers = {run.variant: engine}
        if run.variant == BASELINE:
            answers[SMOOTHED] = engine_of("gp-ei", {"smoothed": True})
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
    """Give the trials of others, from their finished grid."""
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


def common(found: Mapping[Run, list[float]]) -> dict[Run, list[float]]:
    """Keep the seeds, people and levels that every variant has met: only these can be compared."""
    variants = {run.variant for run in found}
    met = {
        (number, level)
        for number, level in {(run.number, run.level) for run in found}
        if all(Run(name, number, level) in found for name in variants)
    }
    return {run: values for run, values in found.items() if (run.number, run.level) in met}


def _kept(path: Path) -> Iterator[tuple[Run, list[float]]]:
    for record, _ in read_records(path, KIND):
        one = record["run"]
        yield Run(one["variant"], one["number"], one["level"]), one["values"]


def curves(found: Mapping[Run, Sequence[float]], variant: str, level: str) -> FloatArray:
    """Gather what a variant reached, (runs, evaluations)."""
    return np.array([v for run, v in found.items() if (run.variant, run.level) == (variant, level)])


def reached_after(found: Mapping[Run, Sequence[float]], variant: str, level: str, count: int) -> FloatArray:
    """Give what a variant reached after so many evaluations, (runs,)."""
    return curves(found, variant, level)[:, LOOKS.index(count)]


def needed(reached: FloatArray, final: float) -> int | None:
    """Give after how many evaluations the median is at least as good as a final one, and stays so."""
    good = np.median(reached, axis=0) <= final
    stays = np.logical_and.accumulate(good[::-1])[::-1]
    return LOOKS[int(np.argmax(stays))] if stays.any() else None


def table(found: Mapping[Run, Sequence[float]]) -> str:
    """Write the comparison as a Markdown table."""
    half = BUDGET // 2
    lines = [
        f"| engine | level | runs | after {half}: median (5-95 %) ms | after {BUDGET} "
        "| as good as the baseline's final |",
        "|---|---|---|---|---|---|",
    ]
    for level in LEVELS:
        final = float(np.median(curves(found, BASELINE, level)[:, -1]))
        for name in dict.fromkeys(run.variant for run in found):
            reached = curves(found, name, level)
            whole = reached.shape[1] == len(LOOKS)
            last = _spread(reached[:, -1]) if whole else "-"
            after = needed(reached, final)
            told = f"after {after}" if after else f"not within {BUDGET if whole else half}"
            reach = f"{len(reached)} | {_spread(reached_after(found, name, level, half))} | {last}"
            lines.append(f"| {name} | {level} | {reach} | {told} |")
    return "\n".join(lines)


def paired(found: Mapping[Run, Sequence[float]], variant: str, level: str) -> str:
    """Tell on how many pairs of runs a variant is at least as good after half the evaluations."""
    gains = [
        found[Run(BASELINE, run.number, level)][-1] - values[LOOKS.index(BUDGET // 2)]
        for run, values in found.items()
        if (run.variant, run.level) == (variant, level)
    ]
    share = 100 * np.mean(np.array(gains) >= 0)
    told = f"better or equal on {share:.0f} % of {len(gains)}; gain {_spread(np.array(gains))} ms"
    return f"{variant}, {level}: {told}"


def _spread(values: FloatArray) -> str:
    low, middle, high = np.percentile(values, [5, 50, 95])
    return f"{middle:.1f} ({low:.1f}-{high:.1f})"


def draw(found: Mapping[Run, Sequence[float]], path: Path) -> None:
    """Draw medians over evaluations, one panel a level."""
    from matplotlib.figure import Figure

    figure = Figure(figsize=(9, 4.2), layout="constrained")
    for axes, level in zip(figure.subplots(1, 2, sharey=True), LEVELS, strict=True):
        for name in dict.fromkeys(run.variant for run in found):
            reached = curves(found, name, level)
            n = LOOKS[: reached.shape[1]]
            (line,) = axes.plot(
                n, np.median(reached, axis=0), label=name, lw=2.5 if name == BASELINE else 1.3
            )
            if name in (BASELINE, "gp, warm"):
                low, high = np.percentile(reached, [5, 95], axis=0)
                axes.fill_between(n, low, high, alpha=0.12, color=line.get_color(), lw=0)
        axes.set(title=f"{level}, simulated", xlabel="evaluations", ylim=(None, 150))
        axes.axhline(np.median(curves(found, BASELINE, level)[:, -1]), color="grey", lw=0.8, ls=":")
    figure.axes[0].set_ylabel("expected asynchrony (ms)")
    figure.axes[1].legend(fontsize=7)
    figure.savefig(path)


def main(arguments: Sequence[str]) -> None:
    """Make what is missing and print what is there."""
    folder = Path(arguments[0])
    if arguments[1:2] == ["figure"]:
        draw(common(dict(_kept(folder / RUNS_FILE))), Path(arguments[2]))
        return
    if arguments[1:2] != ["table"]:
        count, processes = (*map(int, arguments[1:3]), SEEDS * PEOPLE, 2)[:2]
        chosen = {name: VARIANTS[name] for name in arguments[3:] or VARIANTS}
        make_priors(folder, processes, {variant.prior for variant in chosen.values()})
        compare(folder, runs_of(count, chosen), Runner(folder), processes)
    found = common(dict(_kept(folder / RUNS_FILE)))
    print(table(found))
    for level in LEVELS:
        for name in dict.fromkeys(run.variant for run in found):
            if name != BASELINE:
                print(paired(found, name, level))
    print(json.dumps({"runs": len(found), "simulated": True}))


if __name__ == "__main__":
    main(sys.argv[1:])
