"""The slow probe of a button: force on displacement where nothing has mass, and the zero of displacement."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from fdvv.errors import ModelError
from fdvv.model.curve import Stroke
from fdvv.preprocess.fuse import CurveOfForce, table_curve, undo_play
from fdvv.preprocess.reject import Judged
from fdvv.recording.types import Quantity, Recording, Stage, Take
from fdvv.units import FloatArray

STEP_mm = 0.02
"""Samples of a probe are averaged over this: finer than the 50 um of presses, which rest on it."""
TOUCH_cN, FIRM_cN = 1.2, 15.0
"""The probe touches the cap where its force was last below the first on the way to the second."""
STOP_cN_mm = 400.0
"""Steeper than this over a bin, beyond half of the way, is the stop."""


@dataclass(frozen=True, eq=False)
class Probe:
    """The slow probes of a button, both strokes.

    Attributes
    ----------
    velocity_mm_s : of the probe; None if unknown.
    displacement_mm : (n,) even, from 0, the first touch, to the stop.
    press_cN, release_cN : (n,).
    spread_cN : (2, n) between probes, press and release; 0 for a single one.
    closed_mm, open_mm : where the circuit closed and opened, one per probe that recorded it.
    probes : how many.
    """

    velocity_mm_s: float | None
    displacement_mm: FloatArray
    press_cN: FloatArray
    release_cN: FloatArray
    spread_cN: FloatArray
    closed_mm: tuple[float, ...]
    open_mm: tuple[float, ...]
    probes: int

    def force_cN(self, stroke: Stroke) -> FloatArray:
        return self.press_cN if stroke is Stroke.PRESS else self.release_cN

    def curve(self, stroke: Stroke) -> CurveOfForce:
        return table_curve(self.displacement_mm, self.force_cN(stroke))

    def rest_mm(self, force_cN: float) -> float:
        """Return how deep the cap sinks under a resting finger of a given force."""
        steep = self.displacement_mm <= 0.3
        risen = np.maximum.accumulate(self.press_cN[steep])
        return float(np.interp(max(force_cN, 0.0), risen, self.displacement_mm[steep]))


@dataclass(frozen=True, eq=False)
class _Way:
    """One probe: bins of both strokes from the first touch on."""

    press_cN: FloatArray
    release_cN: FloatArray
    closed_mm: float | None
    open_mm: float | None


def probe_of(recording: Recording, zero_cN: float) -> Probe | None:
    """Average the slow probes of a recording; None if it has none. ModelError on one without press."""
    takes = [take for take in recording.takes if take.stage is Stage.PROBE]
    if not takes:
        return None
    ways = [_way(take, recording.bench.force_play_cN, zero_cN) for take in takes]
    size = min(way.press_cN.size for way in ways)
    press = np.array([way.press_cN[:size] for way in ways])
    release = np.array([way.release_cN[:size] for way in ways])
    spread: FloatArray = np.zeros((2, size))
    if len(ways) > 1:
        spread = np.std([press, release], axis=1, ddof=1)
    return Probe(
        takes[0].velocity_mm_s,
        STEP_mm * np.arange(float(size)),
        press.mean(axis=0),
        release.mean(axis=0),
        spread,
        tuple(way.closed_mm for way in ways if way.closed_mm is not None),
        tuple(way.open_mm for way in ways if way.open_mm is not None),
        len(ways),
    )


def _way(take: Take, play_cN: float, zero_cN: float) -> _Way:
    forces, places = take.of(Quantity.FORCE), take.of(Quantity.DISPLACEMENT)
    if not forces or not places or forces[0].clock != places[0].clock:
        raise ModelError(f"probe take {take.number} needs force and displacement on one clock")
    t_s, x_mm = forces[0].t_s, np.interp(forces[0].t_s, places[0].t_s, places[0].values)
    force_cN = undo_play(forces[0].values - zero_cN, play_cN)
    lowest = int(np.argmax(x_mm))
    if x_mm[lowest] - x_mm[0] < 10 * STEP_mm or lowest < 20:
        raise ModelError(f"probe take {take.number} holds no press")
    down = slice(0, lowest + 1)
    touch_mm = _touch_mm(x_mm[down], force_cN[down])
    x_mm = x_mm - touch_mm
    size = _stop(x_mm[down], force_cN[down])
    grid = STEP_mm * np.arange(float(size))
    back = slice(lowest, None)
    closed, opened = (
        float(np.interp(times[pick], t_s, x_mm)) if (times := take.times_s(name)).size else None
        for name, pick in (("closed", 0), ("open", -1))
    )
    press_cN, release_cN = (_bin_means(grid, x_mm[part], force_cN[part]) for part in (down, back))
    return _Way(press_cN, release_cN, closed, opened)


def _touch_mm(x_mm: FloatArray, force_cN: FloatArray) -> float:
    mean = np.convolve(force_cN, np.full(5, 0.2), mode="same")
    below = np.flatnonzero(mean[: int(np.argmax(mean > FIRM_cN))] < TOUCH_cN)
    return float(x_mm[below[-1] + 1]) if below.size else float(x_mm[0])


def _stop(x_mm: FloatArray, force_cN: FloatArray) -> int:
    whole = int(x_mm.max() / STEP_mm)
    force = _bin_means(STEP_mm * np.arange(whole + 1.0), x_mm, force_cN)
    steep = np.flatnonzero(np.diff(force)[whole // 2 :] > STOP_cN_mm * STEP_mm)
    return (int(steep[0]) + whole // 2 if steep.size else whole) + 1


def _bin_means(grid_mm: FloatArray, x_mm: FloatArray, force_cN: FloatArray) -> FloatArray:
    """Average samples within half a step of each position; empty bins are interpolated."""
    place = np.rint(x_mm / STEP_mm).astype(np.int64)
    inside = (place >= 0) & (place < grid_mm.size)
    count = np.bincount(place[inside], minlength=grid_mm.size)
    total = np.bincount(place[inside], force_cN[inside], minlength=grid_mm.size)
    known = count > 0
    return np.interp(grid_mm, grid_mm[known], total[known] / count[known])


FIRST_cN, FIRST_mm = 12.0, 0.4
"""The first give of the cap is read from so much force above the resting finger's, within this depth."""
FEWEST_SAMPLES = 30
"""Fewer samples of it are not used."""
SLOWEST_PART, FEWEST = 4, 3
"""Measured on the slowest quarter of the presses, or three."""


