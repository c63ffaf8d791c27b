"""The people of an experiment: who they are, how a week changes them, who meets what when. Simulated."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np

from fdvv.errors import ModelError
from fdvv.optimize import DesignSpace, SimulatedUser, draw_user
from fdvv.study import counterbalanced
from fdvv.workflow._experiment_setup import LEVELS, ExperimentSetup, WeekGap

WEEK, DESIGN = 1, 2
"""What else is drawn of a person, each from a stream of its own."""
TRIES = 1000


@dataclass(frozen=True)
class Block:
    """One round of one person at one level: every button once, in an order of its own.

    Attributes
    ----------
    person, round : from 0. first : place of its first score among all of this person, from 0.
    """

    person: int
    level: str
    round: int
    buttons: tuple[str, ...]
    first: int


def person_of(setup: ExperimentSetup, number: int) -> SimulatedUser:
    """Draw a person of the experiment; each is the same however many there are."""
    return draw_user(number, setup.seed)


def level_order(person: int) -> tuple[str, ...]:
    """Give the order in which a person meets the levels: every second one the other way round."""
    return LEVELS if person % 2 == 0 else LEVELS[::-1]


def blocks_of(setup: ExperimentSetup, person: int) -> tuple[Block, ...]:
    """Give a person's validation: level after level, round after round, buttons in Williams' orders.

    Orders run through all people's blocks in turn, so that over the experiment every button stands in every
    place, and follows every other, as equally often as the number of blocks allows.
    """
    each = len(LEVELS) * setup.rounds
    orders = counterbalanced(setup.buttons, each * setup.people)[each * person :]
    places = [(level, round_) for level in level_order(person) for round_ in range(setup.rounds)]
    return tuple(
        Block(person, level, round_, orders[i], i * len(setup.buttons))
        for i, (level, round_) in enumerate(places)
    )


def a_week_later(user: SimulatedUser, gap: WeekGap, practised: int, seed: int) -> SimulatedUser:
    """Give the same person on another day, with part of the practice forgotten and rested.

    practised : presses made in training. What of them is kept becomes the state of learning that the person
    comes with; fatigue is gone, adaptation begins anew, and timing, pace and bias are those of the day.
    """
    random = np.random.default_rng([seed, user.number, WEEK])
    bias, anticipated, clock, pace = np.clip(random.standard_normal(4), -2, 2).tolist()
    kept = math.exp(-gap.kept_ratio * practised / user.learning_presses)
    return replace(
        user,
        bias_ms=user.bias_ms + gap.bias_ms * bias,
        anticipated_ms=user.anticipated_ms + gap.anticipated_ms * anticipated,
        clock_ratio=user.clock_ratio * math.exp(gap.clock_ratio * clock),
        pace_mm_s=user.pace_mm_s * math.exp(gap.pace_ratio * pace),
        learning_ratio=user.learning_ratio * kept,
    )


def random_design(space: DesignSpace, seed: int, person: int) -> dict[str, float]:
    """Draw the random design of a person, evenly within the space and its constraints. ModelError."""
    random = np.random.default_rng([seed, person, DESIGN])
    for _ in range(TRIES):
        (design,) = space.of_unit(random.random(len(space.parameters)))
        if not space.broken(design):
            return design
    raise ModelError(f"none of {TRIES} random designs holds the constraints of the space {space.name}")
