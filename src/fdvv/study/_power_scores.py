"""Whole studies of simulated people, many at once: one score of the main claim for each of them."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from fdvv.study._felt_features import FeltDifference
from fdvv.study._participant_proxy import ProxySettings, SimulatedPeople, draw_people
from fdvv.study._plan import StudyKind
from fdvv.study._proxy_judgement import EQUAL_INDEX
from fdvv.study._proxy_trials import ProxyTrials, proxy_trials
from fdvv.units import FloatArray

Progress = Callable[[int, int], None]
NOTHING = FeltDifference(0.0, 0.0, (), 0.0)


@dataclass(frozen=True)
class ItemEffect:
    """What the claim compares in one item.

    Attributes
    ----------
    item : its name. between : how far the claim's first stimulus is from its second.
    more, less : how far each of them is from the reference; not used in kinds without one.
    """

    item: str
    between: FeltDifference
    more: FeltDifference = NOTHING
    less: FeltDifference = NOTHING

    @classmethod
    def of_size(cls, item: str, difference_JND: float) -> ItemEffect:
        """Give an effect of one size: the first is the reference, the second so far from it."""
        apart = FeltDifference(difference_JND, 0.0, (), 0.0)
        return cls(item, apart, NOTHING, apart)


@dataclass(frozen=True)
class PowerDesign:
    """What of a plan its power hangs on.

    Attributes
    ----------
    kind, rounds, ties : of the plan. effects : one per item. alpha : of the claim's test.
    points : of the rating that the claim is about; None: it is about choices.
    """

    kind: StudyKind
    effects: tuple[ItemEffect, ...]
    rounds: int
    ties: bool
    alpha: float
    points: int | None = None

    def of_size(self, difference_JND: float) -> PowerDesign:
        """Give the same design with one difference for all items."""
        effects = tuple(ItemEffect.of_size(one.item, difference_JND) for one in self.effects)
        return PowerDesign(self.kind, effects, self.rounds, self.ties, self.alpha, self.points)


@dataclass(frozen=True, eq=False)
class SimulatedScores:
    """Scores of simulated people.

    Attributes
    ----------
    scores : (studies, people), above 0 for the claim; see claim_scores.
    shares : (items, 3) parts of all answers that were for the claim, "equal", and against it; nan where
        nothing was chosen.
    """

    scores: FloatArray
    shares: FloatArray


def simulate_scores(
    design: PowerDesign,
    people: int,
    studies: int,
    seed: int = 0,
    stream: int = 0,
    settings: ProxySettings | None = None,
    progress: Progress = lambda _done, _total: None,
) -> SimulatedScores:
    """Simulate studies; a person of a study is the same however many people there are.

    stream : 0, 1, ... of independent runs with one seed.
    """
    scores = np.empty((studies, people))
    shares = np.zeros((len(design.effects), 3))
    for number in range(people):
        random = np.random.default_rng([seed, stream, number])
        whole = draw_people(random, (studies,), settings)
        trials = _answered(design, whole, random)
        scores[:, number] = _scored(design, trials)
        shares = shares + _shared(design, trials) / people
        progress(number + 1, people)
    return SimulatedScores(scores, shares)


def _answered(design: PowerDesign, people: SimulatedPeople, random: np.random.Generator) -> ProxyTrials:
    """Let one person of every study answer, (studies, items, rounds)."""
    rounds = (1, 1, design.rounds)
    between, more, less = (
        np.stack([people.felt_JND(getattr(one, part)) for one in design.effects], axis=1)[..., None]
        * np.ones(rounds)
        for part in ("between", "more", "less")
    )
    hidden = random.integers(0, 2, size=between.shape) if design.kind == "abx" else None
    points = () if design.points is None else (design.points,)
    to_reference = np.stack([more, less], axis=-1)
    return proxy_trials(design.kind, people, between, to_reference, random, design.ties, points, hidden)


def _scored(design: PowerDesign, trials: ProxyTrials) -> FloatArray:
    """Give each study's person a score."""
    if design.points is not None:
        return np.asarray((trials.ratings[0][..., 0] - trials.ratings[0][..., 1]).mean(axis=(1, 2)))
    return np.asarray(_spoken(trials).mean(axis=(1, 2)))


def _spoken(trials: ProxyTrials) -> FloatArray:
    """Give 1 for an answer that speaks for the claim, -1 against it, 0 for "equal"."""
    return np.where(trials.chosen == EQUAL_INDEX, 0.0, np.where(trials.correct, 1.0, -1.0))


def _shared(design: PowerDesign, trials: ProxyTrials) -> FloatArray:
    """Give parts of the answers, (items, 3)."""
    if design.kind == "mushra":
        return np.full((len(design.effects), 3), np.nan)
    spoken = _spoken(trials)
    return np.stack([(spoken == one).mean(axis=(0, 2)) for one in (1.0, 0.0, -1.0)], axis=1)