def resting_mm(judged: Sequence[Judged], probe: Probe | None) -> float:
    """Return the depth of the cap before presses began, under the resting finger.

    With a probe from its curve; without one from how the place goes with the first force of slow presses.
    """
    used = [entry for entry in judged if entry.reason is None]
    rests = [entry.press.force_cN[entry.press.t_s < entry.spans.rest_end_s] for entry in used]
    rest_cN = float(np.median([np.median(rest) for rest in rests if rest.size])) if rests else 0.0
    if probe is not None:
        return probe.rest_mm(rest_cN)
    slowest = sorted(used, key=lambda entry: entry.achieved_mm_s)[: max(FEWEST, len(used) // SLOWEST_PART)]
    return max(rest_cN, 0.0) * _first_give_mm_cN(slowest, rest_cN)


def _first_give_mm_cN(used: Sequence[Judged], rest_cN: float) -> float:
    """Return the initial compliance, by the slope of position on force, which is known far better."""
    parts = [np.zeros((2, 0))]
    for entry in used:
        press, spans = entry.press, entry.spans
        place = np.interp(press.t_s, press.frame_s, press.frame_mm)
        first = (press.t_s > spans.start_s - 0.1) & (press.t_s < spans.bottom_s) & (place < FIRST_mm)
        first &= (press.force_cN > rest_cN - 1) & (press.force_cN < rest_cN + FIRST_cN)
        parts.append(np.stack([place[first], press.force_cN[first]]))
    place, force = np.concatenate(parts, axis=1)
    if place.size < FEWEST_SAMPLES or np.ptp(force) < 0.5 * FIRST_cN:
        return 0.0
    return max(float(np.polyfit(force, place, 1)[0]), 0.0)
