"""A key that goes down and up by how deep it is: actuation and reset point, between readings."""

from __future__ import annotations


class TravelKey:
    """A key that is read now and then, and goes down at a place.

    Parameters
    ----------
    actuation_mm, reset_mm : it goes down at the first on its way down, and can again once it was above the
        second.
    """

    def __init__(self, actuation_mm: float, reset_mm: float) -> None:
        self._actuation_mm, self._reset_mm = actuation_mm, reset_mm
        self._down = False
        self._last: tuple[float, float] | None = None

    def read(self, at_s: float, displacement_mm: float) -> float | None:
        """Return when the key went down since the last reading, s, on a straight line; None if it did not."""
        last, self._last = self._last, (at_s, displacement_mm)
        if self._down:
            self._down = displacement_mm > self._reset_mm
            return None
        self._down = displacement_mm >= self._actuation_mm
        if not self._down:
            return None
        if last is None or last[1] >= self._actuation_mm:
            return at_s
        return last[0] + (at_s - last[0]) * (self._actuation_mm - last[1]) / (displacement_mm - last[1])
