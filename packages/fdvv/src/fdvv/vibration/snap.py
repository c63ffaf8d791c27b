"""The snap of one press: its onset between contact and stop, or why there is none."""

from __future__ import annotations

import functools
import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
import numpy.typing as npt

from fdvv.errors import ModelError
from fdvv.model.curve import Stroke
from fdvv.units import FloatArray
from fdvv.vibration.projection import shapes

SMOOTH_DEGREE = 3
"""Motion without a snap is a polynomial of this degree over the window around a candidate."""
REACHES_samples, LONGEST_REACH_s, RING_REACH_s = (8.0, 32.0, 64.0), 0.008, 0.002
"""Windows either side of a candidate. The shortest has samples enough for the unknowns and is most precise in
time; a noisier sensor needs longer ones. With known rings it is half a period of 250 Hz, so that their going
on can be read from their beginning."""
FIRST_ratio = 0.3
"""The first candidate with this part of the largest gain is taken: a blow sets off turns that follow it."""
FALSE_ALARM = 0.01
"""Accepted chance that a press without a turn shows one."""
STOP_mm = 0.15
"""No snap is looked for so near to where the stroke turns: a bench places the cap to 0.1 mm."""
GUARD_samples = 2.0
"""Left out before the stop: its burst has begun by the first sample that shows it."""


@dataclass(frozen=True)
class Turn:
    """A sudden turn of a signal.

    Attributes
    ----------
    t_s : when.
    gain : how much better a turn there explains the signal, in powers of the noise.
    chance : that noise alone gives such a gain somewhere in the stretch, at most 1.
    """

    t_s: float
    gain: float
    chance: float


def noise_rms(signal: npt.ArrayLike) -> float:
    """Estimate the rms of white noise from a record's own third differences, by their median.

    Smooth motion leaves no third differences and short transients do not move a median. The step of a
    converter counts as the noise it is; a record in which nothing changes gives 0. Raises ModelError below 8
    samples.
    """
    values = np.asarray(signal, dtype=np.float64)
    if values.ndim != 1 or values.size < 8:
        raise ModelError(f"noise needs at least 8 samples in a row, got {values.shape}")
    # third differences of white noise have 1 + 9 + 9 + 1 times its power; the median of |x| is 0.6745 sd
    return float(np.median(np.abs(np.diff(values, 3))) / 0.6745 / math.sqrt(20.0))


def find_turn(
    t_s: FloatArray,
    signal: FloatArray,
    start_s: float,
    end_s: float,
    noise: float,
    rings: Sequence[tuple[float, float]] = (),
) -> Turn | None:
    """Find the first strong turn between start_s and end_s; None where too few samples surround any.

    t_s, signal : (n,) evenly sampled, contact and stop already cut off.
    noise : rms of white noise per sample.
    rings : frequency (Hz) and decay (1/s) of modes known to ring. With them a turn is that they begin anew,
        and a ring that merely goes on is none; without, a change of slope and curvature.
    """
    if not noise > 0:
        raise ModelError(f"noise must be above 0, got {noise}")
    if t_s.size < 2:
        return None
    period = float(t_s[-1] - t_s[0]) / (t_s.size - 1)
    shortest, *longer = (count * period for count in REACHES_samples)
    if rings:
        return _search(t_s, signal, (start_s, end_s), noise, max(RING_REACH_s, shortest), rings)
    reaches = [shortest, *(reach for reach in longer if reach <= LONGEST_REACH_s)]
    turns = []
    for reach in reaches:
        turn = _search(t_s, signal, (start_s, end_s), noise, reach, ())
        if turn is not None:
            turns.append(replace(turn, chance=min(1.0, turn.chance * len(reaches))))
            if turns[-1].chance <= FALSE_ALARM:
                return turns[-1]
    return min(turns, key=lambda turn: turn.chance, default=None)


def _search(
    t_s: FloatArray,
    signal: FloatArray,
    span_s: tuple[float, float],
    noise: float,
    reach_s: float,
    rings: Sequence[tuple[float, float]],
) -> Turn | None:
    period = float(t_s[-1] - t_s[0]) / (t_s.size - 1)
    reach, turned = reach_s / period, tuple((f * period, d * period) for f, d in rings)
    # finer than a fortieth of the reach nothing changes
    stride = max(1, int(2 * reach / 40))
    first, last = (math.ceil(2 * (at - t_s[0]) / period) for at in span_s)
    halves = np.arange(max(first, 0), min(last, 2 * t_s.size), stride)
    gain = _gains(signal, halves, noise, reach, turned)
    if not halves.size or not gain.max() > 0:
        return None
    first = int(np.argmax(gain >= FIRST_ratio * gain.max()))
    near = int(np.searchsorted(halves, halves[first] + reach))
    best = first + int(np.argmax(gain[first:near]))
    # gains a third of the reach apart are nearly independent
    tried = 1 + 3 * (span_s[1] - span_s[0]) / reach_s
    chance = min(1.0, tried * chi_square_tail(float(gain[best]), 2 * len(rings) or 2))
    return Turn(float(t_s[0] + 0.5 * period * halves[best]), float(gain[best]), chance)


