"""How long does a library of thousands of curves take, in what memory, and how fast is it searched?

    python -m benchmarks.library_build [FOLDER] [FILES] [PROCESSES]

FILES (12,000) are written out of the real files of FOLDER as `benchmarks.repeated_curves` tells; without a
folder, of the built-in buttons. The library is built with PROCESSES (2), built again unchanged, with ten
files changed and ten gone, and searched. Wall time says what a person waits, but only on an idle machine;
processor time holds on a busy one too. Memory is the proportional share of all processes together, sampled
every 0.1 s, at its largest.
"""

from __future__ import annotations

import json
import os
import resource
import shutil
import subprocess
import sys
import tempfile
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from benchmarks.repeated_curves import readable, repeat_noise, shipped, write_many
from fdvv_studio.library.library import Library, library_query

EVERY_s = 0.1
WORDS = (
    "cherry",
    "gateron yel",
    "kind=tactile peak_cN>=50",
    "box navy",
    "gatreon",
    "travel_mm=3..3.5 linear",
)


@dataclass
class Used:
    """What a command took."""

    wall_s: float = 0.0
    processor_s: float = 0.0
    memory_MB: float = 0.0
    largest_process_MB: float = 0.0


def tree(root: int) -> Iterator[int]:
    """Return a process and all that it started."""
    yield root
    for task in Path(f"/proc/{root}/task").glob("*/children"):
        for child in task.read_text().split():
            yield from tree(int(child))


def share_MB(pid: int) -> float:
    """Return a process's proportional share of memory."""
    try:
        for line in Path(f"/proc/{pid}/smaps_rollup").read_text().splitlines():
            if line.startswith("Pss:"):
                return float(line.split()[1]) / 1024
    except (OSError, ValueError):
        pass
    return 0.0


@contextmanager
def watched(root: int, used: Used) -> Iterator[None]:
    """Sample the memory of a process and its children."""
    ended = threading.Event()

    def sample() -> None:
        while not ended.wait(EVERY_s):
            try:
                shares = [share_MB(pid) for pid in tree(root)]
            except OSError:
                continue
            used.memory_MB = max(used.memory_MB, sum(shares))
            used.largest_process_MB = max(used.largest_process_MB, *shares)

    thread = threading.Thread(target=sample)
    thread.start()
    try:
        yield
    finally:
        ended.set()
        thread.join()


def children_s() -> float:
    """Return the processor time of all children that have ended."""
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def ran(*arguments: str) -> tuple[Used, dict[str, object]]:
    """Run fdvv with --json; give what it took and what it said."""
    used, wall, processor = Used(), time.perf_counter(), children_s()
    command = [sys.executable, "-m", "fdvv", *arguments, "--json"]
    with subprocess.Popen(command, stdout=subprocess.PIPE) as process, watched(process.pid, used):
        assert process.stdout is not None
        said = process.stdout.read()
        process.wait()
    if process.returncode:
        raise SystemExit(f"{' '.join(command)} failed")
    used.wall_s, used.processor_s = time.perf_counter() - wall, children_s() - processor
    return used, json.loads(said)


def built(source: Path, library: Path, processes: int, what: str) -> None:
    """Build and print."""
    used, said = ran("library", "build", str(source), "--output", str(library), "--processes", str(processes))
    print(
        f"{what}: wall {used.wall_s:.1f} s, processor {used.processor_s:.1f} s, memory of all processes "
        f"{used.memory_MB:.0f} MB, of the largest {used.largest_process_MB:.0f} MB; read {said['read']}, "
        f"kept {said['kept']}, gone {said['gone']}, refused {said['refused']} of {said['files']}"
    )


def summary(what: str, times_ms: list[float]) -> str:
    """Write median and the largest."""
    return f"{what}: median {np.median(times_ms):.1f} ms, largest {max(times_ms):.1f} ms of {len(times_ms)}"


def searched(library: Path) -> None:
    """Time searches, in one process and as commands."""
    begun = time.perf_counter()
    opened = Library(library)
    print(f"opened: {time.perf_counter() - begun:.2f} s, {len(opened.rows)} buttons")
    times = []
    for words in WORDS * 3:
        begun = time.perf_counter()
        opened.find(library_query(words))
        times.append(1e3 * (time.perf_counter() - begun))
    print(summary("search in memory", times))
    opened.like("mx-clear")
    times = []
    for row in opened.rows[:: max(1, len(opened.rows) // 20)]:
        begun = time.perf_counter()
        opened.like(row.id)
        times.append(1e3 * (time.perf_counter() - begun))
    print(summary("nearest ten in memory", times))
    for command in (("search", "cherry peak_cN>=50"), ("like", "mx-clear")):
        used, _ = ran("library", command[0], str(library), command[1])
        print(f"fdvv library {command[0]}: wall {used.wall_s:.2f} s, memory {used.memory_MB:.0f} MB")


def touched(source: Path, count: int = 10) -> None:
    """Change some files and remove others."""
    files = sorted(source.rglob("*.csv"))
    for path in files[:: len(files) // count][:count]:
        path.write_bytes(path.read_bytes() + b"\n")
    for path in files[1 :: len(files) // count][:count]:
        path.unlink()


def main(folder: str = "", files: str = "12000", processes: str = "2") -> None:
    """Print the figures."""
    real = readable(Path(folder)) if folder else shipped()
    with tempfile.TemporaryDirectory() as place:
        source, library = Path(place) / "curves", Path(place) / "library"
        noise, size = write_many(real, source, int(files))
        summary = "of real repeats" if noise.from_repeats else "within a curve: no file holds repeats"
        spread = np.sqrt(np.mean(repeat_noise(real).force_cN ** 2, axis=(1, 2)))
        print(f"{files} files, {size / 1e6:.0f} MB, of {len(real)} real ones; noise {summary}: "
              f"{len(spread)} differences, root mean square {np.median(spread):.2f} cN in the median, "
              f"{spread.min():.2f} to {spread.max():.2f}")  # fmt: skip
        print(f"load of the machine before: {os.getloadavg()[0]:.1f} on {os.cpu_count()} cores")
        built(source, library, int(processes), "built")
        print(f"library: {sum(p.stat().st_size for p in library.iterdir()) / 1e6:.1f} MB")
        built(source, library, int(processes), "unchanged")
        touched(source)
        built(source, library, int(processes), "ten changed, ten gone")
        searched(library)
        shutil.rmtree(source)


if __name__ == "__main__":
    main(*sys.argv[1:4])
