"""The log of a loop, and the press in it."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from fdvv.device.remote import DEEP_RATIO, LEAD_TICKS, TOP_mm
from fdvv.model.press import Press
from fdvv.units import FloatArray


@dataclass
class LoopLog:
    """What a loop did, cycle by cycle, on this computer's clock.

    Attributes
    ----------
    sent_s, received_s : when the command left, and when its answer was here; the drive read its sensors
        in between.
    displacement_mm, force_cN : of the answer: the force is that of the sensor, or of the reported torque.
    commanded_cN : what the core made of it; it leaves with the next cycle. limited : it was cut.
    lost : answers that did not come.
    """

    sent_s: list[float] = field(default_factory=list)
    received_s: list[float] = field(default_factory=list)
    displacement_mm: list[float] = field(default_factory=list)
    force_cN: list[float] = field(default_factory=list)
    commanded_cN: list[float] = field(default_factory=list)
    limited: list[bool] = field(default_factory=list)
    lost: int = 0

    def note(
        self,
        sent_s: float,
        received_s: float,
        x_mm: float,
        force_cN: float,
        commanded_cN: float,
        limited: bool,
    ) -> None:
        self.sent_s.append(sent_s)
        self.received_s.append(received_s)
        self.displacement_mm.append(x_mm)
        self.force_cN.append(force_cN)
        self.commanded_cN.append(commanded_cN)
        self.limited.append(limited)

    def __len__(self) -> int:
        return len(self.sent_s)

    def times_s(self) -> FloatArray:
        """Return when the drive read its sensors: in the middle of each cycle, give or take half of it."""
        ends = np.array([self.sent_s, self.received_s], dtype=np.float64)
        return np.asarray(ends.mean(axis=0), dtype=np.float64)

    def press(self, first: int, last: int, tick_s: float, velocity_mm_s: float, simulated: bool) -> Press:
        """Return the cycles from first to last as a press with a row per tick_s.

        Cycles do not come as evenly as a board's ticks, and identification and learning need even ones: what
        was measured is interpolated between its true times, a command holds until the next.
        """
        rows = slice(first, last + 1)
        times_s = self.times_s()[rows]
        count = int((times_s[-1] - times_s[0]) / tick_s) + 1
        t_s = np.arange(count, dtype=np.float64) * tick_s
        at_s = times_s[0] + t_s
        x_mm = np.interp(at_s, times_s, self.displacement_mm[rows])
        force_cN = np.interp(at_s, times_s, self.force_cN[rows])
        held = np.searchsorted(times_s, at_s, side="right") - 1
        commanded_cN, limited = np.array(self.commanded_cN[rows])[held], np.array(self.limited[rows])[held]
        every = np.ones(t_s.size, dtype=np.bool_)
        true = t_s, x_mm, force_cN
        return Press(*true, velocity_mm_s, x_mm, force_cN, commanded_cN, limited, every, simulated)


class PressFinder:
    """Finds, while a loop runs, the first whole press and release that went deep enough.

    Attributes
    ----------
    first : cycle with which the press begins, a few before the cap leaves the top.
    """

    def __init__(self, travel_mm: float) -> None:
        self._travel_mm = travel_mm
        self._cycle = -1
        self._was_up = self._down = False
        self._deepest_mm, self._left = 0.0, LEAD_TICKS
        self.first = 0

    def feed(self, displacement_mm: float) -> bool:
        """Take the next cycle's displacement; return True with the last of the press."""
        self._cycle += 1
        is_down = displacement_mm > TOP_mm
        if self._left < LEAD_TICKS:  # it was pressed, and is back
            self._left -= 1
        elif is_down and self._was_up:  # not held as the loop began
            self._go_down(displacement_mm)
        elif self._down and not is_down:
            self._down = False
            # a lighter touch is passed over
            self._left -= self._deepest_mm >= DEEP_RATIO * self._travel_mm
        self._was_up = self._was_up or not is_down
        return self._left == 0

    def _go_down(self, displacement_mm: float) -> None:
        if not self._down:
            self._down, self._deepest_mm = True, 0.0
            self.first = max(0, self._cycle - LEAD_TICKS)
        self._deepest_mm = max(self._deepest_mm, displacement_mm)
