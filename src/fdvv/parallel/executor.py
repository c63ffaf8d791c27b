"""Chunks in processes of this machine, each started afresh, so that one killed takes nothing with it."""

from __future__ import annotations

import contextlib
import multiprocessing
import signal
import sys
from collections import Counter, deque
from collections.abc import Callable, Generator, Iterator, Sequence
from multiprocessing.connection import Connection, wait
from typing import Any, TypeVar

from fdvv.workflow._executor import TRIES, ChunkLost, answered, found_or_raised

Chunk = TypeVar("Chunk")
Found = TypeVar("Found")


class ProcessExecutor:
    """Works on chunks in a number of processes; see Executor."""

    def __init__(self, processes: int) -> None:
        self._processes = processes

    @property
    def processes(self) -> int:
        """Get how many work at once."""
        return self._processes

    def run(
        self, work: Callable[[Chunk], Found], chunks: Sequence[Chunk]
    ) -> Generator[tuple[int, Found], None, None]:
        """Work on every chunk; see Executor."""
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
        """Wait until a process has answered or is lost; give the answers."""
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
        """End every process, whatever it is at."""
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
        """End the process at once."""
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
