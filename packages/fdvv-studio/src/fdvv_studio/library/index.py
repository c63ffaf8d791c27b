"""The rows of every button of the catalogue, read in the background and kept up to date.

Files are read by processes at low priority, so that none can stop the index. Such a process takes a file a
line on its standard input, as JSON, and answers each with a line. It ends when its input does, so none is
left behind however its parent ends.
"""

from __future__ import annotations

import contextlib
import os
import subprocess
import sys
import time
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, field
from functools import cache
from pathlib import Path
from queue import SimpleQueue
from threading import Event, Thread, Timer

import msgspec

from fdvv.errors import FdvvError
from fdvv.io.documents import MODEL, own_kind
from fdvv.model.file import builtin_names, load_builtin
from fdvv_studio.library.catalog import ButtonFile, Catalog
from fdvv_studio.library.figures import UNREADABLE, refusal, row_of_file, row_of_model
from fdvv_studio.library.library import cache_lines
from fdvv_studio.library.row import ButtonRow, CacheLine, Origin, add_to_cache, read_cache, write_cache

LONGEST_s = 60.0
"""A file that takes longer is given up; the slowest of the real ones takes 0.3 s."""


class ReadRequest(msgspec.Struct, frozen=True):
    """A file to read: its path as the system's bytes, and what its row shall say."""

    path: bytes
    id: str
    collection: str
    origin: Origin


class ReadAnswer(msgspec.Struct, frozen=True):
    """The row of a file, or the reason why it has none; neither if the file is another kind of fdvv's own."""

    row: ButtonRow | None = None
    reason: str = ""


def read_row(ask: ReadRequest) -> ReadAnswer:
    """Read one file; whatever it holds, an answer comes."""
    path = Path(os.fsdecode(ask.path))
    kind = own_kind(path)
    if kind and kind != MODEL:
        return ReadAnswer()
    try:
        return ReadAnswer(row_of_file(path, ask.id, ask.collection, ask.origin))
    except UNREADABLE as error:
        return ReadAnswer(reason=refusal(error))


class RowReader:
    """The parent's side of a process that reads; it is started on the first file, and again if it dies."""

    def __init__(self, longest_s: float = LONGEST_s) -> None:
        self._longest_s = longest_s
        self._process: subprocess.Popen[bytes] | None = None

    def read(self, ask: ReadRequest) -> ReadAnswer:
        """Read one file; one that kills the reader or takes too long is refused with that reason."""
        if self._process is not None and self._process.poll() is not None:
            self.close()
        process = self._process = self._process or _start_reader()
        assert process.stdin is not None
        assert process.stdout is not None
        watch = Timer(self._longest_s, process.kill)
        watch.daemon = True
        watch.start()
        try:
            process.stdin.write(msgspec.json.encode(ask) + b"\n")
            process.stdin.flush()
            line = process.stdout.readline()
            return msgspec.json.decode(line, type=ReadAnswer)
        except (OSError, ValueError, msgspec.MsgspecError):
            self.close()
            return ReadAnswer(
                reason=f"whole file: reading it failed or took over {self._longest_s:g} s; check it"
            )
        finally:
            watch.cancel()

    def close(self) -> None:
        """End the process; a second time does nothing."""
        process, self._process = self._process, None
        if process is not None:
            process.kill()
            process.wait()
            for pipe in (process.stdin, process.stdout):
                with contextlib.suppress(OSError):
                    if pipe:
                        pipe.close()


def _start_reader() -> subprocess.Popen[bytes]:
    """Start a process and wait until it can read, so that its start is not counted as a file's time."""
    command = [sys.executable, "-c", "from fdvv_studio.library.index import serve_rows; serve_rows()"]
    process = subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE)
    assert process.stdout is not None
    process.stdout.readline()
    return process


def serve_rows() -> None:
    """Say that it is ready, then answer until the input ends."""
    if hasattr(os, "nice"):
        os.nice(5)  # the studio's answers come first
    answers = sys.stdout.buffer
    answers.write(b"ready\n")
    answers.flush()
    for line in sys.stdin.buffer:
        answers.write(msgspec.json.encode(read_row(msgspec.json.decode(line, type=ReadRequest))) + b"\n")
        answers.flush()


TELL_s, SAVE_s = 0.1, 2.0
"""How often progress is reported and what was read is saved."""


@dataclass(frozen=True)
class RefusedFile:
    """A file that cannot be used, and why."""

    place: str
    reason: str


@dataclass
class IndexStatus:
    """What the index knows: rows and refusals only grow, until another scan replaces the whole.

    Attributes
    ----------
    epoch : counts the scans that changed something; positions of rows hold within one.
    done, total : files looked at and to look at.
    ended : whether the scan is over.
    trouble : why nothing could be saved; empty if all is well.
    """

    epoch: int
    rows: list[ButtonRow] = field(default_factory=list)
    refused: list[RefusedFile] = field(default_factory=list)
    done: int = 0
    total: int = 0
    ended: bool = False
    trouble: str = ""


