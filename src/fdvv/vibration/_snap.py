"""The snap of one press: its onset between contact and stop, or why none was found."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from fdvv.errors import ModelError
from fdvv.model import Stroke
from fdvv.units import FloatArray
from fdvv.vibration._onset import FALSE_ALARM, Turn, find_turn, noise_rms

STOP_mm = 0.15
"""No snap is looked for so near to where the stroke turns: a bench places the cap to 0.1 mm."""

GUARD_samples = 2.0
"""Left out before the stop: its burst has begun by the first sample that shows it."""


@dataclass(frozen=True)
class NotFound:
    """Nothing was found, and why, in one sentence with the figures that decided."""

    reason: str


@dataclass(frozen=True, eq=False)
class HeardPress:
    """One stroke as a vibration sensor and a displacement sensor have it, on one clock.

    Attributes
    ----------
    t_s, signal : (n,) evenly sampled, from rest to after the stop; delays of filters already taken off t_s.
    place_s, place_mm : (m,) displacement into the button, at any rate; of the whole press or of the stroke.
    stroke : which of the two strokes is meant.
    noise : rms of the signal's noise per sample; estimated from the record if None.
    """

    t_s: FloatArray
    signal: FloatArray
    place_s: FloatArray
    place_mm: FloatArray
    stroke: Stroke
    noise: float | None = None

    def __post_init__(self) -> None:
        object.__setattr__(self, "stroke", Stroke(self.stroke))
        for t, y, name in ((self.t_s, self.signal, "signal"), (self.place_s, self.place_mm, "displacement")):
            if t.shape != y.shape or t.ndim != 1 or t.size < 8 or np.any(np.diff(t) <= 0):
                raise ModelError(
                    f"the {name} needs 8 or more samples at rising times, got {y.shape} at {t.shape}"
                )
            if not (np.isfinite(t).all() and np.isfinite(y).all()):
                raise ModelError(f"the {name} must be finite; leave out what was not seen")

    @property
    def period_s(self) -> float:
        """Time between samples of the signal."""
        return float(self.t_s[-1] - self.t_s[0]) / (self.t_s.size - 1)

    @cached_property
    def _own_noise(self) -> float:
        return noise_rms(self.signal)

    def noise_or_own(self) -> float:
        """Give the noise that was stated, else the record's own."""
        return self._own_noise if self.noise is None else self.noise

    def passing_s(self, at_mm: float) -> float | None:
        """Give when the stroke passes a displacement; None if it never does."""
        turn = int(np.argmax(self.place_mm))
        part = slice(None, turn + 1) if self.stroke is Stroke.PRESS else slice(turn, None)
        t, x = self.place_s[part], self.place_mm[part]
        past = x >= at_mm if self.stroke is Stroke.PRESS else x <= at_mm
        k = int(np.argmax(past))
        if not past.any() or k == 0:
            return None
        return float(t[k - 1] + (at_mm - x[k - 1]) / (x[k] - x[k - 1]) * (t[k] - t[k - 1]))

    def place_at(self, t_s: float) -> float:
        """Give the displacement at a time."""
        return float(np.interp(t_s, self.place_s, self.place_mm))


@dataclass(frozen=True)
class Snap:
    """The snap of one press.

    Attributes
    ----------
    onset_s : on the clock of the press. onset_mm : where the cap was.
    velocity_mm_s : of the cap there, positive.
    stop_s : up to when the signal is free of the stop.
    turn : what was seen of it.
    """

    onset_s: float
    onset_mm: float
    velocity_mm_s: float
    stop_s: float
    turn: Turn


def find_snap(
    press: HeardPress, window_mm: tuple[float, float], rings: Sequence[tuple[float, float]] = ()
) -> Snap | NotFound:
    """Find the onset of the snap of one press in the middle of its stroke.

    window_mm : displacements between which it may start, as SnapEnergy.window_mm; contact and bottom-out
        belong outside.
    rings : frequency (Hz) and decay (1/s) of modes already known, which sharpen the search.

    The largest sudden turn counts if noise alone gives such a one in less than a hundredth of presses.
    """
    deepest = float(press.place_mm.max()) - STOP_mm
    passed = [press.passing_s(min(at, deepest)) for at in window_mm]
    if passed[0] is None or passed[1] is None:
        return NotFound(f"the stroke does not pass {window_mm[0]:.2f} to {window_mm[1]:.2f} mm")
    start, end = sorted((passed[0], passed[1]))
    stop = stop_s(press, end)
    free = press.t_s < stop
    noise = press.noise_or_own()
    if not noise > 0:
        return NotFound("the signal does not change: the sensor heard nothing at all")
    turn = find_turn(press.t_s[free], press.signal[free], start, min(end, stop), noise, rings)
    if turn is None:
        return NotFound(f"{1e3 * (min(end, stop) - start):.1f} ms before the stop hold too few samples")
    if turn.chance > FALSE_ALARM:
        return NotFound(
            "no turn stands out of the noise: the largest would come by chance in "
            f"{100 * turn.chance:.0f} % of presses"
        )
    step = max(press.period_s, 2e-3)
    moved = press.place_at(turn.t_s + step) - press.place_at(turn.t_s - step)
    return Snap(turn.t_s, press.place_at(turn.t_s), abs(moved) / (2 * step), stop, turn)


def stop_s(press: HeardPress, after_s: float) -> float:
    """Give until when the signal is free of the stop that ends the stroke (bottom-out, or the top).

    The stop is by far the loudest thing after the snap. It begins at the first sample after after_s whose
    third difference is six times that of the noise and a thirtieth of the stop's largest, or, in more noise,
    half of the largest. A guard before it is left out.
    """
    turn = float(press.place_s[np.argmax(press.place_mm)])
    end = turn if press.stroke is Stroke.PRESS else float(press.place_s[-1])
    # the samples that a third difference spans end at its own
    third, at = np.abs(np.diff(press.signal, 3)), press.t_s[3:]
    later = (at > after_s) & (at <= max(end, after_s + 10 * press.period_s))
    if not later.any():
        return after_s
    loud = third[later]
    largest = float(loud.max())
    level = min(max(6 * np.sqrt(20.0) * press.noise_or_own(), largest / 30), largest / 2)
    return float(at[later][int(np.argmax(loud >= level))] - GUARD_samples * press.period_s)
