"""Where a signal takes a sudden turn: a likelihood ratio against smooth motion and rings that go on."""

from __future__ import annotations

import functools
import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
import numpy.typing as npt

from fdvv.errors import ModelError
from fdvv.units import FloatArray
from fdvv.vibration._projection import shapes

SMOOTH_DEGREE = 3
"""Motion without a snap is a polynomial of this degree over the window around a candidate."""

REACHES_samples, LONGEST_REACH_s, RING_REACH_s = (8.0, 32.0, 64.0), 0.008, 0.002
"""Windows either side of a candidate. The shortest has samples enough for the unknowns and tells most sharply
when; a noisier sensor needs longer ones. With known rings it is half a period of 250 Hz, so that their going
on can be told from their beginning."""

FIRST_ratio = 0.3
"""The first candidate with this part of the largest gain is taken: a blow sets off turns that follow it."""

FALSE_ALARM = 0.01
"""Accepted chance that a press without a turn shows one."""


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
        raise ModelError(f"noise needs at least 8 samples in a row to be told, got {values.shape}")
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
    if rings:
        return _search(
            t_s, signal, (start_s, end_s), noise, max(RING_REACH_s, REACHES_samples[0] * period), rings
        )
    shortest, *longer = (count * period for count in REACHES_samples)
    reaches = [shortest, *(reach for reach in longer if reach <= LONGEST_REACH_s)]
    found = []
    for reach in reaches:
        turn = _search(t_s, signal, (start_s, end_s), noise, reach, ())
        if turn is not None:
            found.append(replace(turn, chance=min(1.0, turn.chance * len(reaches))))
            if found[-1].chance <= FALSE_ALARM:
                return found[-1]
    return min(found, key=lambda turn: turn.chance, default=None)


def _search(
    t_s: FloatArray,
    signal: FloatArray,
    span_s: tuple[float, float],
    noise: float,
    reach_s: float,
    rings: Sequence[tuple[float, float]],
) -> Turn | None:
    """Scan a span for turns with one reach."""
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
    """Give the chance that chi-square with an even number of degrees of freedom exceeds a value."""
    half, terms = 0.5 * value, range(freedom // 2)
    return float(math.exp(-half) * math.fsum(half**j / math.factorial(j) for j in terms))


def _gains(
    y: FloatArray,
    halves: npt.NDArray[np.int64],
    noise: float,
    reach: float,
    rings: tuple[tuple[float, float], ...],
) -> FloatArray:
    """Give for turns at each of these half samples the fall of the residual power, over the noise power.

    reach in samples, rings per sample. Where even the turn leaves more than the noise, what it leaves is
    taken as the noise, so that lively motion does not pass for a turn. Turns that have as many samples either
    side share one table.
    """
    low = np.maximum(np.ceil(0.5 * halves - reach).astype(int), 0)
    high = np.minimum(np.ceil(0.5 * halves + reach).astype(int), y.size)
    cuts = np.stack([2 * low - halves, high - low], axis=1)
    gains = np.zeros(halves.size)
    for cut in np.unique(cuts, axis=0):
        found = _basis(int(cut[0]), int(cut[1]), reach, rings)
        if found is None:
            continue
        smooth, q = found
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
    """Give the columns that smooth motion takes and an orthonormal basis of it and a turn after it, (n, p).

    first : half samples from the turn to the first sample, below 0. None where a turn cannot be told.
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
    # a turn at the edge of the stretch cannot be told from its smooth motion
    if free < 1 or not u[edge - 1] < 0 < u[-edge]:
        return None
    q, _ = np.linalg.qr(np.hstack([before, turn]))
    return before.shape[1], q
