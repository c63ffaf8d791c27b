"""What a hand does, made later in a simulation: in order, and as long after each other as the hand did it."""

from __future__ import annotations

from collections import deque
from typing import NamedTuple

LONGEST_s = 5.0
"""No hold lasts longer, whatever a page says."""
UP_s = 0.05
"""A finger that was up so long is ready for the next press, however long the hand was up."""


class HandMove(NamedTuple):
    """A move of a hand. down : whether it presses. hand_s : when it was, on the hand's clock."""

    down: bool
    hand_s: float


class HandMoves:
    """Moves of a hand that wait to be made.

    They come late by delays that differ. Made at once, a short press would vanish between two that came
    together; so each waits until the last one is as long ago in the simulation as it was for the hand.
    """

    def __init__(self) -> None:
        self._waiting = deque[tuple[HandMove, float]]()
        self._last: tuple[HandMove, float] | None = None

    def __bool__(self) -> bool:
        """Whether a move waits."""
        return bool(self._waiting)

    def add(self, move: HandMove, now_s: float) -> None:
        """Add a move, later than those before. now_s : simulated time."""
        self._waiting.append((move, now_s))

    def due(self, now_s: float) -> HandMove | None:
        """Return the next move if it is to be made now, else None. now_s : simulated time."""
        if not self._waiting:
            return None
        move, due_s = self._waiting[0]
        if self._last is not None:
            last, made_s = self._last
            due_s = max(due_s, made_s + min(move.hand_s - last.hand_s, UP_s if move.down else LONGEST_s))
        if now_s < due_s:
            return None
        # when it was due, not now: steps of the simulation would add up
        self._last = move, due_s
        self._waiting.popleft()
        return move
