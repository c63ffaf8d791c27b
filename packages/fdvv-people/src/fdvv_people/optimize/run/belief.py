"""How good a recommended design is, as an interval of what an engine's model believes."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fdvv_people.optimize.engines.gp_model import belief_of, finished
from fdvv_people.optimize.engines.preference import believe_choices
from fdvv_people.optimize.run.state import RunState
from fdvv_people.optimize.run.verdict import LEVEL


@dataclass(frozen=True)
class BestDesign:
    """A recommended design, and what the scores say of it.

    Attributes
    ----------
    design : recommended. mean, low, high : its expected score, with the 95 % interval of that; of comparisons
        how much more it is worth than the first design, worth having a variance of 1.
    chance : of comparisons, that it is worth more than the first design; else None.
    count : of the scores or answers that this rests on.
    """

    design: dict[str, float]
    mean: float
    low: float
    high: float
    chance: float | None
    count: int


def best_design(run: RunState) -> BestDesign:
    """Return the recommended design with its interval. ModelError while nothing is done, BuildError.

    The interval is that of a Gaussian process over all scores, whichever engine chose the designs: of the
    mean of more trials of this design, not of the next one.
    """
    return _liked(run) if run.setup.preference else _scored(run)


def _scored(run: RunState) -> BestDesign:
    design, done = run.best(), finished(run.problem, run.trials)
    objective = run.problem.objectives[0]
    belief = belief_of(run.space, objective, done)
    mean, deviation = (float(column[0]) for column in belief.predict(run.space.to_unit([design])))
    mean *= objective.sign
    return BestDesign(design, mean, *_interval(mean, deviation), None, len(done))


def _liked(run: RunState) -> BestDesign:
    from scipy.stats import norm

    design = run.best()
    belief, first = believe_choices(run.space, run.trials, of_lines=run.asks_for == "line"), run.first
    assert belief is not None  # something is answered, or no design were recommended
    assert first is not None
    mean, cov = belief.predict(run.space.to_unit([design, first]))
    more, variance = float(mean[0] - mean[1]), float(cov[0, 0] + cov[1, 1] - 2 * cov[0, 1])
    deviation = float(np.sqrt(max(variance, 1e-12)))
    chance = float(norm.cdf(more / deviation))
    return BestDesign(design, more, *_interval(more, deviation), chance, run.answered)


def _interval(mean: float, deviation: float) -> tuple[float, float]:
    from scipy.stats import norm

    half = float(norm.ppf(0.5 + LEVEL / 2)) * deviation
    return mean - half, mean + half
