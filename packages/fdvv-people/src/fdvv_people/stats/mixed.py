"""Linear mixed model of people's scores: variance components by REML, contrasts of means with intervals.

Every random effect lies within people, so the covariance of the scores has one block a person, and people who
lack a score need not be left out.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from fdvv.errors import ModelError
from fdvv.units import FloatArray
from fdvv_people.stats.effect_size import CONFIDENCE, FEWEST, Estimate

LARGEST = 1e6
"""Of a component's variance in units of the residual's."""
STARTS = (0.1, 1.0, 10.0)
"""Variance ratios from which the search starts."""


@dataclass(frozen=True, eq=False)
class MixedFit:
    """A fitted model.

    Attributes
    ----------
    means, covariance : of the fixed effects, (p,) and (p, p).
    variances : of each random effect by name, and of the residual, last; in the score's unit squared.
    people : how many. criterion : -2 log of the restricted likelihood, constants left out.
    """

    means: FloatArray
    covariance: FloatArray
    variances: Mapping[str, float]
    people: int
    criterion: float

    def contrast(self, weights: npt.ArrayLike) -> MixedContrast:
        """Test a weighted sum of the fixed effects against 0.

        The t distribution has people - 1 degrees of freedom: no contrast within people has fewer.
        """
        from scipy.stats import t as student

        row = np.asarray(weights, dtype=np.float64)
        value, error = float(row @ self.means), math.sqrt(float(row @ self.covariance @ row))
        df = self.people - 1
        half = float(student.ppf(0.5 + CONFIDENCE / 2, df)) * error
        t = value / error
        p = float(2 * student.sf(abs(t), df))
        return MixedContrast(Estimate(value, value - half, value + half), error, t, df, p)


@dataclass(frozen=True)
class MixedContrast:
    """A contrast with its 95 % interval, standard error, t, degrees of freedom and two-sided p."""

    value: Estimate
    error: float
    t: float
    df: int
    p: float


def fit_mixed(
    scores: npt.ArrayLike,
    design: npt.ArrayLike,
    people: Sequence[object],
    effects: Mapping[str, Sequence[object]],
) -> MixedFit:
    """Fit scores = design @ means + a random intercept of every person + those of effects + residual.

    scores : (n,). design : (n, p), of full rank. people : (n,) who. effects : by name, (n,) labels; scores of
    one person with one label share an intercept. REML with the residual variance profiled out, by L-BFGS-B on
    variance ratios, from several starts: over standard deviations the slope at 0 is 0 whatever the data say,
    and a search in ten stayed there.

    Raises ModelError on fewer than 3 people, a score that is missing, and columns of different length.
    """
    y, X = np.asarray(scores, dtype=np.float64), np.asarray(design, dtype=np.float64)
    if X.ndim != 2 or any(len(one) != len(y) for one in (X, people, *effects.values())):
        raise ModelError("scores, design, people and effects need as many rows")
    if not np.isfinite(y).all():
        raise ModelError("a score is missing; leave its row out")
    blocks = [_Block.of(y, X, rows, effects) for rows in _rows_by(people)]
    count = sum(len(one.y) for one in blocks)
    if count < FEWEST:
        raise ModelError(f"a mixed model needs at least {FEWEST} people, got {count}")
    ratios = _minimise(blocks, len(y), 1 + len(effects))
    found = _Profile.at(blocks, ratios, len(y))
    names = ("person", *effects)
    variances = {name: found.residual * float(r) for name, r in zip(names, ratios, strict=True)}
    covariance = np.asarray(found.residual * np.linalg.inv(found.information), dtype=np.float64)
    variances["residual"] = found.residual
    return MixedFit(found.means, covariance, variances, count, found.criterion)


def _rows_by(people: Sequence[object]) -> list[FloatArray]:
    """Return the rows of everybody, (k, m), those with as many together."""
    labels = np.asarray([str(one) for one in people])
    rows = [np.flatnonzero(labels == one) for one in np.unique(labels)]
    sizes = sorted({len(one) for one in rows})
    return [np.array([one for one in rows if len(one) == size]) for size in sizes]


@dataclass(frozen=True, eq=False)
class _Block:
    """The scores of people who have as many, m, (k, m) and (k, m, p).

    alike : by random effect, (k, m, m) of 1 where two scores share an intercept.
    """

    y: FloatArray
    X: FloatArray
    alike: tuple[FloatArray, ...]

    @classmethod
    def of(
        cls, y: FloatArray, X: FloatArray, rows: FloatArray, effects: Mapping[str, Sequence[object]]
    ) -> _Block:
        """Take the rows of people, (k, m)."""
        labels = [np.asarray([str(one) for one in column])[rows] for column in effects.values()]
        alike = [np.ones((*rows.shape, rows.shape[1]))]
        alike += [(one[:, :, None] == one[:, None, :]).astype(float) for one in labels]
        return cls(y[rows], X[rows], tuple(alike))


@dataclass(frozen=True, eq=False)
class _Profile:
    """The model at given ratios of variances to the residual's."""

    means: FloatArray
    information: FloatArray
    residual: float
    criterion: float

    @classmethod
    def at(cls, blocks: Sequence[_Block], ratios: FloatArray, n: int) -> _Profile:
        p = blocks[0].X.shape[2]
        XX, Xy, yy, log_det = np.zeros((p, p)), np.zeros(p), 0.0, 0.0
        for one in blocks:
            V = np.eye(one.y.shape[1]) + sum(r * A for r, A in zip(ratios, one.alike, strict=True))
            L = np.linalg.cholesky(V)
            x, z = np.linalg.solve(L, one.X), np.linalg.solve(L, one.y[..., None])[..., 0]
            XX, Xy = XX + np.einsum("kmp,kmq->pq", x, x), Xy + np.einsum("kmp,km->p", x, z)
            yy += float(np.sum(z * z))
            log_det += 2 * float(np.sum(np.log(np.diagonal(L, axis1=1, axis2=2))))
        means = np.asarray(np.linalg.solve(XX, Xy), dtype=np.float64)
        residual = max((yy - float(means @ Xy)) / (n - p), np.finfo(float).tiny)
        criterion = (n - p) * math.log(residual) + log_det + float(np.linalg.slogdet(XX)[1])
        return cls(means, XX, residual, criterion)


