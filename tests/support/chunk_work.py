"""Work for executors, importable from the processes that do it."""

from __future__ import annotations

import os
import signal
from dataclasses import dataclass
from pathlib import Path

import numpy as np


@dataclass(frozen=True)
class SeededSum:
    """Sums numbers drawn with a seed; processes that get a fatal seed are killed, as `kill -9` does.

    Attributes
    ----------
    folder : where a process that is about to be killed leaves a file ``died-PID``.
    fatal : the seed. deaths : how often it kills.
    """

    folder: Path
    fatal: int | None = None
    deaths: int = 1

    def __call__(self, seed: int) -> float:
        if seed == self.fatal and len(list(self.folder.glob("died-*"))) < self.deaths:
            (self.folder / f"died-{os.getpid()}").touch()
            os.kill(os.getpid(), signal.SIGKILL)
        return float(np.random.default_rng(seed).normal(size=1000).sum())


def refuse_three(seed: int) -> int:
    """Work on every seed but 3."""
    if seed == 3:
        raise ValueError("three is too many")
    return seed


def wait_for_ever(folder: Path) -> None:
    """Write the process's number to a file, then wait for ever."""
    (folder / f"{os.getpid()}.pid").touch()
    signal.pause()
