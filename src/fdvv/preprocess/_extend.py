"""The parts of a stroke that no frame shows: between a stop, or rest, and the nearest frame.

The path found between frames goes on by the equation that held there, as far as the force was sampled before
the stop took over. At 200 mm/s that is up to 0.8 mm of the stroke.
"""

from __future__ import annotations

import numpy as np

from fdvv.preprocess._fuse import CurveOfForce, Path, Seen
from fdvv.units import FloatArray, N_from_cN

PARTS = 10
"""Steps of integration per sample of the force."""

DOUBT_s = 2.5e-4
"""A cap that moves is near an end earlier: its place is known to what it covers in this time."""

JUMP_cN = 10.0
"""Where the force changes within a sample by so much more than the button's could, the stop has been hit."""

LONGEST = 12
"""Samples that are added at most: beyond three frames of the slowest camera something else is wrong."""


def extend(
    seen: Seen,
    path: Path,
    forward: bool,
    felt: tuple[FloatArray, FloatArray],
    shape: CurveOfForce,
    moving_g: float,
    ends_mm: tuple[float, float],
) -> Seen:
    """Add samples after a stroke's window, or before it, with a guess of the path there.

    forward : after it.
    felt : times and forces of the whole press, on the same grid as seen.t_s.
    ends_mm : between these depths the stroke lies; samples beyond belong to rest or stop.
    """
    t_s, force_cN = felt
    edge, way = (-1, 1) if forward else (0, -1)
    here = int(np.argmin(np.abs(t_s - seen.t_s[edge])))
    x, v = float(path.displacement_mm[edge]), float(path.velocity_mm_s[edge])
    down, step_s = v > 0, way * (t_s[1] - t_s[0]) / PARTS
    places: list[float] = []
    i = here
    while 0 <= i + way < t_s.size and len(places) < LONGEST:
        before_cN = float(shape(np.array([x]))[0][0])
        for k in range(PARTS):
            pull_cN = force_cN[i] + (force_cN[i + way] - force_cN[i]) * (k + 0.5) / PARTS
            button_cN = float(shape(np.array([x]))[0][0])
            # newtons over grams are 1e6 mm/s2
            v += step_s * 1e6 * float(N_from_cN(pull_cN - button_cN)) / moving_g
            x += step_s * v
        margin_mm = DOUBT_s * abs(v)
        # a cap that turns round, or that something other than the button holds up, is no longer in the stroke
        if not ends_mm[0] + margin_mm <= x <= ends_mm[1] - margin_mm or (v > 0) != down:
            break
        told_cN = abs(button_cN - before_cN)
        if abs(force_cN[i + way] - force_cN[i]) > JUMP_cN + 2 * told_cN:
            break
        i += way
        places.append(x)
    if not places:
        return seen
    added = slice(here + 1, i + 1) if forward else slice(i, here)
    guess = np.array(places if forward else places[::-1])
    return Seen(
        _join(seen.t_s, t_s[added], forward),
        _join(seen.force_cN, force_cN[added], forward),
        seen.frame_s,
        seen.frame_mm,
        _join(path.displacement_mm, guess, forward),
    )


def _join(old: FloatArray, new: FloatArray, after: bool) -> FloatArray:
    return np.concatenate([old, new] if after else [new, old])
