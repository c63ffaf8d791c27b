"""Scores of a validation that are made up, with a known effect."""

from __future__ import annotations

import math
from itertools import product

import numpy as np

from fdvv_people.study.timing.plan import TimingPlan
from fdvv_people.study.timing.scores import ScoreRow, TimingScores


def made_scores(
    plan: TimingPlan, people: int, gain: float, seed: int = 0, simulated: bool = False
) -> TimingScores:
    """Draw scores: the first condition is lower by gain, and people, levels and buttons differ."""
    random = np.random.default_rng(seed)
    levels = plan.all_levels
    person = 12 * random.standard_normal(people)
    slope = 3 * random.standard_normal((people, len(plan.conditions)))
    rows: list[ScoreRow] = []
    for p, (i, level), round_, (c, one) in product(
        range(people), enumerate(levels), range(plan.rounds), enumerate(plan.conditions)
    ):
        score = 85 + 10 * i - gain * (c == 0) + person[p] + slope[p, c] + 4 * random.standard_normal()
        place = f"P{p + 1:02d}", level, round_, c, len(rows), "K4", one.name
        rows.append(ScoreRow(*place, "page", 1, 20, score, 4.0, 0.05, math.nan, 7.0, "", simulated))
    return TimingScores(plan, tuple(rows))
