"""Several objectives as one: weights drawn anew for every trial, so that trials spread along the front.

Knowles, ParEGO (2006): the augmented Chebyshev function of normalised objectives.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from fdvv.errors import InputError, ModelError
from fdvv.units import FloatArray
from fdvv_people.optimize.engines.gp_model import belief_of, finished, score_table
from fdvv_people.optimize.engines.search import generator
from fdvv_people.optimize.problem import Problem, Trial
from fdvv_people.task.score import Objective, Score

AUGMENTED = 0.05
SCALAR = Objective("scalar")
DOUBT = 4.0
"""A range over the front counts as so many standard errors at least, the width of a 95 % interval."""


def scalar_problem(problem: Problem, trials: Sequence[Trial]) -> tuple[Problem, list[Trial]]:
    """Return a problem of one objective, and its finished trials; as they are where there is one already."""
    done = finished(problem, trials)
    if len(problem.objectives) == 1:
        return problem, done
    weights = generator(problem, trials, 7).dirichlet(np.ones(len(problem.objectives)))
    others = finished(problem, problem.prior)
    both = [*done, *others]
    if not both:
        return replace(problem, objectives=(SCALAR,), prior=()), []
    values, errors = score_table(problem.objectives, both)
    low, span = values.min(axis=0), np.ptp(values, axis=0)
    span = np.where(span > 0, span, 1.0)
    one = [
        replace(trial, scores={SCALAR.name: score})
        for trial, score in zip(both, _joined((values - low) / span, errors / span, weights), strict=True)
    ]
    return replace(problem, objectives=(SCALAR,), prior=tuple(one[len(done) :])), one[: len(done)]


def _joined(values: FloatArray, errors: FloatArray, weights: FloatArray) -> list[Score]:
    """Join each row by its worst weighted objective and a little of the others; the error of that one."""
    weighted = values * weights
    worst = weighted.argmax(axis=1)
    rows = np.arange(len(values))
    joined = weighted[rows, worst] + AUGMENTED * weighted.sum(axis=1)
    error = errors[rows, worst] * weights[worst]
    return [Score(float(v), float(e) if np.isfinite(e) else None) for v, e in zip(joined, error, strict=True)]


@dataclass(frozen=True)
class ParetoFront:
    """The finished trials that no other beats in every objective.

    Attributes
    ----------
    problem : what was optimised. trials : of the front, best in the first objective first.
    """

    problem: Problem
    trials: tuple[Trial, ...]

    def values(self) -> FloatArray:
        """Return the scores, (n, m), in the order of the problem's objectives."""
        return self._turned()[0] * [one.sign for one in self.problem.objectives]

    def knee(self) -> Trial:
        """Choose where giving up a little of one objective gains least of the others.

        The trial nearest to the best of every objective at once, each in parts of its range over the front;
        a range within DOUBT standard errors counts as that wide. ModelError on an empty front.
        """
        return self.trials[int(np.argmin(np.linalg.norm(self._normal(), axis=1)))]

    def weighted(self, weights: Mapping[str, float]) -> Trial:
        """Choose by weights, at least 0, of objectives in parts of their ranges; 0 for one not named.

        InputError on an alien objective or weights that are none, ModelError on an empty front.
        """
        row = check_weights(self.problem.objectives, weights)
        return self.trials[int(np.argmin(self._normal() @ row))]

    def within(self, limits: Mapping[str, float]) -> Trial:
        """Choose the best in the first objective that has no limit, among those within limits.

        limits : the worst value allowed of an objective. InputError if no trial of the front is within.
        """
        _known(self.problem.objectives, limits)
        objectives, values = self.problem.objectives, self._turned()[0]
        bounds = [limits[one.name] * one.sign if one.name in limits else np.inf for one in objectives]
        inside = np.all(values <= bounds, axis=1)
        if not inside.any():
            raise InputError("limits", "all", "no trial of the front is within", "loosen one of them")
        free = next((i for i, one in enumerate(objectives) if one.name not in limits), 0)
        return self.trials[int(np.argmin(np.where(inside, values[:, free], np.inf)))]

    def _turned(self) -> tuple[FloatArray, FloatArray]:
        return score_table(self.problem.objectives, self.trials)

    def _normal(self) -> FloatArray:
        """Return scores from 0, best of the front, to at most 1, worst of it."""
        if not self.trials:
            raise ModelError("no trial is done yet, so there is no front to choose from")
        values, errors = self._turned()
        doubt = DOUBT * np.median(np.where(np.isfinite(errors), errors, 0.0), axis=0)
        span = np.maximum(np.ptp(values, axis=0), doubt)
        return np.asarray((values - values.min(axis=0)) / np.where(span > 0, span, 1.0))


def check_weights(objectives: Sequence[Objective], weights: Mapping[str, float]) -> FloatArray:
    """Return weights in the order of objectives, (m,). InputError on alien ones, and if none is above 0."""
    _known(objectives, weights)
    row = np.array([weights.get(one.name, 0.0) for one in objectives])
    if not (np.all(np.isfinite(row)) and np.all(row >= 0) and row.sum() > 0):
        raise InputError("weights", "all", f"are {dict(weights)}", "give some above 0 and none below")
    return row


def _known(objectives: Sequence[Objective], named: Mapping[str, float]) -> None:
    names = [one.name for one in objectives]
    for name in named:
        if name not in names:
            raise InputError("objective", name, "is none of this run", f"use {', '.join(names)}")


def pareto_front(problem: Problem, trials: Sequence[Trial]) -> ParetoFront:
    """Find the front among finished trials by the scores as measured; empty if none is finished.

    Equal ones all stay. Noise makes a front look better than it is: measure a chosen design again.
    """
    done = finished(problem, trials)
    values, _ = score_table(problem.objectives, done)
    beaten = [bool(np.any(np.all(values <= row, axis=1) & np.any(values < row, axis=1))) for row in values]
    rows = zip(values.tolist(), done, beaten, strict=True)
    kept = sorted(((row, t.number, t) for row, t, out in rows if not out), key=lambda one: one[:2])
    return ParetoFront(problem, tuple(trial for *_, trial in kept))


def believed_front(problem: Problem, trials: Sequence[Trial]) -> ParetoFront:
    """Find the front among finished trials by what a Gaussian process believes of each objective.

    Its trials have posterior means and their standard deviations as scores. So one lucky trial is no front,
    as it is by the scores as measured. BuildError without scikit-learn.
    """
    done = finished(problem, trials)
    if not done:
        return ParetoFront(problem, ())
    columns = {one.name: _believed(problem, one, done) for one in problem.objectives}
    rows = [{name: column[i] for name, column in columns.items()} for i in range(len(done))]
    return pareto_front(problem, [replace(one, scores=row) for one, row in zip(done, rows, strict=True)])


def _believed(problem: Problem, objective: Objective, done: Sequence[Trial]) -> list[Score]:
    belief = belief_of(problem.space, objective, done)
    means, deviations = belief.predict(belief.observed.places)
    pairs = zip((objective.sign * means).tolist(), deviations.tolist(), strict=True)
    return [Score(mean, deviation) for mean, deviation in pairs]
