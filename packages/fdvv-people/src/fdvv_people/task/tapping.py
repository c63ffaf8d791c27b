"""Rapid tapping: as many presses a second as the button lets one make."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from fdvv.errors import ModelError
from fdvv_people.task.score import Objective, Score
from fdvv_people.task.task import TaskPress

REPEAT_s = 0.08
"""A finger does not press again so soon: it makes 5 to 7 strokes a second (Repp 2005). A key that does was
pressed by the button, which kicked, bounced or repeated (the bound is assumed)."""
RATE, UNEVEN = Objective("rate_Hz", larger_is_better=True), Objective("interval_spread_ratio")


@dataclass(frozen=True)
class RapidTapping:
    """Tap as fast as possible.

    Attributes
    ----------
    rounds : taps of a score, three at least.

    Scores the rate of activations and the spread of their intervals over their mean. Taps that the key does
    not tell make an interval longer; fewer than three activations are a rate of 0 and a spread of 1.
    """

    rounds: int = 20

    def __post_init__(self) -> None:
        if self.rounds < 3:
            raise ModelError(f"rapid tapping needs three taps at least, got {self.rounds}")

    @property
    def name(self) -> str:
        return "tapping"

    @property
    def objectives(self) -> tuple[Objective, ...]:
        return (RATE, UNEVEN)

    def scores(self, presses: Sequence[TaskPress]) -> dict[str, Score]:
        """Score the taps; errors as of independent intervals. ModelError if there is nothing to score."""
        if not presses:
            raise ModelError("there is nothing to score: no round was played")
        keys = np.sort([key for press in presses for key in press.activations_s])
        intervals = np.diff(keys)
        if intervals.size < 2:
            return {RATE.name: Score(0.0), UNEVEN.name: Score(1.0)}
        ratio = float(np.std(intervals, ddof=1) / np.mean(intervals))
        rate = float(1 / np.mean(intervals))
        return {
            RATE.name: Score(rate, rate * ratio / float(np.sqrt(intervals.size))),
            UNEVEN.name: Score(ratio, ratio / float(np.sqrt(2 * intervals.size))),
        }


def strokes_Hz(presses: Sequence[TaskPress]) -> float:
    """Return the strokes a second of the finger, nan of fewer than three.

    A press of the key within REPEAT_s of a stroke is none.
    """
    strokes: list[float] = []
    for key_s in sorted(key for press in presses for key in press.activations_s):
        if not strokes or key_s - strokes[-1] >= REPEAT_s:
            strokes.append(key_s)
    return (len(strokes) - 1) / (strokes[-1] - strokes[0]) if len(strokes) > 2 else math.nan
