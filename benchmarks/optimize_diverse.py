"""Does asking the person pay? Engines on people whose best buttons differ, against a fixed design. Simulated.

Run as ``python -m benchmarks.optimize_diverse FOLDER [runs] [processes] [engine ...]``: finished runs stay in
FOLDER, the same command goes on, and tables of what is there are printed; ``... FOLDER table`` only prints.
Run i is one seed and one of 30 people of the group `diverse` at both levels; 600 runs are 20 seeds. Designs
are those of the paper's space that are buttons. People and presses of FIRST_SEED judge; nothing was chosen on
them. Others, from whom a warm start and the fixed design come, are 24 people of another draw.

What is shown is the true value of what an engine recommends after so many evaluations.
"""

from __future__ import annotations

import io
import sys
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from benchmarks.optimize_engines import Runner, Variant, compare, kept_runs, runs_of
from benchmarks.optimize_rivals import FixedDesign, ScikitOptimize
from benchmarks.optimize_tables import BUDGET, LEVELS, LOOKS, PEOPLE, SEEDS, Run, common, curves
from fdvv.io.files import write_atomic
from fdvv.parallel.open import open_executor
from fdvv_people.optimize.engines.search import draw_feasible
from fdvv_people.optimize.population.plan import PopulationPlan
from fdvv_people.optimize.population.population import run_population
from fdvv_people.optimize.problem import Engine, Problem
from fdvv_people.stats.share import share
from fdvv_people.task.pointing import TemporalPointing

