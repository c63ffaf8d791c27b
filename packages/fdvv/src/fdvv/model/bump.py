"""The bump of a tactile curve: its peak, its valley and the drop between them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

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

STOP_EXCESS_cN_mm = 60.0  # over twice a spring's 25, under half of what the softest stop, 150, has above it

STOP_LEAST_cN_mm = 100.0
"""A slope this much above the stroke's own, and at least this steep, is the stop. Springs of switches
have 3 to 25 cN/mm; stops of measured switches 400 to 3000 cN/mm, of rubber domes above 150 cN/mm."""

STOP_GAPS_mm, STOP_RISE_cN, STOP_RISE_ratio = 0.12, 8.0, 0.1
"""Caps, probes and domes slip or settle inside the stop: what rises by 8 cN, and by a tenth of the force
there, before such gaps, no wider than 0.12 mm together, is the same stop. A smaller rise is texture."""

ISOLATED_mm = 0.06
"""What carries the cap lasts longer; a spike of a bench is gone within this."""


def first_loaded(x_mm: FloatArray, force_cN: FloatArray) -> int:
    """Find the first sample that carries the cap: 10 cN, or half of the greatest force if that is less.

    x_mm, force_cN : (n,), x not falling. A load that is gone within 60 um, or after one sample, is a spike,
    which carries nothing.
    """
    most = float(force_cN.max())
    # where the force only pulls, half of the greatest is above it
    starts, ends = bounds_of_runs(force_cN >= min(LOADED_cN, 0.5 * most, most))
    after = np.minimum(ends, x_mm.size - 1)
    wide = (ends == x_mm.size) | (x_mm[after] - x_mm[np.maximum(starts - 1, 0)] > ISOLATED_mm)
    single = (ends - starts == 1) & (force_cN[after] < CONTACT_cN)
    lasting = np.flatnonzero(wide & ~single)
    return int(starts[lasting[0] if lasting.size else 0])


def bounds_of_runs(mask: npt.NDArray[np.bool_]) -> tuple[npt.NDArray[np.intp], npt.NDArray[np.intp]]:
    """Return where each run of True begins, and where it has ended: the index after its last."""
    edges = np.flatnonzero(np.diff(np.concatenate(([False], mask, [False])).astype(np.int8)))
    return edges[::2], edges[1::2]


def find_contact_mm(curve: MeasuredCurve) -> float:
    """Find where the force leaves the air: the last displacement below 2 cN before the stroke is loaded.

    The air's own offset (the median before the load, at most the force of contact) does not count, nor does
    a single sample. A curve that begins loaded has its contact at its first sample.
    """
    x, force = curve.displacement_mm, curve.force_cN
    low = force[: first_loaded(x, force)] < CONTACT_cN
    # one low sample of a loaded stroke is no air
    free = np.flatnonzero(low & np.concatenate((low[:1], low[:-1])))
    return float(x[free[-1]]) if free.size else float(x[0])


def slope_cN_mm(x_mm: FloatArray, force_cN: FloatArray, window_mm: float = WINDOW_mm) -> FloatArray:
    """Return the mean slope from each strictly rising displacement over the next window, (n - 1,)."""
    # a sample one window ahead counts, whatever its last bit
    ahead = np.searchsorted(x_mm, x_mm[:-1] + window_mm - 1e-9)
    ahead = np.clip(ahead, np.arange(1, x_mm.size), x_mm.size - 1)
    here = np.arange(x_mm.size - 1)
    return np.asarray((force_cN[ahead] - force_cN[here]) / (x_mm[ahead] - x_mm[here]))


def find_bottom_out_mm(curve: MeasuredCurve, contact_mm: float | None = None) -> float | None:
    """Find where the stop takes over, the knee before the last steep rise; None if no stop was reached.

    Steep means a slope over 20 um that exceeds both 100 cN/mm and the stroke's own typical slope by
    60 cN/mm. The search runs from the deepest sample back, so that a click or a spike is not a stop, and
    over gaps in the stop, where the force slips or rests for up to 0.12 mm.
    """
    start = find_contact_mm(curve) if contact_mm is None else contact_mm
    x, force, _ = curve.by_displacement()
    force, x = force[x >= start], x[x >= start]
    if x.size < 8:
        return None
    slope = slope_cN_mm(x, force)
    length = x[-1] - start
    # the stroke's own slope is read where a bump is mostly over and no stop has begun
    body = slope[(x[:-1] > start + 0.4 * length) & (x[:-1] < start + 0.85 * length)]
    typical = float(np.median(body)) if body.size else 0.0
    steep = slope > max(STOP_LEAST_cN_mm, typical + STOP_EXCESS_cN_mm)
    # the last samples may waver as the stage turns: the stop is the last steep run in the final tenth
    late = np.flatnonzero(steep & (x[:-1] > start + 0.5 * length))
    if not late.size or x[-1] - x[late[-1]] > 0.1 * length:
        return None
    return float(x[_stop_start(x, force, *bounds_of_runs(steep))])


def _stop_start(
    x: FloatArray, force: FloatArray, starts: npt.NDArray[np.intp], ends: npt.NDArray[np.intp]
) -> int:
    """Return where the stop's first steep run begins: back from the last run, over its gaps."""
    first, bridged = int(starts[-1]), 0.0
    for begin, end in zip(starts[-2::-1], ends[-2::-1], strict=True):
        # the last steep slope reaches a window ahead
        gap = max(0.0, float(x[first] - x[end - 1]) - WINDOW_mm)
        if bridged + gap > STOP_GAPS_mm:
            break
        least_cN = max(STOP_RISE_cN, STOP_RISE_ratio * float(force[begin]))
        if force[begin : first + 1].max() - force[begin] >= least_cN:
            first, bridged = int(begin), bridged + gap
    return first
