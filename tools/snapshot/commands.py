"""Run commands of fdvv in a worker process and get what they print."""

from __future__ import annotations

import json
import os
import subprocess
import sys
import tempfile
from dataclasses import dataclass
from pathlib import Path
from types import TracebackType

ROOT = Path(__file__).resolve().parents[2]


@dataclass(frozen=True)
class Printed:
    """What a command printed, and its exit status."""

    output: bytes
    errors: str
    status: int


class Commands:
    """A process that runs commands until it is left: ``with Commands() as commands``.

    cpu_s : processor time of all commands so far.
    """

    cpu_s = 0.0

    def __enter__(self) -> Commands:
        self._scratch = tempfile.TemporaryDirectory(prefix="snapshot-")
        self._worker = subprocess.Popen(
            [sys.executable, "-m", "tools.snapshot.worker"],
            cwd=ROOT,
            env=environment(),
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            text=True,
        )
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        with self._worker, self._scratch:
            pass

    def run(self, words: list[str], folder: Path) -> Printed:
        """Run a command in a folder."""
        output, errors = (Path(self._scratch.name, name) for name in ("output", "errors"))
        assert self._worker.stdin
        assert self._worker.stdout
        request = {"words": words, "folder": str(folder), "output": str(output), "errors": str(errors)}
        print(json.dumps(request), file=self._worker.stdin, flush=True)
        line = self._worker.stdout.readline()
        if not line:
            raise RuntimeError(f"the worker ended with status {self._worker.wait()}")
        answer = json.loads(line)
        self.cpu_s += answer["cpu_s"]
        return Printed(output.read_bytes(), errors.read_text(), answer["status"])


def environment() -> dict[str, str]:
    """Return an environment in which colours, widths and threads are the same everywhere."""
    kept = {
        key: value for key, value in os.environ.items() if not key.startswith(("FDVV_", "COLUMNS", "FORCE_"))
    }
    return kept | {
        "NO_COLOR": "1",
        "COLUMNS": "100",
        "OPENBLAS_NUM_THREADS": "1",
        "LC_ALL": "C.UTF-8",
        "TZ": "UTC",
    }
