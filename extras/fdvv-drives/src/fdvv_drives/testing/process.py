"""A far end in a process of its own, as tests and benchmarks use it."""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path
from typing import Any, Self

from fdvv_drives.testing.far_end import FaultKind


class FarProcess:
    """``fdvv_drives.testing.serve`` in a process, so that its physics does not slow the loop of the host.

    Attributes
    ----------
    stage : its stage file.
    """

    def __init__(self, kind: str, folder: Path, *options: str) -> None:
        command = [sys.executable, "-m", "fdvv_drives.testing.serve", kind, str(folder), *options]
        self._process = subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)
        assert self._process.stdout is not None
        self.stage = Path(self._process.stdout.readline().strip())

    def ask(self, **order: Any) -> dict[str, Any]:
        assert self._process.stdin is not None
        assert self._process.stdout is not None
        self._process.stdin.write(json.dumps(order) + "\n")
        self._process.stdin.flush()
        answer: dict[str, Any] = json.loads(self._process.stdout.readline())
        return answer

    def press(self, travel_mm: float, velocity_mm_s: float) -> None:
        """Have the hand press once, from now on; what a DriveDevice calls when it is armed."""
        self.ask(press=[travel_mm, velocity_mm_s])

    def fault(self, kind: FaultKind) -> None:
        self.ask(fault=kind)

    def force_N(self) -> float:
        """Return the force that the drive commands at the moment."""
        return float(self.ask(state=1)["force_N"])

    def close(self) -> None:
        assert self._process.stdin is not None
        assert self._process.stdout is not None
        self._process.stdin.close()
        self._process.wait(10)
        self._process.stdout.close()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()
