"""A device that a person presses while a task is shown elsewhere: its key on the host's clock."""

from __future__ import annotations

from collections.abc import Callable
from contextlib import suppress
from threading import Lock

from fdvv.device import Device, PressedDevice, RefusedError, TickColumns
from fdvv.errors import DeviceError, InputError, ModelError
from fdvv.model import FDVVModel
from fdvv.program import Limits, compile_button
from fdvv.protocol import Fault, KeyRequest
from fdvv.workflow._device_line import RealLine
from fdvv.workflow._session_run import clear_latched

PINGS = 12
"""Before the first press, to join the clocks; then every exchange goes on joining them."""
EVERY = 10
"""Ticks between two that are told: frames come steadily, so that a lost one is noticed."""
KEPT = 200
"""Of presses; a round has a handful."""


class DeviceKey:
    """A device on a line under a person's hand, button after button.

    Parameters
    ----------
    device : open; closed with this. failed : called once with one line when the device has fallen to zero
        force or is gone, from a thread of this.

    Raises InputError on a device that no person presses.
    """

    def __init__(self, device: Device, failed: Callable[[str], None] = lambda _line: None) -> None:
        if not isinstance(device, PressedDevice):
            raise InputError("device", device.info().name, "is pressed by no person", "use serial:PORT")
        self._device, self._failed = device, failed
        self._level, self._pressed_s, self._missed = 0, list[float](), 0
        self._problem, self._rendering, self._lock = "", False, Lock()
        device.client.on_key = self._key
        self._line = RealLine(device, self._heard, self._look, self._lost)

    @property
    def device(self) -> PressedDevice:
        """Get the device."""
        return self._device

    @property
    def problem(self) -> str:
        """Tell in one line why the device renders no more; empty while it can."""
        return self._problem

    @property
    def clock_error_ms(self) -> float:
        """Get the bound of what joins the device's clock with the host's: half of the quickest exchange."""
        return self._line.do(lambda: 0.5e-3 * self._device.client.clocks().shortest_us)

    def render(self, model: FDVVModel) -> None:
        """Put a button under the hand.

        Raises InputError, ModelError on one that the device cannot hold, DeviceError.
        """
        self._check()
        limits = Limits(self._device.settings())
        image = compile_button(model, limits=limits).image
        self._guarded(lambda: self._load(image))

    def pressed_s(self, start_s: float, end_s: float) -> tuple[float, ...]:
        """Give when the key went down from start to end, on the host's monotonic clock, rising.

        DeviceError if the device has failed, or if the line lost what may have told of a press.
        """
        self._check()
        missed = self._line.do(lambda: self._device.client.telemetry.missing_frames)
        lost, self._missed = missed - self._missed, missed
        if lost:
            name = self._device.info().name
            raise DeviceError(f"{name}: the line lost {lost} frames, maybe a press; play it again")
        with self._lock:
            return tuple(sorted(at for at in self._pressed_s if start_s <= at <= end_s))

    def rest(self) -> None:
        """Fall to zero force until the next button; nothing happens if the device is gone."""
        self._rendering = False
        if not self._problem:
            with suppress(DeviceError):
                self._line.do(self._device.stop)

    def close(self) -> None:
        """Fall to zero force and let the device go."""
        self.rest()
        self._problem = self._problem or "the device is closed; open it again"
        self._line.close()
        self._device.close()

    # -- in the line's thread ------------------------------------------------------------------------------

    def _load(self, image: bytes) -> None:
        device, client = self._device, self._device.client
        device.stop()
        clear_latched(device, lambda _line: None)
        try:
            device.upload_program(image)
        except RefusedError as error:
            raise ModelError(f"the device does not take it: {error}") from error
        for _ in range(PINGS):
            client.ping()
        client.telemetry.clear()
        self._missed, self._level = 0, 0
        client.stream(EVERY)
        client.arm()
        self._rendering = True

    def _key(self, notice: KeyRequest) -> None:
        """Note a key that went down, or on to the next level."""
        if notice.key > self._level:
            at_s = self._device.client.host_s(notice.time_us)
            with self._lock:
                self._pressed_s = [*self._pressed_s, at_s][-KEPT:]
        self._level = notice.key

    def _heard(self, _told: TickColumns) -> None:
        """Let what came go: keys are noticed by themselves."""

    def _look(self) -> None:
        if self._rendering and not self._problem:
            found = self._device.fault()
            if found.fault is not Fault.NONE:
                reason = found.fault.name.lower().replace("_", " ")
                self._end(
                    f"{self._device.info().name}: fell to zero force: {reason}; let go and play it again"
                )

    def _lost(self, error: DeviceError) -> None:
        self._end(str(error))

    def _end(self, line: str) -> None:
        if self._problem:
            return
        self._problem, self._rendering = line, False
        self._failed(line)

    def _guarded(self, work: Callable[[], None]) -> None:
        try:
            self._line.do(work)
        except DeviceError as error:
            self._end(str(error))
            raise

    def _check(self) -> None:
        if self._problem:
            raise DeviceError(self._problem)
