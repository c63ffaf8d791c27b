"""Ratings of answers as ordered categories: no step of a scale is taken to be as wide as another."""

from __future__ import annotations

import numpy as np

from fdvv.errors import ModelError
from fdvv.study import Answers, Claim, ordinal_model
from fdvv.workflow._study_records import ScaleResult

MOST_CATEGORIES = 21
"""A slider to 100 is no list of categories."""
FEWEST_PEOPLE = 3


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
