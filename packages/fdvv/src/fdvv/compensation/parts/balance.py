"""The balance of forces at the cap, fitted over the presses of a session: what the coil gives per command.

While the cap travels between its stops, with x into the button,

    sensed force = zero - weight + gain command + mass a + drag v + friction sign(v)

`PressBalance` holds what presses say of these five numbers; a further press is held against it.
"""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from fdvv.compensation.parts.facts import PressFacts
from fdvv.units import FloatArray

LEVEL, GAIN = 0, 1
MEAN = np.array([-20.0, 1.0, 2.0, 0.05, 3.0])
SPREAD = np.array([30.0, 2.0, 3.0, 0.1, 5.0])
"""Of cN, ratio, cN per m/s2, cN per mm/s and cN before any press: rigs of 5 to 50 g."""
NOISE_cN = 2.0
"""What the balance leaves of a sound press, rms."""
DELAYS_s = (0.0, 5e-4, 1e-3, 1.5e-3, 2e-3, 3e-3)
"""Of the force behind its command; the one that leaves least counts."""
UPPER_mm, LOWER_mm, SLOWEST_mm_s = 0.25, 0.3, 8.0
"""Only what is so far from the stops, and so fast, counts."""
FEWEST_rows = 10
MOST_turns = 4
"""A cap that turns more often chatters; the delays of its forces are not known well enough for that."""


@dataclass(frozen=True, eq=False)
class Strokes:
    """The rows of a press that count: columns (n, 5) of the balance, and the force (n,)."""

    columns: FloatArray
    force_cN: FloatArray


@dataclass(frozen=True, eq=False)
class PressBalance:
    """What presses so far say of the balance.

    Attributes
    ----------
    weight : (5, 5) and pull : (5,), normal equations with the prior. presses : that count in them.
    """

    weight: FloatArray = field(default_factory=lambda: np.diag(1 / SPREAD**2))
    pull: FloatArray = field(default_factory=lambda: MEAN / SPREAD**2)
    presses: int = 0

    @property
    def numbers(self) -> FloatArray:
        return np.asarray(np.linalg.solve(self.weight, self.pull), dtype=np.float64)

    @property
    def gain(self) -> tuple[float, float]:
        """Force per command, and its standard error."""
        return float(self.numbers[GAIN]), float(np.linalg.inv(self.weight)[GAIN, GAIN] ** 0.5)

    def with_press(self, facts: PressFacts) -> PressBalance:
        """Return the balance with a press more; the same if it shows nothing."""
        fitted = [self._added(rows) for delay in DELAYS_s if (rows := strokes_of(facts, delay))]
        if not fitted:
            return self
        return min(fitted, key=lambda one: one[0])[1]

    def _added(self, rows: Strokes) -> tuple[float, PressBalance]:
        """Return what a press leaves, and the balance with it."""
        scale = 1 / (NOISE_cN**2 * _CORRELATED)
        weight = self.weight + scale * rows.columns.T @ rows.columns
        pull = self.pull + scale * rows.columns.T @ rows.force_cN
        found = PressBalance(weight, pull, self.presses + 1)
        left = rows.force_cN - rows.columns @ found.numbers
        return float(np.mean(left**2)), found

    def missed_cN(self, facts: PressFacts) -> tuple[float, float] | None:
        """Return the mean force beyond the balance, and the coil's part in that; None if nothing shows."""
        fitted = [
            (float(np.std(left)), float(np.mean(left)), float(np.mean(rows.columns[:, GAIN])))
            for delay in DELAYS_s
            if (rows := strokes_of(facts, delay))
            for left in [rows.force_cN - rows.columns @ self.numbers]
        ]
        if not fitted:
            return None
        _, missed, commanded = min(fitted)
        return missed, self.gain[0] * commanded


_CORRELATED = 12.0
"""Rows of a millisecond that say the same, as they were averaged."""


def strokes_of(facts: PressFacts, delay_s: float) -> Strokes | None:
    """Return what counts of a press; None if too little does, or without a force sensor."""
    if facts.force_cN is None:
        return None
    step_s = facts.step_s
    place = facts.per_ms(facts.place_mm)
    speed = facts.smooth(np.gradient(facts.smooth(place), step_s)) if place.size > 2 else place
    turn = facts.smooth(np.gradient(speed, step_s)) / 1000 if place.size > 2 else place
    held = facts.per_ms(facts.commanded_cN)
    late = round(delay_s / step_s)
    pushed = facts.smooth(facts.smooth(np.concatenate([np.full(late, held[0]), held[: held.size - late]])))
    force, where = facts.smooth(facts.smooth(facts.per_ms(facts.force_cN))), facts.smooth(place)
    deep = min(facts.travel_mm, facts.deepest_mm) - LOWER_mm
    rows = (where > UPPER_mm) & (where < deep) & (np.abs(speed) > SLOWEST_mm_s)
    turns = np.count_nonzero(np.diff(np.sign(speed[rows])))
    if np.count_nonzero(rows) < FEWEST_rows or turns > MOST_turns:
        return None
    ones, way = np.ones(place.size), np.sign(speed)
    columns = np.stack([ones, pushed, turn, speed, way], axis=1)
    return Strokes(columns[rows], force[rows])
