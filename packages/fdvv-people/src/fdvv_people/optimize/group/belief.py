"""One Gaussian process over the scores of several people: what they share, and how each departs from it.

A score of person p at place x is y = b_p + f(x) + g_p(x) + noise. f is shared by all, g_p belongs to p alone,
and b_p is how well p does altogether. f and g_p have one Matern-5/2 kernel with a length per parameter and
variances of their own. This is a hierarchical process (Hensman, Lawrence and Rattray, BMC Bioinformatics 14,
252, 2013), with compound symmetry between people. Where all scores are above 0, y is their logarithm: a few
presses that miss make a score several times as large, and would hide what differs between all others.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
import numpy.typing as npt

from fdvv.errors import ModelError
from fdvv.units import FloatArray
from fdvv_people.optimize.engines.gp_model import Observed, believe, pooled
from fdvv_people.optimize.space import LENGTH

PRIORS = ((0.0, 1.0), (-0.5, 1.0), (0.0, 1.0), (-4.0, 1.0))
"""Mean and SD of the log variances of f, g, b and of noise beyond the known errors, parts of the scores' own
variance within a person."""
DRAWS = 4000
FITTED = 200
"""Scores that lengths are fitted to; of more, as many spread evenly."""


@dataclass(frozen=True, eq=False)
class GroupScores:
    """Scores of several people, smaller is better.

    Attributes
    ----------
    people : (n,) who scored, from 0; everybody at least once. places : (n, d) of the unit cube.
    values, errors : (n,) score and its standard error; errors nan where unknown.
    """

    people: npt.NDArray[np.int64]
    places: FloatArray
    values: FloatArray
    errors: FloatArray

    def __post_init__(self) -> None:
        if np.unique(self.people).size < 2 or set(self.people.tolist()) != set(range(self.count)):
            raise ModelError("a group needs scores of at least two people, numbered from 0")

    @property
    def count(self) -> int:
        """How many people there are."""
        return int(self.people.max()) + 1


@dataclass(frozen=True, eq=False)
class GroupBelief:
    """The posterior of f + g_p + b_p.

    Attributes
    ----------
    scores : learned from; logarithmic : by their logarithms. kernel : of scikit-learn, of variance 1.
    noise : (n,) variances, standardised. shared, own, level : variances of f, g and b, standardised.
    centre, scale : that standardised the scores, or their logarithms.
    """

    scores: GroupScores
    logarithmic: bool
    kernel: Any
    noise: FloatArray
    shared: float
    own: float
    level: float
    centre: float
    scale: float

    @cached_property
    def _factor(self) -> tuple[FloatArray, bool]:
        from scipy.linalg import cho_factor

        among = self._between(self.scores.places, self.scores.people)
        lower: tuple[FloatArray, bool] = cho_factor(among + np.diag(self.noise), lower=True)
        return lower

    @cached_property
    def _solved(self) -> FloatArray:
        from scipy.linalg import cho_solve

        values = np.log(self.scores.values) if self.logarithmic else self.scores.values
        return np.asarray(cho_solve(self._factor, (values - self.centre) / self.scale))

    def _between(self, places: FloatArray, people: npt.NDArray[np.int64]) -> FloatArray:
        """Return the covariance, (n, m), between the scores and m places of people."""
        return self._covariance(self.kernel(self.scores.places, places), _same(self.scores.people, people))

    def _covariance(self, kernel: FloatArray, same: npt.NDArray[np.bool_]) -> FloatArray:
        return np.asarray(kernel * (self.shared + self.own * same) + self.level * same)

    def _score(self, standardised: FloatArray) -> FloatArray:
        values = self.centre + self.scale * standardised
        return np.exp(values) if self.logarithmic else values

    def means(self, places: FloatArray) -> FloatArray:
        """Return the score that each person is as likely to exceed as not at places (m, d), (people, m)."""
        everybody = range(self.scores.count)
        rows = [self._between(places, np.full(len(places), one)).T @ self._solved for one in everybody]
        return self._score(np.array(rows))

    def differences(self, first: FloatArray, second: FloatArray) -> FloatArray:
        """Draw by how much each person scores more at the first place than at the second.

        first, second : (people, d), a place for each person.

        Returns DRAWS draws of the posterior, (DRAWS, people), the same for the same places.
        """
        from scipy.linalg import cho_solve

        people = np.tile(np.arange(self.scores.count), 2)
        places = np.vstack([first, second])
        cross = self._between(places, people)
        prior = self._covariance(self.kernel(places), _same(people, people))
        covariance = prior - cross.T @ cho_solve(self._factor, cross)
        drawn = np.random.default_rng(0).multivariate_normal(
            cross.T @ self._solved, covariance, DRAWS, method="eigh"
        )
        score = self._score(drawn)
        return np.asarray(score[:, : self.scores.count] - score[:, self.scores.count :])


def believe_group(scores: GroupScores, length: float = LENGTH) -> GroupBelief:
    """Learn from the scores of all. Raises BuildError without scikit-learn.

    length : over which a score is expected to change, see `DesignSpace`.
    """
    people, logarithmic = scores.people, bool((scores.values > 0).all())
    values = np.log(scores.values) if logarithmic else scores.values
    errors = scores.errors / scores.values if logarithmic else scores.errors
    apart = values - (np.bincount(people, values) / np.bincount(people))[people]
    centre, scale = float(values.mean()), float(apart.std()) or 1.0
    few = np.unique(np.linspace(0, values.size - 1, min(FITTED, values.size)).astype(np.int64))
    matern = believe(Observed(scores.places, apart, errors), few=few, length=length).kernel.k2
    known = np.nan_to_num(pooled(errors) / scale) ** 2
    variances = _variances(matern(scores.places), people, (values - centre) / scale, known)
    shared, own, level, white = variances.tolist()
    return GroupBelief(scores, logarithmic, matern, known + white, shared, own, level, centre, scale)


def _same(some: npt.NDArray[np.int64], others: npt.NDArray[np.int64]) -> npt.NDArray[np.bool_]:
    return np.asarray(some[:, None] == others[None])


def _variances(M: FloatArray, people: npt.NDArray[np.int64], y: FloatArray, errors: FloatArray) -> FloatArray:
    """Return the most probable variances of f, g, b and of further noise, (4,)."""
    from scipy.linalg import cho_factor, cho_solve
    from scipy.optimize import minimize

    same = _same(people, people)
    parts = [M, M * same, same.astype(np.float64), np.eye(y.size)]
    middle, spread = np.array(PRIORS).T
    fixed = np.diag(errors + 1e-8)

    def cost(theta: FloatArray) -> tuple[float, FloatArray]:
        sizes = np.exp(theta)
        factor = cho_factor(sum((s * p for s, p in zip(sizes, parts, strict=True)), fixed), lower=True)
        inverse = cho_solve(factor, np.eye(y.size))
        alpha, off = inverse @ y, (theta - middle) / spread
        value = 0.5 * y @ alpha + np.log(np.diag(factor[0])).sum() + 0.5 * off @ off
        slope = [
            0.5 * s * np.sum((inverse - np.outer(alpha, alpha)) * p)
            for s, p in zip(sizes, parts, strict=True)
        ]
        return float(value), np.array(slope) + off / spread

    found = minimize(cost, middle, jac=True, method="L-BFGS-B", bounds=[(-9.0, 4.0)] * 4)
    return np.exp(found.x)
