"""One start of a job, as a process of its own, and its parent's side.

Ctrl-C is how the workflow is interrupted: it keeps its results and closes the device. A process of its own
can get it at any moment, and nothing it computes keeps the studio waiting. Events go out as lines of JSON,
answers come in as lines; when the studio ends the input ends, and the work stops as if it had been cancelled.
"""

from __future__ import annotations

import _thread
import contextlib
import os
import queue
import signal
import subprocess
import sys
import threading
from collections.abc import Callable
from pathlib import Path
from pkgutil import resolve_name
from typing import IO

import msgspec

from fdvv.errors import DeviceError, FdvvError
from fdvv_studio.studio.contract import error_line
from fdvv_studio.studio.devices import device_names, require_listed
from fdvv_studio.studio.jobs.events import JobEnded, JobEvent
from fdvv_studio.studio.jobs.file import JobFolder
from fdvv_studio.studio.jobs.orders import CaptureOrder, CompensateOrder, ProbeOrder, TuneOrder
from fdvv_studio.studio.jobs.work import Work

STOPPED = "stopped; what was made is kept"
CONNECT = "connect it and resume, or begin the work anew"
PATIENCE_s = 5.0
"""So long may letting go take before the process ends as it is; the device's own watch ends its force."""


class Answers:
    """Answers as they come, and the end of the studio.

    source : unbuffered, for a buffer's lock that is held while the process ends would break it off.
    """

    def __init__(self, source: IO[bytes]) -> None:
        self._source = source
        self._lines: queue.Queue[tuple[int, str]] = queue.Queue()
        threading.Thread(target=self._listen, daemon=True).start()

    def wait(self, number: int) -> str:
        """Wait for the answer to a question; one to another question is passed over."""
        while True:
            # a wait without a bound cannot be interrupted on every system
            with contextlib.suppress(queue.Empty):
                question, answer = self._lines.get(timeout=0.1)
                if question == number:
                    return answer

    def _listen(self) -> None:
        for line in self._source:
            self._lines.put(msgspec.json.decode(line, type=tuple[int, str]))
        _interrupt()
        threading.Event().wait(PATIENCE_s)
        os._exit(1)


def _interrupt() -> None:
    if sys.platform == "win32":
        _thread.interrupt_main()
    else:
        os.kill(os.getpid(), signal.SIGINT)  # breaks off what the main thread waits for, too


WORK = {
    CaptureOrder: "fdvv_studio.studio.jobs.work_capture:capture",
    CompensateOrder: "fdvv_studio.studio.jobs.work_learn:learn",
    ProbeOrder: "fdvv_studio.studio.jobs.work_learn:judge",
    TuneOrder: "fdvv_studio.studio.jobs.work_tune:tune",
}
"""What does an order; imported when it is known which, for the others need seconds."""


def work_on(work: Work) -> None:
    order = work.folder.load().order
    require_listed("device", order.device, device_names(), CONNECT)
    resolve_name(WORK[type(order)])(work, order)


def run_work(work: Work) -> JobEnded:
    """Do the work; tell how it ended."""
    try:
        work_on(work)
    except KeyboardInterrupt:
        return JobEnded("cancelled", STOPPED)
    except DeviceError as error:
        # the error says how to resume at the command line; here the job itself can be resumed
        reason = error.__cause__ if isinstance(error.__cause__, DeviceError) else error
        return JobEnded("failed", f"{reason}; what was made is kept, resume it once that is repaired")
    except (FdvvError, OSError) as error:
        return JobEnded("failed", error_line(error))
    return JobEnded("done", "")


def main() -> None:
    """Do one start of the job in the folder that the command line names."""
    # a shell lets what it starts in the background ignore Ctrl-C, and that is inherited
    signal.signal(signal.SIGINT, signal.default_int_handler)
    with os.fdopen(os.dup(1), "wb", buffering=0) as out:
        os.dup2(2, 1)  # what anything prints is no event: it goes to standard error

        def tell(event: JobEvent) -> None:
            out.write(msgspec.json.encode(event) + b"\n")

        answers = Answers(os.fdopen(os.dup(0), "rb", buffering=0))
        work = Work(JobFolder(Path(sys.argv[1])), int(sys.argv[2]), tell, answers.wait)
        last = run_work(work)
        signal.signal(signal.SIGINT, signal.SIG_IGN)
        tell(last)


if __name__ == "__main__":
    main()


ERRORS = "errors.txt"
LARGEST_chars = 300  # assumed: the last line of the errors becomes part of a line on the page


class JobStart:
    """A process at work on a job.

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
                [
                    sys.executable,
                    "-P",
                    "-m",
                    "fdvv_studio.studio.jobs.process",
                    str(folder.absolute()),
                    str(run),
                ],
                stdin=subprocess.PIPE,
                stdout=subprocess.PIPE,
                stderr=errors,
                start_new_session=True,
            )
        self._thread = threading.Thread(target=self._listen, name=f"job {folder.name}", daemon=True)
        self._thread.start()

    @property
    def pid(self) -> int:
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
        """Interrupt the work, which keeps its results and closes the device; kill it if that takes long."""
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
        if self._stopped:
            return JobEnded("cancelled", STOPPED)
        said = self._errors.read_text(encoding="utf-8", errors="replace").strip().splitlines()
        why = f": {said[-1][:LARGEST_chars]}" if said else ""
        return JobEnded("failed", f"the work broke off with status {status}{why}; what was made is kept")
