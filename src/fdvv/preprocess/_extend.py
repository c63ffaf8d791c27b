"""The part of a stroke beside the stop that no frame shows: between the stop and the nearest frame.

The path found between frames goes on by the equation that held there, as far as the force was sampled before
the stop took over. At 200 mm/s that is up to 0.8 mm of the stroke.
"""

from __future__ import annotations

import numpy as np

from fdvv.model import Stroke
from fdvv.preprocess._fuse import CurveOfForce, Path, Seen
from fdvv.units import FloatArray, N_from_cN

PARTS = 10
"""Steps of integration per sample of the force."""

DOUBT_s = 2.5e-4
"""A cap that moves is near the stop earlier: its place is known to what it covers in this time."""

LONGEST = 12
"""Samples that are added at most: beyond three frames of the slowest camera something else is wrong."""


def extend(
    seen: Seen,
    path: Path,
    stroke: Stroke,
    felt: tuple[FloatArray, FloatArray],
    shape: CurveOfForce,
    moving_g: float,
    stop_mm: float,
) -> Seen:
    """Add to a stroke the samples between its window and the stop, with a guess of the path there.

    felt : times and forces of the whole press, on the same grid as seen.t_s.
    stop_mm : samples that would lie deeper are the stop's.
    """
    t_s, force_cN = felt
    down = stroke is Stroke.PRESS
    here = int(np.argmin(np.abs(t_s - (seen.t_s[-1] if down else seen.t_s[0]))))
    edge = -1 if down else 0
    x, v = float(path.displacement_mm[edge]), float(path.velocity_mm_s[edge])
    way = 1 if down else -1
    step_s = way * (t_s[1] - t_s[0]) / PARTS
    places: list[float] = []
    i = here
    while 0 <= i + way < t_s.size and len(places) < LONGEST:
        for k in range(PARTS):
            pull_cN = force_cN[i] + (force_cN[i + way] - force_cN[i]) * (k + 0.5) / PARTS
            button_cN = float(shape(np.array([x]))[0][0])
            # mm/s2: newtons over grams are 1e6 mm/s2
            v += step_s * 1e6 * float(N_from_cN(pull_cN - button_cN)) / moving_g
            x += step_s * v
        # a cap that turns round, or is at the stop, is no longer in the stroke
        if x > stop_mm - DOUBT_s * abs(v) or v * (1 if down else -1) <= 0 or (places and x <= places[-1]):
            break
        i += way
        places.append(x)
    if not places:
        return seen
    low, high = min(here, i), max(here, i)
    added = slice(low + 1, high + 1) if down else slice(low, high)
    guess = np.array(places if down else places[::-1])
    return Seen(
        _join(seen.t_s, t_s[added], down),
        _join(seen.force_cN, force_cN[added], down),
        seen.frame_s,
        seen.frame_mm,
        _join(path.displacement_mm, guess, down),
    )


def _join(old: FloatArray, new: FloatArray, after: bool) -> FloatArray:
    return np.concatenate([old, new] if after else [new, old])
