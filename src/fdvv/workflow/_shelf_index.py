"""The rows of every button of a shelf, read in the background and kept up to date."""

from __future__ import annotations

import os
import time
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, field
from functools import cache
from pathlib import Path
from queue import SimpleQueue
from threading import Event, Thread

from fdvv.errors import FdvvError
from fdvv.model import builtin_names, load_builtin
from fdvv.workflow._library import known_lines
from fdvv.workflow._shelf import Shelf
from fdvv.workflow._shelf_cache import CacheLine, add_to_cache, read_cache, write_cache
from fdvv.workflow._shelf_files import ShelfFile
from fdvv.workflow._shelf_read import row_of_model
from fdvv.workflow._shelf_row import Origin, ShelfRow
from fdvv.workflow._shelf_worker import ReadAsk, ReadProcess, read

TELL_s, SAVE_s = 0.1, 2.0
"""How often progress is told and what was read is saved."""


@dataclass(frozen=True)
class Refused:
    """A file that cannot be used, and why."""

    place: str
    reason: str


@dataclass
class ShelfStand:
    """What the index knows: rows and refusals only grow, until another scan replaces the whole.

    Attributes
    ----------
    epoch : counts the scans that changed something; positions of rows hold within one.
    done, total : files looked at and to look at.
    ended : whether the scan is over.
    trouble : why nothing could be saved; empty if all is well.
    """

    epoch: int
    rows: list[ShelfRow] = field(default_factory=list)
    refused: list[Refused] = field(default_factory=list)
    done: int = 0
    total: int = 0
    ended: bool = False
    trouble: str = ""


class ShelfIndex:
    """Reads rows in the background: at the start, and again whenever asked.

    Parameters
    ----------
    shelf : whose buttons.
    cache : the file that survives a restart.
    tell : called from the background whenever something changed, at most ten times a second.
    workers : processes that read files, by default one for every core, at most four; 0 reads without any.
    libraries : folders of libraries (fdvv library build) of the same files, which are not read again.
    """

    def __init__(
        self,
        shelf: Shelf,
        cache: Path,
        tell: Callable[[ShelfStand], None] = lambda _: None,
        workers: int | None = None,
        libraries: Sequence[Path] = (),
    ) -> None:
        self._libraries = tuple(libraries)
        self.stand = ShelfStand(0, list(builtin_rows()))
        self._shelf, self._cache, self._tell = shelf, cache, tell
        self._workers = min(4, os.cpu_count() or 1) if workers is None else workers
        self._wanted, self._closing = Event(), Event()
        self._content: list[tuple[str, str]] | None = None
        self._thread = Thread(target=self._run, name="shelf-index", daemon=True)

    def start(self) -> None:
        """Begin; the first scan runs at once."""
        self._wanted.set()
        self._thread.start()

    def rescan(self) -> None:
        """Have the folders looked through again, after the scan that runs."""
        self._wanted.set()

    def close(self) -> None:
        """Stop, and wait for the background to end."""
        self._closing.set()
        self._wanted.set()
        if self._thread.is_alive():
            self._thread.join()

    def _run(self) -> None:
        while self._wanted.wait() and not self._closing.is_set():
            self._wanted.clear()
            self.scan()

    def scan(self) -> None:
        """Bring the rows up to date, in the calling thread."""
        files = self._shelf.scan()
        content = [(file.id, file.stamp) for file in files]
        if content == self._content:
            self._tell(self.stand)
            return
        trouble, cached = self._from_libraries()
        cached |= read_cache(self._cache)
        known = [line for file in files if (line := cached.get(file.place)) and line.stamp == file.stamp]
        stand = ShelfStand(self.stand.epoch + 1, list(builtin_rows()), total=len(files))
        for line in known:
            _take(stand, line)
        stand.trouble = trouble
        self.stand = stand
        self._tell(stand)
        read = {line.place for line in known}
        missing = [file for file in files if file.place not in read]
        if missing or len(known) < len(cached):
            self._save(stand, lambda: write_cache(self._cache, known))
            self._read(missing, stand)
        if not self._closing.is_set():
            stand.ended, self._content = True, content
        self._tell(stand)

    def _from_libraries(self) -> tuple[str, dict[str, CacheLine]]:
        """Give what libraries know, and what is wrong with them; without them all is read."""
        try:
            found = {line.place: line for folder in self._libraries for line in known_lines(folder)}
        except FdvvError as error:
            return str(error), {}
        return "", found

    def _read(self, files: Sequence[ShelfFile], stand: ShelfStand) -> None:
        """Read files into the stand and, every now and then, into the cache."""
        unsaved: list[CacheLine] = []
        told = saved = time.monotonic()
        for line in self._lines(files):
            _take(stand, line)
            unsaved.append(line)
            now = time.monotonic()
            if now - told >= TELL_s:
                told = now
                self._tell(stand)
            if now - saved >= SAVE_s:
                saved = now
                self._add(stand, unsaved)
        self._add(stand, unsaved)

    def _add(self, stand: ShelfStand, unsaved: list[CacheLine]) -> None:
        lines = tuple(unsaved)
        unsaved.clear()
        self._save(stand, lambda: add_to_cache(self._cache, lines))

    def _save(self, stand: ShelfStand, write: Callable[[], None]) -> None:
        try:
            write()
        except OSError as error:
            stand.trouble = f"{self._cache}: cannot be written ({error.strerror}); it is read anew next time"

    def _lines(self, files: Sequence[ShelfFile]) -> Iterator[CacheLine]:
        """Read files with all readers at once, in order; ends early when closing."""
        readers = [ReadProcess() for _ in range(min(self._workers, len(files)))]
        free: SimpleQueue[ReadProcess] = SimpleQueue()
        for reader in readers:
            free.put(reader)

        def one(file: ShelfFile) -> CacheLine | None:
            if self._closing.is_set():
                return None
            ask = ReadAsk(os.fsencode(file.path), file.id, file.collection, file.origin)
            reader = free.get() if readers else None
            answer = reader.read(ask) if reader else read(ask)
            if reader:
                free.put(reader)
            return CacheLine(file.place, file.stamp, answer.row, answer.reason)

        try:
            with ThreadPoolExecutor(max(1, len(readers))) as pool:
                for line in pool.map(one, files):
                    if line is None:
                        return
                    yield line
        finally:
            for reader in readers:
                reader.close()


def _take(stand: ShelfStand, line: CacheLine) -> None:
    """Count a file, with its row or its refusal."""
    if line.row is not None:
        stand.rows.append(line.row)
    elif line.reason:
        stand.refused.append(Refused(line.place, line.reason))
    stand.done += 1


@cache
def builtin_rows() -> tuple[ShelfRow, ...]:
    """Give the rows of the built-in buttons, which do not change."""
    names = builtin_names()
    return tuple(row_of_model(load_builtin(name), f"builtin:{name}", Origin.BUILTIN) for name in names)
