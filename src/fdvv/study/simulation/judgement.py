"""How simulated people judge: what is felt, with noise, becomes a choice and ratings. Arrays of any shape."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fdvv.study.plan.plan import StudyKind
from fdvv.study.simulation.people import SimulatedPeople
from fdvv.units import FloatArray

EQUAL_INDEX = -1
"""Instead of a stimulus's place where the answer is "equal"."""

SLIDER = 101
"""Points of a scale from 0 to 100; others begin at 1."""

NO_REFERENCE: tuple[StudyKind, ...] = ("2afc", "2ac", "preference", "staircase")
"""Kinds whose renderings are held against each other alone."""

FORCED: tuple[StudyKind, ...] = ("abx", "2afc", "staircase")
"""Kinds in which "equal" is no answer."""

PREFERENCE_TASTE_ratio = 1.0
"""Of liking: people's tastes differ as much as they agree. Assumed."""


def perceived_distances(
    people: SimulatedPeople, distances_JND: FloatArray, random: np.random.Generator
) -> FloatArray:
    """Return how far from the reference each stimulus seems, (people..., trials..., stimuli).

    distances_JND : the same shape, as they are. The reference is felt once in a trial, with its own noise;
    all differences are taken to lie on one axis (the differencing rule, Macmillan and Creelman 2005).
    """
    noise = people.settings.noise_JND
    own = random.standard_normal(distances_JND.shape)
    reference = random.standard_normal((*distances_JND.shape[:-1], 1))
    return np.asarray(np.abs(distances_JND + noise * (own - reference)))


def leant(
    people: SimulatedPeople, strengths_JND: FloatArray, between_JND: FloatArray, taste_ratio: float
) -> FloatArray:
    """Add to the first stimulus what a person's taste leans to it: a part of how far the first two are apart.

    between_JND : the shape of the strengths without stimuli.
    """
    moved = strengths_JND.copy()
    moved[..., 0] += taste_ratio * _over(people.taste, between_JND) * between_JND
    return moved


def choices(
    people: SimulatedPeople, strengths_JND: FloatArray, ties: bool, random: np.random.Generator
) -> np.ndarray:
    """Choose the stronger of two, by place, or EQUAL_INDEX; (people..., trials...).

    A lapse is answered by chance, among all answers that are offered.
    """
    apart = strengths_JND[..., 0] - strengths_JND[..., 1]
    chosen = np.where(apart > 0, 0, 1)
    if ties:
        chosen = np.where(np.abs(apart) < _over(people.criterion_JND, apart), EQUAL_INDEX, chosen)
    lapsed = random.uniform(size=apart.shape) < _over(people.lapse_ratio, apart)
    blind = random.integers(EQUAL_INDEX if ties else 0, 2, size=apart.shape)
    return np.asarray(np.where(lapsed, blind, chosen))


def ratings_of_distances(
    people: SimulatedPeople, perceived_JND: FloatArray, points: int, random: np.random.Generator
) -> FloatArray:
    """Rate how close each stimulus seems, on a scale of so many points."""
    quality = np.exp(-np.clip(perceived_JND, 0.0, None) / people.settings.rating_drop_JND)
    return on_scale(people, quality, points, random)


def ratings_with_top(
    people: SimulatedPeople, perceived_JND: FloatArray, points: int, random: np.random.Generator
) -> FloatArray:
    """Rate as MUSHRA has it: one of them is the reference, so what seems closest is given the top."""
    beyond = perceived_JND - perceived_JND.min(axis=-1, keepdims=True)
    rated = ratings_of_distances(people, beyond, points, random)
    return np.where(beyond == 0.0, float(points if points != SLIDER else SLIDER - 1), rated)


def ratings_of_strengths(
    people: SimulatedPeople, perceived_JND: FloatArray, points: int, random: np.random.Generator
) -> FloatArray:
    """Rate how strong each stimulus seems: the middle of the scale for strength 0."""
    quality = 0.5 + 0.5 * np.tanh(perceived_JND / people.settings.rating_drop_JND)
    return on_scale(people, quality, points, random)


def on_scale(
    people: SimulatedPeople, quality: FloatArray, points: int, random: np.random.Generator
) -> FloatArray:
    """Put 0 to 1 on a scale: 1 to points, or a slider of 0 to 100 where there are 101."""
    noise = people.settings.rating_noise_ratio * random.standard_normal(quality.shape)
    shifted = np.clip(quality + _over(people.rating_shift, quality) + noise, 0.0, 1.0)
    lowest = 0 if points == SLIDER else 1
    return np.asarray(lowest + np.rint(shifted * (points - 1)))


def _over(of_people: FloatArray, like: FloatArray) -> FloatArray:
    return of_people.reshape(of_people.shape + (1,) * (like.ndim - of_people.ndim))


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
    seeming = -perceived_distances(people, to_reference_JND, random)
    # what X is, or hides, does not hang on taste
    taste_ratio = people.settings.taste_ratio if kind == "realism" else 0.0
    return leant(people, seeming, np.abs(between_JND), taste_ratio)
