"""What a week does to a simulated person, and the design that nobody searched for."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Annotated

import numpy as np
from msgspec import Meta, Struct

from fdvv.errors import ModelError
from fdvv_people.optimize.people.user import SimulatedUser
from fdvv_people.optimize.space import DesignSpace

WEEK, DESIGN = 1, 2
"""What is drawn of a person, each from a stream of its own."""
TRIES = 1000  # of a space of which 1 % holds the constraints, so many draws miss all in 4 of 100,000 runs


class WeekGap(Struct, frozen=True, forbid_unknown_fields=True):
    """What a week between training and validation does to a simulated person; all of it is assumed.

    Attributes
    ----------
    kept_ratio : share of the presses made in training that still count as practice.
    bias_ms, anticipated_ms : spread of what another day shifts in the person's lateness and anticipation.
    clock_ratio, pace_ratio : spread of the logarithm of timing noise and pace from day to day.
    """

    kept_ratio: Annotated[float, Meta(ge=0, le=1)] = 0.5
    bias_ms: Annotated[float, Meta(ge=0, le=100)] = 5.0
    anticipated_ms: Annotated[float, Meta(ge=0, le=100)] = 5.0
    clock_ratio: Annotated[float, Meta(ge=0, le=1)] = 0.1
    pace_ratio: Annotated[float, Meta(ge=0, le=1)] = 0.1


def a_week_later(user: SimulatedUser, gap: WeekGap, practised: int, seed: int) -> SimulatedUser:
    """Return the same person on another day, with part of the practice forgotten and rested.

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
    """Draw the random design of a person, evenly within the space and its constraints. Raises ModelError."""
    random = np.random.default_rng([seed, person, DESIGN])
    for _ in range(TRIES):
        (design,) = space.of_unit(random.random(len(space.parameters)))
        if not space.broken(design):
            return design
    raise ModelError(f"none of {TRIES} random designs holds the constraints of the space {space.name}")
