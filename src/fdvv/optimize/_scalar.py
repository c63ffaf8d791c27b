"""Several objectives as one: weights drawn anew for every trial, so that trials spread along the front.

Knowles, ParEGO (2006): the augmented Chebyshev function of normalised objectives.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from fdvv.optimize._belief import finished
from fdvv.optimize._engine import Objective, Problem
from fdvv.optimize._places import generator
from fdvv.optimize._trial import Score, Trial
from fdvv.units import FloatArray

AUGMENTED = 0.05
SCALAR = Objective("scalar")


def scalar_problem(problem: Problem, trials: Sequence[Trial]) -> tuple[Problem, list[Trial]]:
    """Give a problem of one objective, and its finished trials; as they are where there is one already."""
    done = finished(problem, trials)
    if len(problem.objectives) == 1:
        return problem, done
    weights = generator(problem, trials, 7).dirichlet(np.ones(len(problem.objectives)))
    others = finished(problem, problem.prior)
    both = [*done, *others]
    if not both:
        return replace(problem, objectives=(SCALAR,), prior=()), []
    values, errors = _table(problem, both)
    low, span = values.min(axis=0), np.ptp(values, axis=0)
    span = np.where(span > 0, span, 1.0)
    one = [
        replace(trial, scores={SCALAR.name: score})
        for trial, score in zip(both, _joined((values - low) / span, errors / span, weights), strict=True)
    ]
    return replace(problem, objectives=(SCALAR,), prior=tuple(one[len(done) :])), one[: len(done)]


def _table(problem: Problem, done: Sequence[Trial]) -> tuple[FloatArray, FloatArray]:
    """Give scores, turned so that smaller is better, and their errors, (n, m) each; nan where unknown."""
    signs = np.array([-1.0 if one.larger_is_better else 1.0 for one in problem.objectives])
    scores = [[trial.scores[one.name] for one in problem.objectives] for trial in done]
    values = np.array([[score.value for score in row] for row in scores]) * signs
    errors = [[np.nan if score.error is None else score.error for score in row] for row in scores]
    return values, np.array(errors)


def _joined(values: FloatArray, errors: FloatArray, weights: FloatArray) -> list[Score]:
    """Join each row by its worst weighted objective and a little of the others; the error of that one."""
    weighted = values * weights
    worst = weighted.argmax(axis=1)
    rows = np.arange(len(values))
    joined = weighted[rows, worst] + AUGMENTED * weighted.sum(axis=1)
    error = errors[rows, worst] * weights[worst]
    return [Score(float(v), float(e) if np.isfinite(e) else None) for v, e in zip(joined, error, strict=True)]
