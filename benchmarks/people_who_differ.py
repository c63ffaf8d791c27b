"""How far apart are people's best buttons, and what does the best fixed one lose? Simulated.

Run as ``python -m benchmarks.people_who_differ [PEOPLE] [DESIGNS] [PROCESSES] [GROUP]`` (default 40
300 2 diverse).
Everybody scores the same designs of the paper's space that are buttons. These are expected scores, without
chance, so the best of many is no lucky one. The best fixed design is chosen on every second person and judged
on the others. People of seed 500 judge; the group's numbers were chosen on seeds 700 and 701. Last, people's
timing is compared with that of 15 people who tapped, if ../shared/data is there. About ten minutes.
"""

from __future__ import annotations

import os
import sys
from collections.abc import Callable, Mapping
from concurrent.futures import ProcessPoolExecutor
from pathlib import Path

import numpy as np

from benchmarks.optimize_people import expected_ms
from benchmarks.people_calibration import Taps, person_spreads_ms, read_taps
from fdvv.model.file import load_builtin
from fdvv.units import FloatArray
from fdvv_people.optimize.button_constraints import button_constraints
from fdvv_people.optimize.engines.registry import engine_of
from fdvv_people.optimize.paper_space import paper_model, paper_space
from fdvv_people.optimize.people.groups import group_named
from fdvv_people.optimize.people.user import SimulatedUser, draw_users
from fdvv_people.optimize.problem import Problem
from fdvv_people.optimize.space import Design
from fdvv_people.task.pointing import TemporalPointing

SEED = 500
SPACE = paper_space(button_constraints())
SWITCHES = ("mx-clear", "mx-brown", "mx-black", "mx-red")
BEST = 5
"""Designs whose mean is a person's best: one alone is a matter of the net."""
BINS = 8
DRAWN = 2000
PERIODS_ms = (1200.0, 1800.0)
"""Of the metronome, on either side of a bullet every 1440 ms."""


class Score:
    """Scores every design by one person at a level, then the switches."""

    def __init__(self, level: str, designs: tuple[Design, ...]) -> None:
        self.task, self.designs = TemporalPointing(level), designs

    def __call__(self, user: SimulatedUser) -> list[float]:
        models = [*map(paper_model, self.designs), *map(load_builtin, SWITCHES)]
        return [expected_ms(self.task, model, user, 1) for model in models]


def table(
    level: str, designs: tuple[Design, ...], users: tuple[SimulatedUser, ...], processes: int
) -> FloatArray:
    """Return expected scores (people, designs and switches), ms."""
    with ProcessPoolExecutor(processes) as executor:
        return np.array(list(executor.map(Score(level, designs), users)))


def explained(places: FloatArray, scores: FloatArray) -> FloatArray:
    """Return the share, (d,), of the variance over designs that each parameter alone explains, one person."""
    bins = np.minimum((places * BINS).astype(int), BINS - 1)
    found = []
    for column in bins.T:
        groups = [scores[column == one] for one in np.unique(column)]
        between = sum(len(group) * (group.mean() - scores.mean()) ** 2 for group in groups) / len(scores)
        # groups of chance differ too: as many degrees of freedom as there are groups
        chance = scores.var() * (len(groups) - 1) / (len(scores) - 1)
        found.append(max(0.0, between - chance) / scores.var())
    return np.array(found)


def report(level: str, scores: FloatArray, designs: tuple[Design, ...]) -> None:
    """Print what the best fixed design loses and where people's best designs lie."""
    free, switches = scores[:, : len(designs)], scores[:, len(designs) :]
    fixed = int(np.argmin(free[::2].mean(axis=0)))
    own, judged = free[1::2].min(axis=1), free[1::2, fixed]
    loss = judged - own
    print(
        f"{level}: own best {middle(own)}; the best fixed design loses {middle(loss)}, "
        f"mean {loss.mean():.1f}, {len(own)} people"
    )
    print(
        f"  random design {middle(np.median(free[1::2], axis=1))}; best switch {middle(switches.min(axis=1))}"
    )
    places = SPACE.to_unit(designs)
    best = np.array([places[np.argsort(row)[:BEST]].mean(axis=0) for row in free])
    weight = np.median([explained(places, row) for row in free], axis=0)
    for name, share, column in zip(SPACE.names, weight, best.T, strict=True):
        low, high = np.percentile(column, [5, 95])
        print(f"  {name:13} explains {100 * share:4.1f} %; best from {low:.2f} to {high:.2f} of its range")


