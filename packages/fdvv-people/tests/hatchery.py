"""Processes that are killed at any moment, each forked from one in which all imports are done.

So a kill costs milliseconds and falls into the work.
"""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time
from collections.abc import Callable

from tests.support.checkout import REPOSITORY


def fork_and_kill(live: Callable[..., None]) -> None:
    """Fork a process for every line of standard input, kill it, and tell what it had acknowledged.

    A line holds words for the process, after how many acknowledgements it is killed, and how long after. live
    is called in it with the words and the descriptor to write acknowledgements into, a line each.
    """
    _tell("ready")
    for line in sys.stdin:
        *words, after, after_s = line.rstrip("\n").split("\t")
        output, into = os.pipe()
        child = os.fork()
        if child == 0:
            live(*words, into)
        os.close(into)
        with os.fdopen(output) as stream:
            said = "".join(stream.readline() for _ in range(int(after)))
            time.sleep(float(after_s))
            os.kill(child, signal.SIGKILL)
            _, status = os.waitpid(child, 0)
            assert os.WTERMSIG(status) == signal.SIGKILL
            _tell("\t".join((said + stream.read()).split("\n")[:-1]))


def _tell(line: str) -> None:
    sys.stdout.write(f"{line}\n")
    sys.stdout.flush()


class Hatchery:
    """A process that starts lives and kills them. module : whose `hatch` it runs, with words."""

    def __init__(self, module: str, *words: str) -> None:
        code = f"import sys; from {module} import hatch; hatch(*sys.argv[1:])"
        self._process = subprocess.Popen(
            [sys.executable, "-c", code, *words],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            text=True,
            cwd=REPOSITORY,
        )
        assert self._line() == "ready"

    def _line(self) -> str:
        assert self._process.stdout is not None
        return self._process.stdout.readline().rstrip("\n")

    def killed(self, *words: object, after: int = 0, after_s: float) -> list[str]:
        """Kill a process so long after so many acknowledgements; return all of them."""
        assert self._process.stdin is not None
        self._process.stdin.write("\t".join(map(str, (*words, after, after_s))) + "\n")
        self._process.stdin.flush()
        return [line for line in self._line().split("\t") if line]

    def close(self) -> None:
        self._process.communicate(timeout=30)
        assert self._process.returncode == 0
