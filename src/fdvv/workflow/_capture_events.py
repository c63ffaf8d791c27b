"""What a capture session tells whoever watches or presses."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field

from fdvv.device import show_nothing
from fdvv.recording import Take
from fdvv.workflow._capture_look import Verdict
from fdvv.workflow._capture_plan import Step


@dataclass(frozen=True)
class TakeAsk:
    """What is wanted next.

    Attributes
    ----------
    step : what to record; number-th of total steps.
    travel_mm : of the button, as far as it is known.
    again : why it is asked for once more; empty the first time.
    """

    step: Step
    number: int
    total: int
    travel_mm: float
    again: str = ""


@dataclass(frozen=True)
class PaceStanding:
    """How far one pace is.

    Attributes
    ----------
    good, wanted : presses.
    made, missed : all that were made at this pace, and how many the session does without.
    achieved_mm_s : of the good ones, as far as their speed is known.
    """

    velocity_mm_s: float
    good: int
    wanted: int
    made: int
    missed: int
    achieved_mm_s: tuple[float, ...] = field(default=(), repr=False)


@dataclass(frozen=True, eq=False)
class TakeDone:
    """A take that is on the disk.

    Attributes
    ----------
    take, verdict : the take itself, and what a quick look found.
    done, total : steps settled.
    missed : it was asked for often enough; the session goes on without.
    standing : how far every pace is.
    """

    take: Take
    verdict: Verdict
    done: int
    total: int
    missed: bool
    standing: tuple[PaceStanding, ...]


@dataclass(frozen=True, eq=False)
class CaptureGuide:
    """Who leads the person through a capture.

    Attributes
    ----------
    cue : called before a take; gives what shows the pace, which is then called with the time.
    done : called after each take, once it is on the disk.
    notice : called with what a person should know.
    """

    cue: Callable[[TakeAsk], Callable[[float], None]] = lambda _ask: show_nothing
    done: Callable[[TakeDone], None] = lambda _done: None
    notice: Callable[[str], None] = lambda _text: None
