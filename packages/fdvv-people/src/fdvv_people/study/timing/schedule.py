"""A person's trials: levels in a public order, conditions in secret balanced ones, codes of no meaning."""

from __future__ import annotations

import hashlib
from typing import Literal

import numpy as np
from msgspec import Struct

from fdvv_people.stats.orders import williams_orders
from fdvv_people.study.plan.trial import StudyTrial
from fdvv_people.study.timing.plan import TimingPlan

Phase = Literal["training", "validation"]
Hand = Literal["button", "switch", "key"]
SEED, RANDOM = 0, 1
"""What is drawn of a person's key: the engine's seed, which is no secret, and that of the random design."""
LETTERS, DIGITS = "ABCDEFGHJKLMNPQRSTUVWXYZ", "23456789"
"""Of codes: none is taken for another."""


class TimingFace(Struct, frozen=True, forbid_unknown_fields=True):
    """All of a trial that may be seen.

    Attributes
    ----------
    number : 0, 1, ... of the person. phase, level, round : where it belongs; round within phase and level.
    code : what the validation calls it; empty in training. hand : what is under the finger; a button is
        rendered. switch, key : of a switch or key its name and the `KeyboardEvent.code` that counts.
    """

    number: int
    phase: Phase
    level: str
    round: int
    code: str = ""
    hand: Hand = "button"
    switch: str = ""
    key: str = ""


def drawn_seed(key: str, stream: int) -> int:
    """Return a seed that follows from a person's key, a hexadecimal number, one way."""
    return int(np.random.SeedSequence([int(key, 16), stream]).generate_state(1)[0])


def level_order(plan: TimingPlan, place: int) -> tuple[str, ...]:
    """Return the order of levels of a place in the study: every second one the other way round."""
    levels = plan.all_levels
    return levels if place % 2 == 0 else levels[::-1]


def draw_validation(plan: TimingPlan, place: int, secret: str) -> tuple[StudyTrial, ...]:
    """Draw a person's validation. **Secret.**

    place : 0, 1, ... in the order of enrolment. secret : what nobody knows who may not know the orders, the
    same for all people of the study.

    Notes
    -----
    Every round of a level has every condition once, in a row of Williams' design over conditions that are
    permuted by the secret. The rows are dealt through all people's rounds in turn, in an order that the
    secret draws anew for each pass through the design. So balance is exact whenever a pass is whole, and the
    place of a person, which everybody knows, does not tell their orders.

    What still reveals: who learns the conditions behind a whole round, as when several switches lie on the
    table, knows part of the permutation, and where that condition is likely to be in other rounds.
    """
    each = plan.rounds * len(plan.all_levels)
    random = np.random.default_rng()
    codes = iter(_codes(each * len(plan.conditions), random))
    trials: list[StudyTrial] = []
    for block, (level, round_) in enumerate(
        (level, round_) for level in level_order(plan, place) for round_ in range(plan.rounds)
    ):
        for name in _order(plan, place * each + block, secret):
            number = plan.training_trials + len(trials)
            trials.append(StudyTrial(number, level, round_, {next(codes): name}))
    return tuple(trials)


def _order(plan: TimingPlan, block: int, secret: str) -> tuple[str, ...]:
    """Return the order of conditions in one of the study's rounds, counted through all people."""
    names = [one.name for one in plan.conditions]
    rows = williams_orders(len(names))
    cycle, at = divmod(block, len(rows))
    seed = int.from_bytes(hashlib.sha256(secret.encode()).digest()[:16])
    permuted = np.random.default_rng([seed, 0]).permutation(len(names))
    row = np.random.default_rng([seed, 1, cycle]).permutation(len(rows))[at]
    return tuple(names[permuted[i]] for i in rows[row])


def _codes(count: int, random: np.random.Generator) -> list[str]:
    pool = [letter + digit for letter in LETTERS for digit in DIGITS]
    if count > len(pool):
        pool = [code + digit for code in pool for digit in DIGITS]
    return [pool[i] for i in random.permutation(len(pool))[:count]]


def faces_of(plan: TimingPlan, place: int, validation: tuple[StudyTrial, ...]) -> tuple[TimingFace, ...]:
    """Return what may be seen of all trials of a person, training first."""
    count = plan.training.trials if plan.training else 0
    places = [(level, round_) for level in level_order(plan, place) for round_ in range(count)]
    training = [TimingFace(i, "training", *where) for i, where in enumerate(places)]
    return (*training, *(_face(plan, trial) for trial in validation))


def _face(plan: TimingPlan, trial: StudyTrial) -> TimingFace:
    ((code, name),) = trial.labels.items()
    one = plan.condition(name)
    hand: Hand = "switch" if one.kind == "switch" else "key" if one.kind == "key" else "button"
    switch = one.name if one.on_the_table else ""
    return TimingFace(trial.number, "validation", trial.item, trial.round, code, hand, switch, one.code)
