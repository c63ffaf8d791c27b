"""What more processes gain for a sweep, and what dask costs beside them. Simulated; minutes.

    python -m benchmarks.sweep_scaling [REPEATS]

The same sweep (compensate and probe on drawn rigs, 16 cells a repeat) by one process, by two, and by two
dask workers on loopback. Wall time says what a person waits, but only on an idle machine; the processor
time over that of one process says what sharing out costs, and holds on a busy one too. The results are
compared to the byte.
"""

from __future__ import annotations

import hashlib
import os
import sys
import tempfile
import time
from pathlib import Path

from benchmarks.library_build import Used, children_s, watched
from fdvv.parallel.open import open_executor
from fdvv_campaigns.sweep.plan import SweepPlan
from fdvv_campaigns.sweep.sweep import RESULTS, run_sweep


def plan(repeats: int) -> SweepPlan:
    """Make the sweep."""
    return SweepPlan(
        format="fdvv-sweep",
        version=1,
        measure="probe",
        seed=1,
        factors={
            "rig": {"draw": 4},
            "button": ["mx-clear", "mx-red"],
            "method": ["none", "rig-aware"],
            "repeat": repeats,
        },
        settings={"presses": 2, "velocities_mm_s": [50.0, 100.0, 200.0]},
    )


def timed(asked: SweepPlan, processes: int | None, workers: int | None) -> tuple[Used, str]:
    """Run the sweep; give what it took and a digest of its rows."""
    used, wall, processor = Used(), time.perf_counter(), children_s() + time.process_time()
    with tempfile.TemporaryDirectory() as place, watched(os.getpid(), used):
        with open_executor(processes, workers) as executor:
            run_sweep(asked, Path(place) / "run", executor)
        digest = hashlib.sha256((Path(place) / "run" / RESULTS).read_bytes()).hexdigest()
    used.wall_s = time.perf_counter() - wall
    used.processor_s = children_s() + time.process_time() - processor
    return used, digest


def main(repeats: int = 8) -> None:
    """Print the figures."""
    asked = plan(repeats)
    load = f"load of the machine before: {os.getloadavg()[0]:.1f} on {os.cpu_count()} cores"
    print(f"{asked.count} cells (simulated); {load}")
    alone, first = timed(asked, 1, None)
    print(summary("1 process", alone, alone))
    for name, processes, workers in (("2 processes", 2, None), ("2 dask workers", None, 2)):
        used, digest = timed(asked, processes, workers)
        print(f"{summary(name, used, alone)}; rows {'the same' if digest == first else 'DIFFER'}")


def summary(name: str, used: Used, alone: Used) -> str:
    """Write what a run took beside that of one process."""
    return (
        f"{name}: wall {used.wall_s:.1f} s, {alone.wall_s / used.wall_s:.2f} times as fast; processor "
        f"{used.processor_s:.1f} s, {used.processor_s / alone.processor_s:.2f} times as much; memory of all "
        f"processes {used.memory_MB:.0f} MB"
    )


if __name__ == "__main__":
    main(*map(int, sys.argv[1:2]))