GROUP, FIRST_SEED, OTHERS_SEED = "diverse", 2000, 11
OTHERS, DESIGNS, POOL = 24, 128, 10_000
FEW = 30
"""Runs of what is not the question: every person once."""
POOL_FILE = "buttons.npy"
FIXED, DEFAULT, WARM, STRONG = "fixed design", "gp", "gp, warm", "scikit-optimize"
WHO = "others"
"""Whose scores a warm start begins from, see benchmarks.optimize_engines.prior_of."""
MAIN = (FIXED, DEFAULT, STRONG, WARM)
VARIANTS: Mapping[str, Variant] = {
    FIXED: Variant(FIXED, prior=WHO, budget=1, runs=SEEDS * PEOPLE),
    DEFAULT: Variant("gp", runs=SEEDS * PEOPLE),
    STRONG: Variant(STRONG, runs=SEEDS * PEOPLE),
    WARM: Variant("gp", prior=WHO, budget=BUDGET // 2, runs=SEEDS * PEOPLE),
    "gp-ei": Variant("gp-ei", runs=FEW),
    "gp-ei, tuned": Variant("gp-ei", {"startup": 10}, runs=FEW),
    "scikit-optimize, five random designs": Variant(STRONG, {"startup": 5}, runs=FEW),
    "tpe": Variant("tpe", runs=FEW),
    "botorch": Variant("botorch", runs=FEW),
    "sobol": Variant("sobol", runs=FEW),
    "random": Variant("random", runs=FEW),
}


@dataclass(frozen=True)
class DiverseRunner(Runner):
    """Makes runs with people of the group, in the space of buttons."""

    group: str = GROUP
    buttons: bool = True

    def engine(self, variant: Variant) -> Engine:
        if variant.engine == STRONG:
            return ScikitOptimize(np.load(self.folder / POOL_FILE), **variant.options)
        return FixedDesign() if variant.engine == FIXED else super().engine(variant)


def prepare(folder: Path, processes: int) -> None:
    """Let others score a grid and draw places that are buttons; what is there already is kept."""
    folder.mkdir(parents=True, exist_ok=True)
    with open_executor(processes) as executor:
        for level in LEVELS:
            plan = PopulationPlan(
                kind="grid",
                people=OTHERS,
                designs=DESIGNS,
                seed=OTHERS_SEED,
                level=level,
                group=GROUP,
                buttons=True,
            )
            run_population(folder / f"{WHO}-{level}", plan, executor)
    path = folder / POOL_FILE
    if not path.exists():
        rng, space = np.random.default_rng(OTHERS_SEED), PopulationPlan(buttons=True).space
        problem = Problem(space, TemporalPointing().objectives)
        places = draw_feasible(
            problem, lambda n: rng.random((8 * n, len(space.names))), np.empty((0, len(space.names))), POOL
        )
        buffer = io.BytesIO()
        np.save(buffer, places)
        write_atomic(path, buffer.getvalue())


def by_person(found: Mapping[Run, Sequence[float]], variant: str, level: str, look: int) -> dict[int, float]:
    """Return what a variant reached after a look, the median over seeds, by person."""
    at = LOOKS.index(look)
    rows: dict[int, list[float]] = {}
    for run, values in found.items():
        if (run.variant, run.level) == (variant, level):
            # a fixed design is the same after any number of trials
            rows.setdefault(run.person, []).append(values[min(at, len(values) - 1)])
    return {person: float(np.median(values)) for person, values in rows.items()}


def better_than_fixed(found: Mapping[Run, Sequence[float]], variant: str, level: str, look: int) -> str:
    """Return for how many people a variant beats the fixed design, with its 95 % interval."""
    own, fixed = (by_person(found, name, level, look) for name in (variant, FIXED))
    gains = np.array([fixed[person] - own[person] for person in own])
    counted = share(int((gains > 0).sum()), gains.size)
    low, middle, high = np.percentile(gains, [5, 50, 95])
    return (
        f"{variant}, {level}, after {look}: better than the fixed design for {100 * counted.share:.0f} % of "
        f"{gains.size} people ({100 * counted.low:.0f} to {100 * counted.high:.0f}); "
        f"gains {middle:.1f} ms ({low:.1f} to {high:.1f}), mean {gains.mean():.1f}"
    )


def table(found: Mapping[Run, Sequence[float]], level: str) -> str:
    """Write what each variant reached as a Markdown table: median (5 to 95 %) and mean over runs, ms."""
    looks = (8, 10, 15, 30)
    lines = [f"| {level} | runs | " + " | ".join(f"after {n}" for n in looks) + " |", "|---" * 6 + "|"]
    for name in dict.fromkeys(run.variant for run in found):
        reached = curves(found, name, level)
        cells = []
        for look in looks:
            at = 0 if name == FIXED else LOOKS.index(look)
            cells.append(_middle(reached[:, at]) if at < reached.shape[1] else "–")
        lines.append(f"| {name} | {len(reached)} | {' | '.join(cells)} |")
    return "\n".join(lines)


def _middle(values: np.ndarray[tuple[int], np.dtype[np.float64]]) -> str:
    low, middle, high = np.percentile(values, [5, 50, 95])
    return f"{middle:.1f} ({low:.1f} to {high:.1f}), {values.mean():.1f}"


def report(found: Mapping[Run, Sequence[float]]) -> str:
    """Write the tables of both levels and who is better off than with the fixed design."""
    lines = []
    names = {run.variant for run in found}
    for level in LEVELS:
        lines += [table(found, level), ""]
        for name, look in ((DEFAULT, 10), (STRONG, 10), (WARM, 8)):
            if {name, FIXED} <= names:
                lines.append(better_than_fixed(found, name, level, look))
        lines.append("")
    return "\n".join(lines)


def main(arguments: Sequence[str]) -> None:
    """Make what is missing and print what is there."""
    folder = Path(arguments[0])
    if arguments[1:2] != ["table"]:
        count, processes = (*map(int, arguments[1:3]), SEEDS * PEOPLE, 2)[:2]
        chosen = {name: VARIANTS[name] for name in arguments[3:] or VARIANTS}
        prepare(folder, processes)
        runner = DiverseRunner(folder, FIRST_SEED, VARIANTS)
        compare(folder, runs_of(count, chosen), runner, processes)
    found = kept_runs(folder)
    every = {run: values for run, values in found.items() if run.variant in MAIN}
    print(f"simulated; all runs of {', '.join(MAIN)}\n")
    print(report(common(every)))
    print("simulated; the runs that all made\n")
    print(report(common(found)))


if __name__ == "__main__":
    main(sys.argv[1:])
