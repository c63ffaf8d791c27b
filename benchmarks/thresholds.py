"""How many trials do thresholds by expected information take, beside staircases of the same error? Simulated.

Every observer has a known JND of force, snap and vibration. Three interleaved staircases, one of each, are
analysed by their turns and by the belief of the other method too: so what choosing brings is parted from what
analysing brings. Their rules were tuned on the seeds from 700; those from 1000 judge and chose nothing.

    python -m benchmarks.thresholds [--seeds 1000-1299] [--kinds proportional,proxy] [--combined]

--combined: every third trial changes several dimensions at once.
"""

from __future__ import annotations

import argparse
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import lru_cache

import numpy as np
from scipy.optimize import brentq
from scipy.special import ndtr

from fdvv.model.file import load_builtin
from fdvv.model.magnify import magnify
from fdvv.model.model import FDVVModel
from fdvv.model.noticeable import AT_JND, DIMENSIONS
from fdvv.units import FloatArray
from fdvv_people.study.plan.plan import Thresholds
from fdvv_people.study.plan.threshold_trials import threshold_estimate, trial_change
from fdvv_people.study.simulation.people import draw_people
from fdvv_people.study.simulation.perception import (
    HapticFeatures,
    PerceivedDifference,
    haptic_features,
    perceived_difference,
)
from fdvv_people.thresholds.belief import Change, Trial

KINDS = ("proportional", "exponent", "lapsing", "tiring", "lognormal", "proxy")
"""Of observers: d' in proportion to the change, about as the method expects; with an exponent of 0.65 to 1.6
and another way of adding up; with 5 to 12 % of lapses; whose JND grows by 0.4 % a trial; a cumulative normal
of the logarithm of the change; and those of fdvv_people.study.simulation at the built-in rubber dome, with
four
times the vibration of mx-clear: each person must feel what can be rendered."""

JND_ratio, JND_spread = (0.10, 0.45, 0.35), 0.6
"""Of the observers but the proxies: middle, and spread of the logarithm. Not what the method expects."""

COUNTS = (30, 36, 42, 48, 54)
TRIALS = 93
"""Of three staircases: 31 each, about what 8 turns take."""

MOST_ratio = (1.0, 2.0, 3.0)
LOUD = 4.0
LARGEST_snap_ratio = 2.2


@dataclass(frozen=True)
class Observer:
    """Who is measured.

    Attributes
    ----------
    felt : JNDs of a change, before tiring. lapse, rate : of lapses, and of tiring. lognormal : spread, or 0.
    """

    felt: Callable[[FloatArray], float]
    lapse: float
    rate: float = 0.0
    lognormal: float = 0.0

    def correct(self, change: FloatArray, trial: float) -> float:
        felt = self.felt(np.asarray(change) * np.exp(-self.rate * trial))
        seen = ndtr(AT_JND * felt)
        if self.lognormal:
            seen = 0.5 + 0.5 * ndtr(np.log(max(felt, 1e-9)) / self.lognormal)
        return float(0.5 * self.lapse + (1.0 - self.lapse) * seen)

    def log_jnd(self, trials: int, share: float | None = None) -> FloatArray:
        """Return the logarithm of its JNDs in the middle of the trials; share : of right answers there."""
        wanted = 0.5 * self.lapse + (1.0 - self.lapse) * 0.75 if share is None else share
        middle = 0.5 * (trials - 1)

        def above(log: float, axis: FloatArray) -> float:
            return self.correct(np.exp(log) * axis, middle) - wanted

        return np.array(
            [brentq(above, -6.0, 3.0, args=(axis,), xtol=1e-3) for axis in np.eye(len(DIMENSIONS))]
        )


def observer(kind: str, seed: int) -> Observer:
    random = np.random.default_rng([seed, KINDS.index(kind)])
    jnd = np.array(JND_ratio) * np.exp(JND_spread * random.standard_normal(3))
    exponent, m, lapse = 1.0, 2.0, 0.04 * random.uniform()
    if kind == "exponent":
        exponent, m = (
            float(np.exp(random.uniform(np.log(0.65), np.log(1.6)))),
            float(random.choice([1.3, 2.0, 4.0])),
        )
    if kind == "lapsing":
        lapse = random.uniform(0.05, 0.12)
    if kind == "proxy":
        return _proxy(random)

    def felt(change: FloatArray) -> float:
        return float(np.sum((change / jnd) ** (exponent * m)) ** (1.0 / m))

    spread = random.uniform(0.5, 1.1) if kind == "lognormal" else 0.0
    return Observer(felt, lapse, 0.004 if kind == "tiring" else 0.0, spread)


def _proxy(random: np.random.Generator) -> Observer:
    people = draw_people(random, (1,))

    def felt(change: FloatArray) -> float:
        force, snap, vibration = np.round(change, 6).tolist()
        # beyond it the button would pull; nobody is asked that
        difference = _difference(force, min(snap, LARGEST_snap_ratio), vibration)
        return float(people.felt_JND(difference)[0])

    return Observer(felt, float(people.lapse_ratio[0]))


@lru_cache(maxsize=100_000)
def _difference(force: float, snap: float, vibration: float) -> PerceivedDifference:
    model, features = _standard()
    return perceived_difference(features, haptic_features(magnify(model, 1 + force, 1 + snap, 1 + vibration)))


@lru_cache(maxsize=1)
def _standard() -> tuple[FDVVModel, HapticFeatures]:
    loud = magnify(load_builtin("mx-clear"), vibration_ratio=LOUD)
    model = replace(load_builtin("rubber-dome"), vibrations=loud.vibrations)
    return model, haptic_features(model)


