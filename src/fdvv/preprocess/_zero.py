"""How deep a cap was before presses began, under the finger that rested on it."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from fdvv.preprocess._probe import Probe
from fdvv.preprocess._reject import Judged

FIRST_cN, FIRST_mm = 12.0, 0.4
"""The first give of the cap is read from so much force above the resting finger's, within this depth."""

FEWEST_SAMPLES = 30
"""Fewer samples of it tell nothing."""

SLOWEST_PART, FEWEST = 4, 3
"""The slowest fourth of the presses tells it, or three."""


def resting_mm(judged: Sequence[Judged], probe: Probe | None) -> float:
    """Tell how deep the cap was before presses began, under the finger that rested on it.

    With a probe from its curve; without one from how the place goes with the first force of slow presses.
    """
    used = [one for one in judged if one.reason is None]
    rests = [one.press.force_cN[one.press.t_s < one.spans.rested_s] for one in used]
    rest_cN = float(np.median([np.median(rest) for rest in rests if rest.size])) if rests else 0.0
    if probe is not None:
        return probe.rest_mm(rest_cN)
    slowest = sorted(used, key=lambda one: one.achieved_mm_s)[: max(FEWEST, len(used) // SLOWEST_PART)]
    return max(rest_cN, 0.0) * _first_give_mm_cN(slowest, rest_cN)


def _first_give_mm_cN(used: Sequence[Judged], rest_cN: float) -> float:
    """Tell by how much the cap gives way at first: the slope of place on force, which is known far better."""
    places, forces = [], []
    for one in used:
        press = one.press
        place = np.interp(press.t_s, press.frame_s, press.frame_mm)
        first = (press.t_s > one.spans.start_s - 0.1) & (press.t_s < one.spans.bottom_s) & (place < FIRST_mm)
        first &= (press.force_cN > rest_cN - 1) & (press.force_cN < rest_cN + FIRST_cN)
        places.append(place[first])
        forces.append(press.force_cN[first])
    place, force = np.concatenate([*places, np.zeros(0)]), np.concatenate([*forces, np.zeros(0)])
    if place.size < FEWEST_SAMPLES or np.ptp(force) < 0.5 * FIRST_cN:
        return 0.0
    return max(float(np.polyfit(force, place, 1)[0]), 0.0)