def chi_square_tail(value: float, freedom: int) -> float:
    """Return the chance that chi-square with an even number of degrees of freedom exceeds a value."""
    half, terms = 0.5 * value, range(freedom // 2)
    return float(math.exp(-half) * math.fsum(half**j / math.factorial(j) for j in terms))


def _gains(
    y: FloatArray,
    halves: npt.NDArray[np.int64],
    noise: float,
    reach: float,
    rings: tuple[tuple[float, float], ...],
) -> FloatArray:
    """Return for turns at each of these half samples the fall of the residual power, over the noise power.

    reach in samples, rings per sample. Where even the turn leaves more than the noise, what it leaves is
    taken as the noise, so that lively motion does not pass for a turn. Turns that have as many samples either
    side share one table.
    """
    low = np.maximum(np.ceil(0.5 * halves - reach).astype(int), 0)
    high = np.minimum(np.ceil(0.5 * halves + reach).astype(int), y.size)
    cuts = np.stack([2 * low - halves, high - low], axis=1)
    gains = np.zeros(halves.size)
    for cut in np.unique(cuts, axis=0):
        basis = _basis(int(cut[0]), int(cut[1]), reach, rings)
        if basis is None:
            continue
        smooth, q = basis
        which = np.all(cuts == cut, axis=1)
        windows = np.lib.stride_tricks.sliding_window_view(y, int(cut[1]))[low[which]]
        parts = (windows @ q) ** 2
        left = (np.sum(windows**2, axis=1) - parts.sum(axis=1)) / (int(cut[1]) - q.shape[1])
        gains[which] = parts[:, smooth:].sum(axis=1) / np.maximum(noise**2, left)
    return gains


@functools.lru_cache(maxsize=1024)
def _basis(
    first: int, count: int, reach: float, rings: tuple[tuple[float, float], ...]
) -> tuple[int, FloatArray] | None:
    """Return the columns that smooth motion takes and an orthonormal basis of it and a turn after it, (n, p).

    first : half samples from the turn to the first sample, below 0. None where a turn cannot be found.
    """
    after: FloatArray = np.asarray(0.5 * first + np.arange(count), dtype=np.float64)
    u = after / reach
    smooth = np.polynomial.legendre.legvander(u, SMOOTH_DEGREE)
    if rings:
        f, d = np.array(rings).T
        before, turn = np.hstack([smooth, shapes(after - after[:1], f, d)]), shapes(after, f, d)
    else:
        rise = np.maximum(u, 0.0)
        before, turn = smooth, np.column_stack([rise, rise**2])
    free, edge = count - before.shape[1] - turn.shape[1], 1 + turn.shape[1]
    # a turn at the edge of the stretch cannot be separated from its smooth motion
    if free < 1 or not u[edge - 1] < 0 < u[-edge]:
        return None
    q, _ = np.linalg.qr(np.hstack([before, turn]))
    return before.shape[1], q


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
        return float(self.t_s[-1] - self.t_s[0]) / (self.t_s.size - 1)

    @cached_property
    def noise_rms(self) -> float:
        """The noise that was stated, else the record's own."""
        return noise_rms(self.signal) if self.noise is None else self.noise

    def passing_s(self, at_mm: float) -> float | None:
        """Return when the stroke passes a displacement; None if it never does."""
        turn = int(np.argmax(self.place_mm))
        part = slice(None, turn + 1) if self.stroke is Stroke.PRESS else slice(turn, None)
        t, x = self.place_s[part], self.place_mm[part]
        past = x >= at_mm if self.stroke is Stroke.PRESS else x <= at_mm
        k = int(np.argmax(past))
        if not past.any() or k == 0:
            return None
        return float(t[k - 1] + (at_mm - x[k - 1]) / (x[k] - x[k - 1]) * (t[k] - t[k - 1]))

    def place_at(self, t_s: float) -> float:
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
    noise = press.noise_rms
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
    """Return until when the signal is free of the stop that ends the stroke (bottom-out, or the top).

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
    level = min(max(6 * np.sqrt(20.0) * press.noise_rms, largest / 30), largest / 2)
    return float(at[later][int(np.argmax(loud >= level))] - GUARD_samples * press.period_s)
