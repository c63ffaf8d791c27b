"""A line whose far end is a function of the bytes that come, and keeps them."""

from __future__ import annotations

import os
import select
import threading
import time
import tty
from collections.abc import Callable, Iterator
from contextlib import contextmanager


class ScriptedLine:
    """A pseudo-terminal and a thread.

    every_s : the function is also called without bytes, so often; None: never.

    Attributes
    ----------
    port : the name that an adapter opens. came : all bytes so far.
    """

    def __init__(self, answer: Callable[[bytes], bytes], every_s: float | None) -> None:
        self._every_s, self._called_s = every_s, time.monotonic()
        self._master, self._slave = os.openpty()
        tty.setraw(self._slave)
        self.port, self.came = os.ttyname(self._slave), b""
        self._answer, self._over = answer, False
        self._thread = threading.Thread(target=self._run, daemon=True)
        self._thread.start()

    def _run(self) -> None:
        while not self._over:
            if select.select([self._master], [], [], 0.01)[0]:
                data = os.read(self._master, 4096)
                self.came += data
                os.write(self._master, self._answer(data))
            elif self._every_s is not None and time.monotonic() > self._called_s + self._every_s:
                self._called_s = time.monotonic()
                os.write(self._master, self._answer(b""))

    def send(self, data: bytes) -> None:
        """Send what nobody asked for."""
        os.write(self._master, data)

    def close(self) -> None:
        self._over = True
        self._thread.join()
        os.close(self._master)
        os.close(self._slave)


@contextmanager
def scripted(answer: Callable[[bytes], bytes], every_s: float | None = None) -> Iterator[ScriptedLine]:
    line = ScriptedLine(answer, every_s)
    try:
        yield line
    finally:
        line.close()