def middle(values: FloatArray) -> str:
    """Write median and 5 to 95 %."""
    low, median, high = np.percentile(values, [5, 50, 95])
    return f"{median:.1f} ms ({low:.1f} to {high:.1f})"


def bias_spread_ms(taps: Taps, period_ms: float) -> float:
    """Return how people differ in their mean asynchrony at a period."""
    return float(np.std([taps.of([one], period_ms).late_ms.mean() for one in taps.people], ddof=1))


def block_spread_ms(taps: Taps, period_ms: float) -> float:
    """Return how a person's mean differs from trial to trial, beyond what single taps let expect."""
    found = []
    for person in taps.people:
        own = taps.of([person], period_ms)
        trials = [own.late_ms[own.trial == one] for one in np.unique(own.trial)]
        trials = [one for one in trials if one.size >= 10]
        chance = np.mean([one.var(ddof=1) / one.size for one in trials])
        found.append(np.var([one.mean() for one in trials], ddof=1) - chance)
    return float(np.sqrt(max(0.0, np.mean(found))))


def clock_spread(taps: Taps, _period_ms: float) -> float:
    """Return how people differ in the logarithm of their spread over all periods."""
    ratios = np.log(person_spreads_ms(taps) / np.array(taps.periods_ms))
    return float(np.nanstd(np.nanmean(ratios, axis=1), ddof=1))


def interval(statistic: Callable[[Taps, float], float], taps: Taps, period_ms: float) -> tuple[float, float]:
    """Return the 95 % interval of a statistic, people resampled."""
    random, found = np.random.default_rng(0), []
    for _ in range(300):
        drawn = random.choice(taps.people, len(taps.people))
        parts = [taps.of([int(one)]) for one in drawn]
        columns = [
            np.concatenate(column)
            for column in zip(*((p.trial, p.period_ms, p.late_ms) for p in parts), strict=True)
        ]
        person = np.repeat(np.arange(len(parts)), [part.late_ms.size for part in parts]).astype(np.float64)
        found.append(statistic(Taps(person, *columns), period_ms))
    low, high = np.percentile(found, [2.5, 97.5])
    return float(low), float(high)


def beside_tapping(group: str) -> None:
    """Print the timing of people who tapped and that of the group."""
    folder = Path(os.environ.get("FDVV_SHARED", "../shared")) / "data" / "baath-sync-tapping"
    files = sorted(folder.glob("*.csv"))
    if not files:
        print(f"left out: no tapping data in {folder}")
        return
    taps, people = read_taps(files[0]), draw_users(DRAWN, SEED, group_named(group))
    simulated: Mapping[str, tuple[Callable[[Taps, float], float], float]] = {
        "spread of people's bias, ms": (bias_spread_ms, float(np.std([one.bias_ms for one in people]))),
        "spread of blocks, ms": (
            block_spread_ms,
            float(np.sqrt(np.mean([one.block_ms**2 for one in people]))),
        ),
        "spread of people's log clock": (
            clock_spread,
            float(np.std(np.log([one.clock_ratio for one in people]))),
        ),
    }
    for what, (statistic, value) in simulated.items():
        rows = [
            (period, statistic(taps, period), *interval(statistic, taps, period)) for period in PERIODS_ms
        ]
        tapped = "; ".join(
            f"{found:.2f} ({low:.2f} to {high:.2f}) every {period:.0f} ms"
            for period, found, low, high in rows
        )
        print(f"{what}: tapped {tapped}; simulated {value:.2f}")


def main() -> None:
    """Print all of it."""
    people, count, processes = (
        int(word) for word in (*sys.argv[1:4], *("40", "300", "2")[len(sys.argv) - 1 :])
    )
    group = sys.argv[4] if len(sys.argv) > 4 else "diverse"
    designs = tuple(engine_of("sobol").suggest(Problem(SPACE, TemporalPointing().objectives), (), count))
    users = draw_users(people, SEED, group_named(group))
    for level in ("easy", "hard"):
        report(level, table(level, designs, users, processes), designs)
    beside_tapping(group)


if __name__ == "__main__":
    main()
