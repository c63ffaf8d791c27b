"""What every capture bench promises: simulated, or one on a serial port with a person at it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Protocol

from fdvv.recording import Bench, Stage, Take


def show_nothing(_t_s: float) -> None:
    """Show nothing."""


@dataclass(frozen=True)
class Cue:
    """What leads a person through one take, on a time of its own that begins with the take.

    Attributes
    ----------
    length_s : from its begin until the person should be done.
    events : what it tells and when, as ("cue contact", 1.5); they become marks of the take.
    show : called with the time, over and over; draws and beeps what is due by then.
    """

    length_s: float
    events: tuple[tuple[str, float], ...] = ()
    show: Callable[[float], None] = show_nothing


@dataclass(frozen=True)
class BenchInfo:
    """Who records.

    Attributes
    ----------
    name : kind of bench.
    simulated : its takes come from the twin.
    bench : what is known of its instruments.
    person : a word for who presses; for a simulated one, all that repeats the session.
    """

    name: str
    simulated: bool
    bench: Bench
    person: str = ""


class CaptureDevice(Protocol):
    """Records takes of one button that a person presses. Errors are DeviceError."""

    def facts(self) -> BenchInfo:
        """Tell who this is and what is known of the instruments."""
        ...

    def take(self, number: int, stage: Stage, velocity_mm_s: float | None, cue: Cue) -> Take:
        """Record one take while the cue is shown; the take bears this number.

        The marks hold the cue's events on the clock of the force. A press that went wrong is a take too.
        Raises DeviceError if the bench fails or falls silent.
        """
        ...

    def close(self) -> None:
        """Let the bench go; a second time does nothing."""
        ...
