"""Who moves a device on while somebody is at it: time itself on a line, whoever waits on a simulated one."""

from __future__ import annotations

import time
from collections.abc import Callable
from concurrent.futures import Future
from queue import Empty, SimpleQueue
from threading import Thread
from typing import Protocol, TypeVar

from fdvv.device import LinkedDevice, Remote, TickColumns
from fdvv.errors import DeviceError

Found = TypeVar("Found")
GLANCE_s = 0.01
"""What is asked for waits no longer while a real line is listened to."""
WATCH_s = 0.5
"""A warning that does not end the force is looked for so often."""
ASKS_s = 0.1


class DeviceLine(Protocol):
    """A device that is heard while it renders."""

    def do(self, work: Callable[[], Found]) -> Found:
        """Do something with the device, one thing at a time; what it raises is raised here."""
        ...

    def now_s(self) -> float:
        """Give the time that changes are measured by."""
        ...

    def wait(self, time_s: float) -> None:
        """Let time pass."""
        ...

    def close(self) -> None:
        """Listen no more."""
        ...


class SimulatedLine:
    """A board in lockstep: its time passes while somebody waits, and at no other time."""

    def __init__(self, device: LinkedDevice) -> None:
        self._device = device

    def do(self, work: Callable[[], Found]) -> Found:
        """Do it."""
        return work()

    def now_s(self) -> float:
        """Give the board's own time."""
        return self._device.client.port.now_s()

    def wait(self, time_s: float) -> None:
        """Let the board run."""
        self._device.client.listen(self.now_s() + time_s)

    def close(self) -> None:
        """Do nothing."""


class RealLine:
    """A device that somebody presses: listened to in a thread of its own, which keeps its watch fed.

    Parameters
    ----------
    device : open. heard : called with what came, also with nothing. watched : called every half second.
    lost : called once with what went wrong. Both in the line's thread.
    """

    def __init__(
        self,
        device: Remote,
        heard: Callable[[TickColumns], None],
        watched: Callable[[], None],
        lost: Callable[[DeviceError], None],
    ) -> None:
        self._device, self._heard, self._watched, self._lost = device, heard, watched, lost
        self._asked: SimpleQueue[Callable[[], None]] = SimpleQueue()
        self._over, self._watch_s = False, time.monotonic()
        self._thread = Thread(target=self._run, name="device line", daemon=True)
        self._thread.start()

    def do(self, work: Callable[[], Found]) -> Found:
        """Have it done between two glances at the line."""
        found: Future[Found] = Future()

        def done() -> None:
            try:
                found.set_result(work())
            except BaseException as error:
                found.set_exception(error)

        self._asked.put(done)
        while True:
            try:
                return found.result(ASKS_s)
            except TimeoutError:
                if not self._thread.is_alive() and not found.done():
                    name = self._device.client.port.name
                    raise DeviceError(f"{name}: nobody listens to it any more; open it again") from None

    def now_s(self) -> float:
        """Give the host's steady clock."""
        return time.monotonic()

    def wait(self, time_s: float) -> None:
        """Sleep."""
        time.sleep(time_s)

    def close(self) -> None:
        """Listen no more; waits until the thread has ended."""
        self._over = True
        self._thread.join()

    def _run(self) -> None:
        client = self._device.client
        while not self._over:
            try:
                client.listen(client.port.now_s() + GLANCE_s)
                self._heard(client.telemetry.take())
                if time.monotonic() >= self._watch_s + WATCH_s:
                    self._watch_s = time.monotonic()
                    self._watched()
            except DeviceError as error:
                self._lost(error)
                self._over = True
            self._do_asked()
        self._do_asked()

    def _do_asked(self) -> None:
        while True:
            try:
                self._asked.get_nowait()()
            except Empty:
                return
