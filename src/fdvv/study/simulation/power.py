"""What a number of people can show: the claim's own test on simulated studies, with intervals."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field

import numpy as np

from fdvv.errors import ModelError
from fdvv.study._claim import claim_holds
from fdvv.study._effect_size import Estimate
from fdvv.study._participant_proxy import ProxySettings
from fdvv.study._power_scores import PowerDesign, SimulatedScores, simulate_scores
from fdvv.study._share import wilson
from fdvv.units import FloatArray

WANTED_power = 0.8
SIZES_JND = (0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.8, 1.0, 1.25, 1.5, 2.0, 2.5, 3.0)
"""Differences that are tried for the smallest that is found."""
Stages = Callable[[str, int, int], None]


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
        """Give the fewest people from whom on the whole interval of power stays at that or above."""
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
        def told(done: int, total: int) -> None:
            progress(label, done, total)

        return simulate_scores(of, counts[-1], repeats, seed, stream, settings, told)

    felt = simulated(design, 0, studies, "people who feel what the proxy says")
    nothing = simulated(design.of_size(0.0), 1, studies, "people who feel no difference")
    sides = np.random.default_rng([seed, 2]).choice([-1.0, 1.0], size=felt.scores.shape)
    sized = [
        simulated(design.of_size(size), 3 + place, studies // 4, "people and differences of every size")
        for place, size in enumerate(sizes_JND)
    ]
    rows = []
    for done, n in enumerate(counts, start=1):
        power, wrong_side, _ = _claims(felt.scores[:, :n], design.alpha)
        false_nothing = _claims(nothing.scores[:, :n], design.alpha)[2]
        false_split = _claims((felt.scores * sides)[:, :n], design.alpha)[2]
        found = _detectable(sizes_JND, sized, n, design.alpha)
        rows.append(PowerRow(n, power, wrong_side, false_nothing, false_split, *found))
        progress("tests", done, len(counts))
    return PowerTable(tuple(rows), felt.shares, design, studies, seed, settings)


def _claims(scores: FloatArray, alpha: float) -> tuple[Estimate, Estimate, Estimate]:
    """Give the parts of studies, (studies, people), with p at most alpha: upwards, downwards, either."""
    found, side = claim_holds(scores, alpha), np.sign(scores.sum(axis=1))
    return _part(found & (side > 0)), _part(found & (side < 0)), _part(found)


def _part(of: np.ndarray) -> Estimate:
    low, high = wilson(of.sum(), of.size)
    return Estimate(float(of.mean()), float(low), float(high))


def _detectable(
    sizes_JND: Sequence[float], sized: Sequence[SimulatedScores], people: int, alpha: float
) -> tuple[float | None, float | None]:
    """Give the smallest difference that so many people find, and its share of answers."""
    powers = [_claims(one.scores[:, :people], alpha)[0].value for one in sized]
    reached = [place for place, power in enumerate(powers) if power >= WANTED_power]
    if not reached:
        return None, None
    place = reached[0]
    below = (0.0, 0.0) if place == 0 else (sizes_JND[place - 1], powers[place - 1])
    smallest = float(np.interp(WANTED_power, [below[1], powers[place]], [below[0], sizes_JND[place]]))
    shares = [float(one.shares[:, 0].mean()) for one in sized]
    return smallest, float(np.interp(smallest, sizes_JND, shares))
