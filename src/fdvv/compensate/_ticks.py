"""What one press tells at its ticks, and the smooth window through which it is looked at."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property, lru_cache

import numpy as np
import numpy.typing as npt

from fdvv.compensate._judge import rig_columns
from fdvv.errors import FitError
from fdvv.model import Press
from fdvv.units import FloatArray

BoolArray = npt.NDArray[np.bool_]

DEGREE = 5
KNOT_s = 1e-3
"""Between the knots of the window; it reaches three of them to both sides."""
NOISE_CUT_percentile = 98.0
"""Larger differences are impacts, not noise."""
SHORTEST_ticks = 40


@lru_cache(maxsize=8)
def windows(tick_s: float) -> tuple[FloatArray, ...]:
    """Give a B-spline window of sum 1 and its first three derivatives (1/s, ...), (2 reach + 1,) each.

    Its knots lie on ticks, so sums over samples are exact for polynomials up to its degree.
    """
    from scipy.interpolate import BSpline

    ticks = max(1, round(KNOT_s / tick_s))
    reach = ticks * (DEGREE + 1) // 2
    knots = (np.arange(DEGREE + 2) - (DEGREE + 1) / 2) * ticks * tick_s
    spline = BSpline.basis_element(knots, extrapolate=False)
    at = np.arange(-reach, reach + 1) * tick_s
    shapes = [spline, *(spline.derivative(order) for order in (1, 2, 3))]
    return tuple(np.nan_to_num(shape(at)) / ticks for shape in shapes)


def through(window: FloatArray, signal: FloatArray) -> FloatArray:
    """Look at a signal through a window: its weighted mean, or that of its derivative, at every tick, (n,).

    A signal goes on beyond its ends with its end values.
    """
    return np.convolve(np.pad(signal, window.size // 2, mode="edge"), window, mode="valid")


@dataclass(frozen=True, eq=False)
class Ticks:
    """A press on even ticks, (n,) each: displacement and force as sensed, the command, and doubtful rows.

    cut : the command was cut to a limit, or a tick is missing here.
    """

    tick_s: float
    t_s: FloatArray
    sensed_mm: FloatArray
    force_cN: FloatArray
    commanded_cN: FloatArray
    cut: BoolArray

    @cached_property
    def motion(self) -> tuple[FloatArray, ...]:
        """Give sensed displacement and its first three derivatives through the window, mm, s."""
        return tuple(through(window, self.sensed_mm) for window in windows(self.tick_s))

    def ahead_mm(self, lag_s: float) -> FloatArray:
        """Give where the cap truly was, its sensed place passing a first-order lag of lag_s."""
        return self.motion[0] + lag_s * self.motion[1]


def ticks_of(press: Press, name: str, tick_s: float | None = None) -> Ticks:
    """Take from a press what its rig knows, on even ticks; FitError, naming it, if that is too little.

    tick_s : period of the loop; the median of the record's ticks if None.
    """
    if press.commanded_cN is None:
        raise FitError(f"{name} holds no commanded force; a rig is known from presses on a rig")
    t_s, sensed, force = rig_columns(press)
    rows = slice(None) if press.tick is None else press.tick
    command = press.commanded_cN[rows]
    if t_s.size < SHORTEST_ticks:
        raise FitError(
            f"{name} has {t_s.size} ticks, at least {SHORTEST_ticks} are needed; record whole presses"
        )
    if not np.isfinite([sensed, force, command]).all():
        raise FitError(f"{name} holds numbers that are not finite; record it again")
    tick_s = tick_s or float(np.median(np.diff(t_s)))
    even = np.arange(t_s[0], t_s[-1] + 0.5 * tick_s, tick_s)
    cut = np.zeros(t_s.size, np.bool_) if press.saturated is None else press.saturated[rows].copy()
    cut[1:] |= np.diff(t_s) > 1.5 * tick_s
    displacement, felt, commanded = (np.interp(even, t_s, column) for column in (sensed, force, command))
    return Ticks(tick_s, even, displacement, felt, commanded, np.interp(even, t_s, cut) > 0)


def noise(columns: list[FloatArray]) -> float:
    """Estimate the rms of what is random from tick to tick, from third differences."""
    squares = np.concatenate([np.diff(column, 3) ** 2 for column in columns])
    kept = np.minimum(squares, np.percentile(squares, NOISE_CUT_percentile))
    return float(np.sqrt(kept.mean() / 20.0))
