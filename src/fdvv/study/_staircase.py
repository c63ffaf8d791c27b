"""A transformed up-down staircase: which difference comes next, and what threshold it found (Levitt 1971)."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from fdvv.study._effect_size import Estimate
from fdvv.study._plan import Staircase
from fdvv.study._staircase_belief import threshold_interval

LARGEST_ratio = 1.0
"""A comparison is never more than twice as strong: a rig's motor and a finger have limits."""


@dataclass(frozen=True)
class Track:
    """Where a staircase stands after some trials.

    Attributes
    ----------
    ratio : of the next trial; None where it has ended. turns : ratios at which it turned round, in order.
    """

    ratio: float | None
    turns: tuple[float, ...]


def track(staircase: Staircase, history: Sequence[tuple[float, bool]]) -> Track:
    """Follow a staircase over (ratio, correct) of its trials, in order.

    So many correct answers in a row as ``down`` says make the difference smaller, each wrong one larger, by
    the step that belongs to the turns so far. A wrong answer at the largest difference changes nothing.
    """
    ratio, row, falling, turns = staircase.start_ratio, 0, None, list[float]()
    for shown, correct in history:
        row = row + 1 if correct else 0
        if correct and row < staircase.down:
            continue
        row = 0
        if falling is not None and falling != correct:
            turns.append(shown)
        falling = correct
        step = staircase.steps_ratio[min(len(turns), len(staircase.steps_ratio) - 1)]
        ratio = min(shown / step if correct else shown * step, LARGEST_ratio)
    ended = len(turns) >= staircase.reversals or len(history) >= staircase.trials
    return Track(None if ended else ratio, tuple(turns[: staircase.reversals]))


def next_ratio(staircase: Staircase, history: Sequence[tuple[float, bool]]) -> float | None:
    """Give the difference of force that the next trial has, as a ratio of the standard; None: it has ended.

    history : (ratio, correct) of the trials of this staircase so far, practice left out.
    """
    return track(staircase, history).ratio


def threshold(staircase: Staircase, history: Sequence[tuple[float, bool]]) -> Estimate:
    """Give the difference that is told apart at the rate the rule converges to (`target_share`).

    Value: the geometric mean of the ratios at which it turned, the first ``dropped`` left out, and one more
    where their number is odd, so that peaks and valleys weigh alike (Levitt 1971); nan where it turned too
    seldom. Interval: from all trials, see `threshold_interval`; turns of one track are too much alike to give
    one. None for one down, which settles where two labels are told apart by chance.
    """
    turns = track(staircase, history).turns[staircase.dropped :]
    turns = turns[len(turns) % 2 :]
    if not turns:
        return Estimate(math.nan)
    value = float(np.exp(np.mean(np.log(turns))))
    if staircase.down == 1:
        return Estimate(value)
    low, high = threshold_interval(history, target_share(staircase))
    return Estimate(value, min(low, value), max(high, value))


def target_share(staircase: Staircase) -> float:
    """Give the share of correct answers at which a staircase stands still: 0.707 for 2 down, 0.794 for 3."""
    return float(0.5 ** (1 / staircase.down))
