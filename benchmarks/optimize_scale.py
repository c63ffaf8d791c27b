"""What more processes gain for a population. Simulated; a minute on an idle machine.

Run as ``python -m benchmarks.optimize_scale [chunks]``. The same grid is scored by one process and by two,
this machine's own and those of dask. Wall time says what a person waits, but only on an idle machine; the
processor time over that of one process says what sharing out costs, and holds on a busy one too.
"""

from __future__ import annotations

import os
import resource
import sys
import tempfile
import time
from pathlib import Path

from fdvv.parallel.open import open_executor
from fdvv_people.optimize.population.plan import PopulationPlan
from fdvv_people.optimize.population.population import run_population

PEOPLE = 20


def used_s() -> float:
    """Return the processor time of this process and of all its children that have ended."""
    both = (resource.getrusage(who) for who in (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN))
    return sum(one.ru_utime + one.ru_stime for one in both)


def timed(chunks: int, processes: int | None, workers: int | None) -> tuple[float, float]:
    """Score a grid; give wall and processor time."""
    plan = PopulationPlan(kind="grid", people=PEOPLE, designs=2 * chunks, seed=1)
    wall, used = time.perf_counter(), used_s()
    with tempfile.TemporaryDirectory() as folder, open_executor(processes, workers) as executor:
        run_population(Path(folder) / "run", plan, executor)
    return time.perf_counter() - wall, used_s() - used


def main(chunks: int = 16) -> None:
    """Print the table."""
    print(f"{chunks} chunks; load of the machine before: {os.getloadavg()[0]:.1f} on {os.cpu_count()} cores")
    alone_wall, alone = timed(chunks, 1, None)
    print(f"1 process: wall {alone_wall:.1f} s, processor {alone:.1f} s")
    for name, processes, workers in (("2 processes", 2, None), ("2 dask workers", None, 2)):
        wall, used = timed(chunks, processes, workers)
        print(f"{name}: wall {wall:.1f} s, processor {used:.1f} s, {alone_wall / wall:.2f} times as fast")
        print(f"  cores in use {used / wall:.2f}, processor time over that of one process {used / alone:.2f}")


if __name__ == "__main__":
    main(*map(int, sys.argv[1:2]))
