"""Which change the next trial has: the one whose answer is expected to say most of the observer."""

from __future__ import annotations

from collections.abc import Sequence
from functools import lru_cache

import numpy as np

from fdvv.model.noticeable import DIMENSIONS, Dimension
from fdvv.units import FloatArray
from fdvv_people.thresholds.belief import FEW_PARTICLES, Belief, Change, Trial, belief_after
from fdvv_people.thresholds.observer import JND, share_correct
from fdvv_people.thresholds.prior import ThresholdPrior

STEP = 1.2
"""Between two sizes of a change, a ratio; all changes lie on one grid, so that equal ones are counted."""

FEWEST, MOST = -3, 8
"""Sizes that are weighed, in steps from the middle of the JND: from 0.6 to 4.3 of it."""

EVERY = 3
"""Of so many trials one changes several dimensions where that is asked for; by information none does."""

DIGITS = 9
"""To which information is compared: below it two changes say the same, and the first is taken."""


def directions(dimensions: Sequence[Dimension], several: bool) -> FloatArray:
    """Return the directions of changes, (directions, 3) of 0 and 1: of one dimension each, or of several."""
    used = [one in dimensions for one in DIMENSIONS]
    rows = [row for row in np.ndindex(2, 2, 2) if any(row) and all(np.less_equal(row, used))]
    rows = [row for row in rows if several == (sum(row) > 1)]
    return np.array(sorted(rows, key=lambda row: (sum(row), *(-one for one in row))), dtype=np.float64)


def next_change(
    trials: Sequence[Trial],
    prior: ThresholdPrior,
    dimensions: Sequence[Dimension] = DIMENSIONS,
    largest: Change = (1.0, 1.0, 1.0),
    combined: bool = False,
) -> Change:
    """Return the change of the next trial; it follows from the trials so far, and from nothing else.

    dimensions : that are measured. largest : change of each that can be rendered. combined : every third
    trial changes several dimensions at once, which says how they add up. Takes some milliseconds.
    """
    return _next_change(tuple(trials), prior, tuple(dimensions), largest, combined)


@lru_cache(maxsize=1024)
def _next_change(
    trials: tuple[Trial, ...],
    prior: ThresholdPrior,
    dimensions: tuple[Dimension, ...],
    largest: Change,
    combined: bool,
) -> Change:
    belief = belief_after(trials, prior, FEW_PARTICLES)
    changes = candidates(belief, _along(len(trials), dimensions, combined), largest)
    best = int(np.argmax(np.round(information(belief, changes), DIGITS)))
    force, snap, vibration = changes[best].tolist()
    return force, snap, vibration


def _along(number: int, dimensions: tuple[Dimension, ...], combined: bool) -> FloatArray:
    several = combined and len(dimensions) > 1 and number % EVERY == EVERY - 1
    return directions(dimensions, several)


def candidates(belief: Belief, along: FloatArray, largest: Change) -> FloatArray:
    """Return the changes that a trial could have, (n, 3): about the JND in each direction, none too large."""
    middle = np.where(along > 0, belief.mean[JND], -np.inf)
    steps = np.round(middle / np.log(STEP))[:, None, :] + np.arange(FEWEST, MOST + 1.0)[:, None]
    steps = np.minimum(steps, np.floor(np.log(largest) / np.log(STEP)))
    return np.unique((STEP**steps).reshape(-1, 3), axis=0)


def information(belief: Belief, changes: FloatArray) -> FloatArray:
    """Return how much the answer to each change is expected to say of the observer, in nats, (changes,).

    The entropy of the answer, less the mean of what is left of it where the observer is known (Kontsevich and
    Tyler 1999). It counts what is learned of exponents and lapses too: a JND is known no better than they.
    """
    share = share_correct(belief.parameters, changes)
    return np.asarray(_entropy(belief.weights @ share) - belief.weights @ _entropy(share))


def _entropy(share: FloatArray) -> FloatArray:
    share = np.clip(share, 1e-12, 1.0 - 1e-12)
    return np.asarray(-share * np.log(share) - (1.0 - share) * np.log1p(-share))
