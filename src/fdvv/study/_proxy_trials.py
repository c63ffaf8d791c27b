"""Trials of every kind as simulated people go through them, many studies at once."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fdvv.study._participant_proxy import SimulatedPeople
from fdvv.study._plan import StudyKind
from fdvv.study._proxy_judgement import (
    choices,
    leant,
    perceived_distances,
    ratings_of_distances,
    ratings_of_strengths,
    ratings_with_top,
)
from fdvv.units import FloatArray

NO_REFERENCE: tuple[StudyKind, ...] = ("2afc", "2ac", "preference", "staircase")
"""Kinds whose renderings are held against each other alone."""
FORCED: tuple[StudyKind, ...] = ("abx", "2afc", "staircase")
"""Kinds in which "equal" is no answer."""
PREFERENCE_TASTE_ratio = 1.0
"""Of liking: people's tastes differ as much as they agree. Assumed."""


@dataclass(frozen=True, eq=False)
class ProxyTrials:
    """What simulated people answered.

    Attributes
    ----------
    chosen : (people..., trials...) 0 or 1, the place of the stimulus, or EQUAL_INDEX; abx: what X was said
        to be.
    correct : the same shape: whether what was chosen is right; abx: X. Elsewhere the first stimulus is.
    ratings : (people..., trials..., stimuli), one for every scale asked for.
    """

    chosen: np.ndarray
    correct: np.ndarray
    ratings: tuple[FloatArray, ...]


def proxy_trials(
    kind: StudyKind,
    people: SimulatedPeople,
    between_JND: FloatArray,
    to_reference_JND: FloatArray,
    random: np.random.Generator,
    ties: bool = True,
    points: tuple[int, ...] = (),
    hidden: np.ndarray | None = None,
) -> ProxyTrials:
    """Answer trials.

    between_JND : (people..., trials...) how far the first stimulus is above, or from, the second; the sign
        counts where there is no reference. to_reference_JND : (people..., trials..., stimuli) how far each is
        from the reference; not used where there is none. ties : "equal" may be said, where the kind has it.
    points : of each rating scale. hidden : abx: the place of what X is, (people..., trials...).
    """
    right = np.zeros(between_JND.shape, dtype=np.int64) if hidden is None else hidden
    if kind in NO_REFERENCE:
        seeming = _strengths(kind, people, between_JND, random)
        ratings = tuple(ratings_of_strengths(people, seeming, one, random) for one in points)
    else:
        if kind == "abx":
            places = np.arange(to_reference_JND.shape[-1])
            to_reference_JND = np.abs(between_JND)[..., None] * (places != right[..., None])
        seeming = _closeness(kind, people, between_JND, to_reference_JND, random)
        rate = ratings_with_top if kind == "mushra" else ratings_of_distances
        ratings = tuple(rate(people, -seeming, one, random) for one in points)
    chosen = choices(people, seeming, ties and kind not in FORCED, random)
    return ProxyTrials(chosen, chosen == right, ratings)


def _strengths(
    kind: StudyKind, people: SimulatedPeople, between_JND: FloatArray, random: np.random.Generator
) -> FloatArray:
    """Give how strong or good both seem, the second at 0 but for noise."""
    both = np.stack([between_JND, np.zeros_like(between_JND)], axis=-1)
    seeming = both + people.settings.noise_JND * random.standard_normal(both.shape)
    taste_ratio = PREFERENCE_TASTE_ratio if kind == "preference" else 0.0
    return leant(people, seeming, np.abs(between_JND), taste_ratio)


def _closeness(
    kind: StudyKind,
    people: SimulatedPeople,
    between_JND: FloatArray,
    to_reference_JND: FloatArray,
    random: np.random.Generator,
) -> FloatArray:
    """Give how close to the reference each seems, never above 0 but for taste."""
    seeming = -perceived_distances(people, to_reference_JND, random)
    # what X is, or hides, does not hang on taste
    taste_ratio = people.settings.taste_ratio if kind == "realism" else 0.0
    return leant(people, seeming, np.abs(between_JND), taste_ratio)
