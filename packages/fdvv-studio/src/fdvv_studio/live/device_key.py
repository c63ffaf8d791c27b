"""A device that a person presses while a task is shown elsewhere: its key on the host's clock."""

from __future__ import annotations

import time
from collections import deque
from collections.abc import Callable
from concurrent.futures import Future
from contextlib import suppress
from queue import Empty, SimpleQueue
from threading import Lock, Thread
from typing import Protocol, TypeVar

from fdvv.device.contract import Device
from fdvv.device.linked import LinkedDevice
from fdvv.device.remote import PressedDevice, Remote
from fdvv.device.telemetry import TickColumns
from fdvv.device.wire import RefusedError
from fdvv.errors import DeviceError, InputError, ModelError
from fdvv.model.model import FDVVModel
from fdvv.program.button import button_program
from fdvv.program.compile import compile_program
from fdvv.program.program import Program
from fdvv.program.surface import Limits
from fdvv.protocol.tables import Fault, KeyRequest
from fdvv.rendering.press_made import clear_latched

Result = TypeVar("Result")

GLANCE_s = 0.01
"""What is asked for waits no longer while a real line is listened to."""
WATCH_s = 0.5
"""A warning that does not end the force is looked for so often."""
ASKS_s = 0.1
"""So often who waits for an answer looks whether anybody listens any more."""


class DeviceLine(Protocol):
    """A device that is heard while it renders."""

    def do(self, work: Callable[[], Result]) -> Result:
        """Call work with exclusive access to the device; its exceptions are raised here."""

    def now_s(self) -> float:
        """Return the time by which changes are measured."""

    def wait(self, time_s: float) -> None:
        """Let time pass."""

    def close(self) -> None:
        """Listen no more."""


class SimulatedLine:
    """A board in lockstep: its time passes while somebody waits, and at no other time."""

    def __init__(self, device: LinkedDevice) -> None:
        self._device = device

    def do(self, work: Callable[[], Result]) -> Result:
        return work()

    def now_s(self) -> float:
        return self._device.client.port.now_s()

    def wait(self, time_s: float) -> None:
        self._device.client.listen(self.now_s() + time_s)

    def close(self) -> None:
        """Do nothing: there is no thread."""


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
        self._requests: SimpleQueue[Callable[[], None]] = SimpleQueue()
        self._over, self._watch_s = False, time.monotonic()
        self._thread = Thread(target=self._run, name="device line", daemon=True)
        self._thread.start()

    def do(self, work: Callable[[], Result]) -> Result:
        """Have it done between two glances at the line."""
        future: Future[Result] = Future()

        def run() -> None:
            try:
                future.set_result(work())
            except BaseException as error:
                future.set_exception(error)

        self._requests.put(run)
        while True:
            try:
                return future.result(ASKS_s)
            except TimeoutError:
                if not self._thread.is_alive() and not future.done():
                    name = self._device.client.port.name
                    raise DeviceError(f"{name}: nobody listens to it any more; open it again") from None

    def now_s(self) -> float:
        return time.monotonic()

    def wait(self, time_s: float) -> None:
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
            self._run_requests()
        self._run_requests()  # what was asked for meanwhile fails or is done, but nobody waits for ever

    def _run_requests(self) -> None:
        while True:
            try:
                self._requests.get_nowait()()
            except Empty:
                return


PINGS = 12
"""Before the first press, to join the clocks; then every exchange goes on joining them."""
EVERY = 10
"""Ticks between two records: frames come steadily, so that a lost one is noticed."""
KEPT = 200
"""Of presses; a round has a handful."""


class DeviceKey:
    """A device on a line under a person's hand, button after button.

    Parameters
    ----------
    device : open; closed with this. failed : called once with one line when the device has fallen to zero
        force or is gone, from a thread of this.

    Attributes
    ----------
    problem : why the device no longer renders, in one line; empty while it does.

    Raises InputError on a device that no person presses.
    """

    def __init__(self, device: Device, failed: Callable[[str], None] = lambda _line: None) -> None:
        if not isinstance(device, PressedDevice):
            raise InputError("device", device.info().name, "is pressed by no person", "use serial:PORT")
        self.device, self._failed = device, failed
        self._level, self._pressed_s, self._missed = 0, deque[float](maxlen=KEPT), 0
        self.problem, self._rendering, self._lock, self._error_us = "", False, Lock(), 0.0
        device.client.on_key = self._key
        # keys are reported separately, so that nothing is to be done with telemetry
        self._line = RealLine(device, lambda _columns: None, self._look, lambda error: self._end(str(error)))

    @property
    def clock_error_ms(self) -> float:
        """Error bound between the device's clock and the host's: the worst since the button came, or now."""
        return self._line.do(lambda: 1e-3 * max(self._error_us, self.device.client.clocks().error_us))

    def render(self, button: FDVVModel | Program) -> None:
        """Put a button under the hand: a model's, or a program.

        Raises InputError, ModelError on one that the device cannot hold, DeviceError.
        """
        self._check()
        limits = Limits(self.device.settings())
        program = button if isinstance(button, Program) else button_program(button)
        image = compile_program(program, limits).image
        try:
            self._line.do(lambda: self._load(image))
        except DeviceError as error:
            self._end(str(error))
            raise

    def pressed_s(self, start_s: float, end_s: float) -> tuple[float, ...]:
        """Return the times the key went down from start to end, on the host's monotonic clock, rising.

        DeviceError if the device has failed, or if the line lost frames that may have reported a press.
        """
        self._check()
        missed = self._line.do(lambda: self.device.client.telemetry.missing_frames)
        lost, self._missed = missed - self._missed, missed
        if lost:
            name = self.device.info().name
            raise DeviceError(f"{name}: the line lost {lost} frames, maybe a press; play it again")
        with self._lock:
            return tuple(sorted(at for at in self._pressed_s if start_s <= at <= end_s))

    def rest(self) -> None:
        """Fall to zero force until the next button; nothing happens if the device is gone."""
        self._rendering = False
        if not self.problem:
            with suppress(DeviceError):
                self._line.do(self.device.stop)

    def close(self) -> None:
        self.rest()
        self.problem = self.problem or "the device is closed; open it again"
        self._line.close()
        self.device.close()

    # -- in the line's thread ------------------------------------------------------------------------------

    def _load(self, image: bytes) -> None:
        device, client = self.device, self.device.client
        device.stop()
        clear_latched(device, lambda _line: None)
        try:
            device.upload_program(image)
        except RefusedError as error:
            raise ModelError(f"the device does not take it: {error}") from error
        for _ in range(PINGS):
            client.ping()
        client.telemetry.clear()
        self._missed, self._level, self._error_us = 0, 0, 0.0
        client.stream(EVERY)
        client.arm()
        self._rendering = True

    def _key(self, notice: KeyRequest) -> None:
        """Note a key that went down, or on to the next level."""
        if notice.key > self._level:
            at_s = self.device.client.host_s(notice.time_us)
            self._error_us = max(self._error_us, self.device.client.clocks().error_us)
            with self._lock:
                self._pressed_s.append(at_s)
        self._level = notice.key

    def _look(self) -> None:
        if self._rendering and not self.problem:
            report = self.device.fault()
            if report.fault is not Fault.NONE:
                reason = report.fault.name.lower().replace("_", " ")
                name = self.device.info().name
                self._end(f"{name}: fell to zero force: {reason}; let go and play it again")

    def _end(self, line: str) -> None:
        if not self.problem:
            self.problem, self._rendering = line, False
            self._failed(line)

    def _check(self) -> None:
        if self.problem:
            raise DeviceError(self.problem)
