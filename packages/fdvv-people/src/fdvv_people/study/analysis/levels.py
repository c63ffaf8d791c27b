"""Staircases and timing of answers: thresholds of people, and the analysis of variance of scores."""

from __future__ import annotations

import numpy as np

from fdvv.errors import ModelError
from fdvv.units import FloatArray
from fdvv_people.stats.anova import repeated_measures_anova
from fdvv_people.stats.post_hoc import PairedTest, post_hoc
from fdvv_people.study.analysis.ratings import names_of, people_means, spread_of
from fdvv_people.study.analysis.records import Spread, ThresholdResult, TimingResult
from fdvv_people.study.plan.answers import Answers, means_by
from fdvv_people.study.plan.plan import Staircase
from fdvv_people.study.plan.staircase import threshold

FACTORS = ("button", "level")


def threshold_results(answers: Answers, staircase: Staircase | None) -> tuple[ThresholdResult, ...]:
    """Find the threshold of every staircase, its trials in the order of the rows.

    A round is a staircase where rounds hold several trials; else a person's trials of a button are one.
    """
    rule = staircase or Staircase()
    if answers.ratio is None:
        return ()
    counted = answers.counts & np.isfinite(answers.ratio) & np.isfinite(answers.correct)
    keys = list(zip(answers.person.tolist(), answers.item.tolist(), answers.round.tolist(), strict=True))
    # rounds of one trial each: all of a person's trials of a button are one staircase
    if len(set(keys)) == len(keys):
        keys = [(person, button, 0) for person, button, _ in keys]
    found = []
    for key in dict.fromkeys(keys):
        rows = counted & np.array([one == key for one in keys])
        ratios, correct = answers.ratio[rows], answers.correct[rows]
        if ratios.size:
            history = [(float(a), bool(b)) for a, b in zip(ratios, correct, strict=True)]
            found.append(ThresholdResult(*key[:2], ratios, correct, threshold(rule, history)))
    return tuple(found)


def threshold_over_people(found: tuple[ThresholdResult, ...]) -> Spread | None:
    """Summarise thresholds over people, buttons averaged first on the logarithm; None where nobody has one.

    Mean and interval are geometric; sd is that of the natural logarithm.
    """
    values = np.log([one.threshold.value for one in found])
    logs = means_by(values, np.array([one.person for one in found])) if found else np.empty(0)
    spread = spread_of(logs)
    if not spread.people:
        return None
    mean, low, high, median = np.exp([spread.mean, spread.low, spread.high, spread.median]).tolist()
    return Spread(spread.people, mean, low, high, spread.sd, median)


def timing_results(answers: Answers, notes: list[str]) -> TimingResult | None:
    """Test scores by button and level, rounds averaged first; who lacks a cell is left out and noted."""
    if not answers.ratings:
        return None
    measure, columns = next(iter(answers.ratings.items()))
    scores = people_means(answers, columns)
    whole = np.array([np.isfinite(one).all() for one in scores])
    lacking = [name for name, one in zip(names_of(answers.person), whole, strict=True) if not one]
    if lacking:
        notes.append(f"Not tested, for they lack a score somewhere: {', '.join(lacking)}.")
    buttons, levels = names_of(answers.item), answers.stimuli
    complete = scores[whole]
    try:
        anova = repeated_measures_anova(complete, FACTORS)
        pairs = _pairs(complete, buttons, levels)
    except ModelError as error:
        notes.append(f"No analysis of variance: {error}.")
        anova, pairs = None, {}
    return TimingResult(measure, buttons, levels, complete if len(complete) else scores, anova, pairs)


def _pairs(
    scores: FloatArray, buttons: tuple[str, ...], levels: tuple[str, ...]
) -> dict[str, tuple[PairedTest, ...]]:
    found = {"all levels": post_hoc(scores.mean(axis=2), buttons)}
    if len(levels) > 1:
        found |= {level: post_hoc(scores[:, :, i], buttons) for i, level in enumerate(levels)}
    return found
