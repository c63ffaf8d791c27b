"""What trials of others say in advance: a mean function whose weight the person's own scores decide."""

from __future__ import annotations

from collections.abc import Sequence
from functools import lru_cache

import numpy as np
import numpy.typing as npt

from fdvv.optimize._belief import finished, observed
from fdvv.optimize._engine import Problem
from fdvv.optimize._gp import Basis, Belief, Observed, believe
from fdvv.optimize._trial import Trial
from fdvv.units import FloatArray

MOST, FITTED = 1000, 150
"""Trials of others that are learned from, and that lengths are fitted to; of more, as many spread evenly."""
WEIGHT, SPREAD = 1.0, 0.6
"""Of the others' differences in a person's scores, before the first of them: the same, and a doubt."""


def prior_basis(problem: Problem) -> Basis | None:
    """Give what others' trials let expect; None without any."""
    done = finished(problem, problem.prior)
    if len(done) < 3:
        return None
    belief = _learned(*_rows(problem, done))
    centre = float(np.mean(belief.predict(belief.observed.places)[0]))

    def of(places: FloatArray) -> FloatArray:
        return np.asarray(belief.predict(places)[0] - centre)[:, None]

    return Basis(of, np.array([WEIGHT]), np.array([SPREAD]))


def _rows(problem: Problem, done: Sequence[Trial]) -> tuple[bytes, bytes, bytes, int]:
    """Write the trials as bytes, by which what was learned of them is kept."""
    few = [done[i] for i in _spread(len(done), MOST)]
    scores = observed(problem.space, problem.objectives[0], few)
    rows = (np.ascontiguousarray(a).tobytes() for a in (scores.places, scores.values, scores.errors))
    places, values, errors = rows
    return places, values, errors, len(problem.space.names)


@lru_cache(maxsize=64)
def _learned(places: bytes, values: bytes, errors: bytes, d: int) -> Belief:
    """Learn of the others once for all suggestions of a run."""
    X = np.frombuffer(places).reshape(-1, d)
    scores = Observed(X, np.frombuffer(values), np.frombuffer(errors))
    return believe(scores, starts=1, few=_spread(len(X), FITTED))


def _spread(count: int, most: int) -> npt.NDArray[np.int64]:
    """Give at most so many places, evenly over count."""
    return np.unique(np.linspace(0, count - 1, most).astype(np.int64))
