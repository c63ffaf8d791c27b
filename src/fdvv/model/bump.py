"""The bump of a tactile curve: its peak, its valley and the drop between them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fdvv.model.curve import MeasuredCurve
from fdvv.units import FloatArray

LEAST_DROP_cN = 4.0
"""A smaller drop is friction, not a bump: stick and slip of measured linear switches drops up to 3 cN."""

RESOLUTION_mm = 0.05
"""Forces of peak and valley are means over this length, the paper's displacement bin: a single sample of
a stick-slip ripple is neither."""


@dataclass(frozen=True)
class Bump:
    """The largest fall of force with displacement.

    peak_mm, peak_cN : where the fall begins.
    valley_mm, valley_cN : where it ends.
    """

    peak_mm: float
    peak_cN: float
    valley_mm: float
    valley_cN: float

    @property
    def drop_cN(self) -> float:
        return self.peak_cN - self.valley_cN

    @property
    def snap_ratio(self) -> float:
        """Return (peak - valley) / peak, the click ratio of switch data sheets."""
        return self.drop_cN / self.peak_cN


def find_bump(x_mm: FloatArray, force_cN: FloatArray, least_drop_cN: float = LEAST_DROP_cN) -> Bump | None:
    """Find the largest fall of force along rising displacement; None if it is less than least_drop_cN.

    x_mm, force_cN : (n,), x strictly rising. Forces are taken as means over 50 um. The largest fall is the
    greatest difference between a running maximum and a later value, so that texture on the flanks does
    not cut a bump in two.
    """
    force_cN = running_mean(x_mm, force_cN, RESOLUTION_mm)
    highest = np.maximum.accumulate(force_cN)
    valley = int(np.argmax(highest - force_cN))
    peak = int(np.argmax(force_cN[: valley + 1]))
    bump = Bump(float(x_mm[peak]), float(force_cN[peak]), float(x_mm[valley]), float(force_cN[valley]))
    return bump if bump.drop_cN >= least_drop_cN else None


def running_mean(x_mm: FloatArray, force_cN: FloatArray, width_mm: float) -> FloatArray:
    """Average the polyline through (x_mm, force_cN) over width_mm around each point, less at the ends."""
    area = np.concatenate([[0.0], np.cumsum(0.5 * (force_cN[1:] + force_cN[:-1]) * np.diff(x_mm))])
    reach = np.minimum(0.5 * width_mm, np.minimum(x_mm - x_mm[0], x_mm[-1] - x_mm))
    inside = reach > 0
    low, high = x_mm[inside] - reach[inside], x_mm[inside] + reach[inside]
    mean = force_cN.astype(np.float64, copy=True)
    mean[inside] = (_area_at(high, x_mm, force_cN, area) - _area_at(low, x_mm, force_cN, area)) / (high - low)
    return mean


def _area_at(at: FloatArray, x: FloatArray, y: FloatArray, area: FloatArray) -> FloatArray:
    """Integrate the polyline from x[0] to each abscissa, exactly."""
    k = np.clip(np.searchsorted(x, at, side="right") - 1, 0, x.size - 2)
    part = at - x[k]
    slope = (y[k + 1] - y[k]) / (x[k + 1] - x[k])
    return np.asarray(area[k] + part * (y[k] + 0.5 * slope * part))


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
    """Return the mean slope from each strictly rising displacement over the next window, (n - 1,)."""
    # a sample one window ahead counts, whatever its last bit
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
    # the stroke's own slope is read where a bump is mostly over and no stop has begun
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
