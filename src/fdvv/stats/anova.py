"""Analysis of variance where every person meets every condition, with sphericity tested and handled.

Each effect is a set of orthonormal contrasts of a person's scores. Their mean over people makes the
effect's sum of squares, their spread the error's, and the covariance of that spread tells how far sphericity
is missed: one matrix for all three, which is why no library's table of F alone is used here.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from fdvv.errors import ModelError
from fdvv.study._scores import complete_scores
from fdvv.study._sphericity import Sphericity, sphericity
from fdvv.units import FloatArray


@dataclass(frozen=True)
class Effect:
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
        """Get both degrees of freedom times epsilon."""
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
    effects: tuple[Effect, ...]
    people_ss: float

    def of(self, name: str) -> Effect:
        """Give an effect by its name. KeyError."""
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


def _effect(name: str, values: FloatArray, spread_ss: float) -> Effect:
    """Test one effect from its contrasts, (people, df)."""
    from scipy.stats import f

    people, df = values.shape
    effect_ss = people * float(np.sum(values.mean(axis=0) ** 2))
    error_ss = float(np.sum((values - values.mean(axis=0)) ** 2))
    # what is left of rounding where every person differs in the same way
    if not error_ss > 1e-24 * (effect_ss + float(np.sum(values**2))):
        raise ModelError(f"{name}: every person differs alike, so there is no error to hold it against")
    error_df = df * (people - 1)
    F = (effect_ss / df) / (error_ss / error_df)
    met = sphericity(values)
    return Effect(
        name=name,
        effect_df=df,
        error_df=error_df,
        F=F,
        p=float(f.sf(F, df, error_df)),
        sphericity=met,
        corrected_p=float(f.sf(F, met.epsilon * df, met.epsilon * error_df)),
        effect_ss=effect_ss,
        error_ss=error_ss,
        partial_eta2=effect_ss / (effect_ss + error_ss),
        generalized_eta2=effect_ss / (effect_ss + spread_ss),
    )


def _mean(levels: int) -> FloatArray:
    """Give the unit row that sums over a factor, (1, levels)."""
    return np.full((1, levels), 1.0 / math.sqrt(levels))


def _contrasts(levels: int) -> FloatArray:
    """Give orthonormal contrasts of a factor, (levels - 1, levels); Helmert's."""
    rows = np.zeros((levels - 1, levels))
    for i in range(1, levels):
        rows[i - 1, :i], rows[i - 1, i] = 1.0, -float(i)
    return np.asarray(rows / np.linalg.norm(rows, axis=1, keepdims=True))