def _minimise(blocks: Sequence[_Block], n: int, count: int) -> FloatArray:
    from scipy.optimize import minimize

    def criterion(ratios: FloatArray) -> float:
        return _Profile.at(blocks, ratios, n).criterion

    bounds = [(0.0, LARGEST)] * count
    tries = [minimize(criterion, np.full(count, s), method="L-BFGS-B", bounds=bounds) for s in STARTS]
    return np.asarray(min(tries, key=lambda one: float(one.fun)).x)


def sign_flip_p(differences: npt.ArrayLike, seed: int = 0, draws: int = 9999) -> float:
    """Return the two-sided p of people's mean difference under flipped signs: no distribution is assumed.

    differences : (people,), none missing. Exact up to 14 people; of more, draws random flips and the data
    themselves count. Raises ModelError on a missing difference and fewer than 3 people.
    """
    found = np.asarray(differences, dtype=np.float64)
    if found.ndim != 1 or len(found) < FEWEST or not np.isfinite(found).all():
        raise ModelError(f"flipped signs need the differences of {FEWEST} people or more, none missing")
    people = len(found)
    if people <= 14:
        signs = 1 - 2 * ((np.arange(2**people)[:, None] >> np.arange(people)) & 1)
    else:
        drawn = np.random.default_rng(seed).integers(0, 2, (draws, people))
        signs = np.vstack([np.ones(people, int), 1 - 2 * drawn])
    sums = np.abs(signs @ found)
    # rounding must not part sums that are equal
    return float(np.mean(sums >= abs(found.sum()) * (1 - 1e-12)))
