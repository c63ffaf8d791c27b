"""Map work over chunks in other processes, here or on a cluster, with the same results wherever it runs.

A chunk must hold all that decides its result, its seed included. Then neither where chunks run, nor in which
order, nor a process that was killed in between can change what is found.
"""

from __future__ import annotations

import contextlib
import multiprocessing
import signal
import sys
import traceback
from collections import Counter, deque
from collections.abc import Callable, Generator, Iterator, Sequence
from dataclasses import dataclass
from multiprocessing.connection import Connection, wait
from typing import Any, Protocol, TypeVar

from fdvv.errors import WorkerError

Chunk = TypeVar("Chunk")
Found = TypeVar("Found")
TRIES = 3
"""A chunk whose process ended so often is given up: it is the chunk that ends them."""
DEADLY = "every process that took it ended before it was done; look for a lack of memory"
LEAST_s = 0.05
"""What a chunk should take at least: handing one out costs up to 2 ms on a cluster."""


class Executor(Protocol):
    """Works on chunks in some processes."""

    def run(
        self, work: Callable[[Chunk], Found], chunks: Sequence[Chunk]
    ) -> Generator[tuple[int, Found], None, None]:
        """Work on every chunk; return each result with the chunk's place, in the order they are done.

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
    """Return what was found, or raise what happened instead, with the other process's trace as a note."""
    if not isinstance(found, Failed):
        return found
    error = WorkerError(f"chunk {number}: {found.reason}")
    error.add_note(found.trace)
    raise error


class ChunkLost(WorkerError):  # noqa: N818 - what became of the chunk
    """A chunk lost every process that worked on it; `number` is its place."""

    def __init__(self, number: int) -> None:
        self.number = number
        super().__init__(f"chunk {number}: {DEADLY}")


def chunks_of(items: Sequence[Chunk], each_s: float, least_s: float = LEAST_s) -> list[tuple[Chunk, ...]]:
    """Cut items, each of which takes about each_s, into runs that are worth handing out."""
    size = max(1, round(-(-least_s // each_s)))
    return [tuple(items[i : i + size]) for i in range(0, len(items), size)]


class ProcessExecutor:
    """Works on chunks in a number of processes of this machine; see Executor."""

    def __init__(self, processes: int) -> None:
        self._processes = processes

    def run(
        self, work: Callable[[Chunk], Found], chunks: Sequence[Chunk]
    ) -> Generator[tuple[int, Found], None, None]:
        pool = _Pool(work, chunks)
        try:
            pool.fill(self._processes)
            while pool.busy:
                for number, found in pool.next():
                    yield number, found_or_raised(number, found)
                pool.fill(self._processes)
        finally:
            pool.close()


class _Pool:
    """The processes of one run, and which chunk each of them is at."""

    def __init__(self, work: Callable[[Any], Any], chunks: Sequence[Any]) -> None:
        self._work, self._chunks = work, chunks
        self._waiting = deque(range(len(chunks)))
        self._tries = Counter[int]()
        self.busy: dict[Connection, tuple[_Worker, int]] = {}

    def fill(self, processes: int) -> None:
        """Start processes as long as chunks wait for one."""
        while self._waiting and len(self.busy) < processes:
            self._hand_out(_Worker(self._work))

    def next(self) -> list[tuple[int, Any]]:
        """Wait until a process has answered or is lost; return the answers."""
        answers = []
        for line in wait(list(self.busy)):
            assert isinstance(line, Connection)
            worker, number = self.busy.pop(line)
            try:
                answers.append((number, line.recv()))
            except (EOFError, OSError):
                worker.end()
                self._again(number)
                continue
            self._hand_out(worker)
        return answers

    def close(self) -> None:
        for worker, _ in self.busy.values():
            worker.end()
        self.busy.clear()

    def _hand_out(self, worker: _Worker) -> None:
        if not self._waiting:
            worker.end()
            return
        number = self._waiting.popleft()
        self.busy[worker.line] = worker, number
        with contextlib.suppress(OSError):  # if it is lost, next() reads that from its line
            worker.line.send(self._chunks[number])

    def _again(self, number: int) -> None:
        self._tries[number] += 1
        if self._tries[number] >= TRIES:
            raise ChunkLost(number)
        self._waiting.appendleft(number)


class _Worker:
    """A process that answers chunks; `line` ends when it does."""

    def __init__(self, work: Callable[[Any], Any]) -> None:
        context = multiprocessing.get_context("spawn")
        self.line, far = context.Pipe()
        self._process = context.Process(target=_serve, args=(far, work), daemon=True)
        with _deaf_to_ctrl_c():
            self._process.start()
        far.close()

    def end(self) -> None:
        self._process.kill()
        self._process.join()
        self._process.close()
        self.line.close()


@contextlib.contextmanager
def _deaf_to_ctrl_c() -> Iterator[None]:
    """Start processes that do not hear Ctrl-C: it reaches all of the terminal and is this one's to answer."""
    if sys.platform == "win32":
        yield  # nothing to block there; the process looks away itself once it runs
        return
    # what is blocked here stays so in what is started
    before = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)


def _serve(line: Connection, work: Callable[[Any], Any]) -> None:
    """Answer chunks until the other side has ended, however that came about."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    try:
        while True:
            line.send(answered(work, line.recv()))
    except (EOFError, OSError):
        return
