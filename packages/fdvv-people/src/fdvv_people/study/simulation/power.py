"""What a number of people can show: the claim's own test on simulated studies, with intervals."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from functools import partial

import numpy as np

from fdvv.errors import ModelError
from fdvv.units import FloatArray
from fdvv_people.stats.effect_size import Estimate
from fdvv_people.stats.share import wilson
from fdvv_people.study.plan.claim import claim_holds
from fdvv_people.study.plan.tasks import task_of
from fdvv_people.study.simulation.judgement import EQUAL_INDEX, ProxyTrials, proxy_trials
from fdvv_people.study.simulation.people import ProxySettings, SimulatedPeople, draw_people
from fdvv_people.study.simulation.perception import PerceivedDifference

Progress = Callable[[int, int], None]
NOTHING = PerceivedDifference(0.0, 0.0, (), 0.0)
WANTED_power = 0.8
SIZES_JND = (0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.8, 1.0, 1.25, 1.5, 2.0, 2.5, 3.0)
"""Differences that are tried for the smallest that is found."""

Stages = Callable[[str, int, int], None]


@dataclass(frozen=True)
class ItemEffect:
    """What the claim compares in one item.

    Attributes
    ----------
    item : its name. between : how far the claim's first stimulus is from its second.
    more, less : how far each of them is from the reference; not used in kinds without one.
    """

    item: str
    between: PerceivedDifference
    more: PerceivedDifference = NOTHING
    less: PerceivedDifference = NOTHING

    @classmethod
    def of_size(cls, item: str, difference_JND: float) -> ItemEffect:
        """Return an effect of one size: the first is the reference, the second so far from it."""
        apart = PerceivedDifference(difference_JND, 0.0, (), 0.0)
        return cls(item, apart, NOTHING, apart)


@dataclass(frozen=True)
class PowerDesign:
    """What of a plan its power hangs on.

    Attributes
    ----------
    kind, rounds, ties : of the plan. effects : one per item. alpha : of the claim's test.
    points : of the rating that the claim is about; None: it is about choices.
    """

    kind: str
    effects: tuple[ItemEffect, ...]
    rounds: int
    ties: bool
    alpha: float
    points: int | None = None

    def of_size(self, difference_JND: float) -> PowerDesign:
        """Return the same design with one difference for all items."""
        effects = tuple(ItemEffect.of_size(one.item, difference_JND) for one in self.effects)
        return replace(self, effects=effects)


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
    hidden = random.integers(0, 2, size=between.shape) if task_of(design.kind).hides_x else None
    points = () if design.points is None else (design.points,)
    to_reference = np.stack([more, less], axis=-1)
    return proxy_trials(design.kind, people, between, to_reference, random, design.ties, points, hidden)


def _scored(design: PowerDesign, trials: ProxyTrials) -> FloatArray:
    if design.points is None:
        return np.asarray(_spoken(trials).mean(axis=(1, 2)))
    return np.asarray((trials.ratings[0][..., 0] - trials.ratings[0][..., 1]).mean(axis=(1, 2)))


def _spoken(trials: ProxyTrials) -> FloatArray:
    return np.where(trials.chosen == EQUAL_INDEX, 0.0, np.where(trials.correct, 1.0, -1.0))


def _shared(design: PowerDesign, trials: ProxyTrials) -> FloatArray:
    """Return parts of the answers, (items, 3)."""
    if not task_of(design.kind).choices:
        return np.full((len(design.effects), 3), np.nan)
    spoken = _spoken(trials)
    return np.stack([(spoken == one).mean(axis=(0, 2)) for one in (1.0, 0.0, -1.0)], axis=1)


@dataclass(frozen=True)
class PowerRow:
    """One number of people.

    Attributes
    ----------
    people : in the study. power : part of simulated studies in which the claim is upheld: p at most alpha,
        and to its side. wrong_side : p at most alpha, to the other side.
    false_nothing : claims of either side, p at most alpha, where nobody can feel a difference.
    false_split : the same where people lean as strongly, half of them each way.
    detectable_JND : smallest difference, the same in all items, that is found with a power of 0.8; None
        where the largest that was tried is not. detectable_share : of answers for the claim there.
    """

    people: int
    power: Estimate
    wrong_side: Estimate
    false_nothing: Estimate
    false_split: Estimate
    detectable_JND: float | None = None
    detectable_share: float | None = None


@dataclass(frozen=True, eq=False)
class PowerTable:
    """What a plan can show with how many people. **Simulated**: the proxy's word, no person's.

    Attributes
    ----------
    rows : by people, rising. shares : (items, 3) as in SimulatedScores.
    design, settings, studies, seed : that the rows come from.
    """

    rows: tuple[PowerRow, ...]
    shares: FloatArray
    design: PowerDesign
    studies: int
    seed: int
    settings: ProxySettings = field(default_factory=ProxySettings)
    simulated: bool = True

    def enough(self, power: float = WANTED_power) -> int | None:
        """Return the fewest people from whom on the whole interval of power stays at that or above."""
        short = [i for i, row in enumerate(self.rows) if (row.power.low or 0.0) < power]
        after = short[-1] + 1 if short else 0
        return self.rows[after].people if after < len(self.rows) else None


def power_table(
    design: PowerDesign,
    people: Sequence[int],
    studies: int = 2000,
    seed: int = 0,
    settings: ProxySettings | None = None,
    sizes_JND: Sequence[float] = SIZES_JND,
    progress: Stages = lambda _label, _done, _total: None,
) -> PowerTable:
    """Simulate studies and test the claim in each, for every number of people.

    The first n people of a simulated study are its study of n, so rows share their chance. sizes_JND :
    differences, rising, tried for what is detectable, each in a quarter of the studies; () leaves that out.
    Raises ModelError on fewer than 2 people or 4 studies.
    """
    settings = settings or ProxySettings()
    counts = sorted(set(people))
    if not counts or counts[0] < 2 or studies < 4:
        raise ModelError("power needs at least 2 people and 4 simulated studies")

    def simulated(of: PowerDesign, stream: int, repeats: int, label: str) -> SimulatedScores:
        return simulate_scores(of, counts[-1], repeats, seed, stream, settings, partial(progress, label))

    perceived = simulated(design, 0, studies, "people who feel what the proxy says")
    nothing = simulated(design.of_size(0.0), 1, studies, "people who feel no difference")
    sides = np.random.default_rng([seed, 2]).choice([-1.0, 1.0], size=perceived.scores.shape)
    sized = [
        simulated(design.of_size(size), 3 + place, studies // 4, "people and differences of every size")
        for place, size in enumerate(sizes_JND)
    ]
    rows = []
    for done, n in enumerate(counts, start=1):
        power, wrong_side, _ = _claims(perceived.scores[:, :n], design.alpha)
        false_nothing = _claims(nothing.scores[:, :n], design.alpha)[2]
        false_split = _claims((perceived.scores * sides)[:, :n], design.alpha)[2]
        found = _detectable(sizes_JND, sized, n, design.alpha)
        rows.append(PowerRow(n, power, wrong_side, false_nothing, false_split, *found))
        progress("tests", done, len(counts))
    return PowerTable(tuple(rows), perceived.shares, design, studies, seed, settings)


def _claims(scores: FloatArray, alpha: float) -> tuple[Estimate, Estimate, Estimate]:
    """Return the parts of studies, (studies, people), with p at most alpha: upwards, downwards, either."""
    found, side = claim_holds(scores, alpha), np.sign(scores.sum(axis=1))
    return _part(found & (side > 0)), _part(found & (side < 0)), _part(found)


def _part(of: np.ndarray) -> Estimate:
    low, high = wilson(of.sum(), of.size)
    return Estimate(float(of.mean()), float(low), float(high))


def _detectable(
    sizes_JND: Sequence[float], sized: Sequence[SimulatedScores], people: int, alpha: float
) -> tuple[float | None, float | None]:
    powers = [_claims(one.scores[:, :people], alpha)[0].value for one in sized]
    reached = [place for place, power in enumerate(powers) if power >= WANTED_power]
    if not reached:
        return None, None
    place = reached[0]
    below = (0.0, 0.0) if place == 0 else (sizes_JND[place - 1], powers[place - 1])
    smallest = float(np.interp(WANTED_power, [below[1], powers[place]], [below[0], sizes_JND[place]]))
    shares = [float(one.shares[:, 0].mean()) for one in sized]
    return smallest, float(np.interp(smallest, sizes_JND, shares))
