"""What trials say of an observer: the JND of each dimension, with its interval, and the surface between."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from fdvv.model.noticeable import DIMENSIONS, Dimension
from fdvv.units import FloatArray
from fdvv_people.thresholds.belief import PARTICLES, Belief, Trial, belief_after
from fdvv_people.thresholds.observer import JND, log_jnd_along
from fdvv_people.thresholds.prior import ThresholdPrior

INTERVAL = (0.025, 0.975)  # equal tails of `fdvv_people.stats.effect_size.CONFIDENCE`, 95 %


@dataclass(frozen=True)
class JndEstimate:
    """The JND in one direction, as a ratio of the standard.

    Attributes
    ----------
    ratio : geometric mean of the belief. low, high : its 95 % interval, equal tails.
    log_error : standard error of the natural logarithm. trials : that changed this dimension alone.
    """

    ratio: float
    low: float
    high: float
    log_error: float
    trials: int


@dataclass(frozen=True, eq=False)
class ThresholdEstimate:
    """What is known of one observer.

    Attributes
    ----------
    jnds : of the dimensions that were measured. belief : all of it. trials : made.
    """

    jnds: dict[Dimension, JndEstimate]
    belief: Belief
    trials: int

    def surface(self, across: Dimension, up: Dimension, count: int = 25) -> FloatArray:
        """Return the just noticeable changes of two dimensions together, (count, 2, 3).

        In order from one alone to the other alone; of each the change of both, as middle and ends of the 95 %
        interval along its direction. What was not measured with both changed rests on the prior of how
        differences add up.
        """
        turn = np.linspace(0.0, 0.5 * np.pi, count)
        middle = np.exp(self.belief.mean[JND])
        directions = np.zeros((count, len(DIMENSIONS)))
        for part, name in ((np.cos(turn), across), (np.sin(turn), up)):
            place = DIMENSIONS.index(name)
            directions[:, place] = np.where(part > 1e-9, part, 0.0) * middle[place]
        sizes = log_jnd_along(self.belief.parameters, directions)
        ends = np.array([_summary(column, self.belief.weights)[:3] for column in sizes.T])
        used = directions[:, [DIMENSIONS.index(across), DIMENSIONS.index(up)]]
        return np.asarray(used[:, :, None] * np.exp(ends)[:, None, :])


def estimate(
    trials: Sequence[Trial],
    prior: ThresholdPrior,
    dimensions: Sequence[Dimension] = DIMENSIONS,
    particles: int = PARTICLES,
) -> ThresholdEstimate:
    """Return what trials say, in any order; how they were chosen does not matter."""
    belief = belief_after(trials, prior, particles)
    found = {}
    for one in dimensions:
        place = DIMENSIONS.index(one)
        middle, low, high, error = _summary(belief.parameters[:, place], belief.weights)
        alone = sum(np.count_nonzero(change) == 1 and change[place] > 0 for change, _ in trials)
        found[one] = JndEstimate(math.exp(middle), math.exp(low), math.exp(high), error, int(alone))
    return ThresholdEstimate(found, belief, len(trials))


def _summary(values: FloatArray, weights: FloatArray) -> tuple[float, float, float, float]:
    """Return mean, ends of the interval and spread of weighted values."""
    mean = float(weights @ values)
    order = np.argsort(values)
    passed = np.cumsum(weights[order]) - 0.5 * weights[order]
    low, high = np.interp(INTERVAL, passed, values[order])
    return mean, float(low), float(high), float(np.sqrt(weights @ (values - mean) ** 2))
