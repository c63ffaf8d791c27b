"""A device kept open by a thread of its own, which runs requests in turn and streams ticks."""

from __future__ import annotations

import queue
import threading
import time
from collections.abc import Callable
from concurrent.futures import Future
from contextlib import suppress
from typing import Any, NamedTuple, TypeVar

import numpy as np

from fdvv.device.contract import Device
from fdvv.device.linked import LinkedDevice
from fdvv.device.remote import Remote
from fdvv.device.telemetry import TickColumns
from fdvv.device.twin import TwinDevice
from fdvv.errors import DeviceError
from fdvv.protocol.tables import KeyRequest, Mode, TickFlag
from fdvv.twin.trace import Trace
from fdvv_studio.live.tick_bins import BoolArray, TickPiece

Answer = TypeVar("Answer")
GONE = "the device is gone; connect it again"
GLANCE_s = 0.05
"""Of a device's time between two looks at what it tells."""
PATIENCE_s = 120.0
"""For an answer: an emulated board takes a minute for some presses."""
BETWEEN_s = 0.25
"""Shown between two presses of a device that has no time of its own."""
CUT = TickFlag.LIMITED | TickFlag.SLEWED | TickFlag.DERATED


class KeyChange(NamedTuple):
    """A key that changed its level, 0 while it is up: when on the clock of the ticks, and on the host's."""

    level: int
    t_s: float
    host_s: float


class DeviceThread:
    """A device in use by the studio.

    device : open; closed with this.
    ticks : called with ticks as they come. lost : called once if the device goes away. keys : called with
        every change of the key. All in the thread.
    """

    def __init__(
        self,
        device: Device,
        ticks: Callable[[TickPiece], None],
        lost: Callable[[DeviceError], None],
        keys: Callable[[KeyChange], None] = lambda _change: None,
    ) -> None:
        self.device = device
        self._ticks, self._lost, self._keys = ticks, lost, keys
        if self.remote:
            self.remote.client.on_key = self._key
        self._requests: queue.Queue[tuple[Callable[[], Any], Future[Any]]] = queue.Queue()
        self._over, self._lock = threading.Event(), threading.Lock()
        self._twin_s = 0.0
        self._thread = threading.Thread(target=self._serve, name="device", daemon=True)
        self._thread.start()

    @property
    def remote(self) -> Remote | None:
        """Return the device if it streams its ticks, else None."""
        return self.device if isinstance(self.device, Remote) else None

    def do(self, work: Callable[[], Answer]) -> Answer:
        """Run work in the device's thread. Raises what it raises; DeviceError if the device is gone."""
        if threading.current_thread() is self._thread:
            return work()
        answer: Future[Answer] = Future()
        with self._lock:
            if self._over.is_set():
                raise DeviceError(GONE)
            self._requests.put((work, answer))
        try:
            return answer.result(PATIENCE_s)
        except TimeoutError:
            raise DeviceError(f"the device has not answered for {PATIENCE_s:g} s; disconnect it") from None

    def press(self, velocity_mm_s: float) -> Any:
        """Make one simulated press and stream its ticks; to be called through do(). DeviceError."""
        if isinstance(self.device, TwinDevice):
            trace = self.device.press_trace(velocity_mm_s)
            piece = self._of_twin(trace)
            self._twin_keys(trace, piece)
            self._ticks(piece)
            return trace.press(velocity_mm_s)
        press = self.device.press(velocity_mm_s)
        self._tell_ticks()
        return press

    def host_s(self, t_s: float) -> float:
        """Return when a recent moment of the ticks' clock was on the host's monotonic clock.

        A simulated device has no time of its own there: it is when this is called.
        """
        last = self.remote.client.telemetry.last if self.remote else None
        if last is None:
            return time.monotonic()
        after_us = 1e6 * t_s - last.first_tick * self.device.settings().tick_us
        return self._host_s(last.first_us + round(after_us))

    def _host_s(self, time_us: int) -> float:
        if self.remote and not isinstance(self.device, LinkedDevice):
            with suppress(DeviceError):  # until the clocks were compared
                return self.remote.client.host_s(time_us % 2**32)
        return time.monotonic()

    def _key(self, notice: KeyRequest) -> None:
        t_s = notice.tick * self.device.settings().tick_us * 1e-6
        self._keys(KeyChange(notice.key, t_s, self._host_s(notice.time_us)))

    def _twin_keys(self, trace: Trace, piece: TickPiece) -> None:
        levels = trace.key[trace.tick]
        for row in (np.flatnonzero(np.diff(levels)) + 1).tolist():
            self._keys(KeyChange(int(levels[row]), float(piece.t_s[row]), time.monotonic()))

    def close(self) -> None:
        self._over.set()
        self._thread.join(PATIENCE_s)

    def _serve(self) -> None:
        lost = None
        try:
            while not self._over.is_set():
                self._turn()
        except DeviceError as error:
            lost = error
        finally:
            self._refuse()
            device: Any = self.device
            if hasattr(device, "close"):
                device.close()
        if lost:
            self._lost(lost)

    def _refuse(self) -> None:
        with self._lock:
            self._over.set()
            while not self._requests.empty():
                self._requests.get()[1].set_exception(DeviceError(GONE))

    def _turn(self) -> None:
        """Do what is asked, or look at what the device tells for a moment."""
        wait_s = self._watch() if self.remote else GLANCE_s
        try:
            work, answer = self._requests.get(timeout=max(wait_s, 0.001))
        except queue.Empty:
            return
        try:
            answer.set_result(work())
        except BaseException as error:
            answer.set_exception(error)
        if self.remote:
            # what was not sent while something else was done is not missing
            self.remote.client.telemetry.clear()
            self.remote.client.stream(1)

    def _watch(self) -> float:
        """Listen for a moment; give what is left of it: a device in lockstep is no faster than the clock."""
        assert self.remote
        client, started_s = self.remote.client, time.monotonic()
        if client.telemetry.last is None:
            client.stream(1)
        client.listen(client.port.now_s() + GLANCE_s)
        self._tell_ticks()
        lockstep = isinstance(self.device, LinkedDevice)
        return GLANCE_s - (time.monotonic() - started_s) if lockstep else 0.0

    def _tell_ticks(self) -> None:
        assert self.remote
        armed, ticks = self.remote.client.telemetry.armed(), self.remote.client.telemetry.take()
        if ticks.tick.size:
            self._ticks(self._of_ticks(ticks, armed))

    def _of_ticks(self, ticks: TickColumns, armed: BoolArray) -> TickPiece:
        settings = self.device.settings()
        force_cN = ticks.force_cN if settings.force_gain_q14 else np.full(ticks.tick.size, np.nan)
        return TickPiece(
            ticks.tick.astype(np.float64) * settings.tick_us * 1e-6,
            ticks.displacement_mm,
            force_cN,
            ticks.commanded_cN,
            ticks.state,
            (ticks.flags & CUT) > 0,
            armed,
        )

    def _of_twin(self, trace: Trace) -> TickPiece:
        """Return the ticks of a simulated press; presses follow each other on one clock."""
        rows = trace.tick
        t_s = self._twin_s + BETWEEN_s + trace.t_s[rows]
        self._twin_s = float(t_s[-1])
        return TickPiece(
            t_s,
            trace.displacement_mm[rows],
            trace.force_cN[rows],
            trace.commanded_cN[rows],
            trace.state[rows].astype(np.int64),
            trace.saturated[rows],
            np.ones(int(rows.sum()), dtype=np.bool_),
        )


def mode_of(remote: Remote) -> str:
    last = remote.client.telemetry.last
    return Mode(last.mode).name.lower() if last else ""
