"""The studio's side of one start of a job: begin the process, hear it, answer it, stop it."""

from __future__ import annotations

import signal
import subprocess
import sys
import threading
from collections.abc import Callable
from pathlib import Path

import msgspec

from fdvv.studio._job_process import STOPPED, PATIENCE_s
from fdvv.studio._messages_events import JobEnded, JobEvent

ERRORS = "errors.txt"
LARGEST_chars = 300


class JobStart:
    """A process at work on a job.

    Parameters
    ----------
    folder : of the job. run : counts the starts.
    heard : called with every event, the end not among them; over : with the end; both in one thread.
    """

    def __init__(
        self, folder: Path, run: int, heard: Callable[[JobEvent], None], over: Callable[[JobEnded], None]
    ) -> None:
        self._heard, self._over, self._stopped = heard, over, False
        self._errors = folder / ERRORS
        with self._errors.open("wb") as errors:
            # -P: what lies where the studio was started is none of Python's modules
            self._process = subprocess.Popen(
                [sys.executable, "-P", "-m", "fdvv.studio._job_process", str(folder.absolute()), str(run)],
                stdin=subprocess.PIPE,
                stdout=subprocess.PIPE,
                stderr=errors,
                start_new_session=True,
            )
        self._thread = threading.Thread(target=self._listen, name=f"job {folder.name}", daemon=True)
        self._thread.start()

    @property
    def pid(self) -> int:
        """Number of the process."""
        return self._process.pid

    def answer(self, number: int, answer: str) -> None:
        """Hand over the answer to a question; one that comes too late is lost."""
        assert self._process.stdin
        try:
            self._process.stdin.write(msgspec.json.encode((number, answer)) + b"\n")
            self._process.stdin.flush()
        except (OSError, ValueError):  # the pipe is broken, or stop() has closed it
            pass

    def stop(self) -> None:
        """Have the work stopped: what was made is kept, the device lets go. By force if that takes long."""
        self._stopped = True
        if sys.platform == "win32":
            # no process can be sent Ctrl-C there by itself; the end of its input tells it the same
            assert self._process.stdin
            self._process.stdin.close()
        else:
            self._process.send_signal(signal.SIGINT)
        force = threading.Timer(PATIENCE_s, self._process.kill)
        force.daemon = True
        force.start()

    def wait(self, timeout_s: float | None = None) -> None:
        """Wait until the end is told."""
        self._thread.join(timeout_s)

    def _listen(self) -> None:
        last = None
        assert self._process.stdin
        assert self._process.stdout
        for line in self._process.stdout:
            event: JobEvent = msgspec.json.decode(line, type=JobEvent)
            if isinstance(event, JobEnded):
                last = event
            else:
                self._heard(event)
        status = self._process.wait()
        self._process.stdin.close()
        self._process.stdout.close()
        self._over(last or self._without_word(status))

    def _without_word(self, status: int) -> JobEnded:
        """Tell of a process that ended without telling why."""
        if self._stopped:
            return JobEnded("cancelled", STOPPED)
        said = self._errors.read_text(encoding="utf-8", errors="replace").strip().splitlines()
        why = f": {said[-1][:LARGEST_chars]}" if said else ""
        return JobEnded("failed", f"the work broke off with status {status}{why}; what was made is kept")