@dataclass(frozen=True)
class Rule:
    """Of staircases: where each starts, in expected JNDs, its steps by turns, correct answers in a row."""

    start: float
    steps: tuple[float, ...]
    down: int


RULES = {
    "as shipped": Rule(2.5, (1.6, 1.25), 2),
    "2 down": Rule(1.5, (1.25,), 2),
    "3 down": Rule(1.5, (1.25,), 3),
}


def staircases(of: Observer, rule: Rule, random: np.random.Generator) -> tuple[list[Trial], FloatArray]:
    """Run three interleaved staircases; return their trials, and the mean logarithm of each one's turns."""
    level = np.minimum(rule.start * np.array(Thresholds().expected_ratio.all), MOST_ratio)
    row, turns, order = [0] * 3, [list[float]() for _ in DIMENSIONS], list[int]()
    falling: list[bool | None] = [None] * 3
    trials: list[Trial] = []
    for number in range(TRIALS):
        order = order or random.permutation(3).tolist()
        k = order.pop()
        change = np.where(np.arange(3) == k, level, 0.0)
        right = bool(random.random() < of.correct(change, number))
        trials.append((_change(change), right))
        row[k] = row[k] + 1 if right else 0
        if right and row[k] < rule.down:
            continue
        row[k] = 0
        if falling[k] is not None and falling[k] != right:
            turns[k].append(level[k])
        falling[k] = right
        step = rule.steps[min(len(turns[k]), len(rule.steps) - 1)]
        level[k] = min(level[k] / step if right else level[k] * step, MOST_ratio[k])
    # as Levitt: of an odd number of turns the first is left out; without any, where it stands
    kept = [one[len(one) % 2 :] or [level[k]] for k, one in enumerate(turns)]
    return trials, np.array([np.mean(np.log(one)) for one in kept])


def informed(
    of: Observer, rule: Thresholds, random: np.random.Generator, count: int
) -> tuple[list[Trial], float]:
    """Run trials as a study of thresholds chooses them; return the longest time of a choice too, in s."""
    trials: list[Trial] = []
    longest_s = 0.0
    for number in range(count):
        began_s = time.process_time()
        change = trial_change(rule, trials)
        longest_s = max(longest_s, time.process_time() - began_s) if number else 0.0
        trials.append((change, bool(random.random() < of.correct(np.array(change), number))))
    return trials, longest_s


def _change(change: FloatArray) -> Change:
    force, snap, vibration = change.tolist()
    return force, snap, vibration


@dataclass(frozen=True, eq=False)
class Judged:
    """error : (3,) of the logarithm of the JNDs. held : (3,) in the 95 % interval, nan without one."""

    error: FloatArray
    held: FloatArray


def judged(trials: Sequence[Trial], rule: Thresholds, truth: FloatArray) -> Judged:
    found = [threshold_estimate(rule, trials).jnds[one] for one in DIMENSIONS]
    error = np.log([one.ratio for one in found]) - truth
    held = [np.log(one.low) <= t <= np.log(one.high) for one, t in zip(found, truth, strict=True)]
    return Judged(error, np.array(held, float))


def measure(kinds: Sequence[str], seeds: range, combined: bool) -> dict[str, dict[str, list[Judged]]]:
    rule = Thresholds(combined=combined, trials=TRIALS)
    found: dict[str, dict[str, list[Judged]]] = {}
    longest_s = []
    for kind in kinds:
        mine: dict[str, list[Judged]] = found.setdefault(kind, {})
        for seed in seeds:
            of = observer(kind, seed)
            trials, took_s = informed(of, rule, np.random.default_rng([seed, 1]), max(COUNTS))
            longest_s.append(took_s)
            truth = of.log_jnd(TRIALS)
            for count in COUNTS:
                name = f"information, {count} trials"
                there = of.log_jnd(count) if of.rate else truth
                mine.setdefault(name, []).append(judged(trials[:count], rule, there))
            for name, steps in RULES.items():
                trials, turned = staircases(of, steps, np.random.default_rng([seed, 2]))
                settled = of.log_jnd(TRIALS, 0.5 ** (1 / steps.down))
                by_turns = Judged(turned - settled, np.full(3, np.nan))
                mine.setdefault(f"staircases {name}, turns", []).append(by_turns)
                by_belief = judged(trials, rule, truth)
                mine.setdefault(f"staircases {name}, belief", []).append(by_belief)
    print(f"a choice took at most {1e3 * np.median(longest_s):.0f} ms of one core (median of observers)")
    return found


def print_table(found: dict[str, dict[str, list[Judged]]]) -> None:
    kinds = list(found)
    print(
        f"{'standard error of the logarithm of a JND':36}" + "".join(f"{one:>14}" for one in [*kinds, "all"])
    )
    for name in found[kinds[0]]:
        groups = [found[kind][name] for kind in kinds]
        groups.append([one for group in groups for one in group])
        cells = []
        for group in groups:
            errors = np.array([one.error for one in group])
            held = np.mean([one.held for one in group])
            cells.append(
                f"{np.sqrt(np.mean(errors**2)):6.3f}" + (f" {100 * held:5.1f} %" if held == held else " " * 8)
            )
        print(f"{name:36}" + "".join(f"{cell:>14}" for cell in cells), flush=True)


def main() -> None:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--seeds", default="1000-1299")
    parser.add_argument("--kinds", default=",".join(KINDS))
    parser.add_argument("--combined", action="store_true")
    options = parser.parse_args()
    first, last = map(int, options.seeds.split("-"))
    seeds = range(first, last + 1)
    many = f"{len(seeds)} observers of each kind, seeds {options.seeds}"
    print(f"simulated; {many}; staircases of {TRIALS} trials")
    print_table(measure(options.kinds.split(","), seeds, options.combined))


if __name__ == "__main__":
    main()
