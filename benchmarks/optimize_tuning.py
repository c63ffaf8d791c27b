"""The baseline and the engine gp under other settings, on people and seeds that judge nothing. Simulated.

Run as ``python -m benchmarks.optimize_tuning FOLDER [runs] [processes]``: 24 runs of both levels by default,
people and seeds of FIRST_SEED, see benchmarks.optimize_engines. What is best here is what is compared there.
"""

from __future__ import annotations

import sys
from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np

from benchmarks.optimize_engines import Runner, Variant, compare, runs_of
from benchmarks.optimize_tables import BASELINE, LEVELS, LOOKS, Run, common, curves

FIRST_SEED, RUNS = 500, 24
VARIANTS: Mapping[str, Variant] = {
    BASELINE: Variant("gp-ei"),
    "ten random designs first": Variant("gp-ei", {"startup": 10}),
    "jitter 0.1": Variant("gp-ei", {"jitter": 0.1}),
    "a length per parameter": Variant("gp-ei", {"ard": True}),
    "improves on the posterior mean": Variant("gp-ei", {"plug_in": True}),
    "the last two": Variant("gp-ei", {"ard": True, "plug_in": True}),
    "ten designs, a length per parameter": Variant("gp-ei", {"startup": 10, "ard": True}),
    "gp": Variant("gp"),
}


def main(arguments: Sequence[str]) -> None:
    """Make what is missing and print what is there."""
    folder = Path(arguments[0])
    count, processes = (*map(int, arguments[1:3]), RUNS, 2)[:2]
    runner = Runner(folder, FIRST_SEED, VARIANTS)
    found = common(compare(folder, runs_of(count, VARIANTS), runner, processes))
    print("| engine | level | after 15: median, mean ms | after 30 | after 30, less than the baseline's |")
    print("|---|---|---|---|---|")
    for level in LEVELS:
        numbers = [run.number for run in found if (run.variant, run.level) == (BASELINE, level)]
        for name in dict.fromkeys(run.variant for run in found):
            gains = [found[Run(BASELINE, i, level)][-1] - found[Run(name, i, level)][-1] for i in numbers]
            reached = curves(found, name, level)[:, [LOOKS.index(15), -1]]
            columns = (f"{np.median(one):.1f}, {np.mean(one):.1f}" for one in reached.T)
            error = np.std(gains, ddof=1) / np.sqrt(len(gains))
            print(f"| {name} | {level} | {' | '.join(columns)} | {np.mean(gains):.1f} ± {error:.1f} |")


if __name__ == "__main__":
    main(sys.argv[1:])
