"""Whether the differences between conditions spread alike: epsilon and Mauchly's test."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from fdvv.units import FloatArray


@dataclass(frozen=True)
class Sphericity:
    """How far sphericity holds.

    Attributes
    ----------
    epsilon : of Greenhouse and Geisser: 1 where it holds, 1 / df at the worst.
    W, p : Mauchly's statistic and the chance of one as small if sphericity held; None with one contrast,
        which cannot miss it, and with too few people for the determinant.
    """

    epsilon: float
    W: float | None = None
    p: float | None = None


def sphericity(values: FloatArray) -> Sphericity:
    """Judge orthonormal contrasts of people's scores, (people, df); their covariance must not be all 0."""
    people, df = values.shape
    if df == 1:
        return Sphericity(1.0)
    covariance = np.cov(values, rowvar=False)
    trace = float(np.trace(covariance))
    epsilon = trace**2 / (df * float(np.sum(covariance**2)))
    W, p = _mauchly(covariance, people) if people > df else (None, None)
    # rounding may lift it above its bound by the last digit
    return Sphericity(min(epsilon, 1.0), W, p)


def _mauchly(covariance: FloatArray, people: int) -> tuple[float, float]:
    """Give Mauchly's W and p by the expansion in two terms (Anderson 2003, section 10.7), as R has it."""
    from scipy.stats import chi2

    df, n = covariance.shape[0], people - 1
    sign, log_determinant = np.linalg.slogdet(covariance)
    if sign <= 0:
        return 0.0, 0.0
    log_W = float(log_determinant) - df * math.log(float(np.trace(covariance)) / df)
    rho = 1.0 - (2 * df**2 + df + 2) / (6.0 * df * n)
    second = (
        (df + 2) * (df - 1) * (df - 2) * (2 * df**3 + 6 * df**2 + 3 * df + 2) / (288 * (n * df * rho) ** 2)
    )
    at, freedom = -n * rho * log_W, df * (df + 1) / 2 - 1
    p = chi2.sf(at, freedom) * (1.0 - second) + second * chi2.sf(at, freedom + 4)
    return math.exp(log_W), float(p)
