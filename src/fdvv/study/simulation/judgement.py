"""How simulated people judge: what is felt, with noise, becomes a choice and ratings. Arrays of any shape."""

from __future__ import annotations

import numpy as np

from fdvv.study._participant_proxy import SimulatedPeople
from fdvv.units import FloatArray

EQUAL_INDEX = -1
"""Instead of a stimulus's place where the answer is "equal"."""
SLIDER = 101
"""Points of a scale from 0 to 100; others begin at 1."""


def perceived_distances(
    people: SimulatedPeople, distances_JND: FloatArray, random: np.random.Generator
) -> FloatArray:
    """Give how far from the reference each stimulus seems, (people..., trials..., stimuli).

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
    """Give people's numbers axes for their trials."""
    return of_people.reshape(of_people.shape + (1,) * (like.ndim - of_people.ndim))
