"""How far the cap goes to its stop, the stop's own give taken off."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from fdvv.preprocess._reject import Judged
from fdvv.preprocess._strokes import NEAR_mm
from fdvv.units import FloatArray, N_from_cN

SOFTEST_mm_N = 0.1
"""A stop gives way by less; more is noise."""


def travels_mm(used: Sequence[Judged], zero_mm: float, arrival_cN: float) -> list[float]:
    """Tell for every press how deep the stop lies where it begins to bear.

    While the finger rests on the stop its force wanders, and the cap with it: from that, over all presses,
    comes how much the stop gives, and so where it was at the force with which the cap arrives.
    """
    rests = [_rest(one) for one in used]
    give_mm_N = _give_mm_N([rest for rest in rests if rest[0].size > 2])
    found = []
    for one, (force_cN, _) in zip(used, rests, strict=True):
        more_N = float(N_from_cN(float(np.median(force_cN)) - arrival_cN)) if force_cN.size else 0.0
        found.append(one.spans.bottom_mm + zero_mm - give_mm_N * max(more_N, 0.0))
    return found


def _rest(one: Judged) -> tuple[FloatArray, FloatArray]:
    """Give force and place of the frames in which the cap was on its stop."""
    press = one.press
    there = (press.frame_s >= one.spans.bottom_s) & (press.frame_s <= one.spans.leave_s)
    there &= press.frame_mm > one.spans.bottom_mm - NEAR_mm
    return np.interp(press.frame_s[there], press.t_s, press.force_cN), press.frame_mm[there]


def _give_mm_N(rests: Sequence[tuple[FloatArray, FloatArray]]) -> float:
    """Find the slope of place on force within presses: their zeros differ, their stop does not."""
    if not rests:
        return 0.0
    force_N = np.concatenate([N_from_cN(force - force.mean()) for force, _ in rests])
    place_mm = np.concatenate([place - place.mean() for _, place in rests])
    square = float(force_N @ force_N)
    return min(max(float(force_N @ place_mm) / square, 0.0), SOFTEST_mm_N) if square > 0 else 0.0
