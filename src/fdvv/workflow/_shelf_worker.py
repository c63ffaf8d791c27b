"""A process that reads files for the shelf, one after another, at low priority.

It takes a file a line on its standard input, as JSON, and answers each with a line. It ends when its input
does, so none is left behind however its parent ends.
"""

from __future__ import annotations

import contextlib
import os
import subprocess
import sys
from pathlib import Path
from threading import Timer

import msgspec

from fdvv.errors import FdvvError, InputError
from fdvv.workflow._fit import one_line
from fdvv.workflow._kind import MODEL, own_kind
from fdvv.workflow._shelf_read import row_of_file
from fdvv.workflow._shelf_row import Origin, ShelfRow

LONGEST_s = 60.0
"""A file that takes longer is given up; the slowest of the real ones takes 0.3 s."""


class ReadAsk(msgspec.Struct, frozen=True):
    """A file to read: its path as the system's bytes, and what its row shall say."""

    path: bytes
    id: str
    collection: str
    origin: Origin


class ReadAnswer(msgspec.Struct, frozen=True):
    """The row of a file, or the reason why it has none; neither if the file is another kind of fdvv's own."""

    row: ShelfRow | None = None
    reason: str = ""


def read(ask: ReadAsk) -> ReadAnswer:
    """Read one file; whatever it holds, an answer comes."""
    path = Path(os.fsdecode(ask.path))
    kind = own_kind(path)
    if kind and kind != MODEL:
        return ReadAnswer()
    try:
        return ReadAnswer(row_of_file(path, ask.id, ask.collection, ask.origin))
    except InputError as error:
        return ReadAnswer(reason=one_line(f"{error.place}: {error.reason}; {error.remedy}"))
    except (FdvvError, OSError, ValueError, ArithmeticError, LookupError, MemoryError) as error:
        return ReadAnswer(reason=one_line(f"whole file: cannot be read ({error}); check the file"))


class ReadProcess:
    """The parent's side of a process that reads; it is started on the first file, and again if it dies."""

    def __init__(self, longest_s: float = LONGEST_s) -> None:
        self._longest_s = longest_s
        self._process: subprocess.Popen[bytes] | None = None

    def read(self, ask: ReadAsk) -> ReadAnswer:
        """Have one file read; one that kills the reader or takes too long is answered with that reason."""
        if self._process is not None and self._process.poll() is not None:
            self.close()
        process = self._process = self._process or _started()
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


def _started() -> subprocess.Popen[bytes]:
    """Start a process and wait until it can read, so that its start is not counted as a file's time."""
    command = [sys.executable, "-c", "from fdvv.workflow._shelf_worker import main; main()"]
    process = subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE)
    assert process.stdout is not None
    process.stdout.readline()
    return process


def main() -> None:
    """Say that it is ready, then answer until the input ends."""
    if hasattr(os, "nice"):
        os.nice(5)
    answers = sys.stdout.buffer
    answers.write(b"ready\n")
    answers.flush()
    for line in sys.stdin.buffer:
        answers.write(msgspec.json.encode(read(msgspec.json.decode(line, type=ReadAsk))) + b"\n")
        answers.flush()
