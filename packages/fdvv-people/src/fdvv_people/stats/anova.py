"""Repeated-measures analysis of variance, with sphericity tested and corrected for.

Each effect is a set of orthonormal contrasts of a person's scores. Their mean over people makes the
effect's sum of squares, their spread the error's, and the covariance of that spread how far sphericity is
missed: one matrix for all three, which is why no library's table of F alone is used here.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from fdvv.errors import ModelError
from fdvv.units import FloatArray
from fdvv_people.stats.effect_size import complete_scores


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
    """Return Mauchly's W and p by the expansion in two terms (Anderson 2003, section 10.7), as R has it."""
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


@dataclass(frozen=True)
class AnovaEffect:
    """One line of the table.

    Attributes
    ----------
    name : a factor, or two joined by " × ".
    effect_df, error_df : degrees of freedom, before any correction.
    F, p : if sphericity held.
    sphericity : how far it holds; its epsilon multiplies both degrees of freedom.
    corrected_p : of F with both degrees of freedom times epsilon (Greenhouse and Geisser 1959).
    effect_ss, error_ss : sums of squares.
    partial_eta2 : effect_ss / (effect_ss + error_ss).
    generalized_eta2 : effect_ss over itself, the people's and every error's (Olejnik and Algina 2003; Bakeman
        2005): comparable between studies, with factors manipulated.
    """

    name: str
    effect_df: int
    error_df: int
    F: float
    p: float
    sphericity: Sphericity
    corrected_p: float
    effect_ss: float
    error_ss: float
    partial_eta2: float
    generalized_eta2: float

    @property
    def corrected_df(self) -> tuple[float, float]:
        """Both degrees of freedom times epsilon."""
        epsilon = self.sphericity.epsilon
        return epsilon * self.effect_df, epsilon * self.error_df


@dataclass(frozen=True)
class Anova:
    """A table of effects.

    Attributes
    ----------
    people : how many.
    effects : the two factors, then their interaction.
    people_ss : sum of squares between people.
    """

    people: int
    effects: tuple[AnovaEffect, ...]
    people_ss: float

    def of(self, name: str) -> AnovaEffect:
        """Return an effect by its name. KeyError."""
        return {effect.name: effect for effect in self.effects}[name]


def repeated_measures_anova(scores: npt.ArrayLike, factors: Sequence[str]) -> Anova:
    """Test two factors and their interaction, all within people.

    scores : (people, levels of the first factor, levels of the second); one score per cell, rounds averaged
    before (averaged_rounds). factors : the two names.

    Raises ModelError on a missing cell, fewer than 3 people, a factor of one level, and where an effect has
    no error to be held against (every person alike).
    """
    found = complete_scores(scores, ("person", *factors))
    people, first, second = found.shape
    rows = found.reshape(people, -1)
    parts = {
        factors[0]: np.kron(_contrasts(first), _mean(second)),
        factors[1]: np.kron(_mean(first), _contrasts(second)),
        f"{factors[0]} × {factors[1]}": np.kron(_contrasts(first), _contrasts(second)),
    }
    between = rows @ np.kron(_mean(first), _mean(second)).T
    people_ss = float(np.sum((between - between.mean(axis=0)) ** 2))
    values = {name: rows @ contrasts.T for name, contrasts in parts.items()}
    spread_ss = people_ss + sum(float(np.sum((z - z.mean(axis=0)) ** 2)) for z in values.values())
    return Anova(people, tuple(_effect(name, z, spread_ss) for name, z in values.items()), people_ss)


def _effect(name: str, values: FloatArray, spread_ss: float) -> AnovaEffect:
    """Test one effect from its contrasts, (people, df)."""
    from scipy.stats import f

    people, df = values.shape
    effect_ss = people * float(np.sum(values.mean(axis=0) ** 2))
    error_ss = float(np.sum((values - values.mean(axis=0)) ** 2))
    # rounding is all that is left where every person differs alike
    if not error_ss > 1e-24 * (effect_ss + float(np.sum(values**2))):
        raise ModelError(f"{name}: every person differs alike, so there is no error to hold it against")
    error_df = df * (people - 1)
    F = (effect_ss / df) / (error_ss / error_df)
    found = sphericity(values)
    return AnovaEffect(
        name=name,
        effect_df=df,
        error_df=error_df,
        F=F,
        p=float(f.sf(F, df, error_df)),
        sphericity=found,
        corrected_p=float(f.sf(F, found.epsilon * df, found.epsilon * error_df)),
        effect_ss=effect_ss,
        error_ss=error_ss,
        partial_eta2=effect_ss / (effect_ss + error_ss),
        generalized_eta2=effect_ss / (effect_ss + spread_ss),
    )


def _mean(levels: int) -> FloatArray:
    """Return the unit row that sums over a factor, (1, levels)."""
    return np.full((1, levels), 1.0 / math.sqrt(levels))


def _contrasts(levels: int) -> FloatArray:
    rows = np.zeros((levels - 1, levels))
    for i in range(1, levels):
        rows[i - 1, :i], rows[i - 1, i] = 1.0, -float(i)
    return np.asarray(rows / np.linalg.norm(rows, axis=1, keepdims=True))
