"""Ratings as ordered categories: a cumulative probit model in which people differ.

It takes ratings for what they are, steps of unknown size, and counts people as people: what the paper's
means of six 7-point ratings leave out.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from fdvv.errors import ModelError
from fdvv.units import FloatArray
from fdvv_people.stats.effect_size import CONFIDENCE
from fdvv_people.stats.ordinal_fit import (
    FLATTEST,
    OrdinalData,
    OrdinalFit,
    OrdinalPoint,
    fitted,
    gathered,
    person_modes,
)

NODES = 15
"""Quadrature nodes per dimension. With 9 an effect's error was off by up to 3 % where answers are few."""

FEWEST_NODES = 5
SMALLEST_SD, CLOSEST = 1e-3, 0.999
"""A spread between people below the first, in standard deviations of a feeling, is none; two spreads whose
correlation is above the second are one."""

WIDEST_ERROR = 20.0
"""Standard error, in standard deviations of a feeling, of an effect that the answers do not bound."""


@dataclass(frozen=True)
class OrdinalEffect:
    """An effect in standard deviations of one feeling, Wald interval and two-sided p."""

    name: str
    value: float
    error: float
    low: float
    high: float
    z: float
    p: float


@dataclass(frozen=True)
class OrdinalModel:
    """A fitted model.

    Attributes
    ----------
    people, n : who and how many answers count; missing : answers left out.
    thresholds : between neighbouring categories that were used. categories : those, in order.
    effects : of the predictors, in their order.
    person_sd : standard deviation between people: of their use of the scale, then of their slope if asked.
    correlation : of the two; None with one, and where the fit is singular.
    person_effects : (people in the order of first appearance), the most likely effect of each in the model
        with a slope: the common one and the person's own; () without a slope.
    log_likelihood : at the maximum. nodes : of the quadrature, per dimension.
    problem : why the numbers do not hold, as one line; "" where they do. Show it wherever they are shown.
    singular : why the spread between people cannot be split into its parts, as one line; "" where it can.
    """

    people: int
    n: int
    missing: int
    categories: tuple[float, ...]
    thresholds: tuple[float, ...]
    effects: tuple[OrdinalEffect, ...]
    person_sd: tuple[float, ...]
    correlation: float | None
    person_effects: tuple[float, ...]
    log_likelihood: float
    nodes: int
    problem: str = ""
    singular: str = ""

    def of(self, name: str) -> OrdinalEffect:
        """Return an effect by its name. KeyError."""
        return {effect.name: effect for effect in self.effects}[name]


def ordinal_model(
    ratings: npt.ArrayLike,
    person: Sequence[object] | np.ndarray,
    predictors: npt.ArrayLike,
    names: Sequence[str],
    slope: str | None = None,
    nodes: int | None = None,
) -> OrdinalModel:
    """Fit ratings by predictors, every person with an own use of the scale.

    ratings : (n,) in any steps that have an order, nan where missing. person : (n,). predictors : (n, k) or
    (n,), as 0 for FD and 1 for FDVV. names : of them. slope : the predictor by which people differ as well.
    nodes : per dimension, 15 by default; at least 5, below which the maximum is missed.

    Raises ModelError below 2 people, 2 categories or 5 nodes, on a missing predictor and one that never
    changes.
    """
    columns = np.asarray(predictors, dtype=np.float64).reshape(len(person), -1)
    _check(columns, names, slope)
    there = ~np.isnan(np.asarray(ratings, dtype=np.float64))
    used, category = np.unique(np.asarray(ratings, dtype=np.float64)[there], return_inverse=True)
    who = np.asarray(person)[there]
    people = len(set(who.tolist()))
    if used.size < 2 or people < 2:
        raise ModelError(f"a model needs 2 categories and 2 people, got {used.size} and {people}")
    place = None if slope is None else list(names).index(slope)
    data = gathered(category, who, columns[there], place)
    chosen = NODES if nodes is None else nodes
    if chosen < FEWEST_NODES:
        raise ModelError(f"the quadrature needs at least {FEWEST_NODES} nodes, got {chosen}")
    fit = fitted(data, chosen)
    effects = tuple(
        _effect(*row) for row in zip(names, fit.point.effects.tolist(), _errors(fit), strict=True)
    )
    sd, correlation = _spread(fit.point.factor)
    singular = _singular(sd, correlation)
    return OrdinalModel(
        people=people,
        n=who.size,
        missing=int(np.sum(~there)),
        categories=tuple(used.tolist()),
        thresholds=tuple(fit.point.thresholds.tolist()),
        effects=effects,
        person_sd=sd,
        correlation=None if singular else correlation,
        person_effects=() if place is None else _person_effects(data, fit.point, place),
        log_likelihood=fit.log_likelihood,
        nodes=chosen,
        problem=_problem(effects, fit.slope),
        singular=singular,
    )


