"""Where a measured stroke begins and ends: first contact with the cap, and the stop."""

from __future__ import annotations

import numpy as np

from fdvv.model._curve import MeasuredCurve
from fdvv.units import FloatArray

CONTACT_cN = 2.0
"""Force that counts as touching: 2 gf is the convention of the published data sets, 20 times their noise."""

LOADED_cN = 10.0
"""Force that a stroke surely carries once the cap is held; the search for contact runs back from it."""

WINDOW_mm = 0.02
"""Length over which a slope is taken: four steps of the finest bench, a third of a contact step."""

STOP_EXCESS_cN_mm = 60.0
STOP_LEAST_cN_mm = 100.0
"""A slope this much above the stroke's own, and at least this steep, is the stop. Springs of switches
have 3 to 25 cN/mm; stops of measured switches 400 to 3000 cN/mm, of rubber domes above 150 cN/mm."""


def first_loaded(force_cN: FloatArray) -> int:
    """Find the first sample that carries the cap: 10 cN, or half of the greatest force if that is less."""
    return int(np.argmax(force_cN >= min(LOADED_cN, 0.5 * float(force_cN.max()))))


def find_contact_mm(curve: MeasuredCurve) -> float:
    """Find where the force leaves the air: the last displacement below 2 cN before the stroke is loaded.

    The air's own offset (the median before the load, at most the force of contact) does not count.
    A curve that begins loaded has its contact at its first sample.
    """
    x, force = curve.displacement_mm, curve.force_cN
    free = np.flatnonzero(force[: first_loaded(force)] < CONTACT_cN)
    return float(x[free[-1]]) if free.size else float(x[0])


def slope_cN_mm(x_mm: FloatArray, force_cN: FloatArray, window_mm: float = WINDOW_mm) -> FloatArray:
    """Give the mean slope from each strictly rising displacement over the next window, (n - 1,)."""
    ahead = np.searchsorted(x_mm, x_mm[:-1] + window_mm - 1e-9)
    ahead = np.clip(ahead, np.arange(1, x_mm.size), x_mm.size - 1)
    here = np.arange(x_mm.size - 1)
    return np.asarray((force_cN[ahead] - force_cN[here]) / (x_mm[ahead] - x_mm[here]))


def find_bottom_out_mm(curve: MeasuredCurve, contact_mm: float | None = None) -> float | None:
    """Find where the stop takes over: the start of the last steep rise; None if no stop was reached.

    Steep means a slope over 20 um that exceeds both 100 cN/mm and the stroke's own typical slope by
    60 cN/mm. The search runs from the deepest sample back, so that a click or a spike is not a stop.
    """
    start = find_contact_mm(curve) if contact_mm is None else contact_mm
    x, force, _ = curve.by_displacement()
    force, x = force[x >= start], x[x >= start]
    if x.size < 8:
        return None
    slope = slope_cN_mm(x, force)
    body = slope[(x[:-1] > start + 0.4 * (x[-1] - start)) & (x[:-1] < start + 0.85 * (x[-1] - start))]
    typical = float(np.median(body)) if body.size else 0.0
    steep = slope > max(STOP_LEAST_cN_mm, typical + STOP_EXCESS_cN_mm)
    # the last samples may waver as the stage turns: the stop is the last steep run in the final tenth
    late = np.flatnonzero(steep & (x[:-1] > start + 0.5 * (x[-1] - start)))
    if not late.size or x[-1] - x[late[-1]] > 0.1 * (x[-1] - start):
        return None
    first = int(late[-1])
    while first > 0 and steep[first - 1]:
        first -= 1
    return float(x[first])
