"""What a record of a rig shows of its parts: place, force and command, as the board sensed them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fdvv.model.press import Press
from fdvv.units import FloatArray

STEP_s, SMOOTH_s = 1e-3, 6e-3
"""Ticks are averaged to the one; rates and forces are then averaged over the other, all alike."""
FEWEST_ticks = 20  # assumed: three spans of SMOOTH_s at 1 kHz; fewer show nothing of a press


@dataclass(frozen=True, eq=False)
class PressFacts:
    """A press, or a while without one, as the board recorded it.

    Attributes
    ----------
    tick_s : between two rows.
    place_mm, commanded_cN : (n,) at every tick.
    force_cN : (n,) of the force sensor; None where the settings have none.
    travel_mm : where the bottom stop was asked to be.
    """

    tick_s: float
    place_mm: FloatArray
    commanded_cN: FloatArray
    force_cN: FloatArray | None
    travel_mm: float

    @classmethod
    def of_press(cls, press: Press, travel_mm: float, has_force: bool) -> PressFacts | None:
        """Take a device's record; None without a rig's columns, or with too few ticks."""
        if press.tick is None or press.sensed_mm is None or press.commanded_cN is None:
            return None
        rows = press.tick
        t_s, force = press.t_s[rows], press.sensed_cN
        if t_s.size < FEWEST_ticks or not np.isfinite(press.sensed_mm[rows]).all():
            return None
        felt = force[rows] if has_force and force is not None else None
        tick_s = float(np.median(np.diff(t_s)))
        return cls(tick_s, press.sensed_mm[rows], press.commanded_cN[rows], felt, travel_mm)

    @property
    def span_mm(self) -> float:
        return float(np.ptp(self.place_mm))

    @property
    def deepest_mm(self) -> float:
        return float(self.place_mm.max())

    def per_ms(self, column: FloatArray) -> FloatArray:
        """Return a column averaged to steps of a millisecond, or as it is if its ticks are longer."""
        many = max(1, round(STEP_s / self.tick_s))
        whole = column.size // many * many
        return np.asarray(column[:whole].reshape(-1, many).mean(axis=1))

    @property
    def step_s(self) -> float:
        """Between two values of `per_ms`."""
        return self.tick_s * max(1, round(STEP_s / self.tick_s))

    def smooth(self, column: FloatArray) -> FloatArray:
        """Return a column of `per_ms`, averaged over 6 ms around each value."""
        width = max(3, round(SMOOTH_s / self.step_s))
        before = width // 2
        held = np.pad(column, (before, width - 1 - before), mode="edge")
        return np.convolve(held, np.ones(width) / width, "valid")

    @property
    def still_cN(self) -> tuple[float, float]:
        """Smallest and largest smoothed force; NaN without a sensor."""
        if self.force_cN is None:
            return float("nan"), float("nan")
        force = self.smooth(self.per_ms(self.force_cN))
        return float(force.min()), float(force.max())
