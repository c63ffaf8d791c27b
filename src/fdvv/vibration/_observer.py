"""A simulated observer: answers by a hidden preference with noise. For tests only; evidence of nothing."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from fdvv.vibration._tune import Preferred, Question
from fdvv.vibration._tune_rate import HIGHEST, LOWEST

SCALE = 1.5
"""Ratings per unit of how much a template is liked."""


@dataclass(frozen=True)
class SimulatedObserver:
    """Answers as someone might whose likes are known; a proxy that shows that the machinery works.

    Attributes
    ----------
    likes : per velocity and template, in units of the noise of a comparison by Thurstone's model.
    unsure : difference felt below which neither is preferred.
    seed : of the noise. noise : standard deviation of what is felt of one template.
    """

    likes: Sequence[Sequence[float]]
    unsure: float = 0.2
    noise: float = 1.0
    seed: int = 0

    def answer(self, question: Question) -> int | Preferred:
        """Rate one template, or compare two; the same question, by its number, is answered the same."""
        random = np.random.default_rng([self.seed, question.number])
        likes = self.likes[question.place]
        felt = [likes[i] + self.noise * random.normal() for i in question.templates]
        if len(felt) == 1:
            middle = (LOWEST + HIGHEST) / 2
            return int(np.clip(round(middle + SCALE * felt[0]), LOWEST, HIGHEST))
        if abs(felt[0] - felt[1]) < self.unsure:
            return Preferred.NEITHER
        return Preferred.FIRST if felt[0] > felt[1] else Preferred.SECOND