class CatalogIndex:
    """Reads rows in the background: at the start, and again whenever asked.

    Parameters
    ----------
    catalog : whose buttons.
    cache : the file that survives a restart.
    tell : called from the background whenever something changed, at most ten times a second.
    workers : processes that read files, by default one for every core, at most four; 0 reads without any.
    libraries : folders of libraries (fdvv library build) of the same files, which are not read again.
    """

    def __init__(
        self,
        catalog: Catalog,
        cache: Path,
        tell: Callable[[IndexStatus], None] = lambda _: None,
        workers: int | None = None,
        libraries: Sequence[Path] = (),
    ) -> None:
        self._libraries = tuple(libraries)
        self.status = IndexStatus(0, list(builtin_rows()))
        self._catalog, self._cache, self._tell = catalog, cache, tell
        self._workers = min(4, os.cpu_count() or 1) if workers is None else workers
        self._wanted, self._closing = Event(), Event()
        self._content: list[tuple[str, str]] | None = None
        self._thread = Thread(target=self._run, name="catalog-index", daemon=True)

    def start(self) -> None:
        """Begin; the first scan runs at once."""
        self._wanted.set()
        self._thread.start()

    def rescan(self) -> None:
        """Scan the folders again, after the scan in progress."""
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
        files = self._catalog.scan()
        content = [(file.id, file.stamp) for file in files]
        if content == self._content:
            self._tell(self.status)
            return
        trouble, cached = self._from_libraries()
        cached |= read_cache(self._cache)
        known = [line for file in files if (line := cached.get(file.place)) and line.stamp == file.stamp]
        status = IndexStatus(self.status.epoch + 1, list(builtin_rows()), total=len(files))
        for line in known:
            _count_line(status, line)
        status.trouble = trouble
        self.status = status
        self._tell(status)
        places = {line.place for line in known}
        missing = [file for file in files if file.place not in places]
        # also where only something is gone: the cache grows, and is written anew here alone
        if missing or len(known) < len(cached):
            self._save(status, lambda: write_cache(self._cache, known))
            self._read(missing, status)
        if not self._closing.is_set():
            status.ended, self._content = True, content
        self._tell(status)

    def _from_libraries(self) -> tuple[str, dict[str, CacheLine]]:
        """Return the reason why libraries cannot be used, if so, and their lines by place."""
        try:
            lines = {line.place: line for folder in self._libraries for line in cache_lines(folder)}
        except FdvvError as error:
            return str(error), {}
        return "", lines

    def _read(self, files: Sequence[ButtonFile], status: IndexStatus) -> None:
        """Read files into the status and, every now and then, into the cache."""
        unsaved: list[CacheLine] = []
        reported = saved = time.monotonic()
        for line in self._lines(files):
            _count_line(status, line)
            unsaved.append(line)
            now = time.monotonic()
            if now - reported >= TELL_s:
                reported = now
                self._tell(status)
            if now - saved >= SAVE_s:
                saved = now
                self._add(status, unsaved)
        self._add(status, unsaved)

    def _add(self, status: IndexStatus, unsaved: list[CacheLine]) -> None:
        lines = tuple(unsaved)
        unsaved.clear()
        self._save(status, lambda: add_to_cache(self._cache, lines))

    def _save(self, status: IndexStatus, write: Callable[[], None]) -> None:
        try:
            write()
        except OSError as error:
            status.trouble = f"{self._cache}: cannot be written ({error.strerror}); it is read anew next time"

    def _lines(self, files: Sequence[ButtonFile]) -> Iterator[CacheLine]:
        """Read files with all readers at once, in order; ends early when closing."""
        readers = [RowReader() for _ in range(min(self._workers, len(files)))]
        free: SimpleQueue[RowReader] = SimpleQueue()
        for reader in readers:
            free.put(reader)

        def read_line(file: ButtonFile) -> CacheLine | None:
            if self._closing.is_set():
                return None
            ask = ReadRequest(os.fsencode(file.path), file.id, file.collection, file.origin)
            reader = free.get() if readers else None
            answer = reader.read(ask) if reader else read_row(ask)
            if reader:
                free.put(reader)
            return CacheLine(file.place, file.stamp, answer.row, answer.reason)

        try:
            with ThreadPoolExecutor(max(1, len(readers))) as pool:
                for line in pool.map(read_line, files):
                    if line is None:
                        return
                    yield line
        finally:
            for reader in readers:
                reader.close()


def _count_line(status: IndexStatus, line: CacheLine) -> None:
    if line.row is not None:
        status.rows.append(line.row)
    elif line.reason:
        status.refused.append(RefusedFile(line.place, line.reason))
    status.done += 1


@cache
def builtin_rows() -> tuple[ButtonRow, ...]:
    """Return the rows of the built-in buttons, which do not change."""
    names = builtin_names()
    return tuple(row_of_model(load_builtin(name), f"builtin:{name}", Origin.BUILTIN) for name in names)
