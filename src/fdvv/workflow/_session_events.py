"""What a session tells whoever watches or presses."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from fdvv.compensate import CurveOutcome
from fdvv.model import Press


@dataclass(frozen=True)
class Standing:
    """How far one velocity is.

    Attributes
    ----------
    made, wanted : presses used, and those it takes; None if the method does not say.
    curves : of both strokes, as far as they are known.
    """

    velocity_mm_s: float
    made: int
    wanted: int | None
    curves: tuple[CurveOutcome, ...] = ()


@dataclass(frozen=True, eq=False)
class PressDone:
    """A press that was made: what a display of progress needs, and the record itself.

    Attributes
    ----------
    stage : "compensate" or "probe".
    presses_done, presses_total : those used; the total holds if the method keeps to its plan.
    press : None if the device faulted before it could tell of it.
    skipped : why the press was not used and what to do; empty if it was.
    achieved_mm_s : its mean speed; NaN if it has none.
    told : what the method says that it changed.
    standing : gives how far every velocity is, slowest first.
    """

    stage: str
    velocity_mm_s: float
    presses_done: int
    presses_total: int
    press: Press | None
    skipped: str
    achieved_mm_s: float
    told: str
    standing: Callable[[], tuple[Standing, ...]]


Progress = Callable[[PressDone], None]


@dataclass(frozen=True)
class Ask:
    """What is wanted of the person next: one press, the ``number``-th of ``total`` that are used."""

    velocity_mm_s: float
    travel_mm: float
    number: int
    total: int


@dataclass(frozen=True, eq=False)
class Guide:
    """Who leads the person through a session.

    Attributes
    ----------
    ask : called before every press.
    notice : called with what a person should know: that a session goes on, that a record was cut short.
    """

    ask: Callable[[Ask], None] = lambda _ask: None
    notice: Callable[[str], None] = lambda _text: None
