"""A way to a board's link: bytes there and back, and the clock by which one waits."""

from __future__ import annotations

from typing import Protocol


class Port(Protocol):
    """A line to a board. Time is the port's own: a board in lockstep runs only while someone waits."""

    @property
    def name(self) -> str:
        """Name the line for messages to a person."""
        ...

    def now_s(self) -> float:
        """Give a clock that never goes back."""
        ...

    def write(self, data: bytes) -> None:
        """Send bytes; DeviceError if the line is dead."""
        ...

    def read(self, until_s: float) -> bytes:
        """Wait for bytes until now_s() reaches until_s; b"" if none came. DeviceError if the line is dead."""
        ...

    def reopen(self) -> None:
        """Open the line again after it broke; DeviceError if it cannot be."""
        ...

    def close(self) -> None:
        """Close the line; a second time does nothing."""
        ...
