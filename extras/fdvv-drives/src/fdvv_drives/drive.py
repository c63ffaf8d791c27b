"""What a loop needs of a motor drive, and the lines to it."""

from __future__ import annotations

import time
from collections.abc import Iterator
from contextlib import contextmanager
from typing import NamedTuple, Protocol

from fdvv.errors import BuildError, DeviceError

WATCHDOG_ms = (10.0, 1000.0)
STEP_s = 0.002
"""Longest wait inside one reading of a serial line."""


def check_watchdog(watchdog_ms: float, may_be_off: bool) -> None:
    """Refuse a time that guards nothing; msgspec makes a ValidationError of the ValueError."""
    if may_be_off and watchdog_ms == 0:
        return
    low_ms, high_ms = WATCHDOG_ms
    if not low_ms <= watchdog_ms <= high_ms:
        off = ", or 0 for none" if may_be_off else ""
        raise ValueError(f"watchdog_ms is {watchdog_ms:g}, write {low_ms:g} to {high_ms:g}{off}")


class LostAnswerError(DeviceError):
    """The drive did not answer one command; the next may be answered."""


class Reading(NamedTuple):
    """One answer: position in the drive's unit, torque in that of its command, as reported.

    force_N : against the finger, of a load cell at the drive's own input; None without one.
    """

    position: float
    torque: float
    force_N: float | None = None


class Drive(Protocol):
    """A motor drive in torque mode. Every method raises DeviceError, of one line.

    Attributes
    ----------
    name : for messages.
    watchdog_s : the drive falls to no torque when it hears nothing for so long; None if nothing does.
    senses_force : its readings hold the force of a load cell.
    """

    name: str
    watchdog_s: float | None
    senses_force: bool

    def enable(self) -> None:
        """Switch torque mode on at zero torque; refuses a drive that reports an error or another mode."""

    def exchange(self, torque: float) -> Reading:
        """Command a torque and return the answer. LostAnswerError if none comes in time."""

    def has_fallen(self) -> bool:
        """Return whether the drive has switched its torque off by itself."""

    def stop(self) -> None:
        """Command zero torque and switch it off, without waiting for an answer."""

    def close(self) -> None:
        """Let the line go; a second time does nothing."""


@contextmanager
def line_errors(name: str) -> Iterator[None]:
    """Turn what a broken line raises into a DeviceError."""
    try:
        yield
    except DeviceError:
        raise
    except Exception as error:
        # pyserial and python-can raise their own, TypeError and termios.error among it, as a port goes away
        reason = getattr(error, "strerror", None) or str(error) or type(error).__name__
        raise DeviceError(
            f"{name}: the line broke ({' '.join(str(reason).split())}); check cable and power, "
            "then open the device again"
        ) from error


class SerialLine:
    """Lines of text over a serial port, by pyserial.

    Attributes
    ----------
    sent_bytes, received_bytes : so far.
    last : the last line that came, for messages.
    """

    def __init__(self, port: str, baud: int) -> None:
        try:
            import serial
        except ImportError:
            raise BuildError("drives on a serial port need pyserial; pip install pyserial") from None
        self.name = port
        self.sent_bytes = self.received_bytes = 0
        self.last = b""
        self._waiting = b""
        try:
            self._port = serial.Serial(port, baud, timeout=STEP_s, write_timeout=1.0)
        except (OSError, ValueError) as error:
            reason = getattr(error, "strerror", None) or error
            raise DeviceError(
                f"{port}: cannot be opened ({reason}); check the cable, the port's name and permissions"
            ) from error

    def write(self, data: bytes) -> None:
        with line_errors(self.name):
            self._port.write(data)
        self.sent_bytes += len(data)

    def lines(self, until_s: float) -> Iterator[bytes]:
        """Yield the lines that come until time.perf_counter() reaches until_s."""
        while True:
            while b"\n" in self._waiting:
                line, self._waiting = self._waiting.split(b"\n", 1)
                self.last = line.strip()
                if self.last:
                    yield self.last
            if time.perf_counter() >= until_s:
                return
            self._receive()

    def _receive(self) -> None:
        with line_errors(self.name):
            data = self._port.read(1)
            if data:
                data += self._port.read(self._port.in_waiting)
        self.received_bytes += len(data)
        # what has no end of line is not ours
        self._waiting = (self._waiting + data)[-4096:]

    def drop(self) -> None:
        """Forget what has come so far: answers to what was asked before."""
        self._waiting = b""
        with line_errors(self.name):
            self._port.reset_input_buffer()

    def what_came(self) -> str:
        """Say what came last, for a message that misses something."""
        return f"; what came last was {self.last[:40]!r}" if self.last else ""

    def close(self) -> None:
        with line_errors(self.name):
            self._port.close()
