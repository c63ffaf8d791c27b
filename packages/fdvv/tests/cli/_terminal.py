"""A command whose standard error is a terminal."""

from __future__ import annotations

import os
import pty
import subprocess
import sys
from pathlib import Path


def run_on_terminal(*arguments: str, folder: Path | None = None) -> tuple[str, str]:
    """Run fdvv, which must succeed; return its standard output and what the terminal showed."""
    screen, terminal = pty.openpty()
    command, environment = [sys.executable, "-m", "fdvv", *arguments], {**os.environ, "TERM": "xterm"}
    with subprocess.Popen(
        command, cwd=folder, stdout=subprocess.PIPE, stderr=terminal, env=environment, text=True
    ) as running:
        os.close(terminal)
        shown = b""
        try:
            while piece := os.read(screen, 4096):
                shown += piece
        except OSError:
            pass  # Linux gives an error, not an end of file, once the other side has closed
        out, _ = running.communicate(timeout=30)
    os.close(screen)
    assert running.returncode == 0, shown
    return out, shown.decode()