def _check(columns: FloatArray, names: Sequence[str], slope: str | None) -> None:
    if columns.shape[1] != len(names) or len(set(names)) != len(names):
        raise ModelError(f"{columns.shape[1]} predictors need as many different names, got {list(names)}")
    if not np.isfinite(columns).all():
        raise ModelError("a predictor is missing somewhere; leave those rows out")
    if len(names) and np.linalg.matrix_rank(np.column_stack([np.ones(len(columns)), columns])) <= len(names):
        raise ModelError(f"{', '.join(names)} cannot be separated: one never changes or follows from others")
    if slope is not None and slope not in names:
        raise ModelError(f"there is no predictor {slope!r} among {', '.join(names)}")


def _errors(fit: OrdinalFit) -> list[float]:
    """Return the standard errors of the effects, nan where the likelihood does not bend."""
    first, count = len(fit.point.thresholds), len(fit.point.effects)
    variances = np.diag(fit.covariance)[first : first + count]
    return list(np.sqrt(np.where(variances > 0, variances, np.nan)).tolist())


def _spread(factor: FloatArray) -> tuple[tuple[float, ...], float | None]:
    spread = factor @ factor.T
    sd = np.sqrt(np.diag(spread))
    correlation = float(spread[0, 1] / (sd[0] * sd[1])) if len(sd) == 2 and sd.min() > 0 else None
    return tuple(sd.tolist()), correlation


def _singular(sd: tuple[float, ...], correlation: float | None) -> str:
    """Return what of the spread between people lies on the edge of what can be (Bates et al. 2015); or ""."""
    if min(sd) < SMALLEST_SD:
        own = "use of the scale" if sd[0] < SMALLEST_SD else "own difference"
        return f"the fit is singular: people's {own} does not differ at all"
    if correlation is not None and abs(correlation) > CLOSEST:
        sides = "more" if correlation > 0 else "less"
        return (
            f"the fit is singular: who rates higher differs {sides} without exception (a correlation of "
            f"{correlation:+.0f}), so people's use of the scale and their own difference cannot be separated"
        )
    return ""


def _person_effects(data: OrdinalData, point: OrdinalPoint, place: int) -> tuple[float, ...]:
    own = person_modes(data, point)[0] @ point.factor.T
    return tuple((point.effects[place] + own[:, 1]).tolist())


def _effect(name: str, value: float, error: float) -> OrdinalEffect:
    from scipy.special import ndtr, ndtri

    half = float(ndtri(0.5 + CONFIDENCE / 2)) * error
    z = value / error
    return OrdinalEffect(name, value, error, value - half, value + half, z, 2 * float(ndtr(-abs(z))))


def _problem(effects: tuple[OrdinalEffect, ...], slope: float) -> str:
    loose = [one.name for one in effects if not one.error < WIDEST_ERROR]
    if loose:
        return f"the answers do not bound {', '.join(loose)}: they are too few, or all lie on one side"
    return f"no maximum was found (slope {slope:.2g} an answer)" if slope > FLATTEST else ""
