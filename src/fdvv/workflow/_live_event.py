"""What a live press tells of beside its columns."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from enum import StrEnum

import numpy as np

from fdvv.twin import LedTicks
from fdvv.units import FloatArray

TOP_mm, DEEP_mm = 0.1, 0.3
"""A press begins where the cap passes the first; it counts once it was deeper than the second."""
STEP_mm = 0.02
DOWN_RATIO = 0.9
"""Of its depth: there a press counts as down; what follows may be a finger that holds."""


class LiveEventKind(StrEnum):
    """What a live press tells of beside its columns.

    actuation, reset : the key went down, came up. level : it changed from one level to another.
    vibration : a signal starts at the cap. pressed : a press is over. fault : the firmware fell to no force.
    """

    ACTUATION = "actuation"
    RESET = "reset"
    LEVEL = "level"
    VIBRATION = "vibration"
    PRESSED = "pressed"
    FAULT = "fault"


@dataclass(frozen=True)
class LiveEvent:
    """Something that happened at one moment, simulated.

    Attributes
    ----------
    kind : what. t_s : when; of a vibration, when it starts at the cap, the board's latency included.
    displacement_mm : of the cap then; of a press, how deep it went.
    velocity_mm_s : of the cap, positive downward; of a press, its mean speed from 0.1 mm to nine tenths of
        its depth.
    number : key level, or slot of the vibration's signal. told : the reason of a fault.
    """

    kind: LiveEventKind
    t_s: float
    displacement_mm: float
    velocity_mm_s: float
    number: int = 0
    told: str = ""


class Descent:
    """The way down of the press that is going on, from first to first deeper place."""

    def __init__(self) -> None:
        self._t_s: list[float] = []
        self._x_mm: list[float] = []

    @property
    def begun(self) -> bool:
        """Whether the cap is down."""
        return bool(self._t_s)

    def take(self, t_s: FloatArray, x_mm: FloatArray) -> LiveEvent | None:
        """Go on with a stretch on one side of TOP_mm; give the press that it ended, if any."""
        if x_mm[0] <= TOP_mm:
            return self._over(float(t_s[0]))
        steps = np.floor(x_mm / STEP_mm)
        deeper = steps > np.maximum.accumulate(np.concatenate([[self._deepest_step()], steps[:-1]]))
        self._t_s += t_s[deeper].tolist()
        self._x_mm += x_mm[deeper].tolist()
        return None

    def _deepest_step(self) -> float:
        return float(np.floor(self._x_mm[-1] / STEP_mm)) if self._x_mm else -1.0

    def _over(self, now_s: float) -> LiveEvent | None:
        t, x = np.array(self._t_s), np.array(self._x_mm)
        self._t_s, self._x_mm = [], []
        if not x.size or x[-1] < DEEP_mm:
            return None
        down = int(np.argmax(x >= DOWN_RATIO * x[-1]))
        # a cap that is down within a tick was as fast as can be told
        speed = float((x[down] - x[0]) / max(t[down] - t[0], 1e-4))
        return LiveEvent(LiveEventKind.PRESSED, now_s, float(x[-1]), speed)


def stretches(columns: LedTicks, was_down: bool) -> Iterator[tuple[FloatArray, FloatArray]]:
    """Give time and place of the cap, cut where it passes TOP_mm; was_down : how it stood before."""
    deep = columns.displacement_mm > TOP_mm
    before = np.concatenate([[was_down], deep[:-1]])
    for piece in np.split(np.arange(deep.size), np.flatnonzero(deep != before)):
        if piece.size:
            yield columns.t_s[piece], columns.displacement_mm[piece]
