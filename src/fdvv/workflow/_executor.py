"""Map work over chunks in other processes, here or on a cluster, with the same results wherever it runs.

A chunk must hold all that decides its result, its seed included. Then neither where chunks run, nor in which
order, nor a process that was killed in between can change what is found.
"""

from __future__ import annotations

import os
import traceback
from collections.abc import Callable, Generator, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from typing import Any, Protocol, TypeVar

from fdvv.errors import WorkerError

Chunk = TypeVar("Chunk")
Found = TypeVar("Found")

TRIES = 3
"""A chunk whose process ended so often is given up: it is the chunk that ends them."""
LEAST_s = 0.05
"""What a chunk should take at least: handing one out costs up to 2 ms on a cluster."""


class Executor(Protocol):
    """Works on chunks in some processes."""

    @property
    def processes(self) -> int:
        """Get how many work at once."""
        ...

    def run(
        self, work: Callable[[Chunk], Found], chunks: Sequence[Chunk]
    ) -> Generator[tuple[int, Found], None, None]:
        """Work on every chunk; give each result with the chunk's place, in the order they are done.

        work is a function of a module, or a record that can be called; it, the chunks and what is found must
        be picklable. A process that is lost costs only the chunk it was at: that one is done again.
        Processes end when all is done, when the iterator is closed and when an error leaves it.
        Raises WorkerError if work raised anything, ChunkLost if a chunk lost every process that took it.
        """
        ...


@dataclass(frozen=True)
class Failed:
    """What work raised: many errors cannot be pickled back as they are."""

    reason: str
    trace: str


def answered(work: Callable[[Chunk], Found], chunk: Chunk) -> Found | Failed:
    """Work on a chunk, in the process where that is done."""
    try:
        return work(chunk)
    except Exception as error:
        return Failed(f"{type(error).__name__}: {error}", traceback.format_exc())


def found_or_raised(number: int, found: Any) -> Any:
    """Give what was found, or raise what happened instead, with the other process's trace as a note."""
    if not isinstance(found, Failed):
        return found
    error = WorkerError(f"chunk {number}: {found.reason}")
    error.add_note(found.trace)
    raise error


class ChunkLost(WorkerError):  # noqa: N818 - what became of the chunk
    """A chunk lost every process that worked on it; `number` is its place."""

    def __init__(self, number: int) -> None:
        self.number = number
        super().__init__(
            f"chunk {number}: every process that took it ended before it was done; look for a lack of memory"
        )


@contextmanager
def open_executor(
    processes: int | None = None, workers: int | None = None, cluster: str | None = None
) -> Iterator[Executor]:
    """Open what the options of a command ask for; it is closed when the context is left.

    Parameters
    ----------
    processes : local processes; None: as many as this process may use.
    workers : workers of a dask cluster started here, reachable from this machine only.
    cluster : address of a dask scheduler that runs already, as ``tcp://10.0.0.5:8786``. Whoever controls it
        can run code here: use none but your own.

    Raises BuildError without the extra `sweep`, InputError if nobody answers at cluster.
    """
    if workers is None and cluster is None:
        from fdvv.workflow._process_executor import ProcessExecutor

        yield ProcessExecutor(processes or len(os.sched_getaffinity(0)))
        return
    from fdvv.workflow._dask_executor import open_dask

    with open_dask(workers, cluster) as executor:
        yield executor


def chunks_of(items: Sequence[Chunk], each_s: float, least_s: float = LEAST_s) -> list[tuple[Chunk, ...]]:
    """Cut items, each of which takes about each_s, into runs that are worth handing out."""
    size = max(1, round(-(-least_s // each_s)))
    return [tuple(items[i : i + size]) for i in range(0, len(items), size)]
