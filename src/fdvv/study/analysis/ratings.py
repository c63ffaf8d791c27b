"""Ratings of answers: people's means by button, tests between renderings, and of many beside each other."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from fdvv.errors import ModelError
from fdvv.stats.ordinal import ordinal_model
from fdvv.stats.post_hoc import holm
from fdvv.stats.rank_tests import Friedman, friedman, ranked_pairs, signed_rank
from fdvv.study.analysis.records import ALL_BUTTONS, ButtonTest, RatedResult, ScaleResult, Spread
from fdvv.study.plan.answers import Answers
from fdvv.study.plan.plan import Claim
from fdvv.units import FloatArray

MOST_CATEGORIES = 21
"""A slider to 100 is no list of categories."""

FEWEST_PEOPLE = 3


def names_of(column: np.ndarray) -> tuple[str, ...]:
    """Return the names of a column in the order in which they first appear."""
    return tuple(dict.fromkeys(str(one) for one in column))


def people_means(answers: Answers, columns: FloatArray) -> FloatArray:
    """Average columns (n, k) over the rounds that count: (people, buttons, k), nan where there is none.

    People and buttons in the order in which they first appear in all rows.
    """
    people, buttons = names_of(answers.person), names_of(answers.item)
    found = np.full((len(people), len(buttons), columns.shape[1]), np.nan)
    for i, person in enumerate(people):
        for j, button in enumerate(buttons):
            rows = (answers.person == person) & (answers.item == button) & answers.counts
            count = np.isfinite(columns[rows]).sum(axis=0)
            found[i, j] = np.nansum(columns[rows], axis=0) / np.where(count, count, np.nan)
    return found


def spread_of(values: FloatArray) -> Spread:
    """Summarise one number a person, missing ones left out."""
    from scipy.stats import t as student

    there = values[np.isfinite(values)]
    n = there.size
    if not n:
        return Spread(0, *[np.nan] * 5)
    mean = float(there.mean())
    sd = float(there.std(ddof=1)) if n > 1 else float("nan")
    half = float(student.ppf(0.975, n - 1)) * sd / n**0.5 if n > 1 else float("nan")
    return Spread(n, mean, mean - half, mean + half, sd, float(np.median(there)))


def button_tests(answers: Answers, claim: Claim) -> tuple[ButtonTest, ...]:
    """Test the ratings of two renderings at every button; Holm's correction within a rating."""
    more, less = (answers.stimuli.index(name) for name in (claim.more, claim.less))
    found: list[ButtonTest] = []
    for rating, columns in answers.ratings.items():
        means = people_means(answers, columns)
        tests = []
        for j, button in enumerate(names_of(answers.item)):
            pair = means[:, j, [more, less]]
            both = pair[np.isfinite(pair).all(axis=1)]
            if len(both):
                test = signed_rank(pair[:, 0] - pair[:, 1])
                spreads = spread_of(both[:, 0]), spread_of(both[:, 1])
                tests.append(ButtonTest(button, rating, claim.more, claim.less, *spreads, test, 1.0))
        corrected = holm([one.test.p_exact for one in tests])
        found += [replace(one, p_holm=p) for one, p in zip(tests, corrected, strict=True)]
    return tuple(found)


def rated_results(answers: Answers, notes: list[str]) -> tuple[RatedResult, ...]:
    """Compare all renderings of a MUSHRA-like study: over all buttons, then at each."""
    found = []
    for rating, columns in answers.ratings.items():
        means = people_means(answers, columns)
        buttons = names_of(answers.item)
        # a person's mean over buttons only where they rated each, or what is missing would pass for a taste
        places = [(ALL_BUTTONS, means.mean(axis=1))]
        if len(buttons) > 1:
            places += [(button, means[:, j]) for j, button in enumerate(buttons)]
        for button, scores in places:
            one = _rated(answers.stimuli, rating, button, scores, notes)
            found += [one] if one else []
    return tuple(found)


def _rated(
    stimuli: tuple[str, ...], rating: str, button: str, scores: FloatArray, notes: list[str]
) -> RatedResult | None:
    """Compare people's scores (people, stimuli)."""
    if not np.isfinite(scores).any(axis=0).all():
        notes.append(f"Nobody rated every rendering of {button or 'all buttons'}: it is left out.")
        return None
    spreads = {name: spread_of(scores[:, i]) for i, name in enumerate(stimuli)}
    try:
        pairs = ranked_pairs(scores, stimuli)
    except ModelError as error:
        notes.append(f"Pairs of {button or 'all buttons'} are not tested: {error}.")
        pairs = ()
    return RatedResult(button, rating, spreads, _friedman(scores, button, notes), pairs)


def _friedman(scores: FloatArray, button: str, notes: list[str]) -> Friedman | None:
    complete = scores[np.isfinite(scores).all(axis=1)]
    try:
        return friedman(complete)
    except ModelError as error:
        notes.append(f"Friedman's test of {button or 'all buttons'} cannot be computed: {error}.")
        return None


def scale_results(answers: Answers, claim: Claim, notes: list[str]) -> tuple[ScaleResult, ...]:
    """Fit the ratings of two renderings, people with their own use of the scale and their own difference."""
    found = []
    for rating, columns in answers.ratings.items():
        less, more = (columns[answers.counts, answers.stimuli.index(n)] for n in (claim.less, claim.more))
        values = np.concatenate([less, more])
        used = np.unique(values[np.isfinite(values)])
        person = np.tile(answers.person[answers.counts], 2)
        people = np.unique(person[np.isfinite(values)]).size
        if used.size > MOST_CATEGORIES or people < FEWEST_PEOPLE or np.any(used % 1):
            continue
        which = np.repeat([0.0, 1.0], less.size)
        try:
            model = ordinal_model(values, person, which, [claim.more], slope=claim.more)
        except ModelError as error:
            notes.append(f"No ordinal model of {rating}: {error}.")
            continue
        found.append(ScaleResult(rating, claim.more, claim.less, model))
    return tuple(found)
