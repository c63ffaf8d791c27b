"""A person's whole schedule: items in balanced orders, and behind each label something drawn anew."""

from __future__ import annotations

import math

import msgspec
import numpy as np

from fdvv_people.stats.orders import williams_orders
from fdvv_people.study.plan.plan import Item, StudyPlan
from fdvv_people.study.plan.task import Assignment
from fdvv_people.study.plan.tasks import task_of
from fdvv_people.study.plan.threshold_trials import practice_change
from fdvv_people.study.plan.trial import StudyTrial


def draw_schedule(plan: StudyPlan, person_index: int, random: np.random.Generator) -> tuple[StudyTrial, ...]:
    """Draw all trials of one person, practice first. **Secret.**

    person_index : 0, 1, ... in the order of enrolment; it sets the orders of items, which are no secret.
    random : draws the labels. It must be made anew for every person from what the operating system holds
        random (``numpy.random.default_rng()``): drawn on from one person to the next, whoever learns one
        schedule could work out the next.

    A staircase has ``staircase.trials`` trials for every item and round, of which those behind its end are
    not shown, and thresholds have ``thresholds.trials``; their ratio, or change, is filled in when their turn
    comes.

    Notes
    -----
    *What labels reveal.* Of two stimuli each hides behind A in half of a person's rounds of an item, or in
    one more or less, by lot, where the rounds are odd. All such sequences are equally likely, and that is all
    there is to know: people, items and practice are drawn independently of each other. (A staircase's
    labels are balanced over all its trials of a person and item, shown or not.)

    An operator who watches can therefore learn in one way only, within one person's rounds of one item: where
    an assignment was seen through, the opposite one is likelier later. With six rounds, an operator shown the
    truth after every trial would guess 68 % of the assignments beforehand, the last for certain (Blackwell
    and Hodges 1957). Nobody is shown it. From answers that name one rendering in 77 % of the trials, as in
    the paper, 57 % are guessed beforehand and 63 % of the last ones, where chance is 50 %
    (packages/fdvv-people/tests/study/test_schedule.py computes all four); with two rounds it is 64 and 77 %.
    A person's answer
    reveals as much of its own trial, 77 %, and no draw helps against that; but it comes when nothing can be
    spoiled any more. Labels drawn independently would leave 50 % beforehand. The price: one person and item
    in 32 would have felt the same rendering behind A six times of six, and a person who likes A better would
    then count as preferring what it hid.

    In ABX, what X is and which label is right are two such sequences, independent of each other. Three and
    more stimuli (MUSHRA) are permuted independently in every trial: to see the hidden reference rated at the
    top reveals nothing about the next trial.
    """
    names = [item.name for item in plan.items]
    # orders are seen by all, and must not reveal the state that labels are drawn from
    orders = item_orders(plan, person_index, random.spawn(1)[0])
    drawn = {item.name: _assignments(plan, item, random) for item in plan.items}
    trials = _practice(plan, random)
    for round_, order in enumerate(orders):
        for item in order:
            block = drawn[names[item]][round_]
            trials += [StudyTrial(0, names[item], round_, labels, False, right) for labels, right in block]
    return tuple(msgspec.structs.replace(trial, number=i) for i, trial in enumerate(trials))


def item_orders(
    plan: StudyPlan, person_index: int, random: np.random.Generator | None = None
) -> tuple[tuple[int, ...], ...]:
    """Return the order of items in each round of a person, as indices into plan.items.

    The rows of Williams' design are dealt so that everything is balanced as early as can be: over any number
    of people, no row was used more than once more often than another; a person has all of them where there
    are rounds enough; and once there were as many people as rows, each round had each row. random : only
    for plans whose order is "random".
    """
    count = len(plan.items)
    if count == 1:
        return ((0,),) * plan.rounds
    if plan.order == "random":
        random = np.random.default_rng() if random is None else random
        return tuple(tuple(int(i) for i in random.permutation(count)) for _ in range(plan.rounds))
    rows = williams_orders(count)
    # after so many people the rows would come round in step with the rounds: one more is skipped
    repeat = len(rows) // math.gcd(plan.rounds, len(rows))
    begin = person_index * plan.rounds + person_index // repeat
    return tuple(rows[(begin + i) % len(rows)] for i in range(plan.rounds))


def _assignments(plan: StudyPlan, item: Item, random: np.random.Generator) -> list[list[Assignment]]:
    size = plan.block
    count = size * plan.rounds
    names = [stimulus.name for stimulus in item.stimuli]
    flat = task_of(plan.kind).draw(names, count, random)
    return [flat[i : i + size] for i in range(0, count, size)]


def _practice(plan: StudyPlan, random: np.random.Generator) -> list[StudyTrial]:
    found = []
    for i in range(plan.practice):
        item = plan.items[i % len(plan.items)]
        names = [stimulus.name for stimulus in item.stimuli]
        ((labels, right),) = task_of(plan.kind).draw(names, 1, random)
        ratio = plan.staircase.start_ratio if plan.staircase else 0.0
        change = practice_change(plan.thresholds, i) if plan.thresholds else ()
        found.append(StudyTrial(i, item.name, 0, labels, True, right, ratio, change))
    return found
