"""Ratings of answers: people's means by button, tests between renderings, and of many beside each other."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from fdvv.errors import ModelError
from fdvv.units import FloatArray
from fdvv_people.stats.ordinal import ordinal_model
from fdvv_people.stats.post_hoc import holm, pairs_of
from fdvv_people.stats.rank_tests import Friedman, RankPair, friedman, rank_pairs, signed_rank
from fdvv_people.study.analysis.records import ALL_BUTTONS, ButtonTest, RatedResult, ScaleResult, Spread
from fdvv_people.study.analysis.words import people_text
from fdvv_people.study.plan.answers import Answers, is_answered
from fdvv_people.study.plan.plan import Claim

MOST_CATEGORIES = 21
"""A slider to 100 is no list of categories."""

FEWEST_PEOPLE = 3  # the model has two spreads between people, and two people hardly show a spread


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


def complete_rows(columns: FloatArray) -> FloatArray:
    """Return columns (n, k) with the rows that lack a number emptied.

    A difference is taken within a trial: else who skipped one rating of a hard trial would show a difference
    between trials.
    """
    return np.where(np.isfinite(columns).all(axis=1, keepdims=True), columns, np.nan)


def _unpaired(columns: FloatArray) -> int:
    return int(np.isfinite(columns).sum() - np.isfinite(complete_rows(columns)).sum())


def button_tests(answers: Answers, claim: Claim, notes: list[str]) -> tuple[ButtonTest, ...]:
    """Test the ratings of two renderings at every button, trials in which both were rated.

    Holm's correction within a rating. What is left out is noted.
    """
    more, less = (answers.stimuli.index(name) for name in (claim.more, claim.less))
    found: list[ButtonTest] = []
    for rating, columns in answers.ratings.items():
        pairs = columns[:, [more, less]]
        means = people_means(answers, complete_rows(pairs))
        tests = []
        for j, button in enumerate(names_of(answers.item)):
            alone = _unpaired(pairs[answers.counts & (answers.item == button)])
            test = _button_test(button, rating, claim, means[:, j], alone)
            if test:
                tests.append(test)
            elif alone:
                reason = f"{claim.more} and {claim.less} were never rated in one trial"
                notes.append(f"{rating} of {button} is not tested: {reason}.")
        corrected = holm([one.test.p_exact for one in tests])
        found += [replace(one, p_holm=p) for one, p in zip(tests, corrected, strict=True)]
    counted = np.unique(answers.person[answers.counts & is_answered(answers)]).size
    notes += _left_out(found, counted)
    return tuple(found)


def _button_test(
    button: str, rating: str, claim: Claim, means: FloatArray, unpaired: int
) -> ButtonTest | None:
    """Test people's means (people, 2), the same trials in both; None where there are none."""
    both = means[np.isfinite(means).all(axis=1)]
    if not len(both):
        return None
    test = signed_rank(means[:, 0] - means[:, 1])
    spreads = spread_of(both[:, 0]), spread_of(both[:, 1])
    return ButtonTest(button, rating, claim.more, claim.less, *spreads, test, 1.0, unpaired)


def _left_out(tests: list[ButtonTest], people: int) -> list[str]:
    """Say for each rating how many answers, and of how many people, the tests by button do without."""
    notes = []
    for rating in dict.fromkeys(one.rating for one in tests):
        of_it = [one for one in tests if one.rating == rating]
        alone = sum(one.unpaired for one in of_it)
        lacking = [f"{people - one.test.n} at {one.button}" for one in of_it if one.test.n < people]
        if alone:
            ratings = "1 rating stands" if alone == 1 else f"{alone} ratings stand"
            why = "the tests by button compare within trials and leave out what lacks the other stimulus's"
            notes.append(f"{rating}: {ratings} alone in a trial; {why}.")
        if lacking:
            notes.append(f"{rating}: not tested for want of a pair, people: {', '.join(lacking)}.")
    return notes


def rated_results(answers: Answers, notes: list[str]) -> tuple[RatedResult, ...]:
    """Compare all renderings of a MUSHRA-like study: over all buttons, then at each.

    Friedman's test takes trials in which every rendering was rated, a pair those in which both were.
    """
    found = []
    for rating, columns in answers.ratings.items():
        buttons = names_of(answers.item)
        for button in [ALL_BUTTONS, *(buttons if len(buttons) > 1 else ())]:
            one = _rated(answers, rating, button, columns, notes)
            found += [one] if one else []
    return tuple(found)


def _scores(answers: Answers, button: str, columns: FloatArray) -> FloatArray:
    """Return people's means (people, k) at a button; over all only of who rated at each.

    What is missing would else pass for a taste.
    """
    means = people_means(answers, columns)
    place = None if button == ALL_BUTTONS else names_of(answers.item).index(button)
    return means.mean(axis=1) if place is None else means[:, place]


def _rated(
    answers: Answers, rating: str, button: str, columns: FloatArray, notes: list[str]
) -> RatedResult | None:
    scores = _scores(answers, button, columns)
    if not np.isfinite(scores).any(axis=0).all():
        notes.append(f"Nobody rated every rendering of {button or 'all buttons'}: it is left out.")
        return None
    spreads = {name: spread_of(scores[:, i]) for i, name in enumerate(answers.stimuli)}
    rows = answers.counts & ((answers.item == button) | (button == ALL_BUTTONS))
    unpaired = _unpaired(columns[rows])
    complete = _scores(answers, button, complete_rows(columns))
    tested = _friedman(complete, button, notes)
    lost = int(np.isfinite(scores).any(axis=1).sum() - np.isfinite(complete).all(axis=1).sum())
    if tested and (lost or unpaired):
        who = f"{people_text(lost)} without a complete trial"
        of = f"Friedman's test of {button or 'all buttons'}"
        notes.append(f"{of} leaves out {who} and {unpaired} ratings of incomplete ones.")
    pairs = _rank_pairs(answers, button, columns, notes)
    return RatedResult(button, rating, spreads, tested, pairs, unpaired)


def _rank_pairs(answers: Answers, button: str, columns: FloatArray, notes: list[str]) -> tuple[RankPair, ...]:
    differences = {}
    for first, second in pairs_of(answers.stimuli, None):
        places = [answers.stimuli.index(first), answers.stimuli.index(second)]
        means = _scores(answers, button, complete_rows(columns[:, places]))
        differences[first, second] = means[:, 0] - means[:, 1]
    try:
        return rank_pairs(differences)
    except ModelError as error:
        notes.append(f"Pairs of {button or 'all buttons'} are not tested: {error}.")
        return ()


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
        if model.singular:
            notes.append(f"The ordinal model of {rating}: {model.singular}.")
        found.append(ScaleResult(rating, claim.more, claim.less, model))
    return tuple(found)
