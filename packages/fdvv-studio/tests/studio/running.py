"""A studio in a process of its own, as a person starts it."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
from pathlib import Path


class RunningStudio:
    """``fdvv studio`` on a port, a free one unless it is named. more : options.

    first : Python code that runs before it, such as to put something beside it that is not there.

    Attributes
    ----------
    address : to open, token included. base : without it. token : the secret of this run.
    """

    def __init__(
        self,
        project: Path,
        sources: tuple[Path, ...] = (),
        port: int = 0,
        more: tuple[str, ...] = (),
        first: str = "",
    ) -> None:
        begin = ["-c", f"{first}\nfrom fdvv.cli.main import main\nmain()"] if first else ["-m", "fdvv"]
        command = [sys.executable, *begin, "studio", *map(str, sources)]
        self.project = project
        self.process = subprocess.Popen(
            [*command, "--project", str(project), "--port", str(port), "--no-browser", *more],
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            text=True,
            env={**os.environ, "OPENBLAS_NUM_THREADS": "1"},
        )
        assert self.process.stdout is not None
        line = self.process.stdout.readline()
        assert line, self._said()
        self.address = line.split()[-1]
        self.base = self.address.partition("/?")[0]
        self.token = self.address.partition("token=")[2]

    def stop(self, how: int = signal.SIGINT) -> str:
        """End it, by default as Ctrl-C does; return its standard error."""
        if self.process.poll() is None:
            self.process.send_signal(how)
            self.process.wait(15)
        return self._said()

    def _said(self) -> str:
        assert self.process.stdout is not None
        assert self.process.stderr is not None
        if self.process.stderr.closed:
            return ""
        said = self.process.stderr.read()
        self.process.stdout.close()
        self.process.stderr.close()
        return said
