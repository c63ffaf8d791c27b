"""How a simulated person likes a button: an ideal of their own, and an answer to every item. Simulated.

The model is Coombs' ideal point (1964): liking falls with the distance from what a person likes best. It has
draws of its own, so whoever presses is the same person whether or not they are asked.
docs/explanation/simulated-users.md says where its numbers come from.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fdvv.model.curve import Stroke
from fdvv.model.model import FDVVModel
from fdvv.units import FloatArray
from fdvv_people.task.questionnaire import HIGHEST, LOWEST

DRAW, RATE = 31, 32
"""Streams of random numbers that nothing else draws from."""
PRESSED_mm_s = 100.0
POINTS = 240
TOLERANCES = np.array([0.4, 0.6, 12.0])
"""How far from the ideal liking falls to exp(-1/2): of the log of force, mm of depth, cN of the bump."""
ITEM_NOISE, TRIAL_NOISE = 0.6, 0.3
"""Points, from item to item and from trial to trial: a tenth of the scale, as in simulated studies."""


@dataclass(frozen=True)
class Taste:
    """What one person likes.

    Attributes
    ----------
    force_cN : of the peak that a press has to overcome. depth_mm : at which the key goes down.
    bump_cN : by which the force falls. work_mJ : of a press, that is half as effortless as none.
    shift : points by which the person rates everything higher.
    """

    force_cN: float = 65.0
    depth_mm: float = 1.8
    bump_cN: float = 15.0
    work_mJ: float = 2.5
    shift: float = 0.0


SPREADS = {"force_cN": 0.25, "depth_mm": 0.4, "bump_cN": 10.0, "work_mJ": 0.3, "shift": 0.6}
"""Between people: of the logarithm for force and work, else in the unit of the name."""


def draw_taste(number: int, seed: int = 0) -> Taste:
    """Draw the taste of a person by the numbers of `draw_user`, two spreads either way at most."""
    random = np.random.default_rng([seed, number, DRAW])
    by = dict(zip(SPREADS, np.clip(random.standard_normal(len(SPREADS)), -2, 2).tolist(), strict=True))
    middle = Taste()
    return Taste(
        middle.force_cN * float(np.exp(SPREADS["force_cN"] * by["force_cN"])),
        middle.depth_mm + SPREADS["depth_mm"] * by["depth_mm"],
        max(0.0, middle.bump_cN + SPREADS["bump_cN"] * by["bump_cN"]),
        middle.work_mJ * float(np.exp(SPREADS["work_mJ"] * by["work_mJ"])),
        SPREADS["shift"] * by["shift"],
    )


def item_points(model: FDVVModel, taste: Taste) -> FloatArray:
    """Return what a person would answer to each item on average, (4,), before it is rounded.

    Comfort is nearness to the ideal in force, depth and bump. Accuracy needs the depth, and a bump that is
    not smaller than the ideal. Effort falls with the work of a press. Overall is the mean of the three.
    """
    x = np.linspace(0.0, model.travel_mm, POINTS)
    force_cN = model.force_cN(x, PRESSED_mm_s, Stroke.PRESS)
    depth_mm = model.travel_mm if model.actuation_mm is None else model.actuation_mm
    peak_cN = max(1.0, float(force_cN[x <= depth_mm].max()))
    bump_cN = float((np.maximum.accumulate(force_cN) - force_cN).max())
    work_mJ = 0.01 * float(np.trapezoid(force_cN, x))
    off = (
        np.array([np.log(peak_cN / taste.force_cN), depth_mm - taste.depth_mm, bump_cN - taste.bump_cN])
        / TOLERANCES
    )
    comfort = np.exp(-0.5 * np.mean(off**2))
    accuracy = np.exp(-0.5 * np.mean([off[1] ** 2, min(0.0, off[2]) ** 2]))
    effortless = 1.0 / (1.0 + (work_mJ / taste.work_mJ) ** 2)
    ratios = np.array([comfort, accuracy, effortless, np.mean([comfort, accuracy, effortless])])
    return np.asarray(LOWEST + (HIGHEST - LOWEST) * ratios + taste.shift)


def expected_liking(model: FDVVModel, taste: Taste) -> float:
    """Return the mean of `item_points`: what many answers come to but for the ends of the scale."""
    return float(item_points(model, taste).mean())


def felt_liking(model: FDVVModel, taste: Taste, random: np.random.Generator) -> float:
    """Return how much a person likes a button as they feel it once, points of the questionnaire's scale."""
    return expected_liking(model, taste) + TRIAL_NOISE * float(random.standard_normal())


def rate(model: FDVVModel, taste: Taste, seed: int) -> tuple[int, ...]:
    """Answer the items after a trial: same arguments, same answers."""
    random = np.random.default_rng([seed, RATE])
    points = item_points(model, taste)
    heard = points + TRIAL_NOISE * random.standard_normal() + ITEM_NOISE * random.standard_normal(points.size)
    return tuple(int(one) for one in np.clip(np.round(heard), LOWEST, HIGHEST))
