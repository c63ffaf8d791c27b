"""One start of a job, as a process of its own.

Ctrl-C is how the workflow is stopped: it keeps what was made and lets the device go. A process of its own has
that at any moment, and nothing it computes keeps the studio waiting. Events go out as lines of JSON, answers
come in as lines; when the studio is gone the input ends, and the work stops as if it had been cancelled.
"""

from __future__ import annotations

import _thread
import contextlib
import os
import queue
import signal
import sys
import threading
from collections.abc import Iterator
from pathlib import Path
from typing import IO

import msgspec

from fdvv.errors import DeviceError, FdvvError
from fdvv.studio._job_file import JobFolder
from fdvv.studio._messages_events import JobEnded, JobEvent
from fdvv.studio._messages_orders import CaptureOrder, CompensateOrder, ProbeOrder
from fdvv.studio._told import told as line_of
from fdvv.studio._work import Work

STOPPED = "stopped; what was made is kept"
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
                asked, answer = self._lines.get(timeout=0.1)
                if asked == number:
                    return answer

    def _listen(self) -> None:
        for line in self._source:
            self._lines.put(msgspec.json.decode(line, type=tuple[int, str]))
        _interrupt()
        threading.Event().wait(PATIENCE_s)
        os._exit(1)


def _interrupt() -> None:
    """Do to this process what Ctrl-C does."""
    if sys.platform == "win32":
        _thread.interrupt_main()
    else:
        os.kill(os.getpid(), signal.SIGINT)  # breaks off what the main thread waits for, too


def work_on(work: Work) -> None:
    """Do what the job's order says."""
    order = work.folder.load().order
    if isinstance(order, CaptureOrder):
        from fdvv.studio._work_capture import capture

        capture(work, order)
    elif isinstance(order, CompensateOrder | ProbeOrder):
        from fdvv.studio._work_learn import judge, learn

        learn(work, order) if isinstance(order, CompensateOrder) else judge(work, order)
    else:
        from fdvv.studio._work_tune import tune

        tune(work, order)


def ended(work: Work) -> JobEnded:
    """Do the work; tell how it ended."""
    try:
        work_on(work)
    except KeyboardInterrupt:
        return JobEnded("cancelled", STOPPED)
    except DeviceError as error:
        # the workflow adds how to go on at the command line; here the job itself goes on
        told = error.__cause__ if isinstance(error.__cause__, DeviceError) else error
        return JobEnded("failed", f"{told}; what was made is kept, go on once that is mended")
    except (FdvvError, OSError) as error:
        return JobEnded("failed", line_of(error))
    return JobEnded("done", "")


@contextlib.contextmanager
def _own_output() -> Iterator[IO[bytes]]:
    """Give the line to the studio; what anything prints goes to standard error."""
    with os.fdopen(os.dup(1), "wb", buffering=0) as out:
        os.dup2(2, 1)
        yield out


def main() -> None:
    """Do one start of the job in the folder that the command line names."""
    # a shell lets what it starts in the background ignore Ctrl-C, and that is inherited
    signal.signal(signal.SIGINT, signal.default_int_handler)
    with _own_output() as out:

        def tell(event: JobEvent) -> None:
            out.write(msgspec.json.encode(event) + b"\n")

        answers = Answers(os.fdopen(os.dup(0), "rb", buffering=0))
        work = Work(JobFolder(Path(sys.argv[1])), int(sys.argv[2]), tell, answers.wait)
        last = ended(work)
        signal.signal(signal.SIGINT, signal.SIG_IGN)
        tell(last)


if __name__ == "__main__":
    main()
