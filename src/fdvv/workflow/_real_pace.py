"""Real pace: how much simulated time is due, and how much was lost because this machine was busy."""

from __future__ import annotations

from collections.abc import Callable

LONGEST_s = 0.1
"""More than this at once would be a burst that nobody led: it is dropped and told."""


class RealPace:
    """Turns a monotonic clock into stretches of simulated time.

    Parameters
    ----------
    clock : monotonic, s.
    longest_s : most that may be made up for.
    """

    def __init__(self, clock: Callable[[], float], longest_s: float = LONGEST_s) -> None:
        self._clock, self._longest_s = clock, longest_s
        self._last_s: float | None = None

    @property
    def last_s(self) -> float:
        """Get the clock as due() read it last; 0 before."""
        return self._last_s or 0.0

    def due(self) -> tuple[float, float]:
        """Give what is due since the last call, and what is dropped of it; nothing after pause()."""
        now = self._clock()
        passed = 0.0 if self._last_s is None else now - self._last_s
        self._last_s = now
        run = min(passed, self._longest_s)
        return run, passed - run

    def pause(self) -> None:
        """Forget the time: what passes until the next call is neither run nor dropped."""
        self._last_s = None
