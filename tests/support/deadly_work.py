"""Work on files and cells for tests, some of which ends the process, as a lack of memory would."""

from __future__ import annotations

import os
import signal
import time
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any


@dataclass(frozen=True)
class DeadlyReader:
    """Reads a library's files; those whose name holds a word end the process that reads them.

    Attributes
    ----------
    read : reads a file. word : in names of files that kill. slow_s : what every file takes at least.
    log : a folder that gets a file for each that was read; None for none.
    """

    read: Callable[[Any], Any]
    word: str = ""
    slow_s: float = 0.0
    log: Path | None = None

    def __call__(self, file: Any) -> Any:
        if self.word and self.word in file.path.name:
            os.kill(os.getpid(), signal.SIGKILL)
        time.sleep(self.slow_s)
        if self.log:
            (self.log / file.id.rpartition(":")[2]).touch()
        return self.read(file)


@dataclass(frozen=True)
class DeadlyCells:
    """Works on a sweep's cells; one of them ends the process that works on it.

    Attributes
    ----------
    work : what else is done to a chunk. fatal : number of the cell.
    """

    work: Callable[[Any], Any]
    fatal: int

    def __call__(self, cells: tuple[tuple[int, Any], ...]) -> Any:
        if any(number == self.fatal for number, _ in cells):
            os.kill(os.getpid(), signal.SIGKILL)
        return self.work(cells)
