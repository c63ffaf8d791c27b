"""2-AC answers of several people, some of whom gave many: d' of the population, with people as people.

Each person has an own d', normal about the population's, and all one tau (Christensen, Lee and Brockhoff 2012
by a cumulative probit model with a person's intercept).
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from fdvv.errors import ModelError
from fdvv.study._clustered_share import effective_answers
from fdvv.study._effect_size import CONFIDENCE
from fdvv.study._ordinal_fit import FLATTEST, fitted, gathered
from fdvv.study._share import sign_p
from fdvv.study._thurstone import DPrime
from fdvv.study._two_ac import ROOT_2, two_ac
from fdvv.units import FloatArray

NODES = 15


@dataclass(frozen=True)
class PeopleDPrime:
    """d' of a population from its people's 2-AC answers.

    Attributes
    ----------
    all : of the population; its p is the sign test of people who named the second more often, or less.
    person_sd : how far people's own d' lie apart; nan where it could not be told. each : everyone's own d'.
    """

    all: DPrime
    person_sd: float
    each: tuple[DPrime, ...]


def two_ac_people(counts: npt.ArrayLike) -> PeopleDPrime:
    """Fit counts (people, 3) of naming the first, neither, and the second; who gave none is left out.

    The interval is Wald's. Where some kind of answer is never given the mixed model does not bound d': then
    two_ac of as many answers as the spread between people leaves. ModelError below 2 people.
    """
    found = np.asarray(counts, dtype=np.float64)
    if found.ndim != 2 or found.shape[1] != 3 or np.any(found < 0):
        raise ModelError(f"2-AC counts are (people, 3) and not negative, got the shape {found.shape}")
    found = found[found.sum(axis=1) > 0]
    if len(found) < 2:
        raise ModelError(f"d' of a population needs at least 2 people with answers, got {len(found)}")
    each = tuple(two_ac(*(int(one) for one in row)) for row in found)
    p = sign_p(int(np.sum(found[:, 2] > found[:, 0])), int(np.sum(found[:, 2] < found[:, 0])))
    mixed = _mixed(found, p) if np.all(found.sum(axis=0) > 0) else None
    return PeopleDPrime(*(mixed or (_counted(found, p), math.nan)), each)


def _mixed(counts: FloatArray, p: float) -> tuple[DPrime, float] | None:
    """Fit the mixed model; None where it has no maximum that bends."""
    from scipy.special import ndtri

    people = np.repeat(np.arange(len(counts)), counts.sum(axis=1).astype(int))
    answers = np.concatenate([np.repeat([0, 1, 2], row.astype(int)) for row in counts])
    fit = fitted(gathered(answers, people, np.empty((len(answers), 0))), NODES)
    lower, upper = fit.point.thresholds
    variance = float(fit.covariance[:2, :2].sum()) / 2
    if fit.slope > FLATTEST or not variance > 0:
        return None
    d, half = -(lower + upper) / ROOT_2, float(ndtri(0.5 + CONFIDENCE / 2)) * math.sqrt(variance)
    method = "2ac, mixed model, Wald"
    first, equal, second = (int(one) for one in counts.sum(axis=0))
    n, tau = first + equal + second, float(upper - lower) / ROOT_2
    found = DPrime(float(d), float(d - half), float(d + half), p, second, n, method, tau, len(counts))
    return found, ROOT_2 * abs(float(fit.point.factor[0, 0]))


def _counted(counts: FloatArray, p: float) -> DPrime:
    """Give d' of all answers, bounded as if there were only as many as people leave."""
    n, totals = counts.sum(axis=1), counts.sum(axis=0)
    part = min(effective_answers(column, n) for column in counts.T if column.any()) / float(n.sum())
    plain = two_ac(*totals.tolist())
    fewer = two_ac(*(totals * part).tolist())
    method = "2ac, profile likelihood of the answers that people leave"
    return DPrime(
        plain.d, fewer.low, fewer.high, p, int(totals[2]), int(n.sum()), method, plain.tau, len(counts)
    )
