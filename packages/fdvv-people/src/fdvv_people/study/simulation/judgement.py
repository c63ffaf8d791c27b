"""How simulated people judge: what is felt, with noise, becomes a choice and ratings. Arrays of any shape."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fdvv.units import FloatArray
from fdvv_people.study.plan.task import StudyTask
from fdvv_people.study.plan.tasks import task_of
from fdvv_people.study.simulation.people import SimulatedPeople

EQUAL_INDEX = -1
"""Instead of a stimulus's place where the answer is "equal"."""

SLIDER = 101
"""Points of a scale from 0 to 100; others begin at 1."""


def _seeming(
    task: StudyTask,
    people: SimulatedPeople,
    between_JND: FloatArray,
    to_reference_JND: FloatArray,
    random: np.random.Generator,
) -> FloatArray:
    """Return how strong, or how close to the reference, each stimulus seems, (people..., trials..., stimuli).

    The reference is felt once in a trial, with its own noise; all differences are taken to lie on one axis
    (the differencing rule, Macmillan and Creelman 2005). A person's taste leans to the first stimulus by a
    part of how far the first two are apart.
    """
    noise = people.settings.noise_JND
    if not task.has_reference:
        both = np.stack([between_JND, np.zeros_like(between_JND)], axis=-1)
        seeming = both + noise * random.standard_normal(both.shape)
    else:
        own = random.standard_normal(to_reference_JND.shape)
        reference = random.standard_normal((*to_reference_JND.shape[:-1], 1))
        seeming = -np.abs(to_reference_JND + noise * (own - reference))
    # in the other kinds something is right, and what X is, or hides, does not hang on taste
    apart_JND = np.abs(between_JND)
    seeming[..., 0] += task.taste_ratio(people.settings) * _over(people.taste, apart_JND) * apart_JND
    return np.asarray(seeming)


def _choices(
    people: SimulatedPeople, seeming_JND: FloatArray, ties: bool, random: np.random.Generator
) -> np.ndarray:
    """Choose the stronger of two, by place, or EQUAL_INDEX; (people..., trials...).

    A lapse is answered by chance, among all answers that are offered.
    """
    apart = seeming_JND[..., 0] - seeming_JND[..., 1]
    chosen = np.where(apart > 0, 0, 1)
    if ties:
        chosen = np.where(np.abs(apart) < _over(people.criterion_JND, apart), EQUAL_INDEX, chosen)
    lapsed = random.uniform(size=apart.shape) < _over(people.lapse_ratio, apart)
    blind = random.integers(EQUAL_INDEX if ties else 0, 2, size=apart.shape)
    return np.asarray(np.where(lapsed, blind, chosen))


def _ratings(
    task: StudyTask,
    people: SimulatedPeople,
    seeming_JND: FloatArray,
    points: int,
    random: np.random.Generator,
) -> FloatArray:
    """Rate how strong, or how close to the reference, each stimulus seems, on a scale of so many points."""
    drop_JND = people.settings.rating_drop_JND
    if not task.has_reference:
        # the middle of the scale for strength 0
        return _on_scale(people, 0.5 + 0.5 * np.tanh(seeming_JND / drop_JND), points, random)
    apart = -seeming_JND
    if task.hides_reference:
        apart = apart - apart.min(axis=-1, keepdims=True)
    rated = _on_scale(people, np.exp(-np.clip(apart, 0.0, None) / drop_JND), points, random)
    if not task.hides_reference:
        return rated
    # one of them is the reference, so what seems closest is given the top
    return np.where(apart == 0.0, float(points if points != SLIDER else SLIDER - 1), rated)


def _on_scale(
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
    kind: str,
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
    task = task_of(kind)
    if task.hides_x:
        places = np.arange(to_reference_JND.shape[-1])
        to_reference_JND = np.abs(between_JND)[..., None] * (places != right[..., None])
    seeming = _seeming(task, people, between_JND, to_reference_JND, random)
    ratings = tuple(_ratings(task, people, seeming, one, random) for one in points)
    chosen = _choices(people, seeming, task.offers_equal(ties), random)
    return ProxyTrials(chosen, chosen == right, ratings)
