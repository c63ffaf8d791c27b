"""From the takes of a recording to presses on one clock."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from fdvv.errors import ModelError
from fdvv.preprocess.clock import ClockFit, align_clocks
from fdvv.preprocess.edges import Edges, find_edges
from fdvv.preprocess.fuse import even, undo_filter, undo_play
from fdvv.preprocess.press import GUARD_s, RawPress, excursions
from fdvv.recording.types import Bench, Quantity, Recording, Stage, Stream, Take
from fdvv.units import FloatArray


@dataclass(frozen=True, eq=False)
class Depth:
    """How deep the cap was seen, on the clock of the instrument that saw it.

    Attributes
    ----------
    t_s : (k,) starts of the exposures; frames in which nothing was seen are left out.
    depth_mm : (k,) along the press, zero not yet set.
    apart_mm : (k,) how far the markers are from each other along the press; NaN where one is missing, or
        is all there is.
    """

    t_s: FloatArray
    depth_mm: FloatArray
    apart_mm: FloatArray


def press_axis(takes: Sequence[Take]) -> FloatArray | None:
    """Find the direction in which the markers go when the cap is pressed, (3,); None for one-axis sensors.

    It is the first principal axis of all movement; its sign is that in which force and place rise together.
    """
    moved, loads = [], []
    for take in takes:
        for marker in take.of(Quantity.MARKER):
            if marker.raw.ndim != 2 or not np.isfinite(marker.values).any():
                continue
            place = marker.values - np.nanmedian(marker.values, axis=0)
            seen = np.isfinite(place).all(axis=1)
            moved.append(place[seen])
            force = _force_at(take, marker.t_s[seen])
            loads.append(force if force is not None else np.zeros(int(seen.sum())))
    if not moved:
        return None
    places, forces = np.concatenate(moved), np.concatenate(loads)
    if places.shape[0] < 3:
        raise ModelError("the markers were seen in fewer than 3 frames")
    far = np.linalg.norm(places, axis=1) >= np.quantile(np.linalg.norm(places, axis=1), 0.5)
    axis: FloatArray = np.linalg.svd(places[far] - places[far].mean(axis=0), full_matrices=False)[2][0]
    along = places @ axis
    rising = float(np.sum((along - along.mean()) * (forces - forces.mean())))
    return axis if rising >= 0 else -axis


def _force_at(take: Take, t_s: FloatArray) -> FloatArray | None:
    """Interpolate the force at times of another clock; both records begin together only roughly."""
    forces = take.of(Quantity.FORCE)
    if not forces or t_s.size < 2:
        return None
    force = forces[0]
    part = (t_s - t_s[0]) / (t_s[-1] - t_s[0])
    return np.asarray(np.interp(part, np.linspace(0, 1, force.t_s.size), force.values))


def depth_of(take: Take, axis: FloatArray | None) -> Depth | None:
    """Return the depth of the cap in a take; None if nothing measured it.

    A displacement sensor is taken as it is. Of two markers the middle counts: rocking moves them against each
    other. Where one is missing the other is led by what they were apart at that depth.
    """
    sensors = take.of(Quantity.DISPLACEMENT)
    if sensors:
        return _finite(sensors[0].t_s, sensors[0].values)
    markers = take.of(Quantity.MARKER)
    if not markers:
        return None
    if len(markers) > 2:
        raise ModelError(f"take {take.number} has {len(markers)} markers; name the one or two on the cap")
    times, columns = _together([_along(marker, axis) for marker in markers])
    return _finite(times, columns[0]) if len(columns) == 1 else _two(times, *columns)


def _along(marker: Stream, axis: FloatArray | None) -> tuple[FloatArray, FloatArray]:
    values = marker.values
    if values.ndim == 2:
        values = values @ (axis if axis is not None else np.array([0.0, 0.0, 1.0]))
    return marker.t_s, values


def _together(columns: Sequence[tuple[FloatArray, FloatArray]]) -> tuple[FloatArray, list[FloatArray]]:
    times = np.unique(np.concatenate([t for t, _ in columns]))
    joined = np.full((len(columns), times.size), np.nan)
    for row, (t, values) in zip(joined, columns, strict=True):
        row[np.searchsorted(times, t)] = values
    return times, list(joined)


def _finite(times: FloatArray, values: FloatArray) -> Depth:
    seen = np.isfinite(values)
    return Depth(times[seen], values[seen], np.full(int(seen.sum()), np.nan))


def _two(times: FloatArray, left: FloatArray, right: FloatArray) -> Depth:
    both = np.isfinite(left) & np.isfinite(right)
    if both.sum() < 3:
        return _finite(times, np.where(np.isfinite(left), left, right))
    half = 0.5 * (left - right)
    middle = 0.5 * (left + right)
    for marker, sign in ((left, -1.0), (right, 1.0)):
        alone = np.isfinite(marker) & ~both
        if alone.any():
            # how far apart they are goes with how deep the cap is: rocking
            slope, start = np.polyfit(marker[both], half[both], 1)
            middle[alone] = marker[alone] + sign * (start + slope * marker[alone])
    seen = np.isfinite(middle)
    return Depth(times[seen], middle[seen], 2 * half[seen])


LEAST_REST = 5
"""Fewer frames give no rest position."""
TAIL_s = 0.06
"""Kept of a record before and after a press."""


@dataclass(frozen=True, eq=False)
class Presses:
    """Every press of a recording, on the clock of the force.

    Attributes
    ----------
    presses : in the order they were made.
    clock : how the camera's clock runs against it; that of identity where one clock is all.
    zero_cN : what the force sensor reads of nothing, taken off already.
    lost : takes without a press, and why, one sentence each.
    """

    presses: tuple[RawPress, ...]
    clock: ClockFit
    zero_cN: float
    lost: tuple[str, ...] = ()


def presses_of(recording: Recording) -> Presses:
    """Find the presses of a recording: clocks joined, the force sensor's filter and play undone, rest at 0.

    Raises ModelError if there is no force, nothing that shows displacement, or no way to join two clocks.
    """
    pressed = [take for take in recording.takes if take.stage in (Stage.PRESS, Stage.UNKNOWN)]
    takes = [take for take in pressed if take.of(Quantity.FORCE)]
    if not takes:
        raise ModelError(f"recording {recording.name!r} has no take with presses and a force stream")
    clock = join_clocks(recording)
    axis = press_axis(takes)
    zero_cN = idle_cN(recording)
    by_take = {take.number: _of_take(take, recording.bench, clock, axis, zero_cN) for take in takes}
    lost = tuple(f"take {number}: no press was seen" for number, presses in by_take.items() if not presses)
    return Presses(tuple(press for presses in by_take.values() for press in presses), clock, zero_cN, lost)


def join_clocks(recording: Recording) -> ClockFit:
    """Fit the clock of the displacement to that of the force, by the light that both record."""
    pairs = [_clocks(take) for take in recording.takes if take.stage is not Stage.PROBE]
    known = {pair for pair in pairs if pair is not None}
    if not known:
        raise ModelError(f"recording {recording.name!r} has no stream that shows displacement")
    if len(known) > 1:
        clocks = ", ".join(sorted(f"{a} and {b}" for a, b in known))
        raise ModelError(f"recording {recording.name!r} changes its clocks: {clocks}")
    board, camera = known.pop()
    if board == camera:
        return ClockFit(0.0)
    edges, frame_s, light = light_edges(recording, board, camera)
    return align_clocks(edges, frame_s, light, 1e-3 * recording.bench.exposure_ms, camera)


def light_edges(recording: Recording, board: str, camera: str) -> tuple[Edges, FloatArray, FloatArray]:
    """Return when one clock switched the light, and times and brightness of the frames by the other."""
    lights = [s for take in recording.takes for s in take.of(Quantity.LIGHT) if s.clock == camera]
    if not lights:
        raise ModelError(f"nothing joins the clocks {board!r} and {camera!r}: no stream shows the light")
    edges = Edges.of(*(_mark_times(recording.takes, f"light {way}", board) for way in ("on", "off")))
    if not edges.t_s.size:
        raise ModelError(f"nothing joins the clocks {board!r} and {camera!r}: no mark tells of the light")
    times, first = np.unique(np.concatenate([s.t_s for s in lights]), return_index=True)
    return edges, times, np.concatenate([s.values for s in lights])[first]


def _clocks(take: Take) -> tuple[str, str] | None:
    forces, places = take.of(Quantity.FORCE), (*take.of(Quantity.DISPLACEMENT), *take.of(Quantity.MARKER))
    return (forces[0].clock, places[0].clock) if forces and places else None


def _mark_times(takes: Sequence[Take], name: str, clock: str) -> FloatArray:
    return np.unique([m.t_s for take in takes for m in take.marks if m.name == name and m.clock == clock])


def idle_cN(recording: Recording) -> float:
    """Return the median force with nothing touching the sensor; 0 if that was not recorded."""
    idle = [s.values for t in recording.takes if t.stage is Stage.REST for s in t.of(Quantity.FORCE)]
    return float(np.mean(np.concatenate(idle))) if idle else 0.0


def true_force_cN(stream: Stream, bench: Bench, zero_cN: float) -> tuple[FloatArray, FloatArray]:
    """Return even times and the force on the sensor, with zero, filter and play corrected."""
    step_s = float(np.median(np.diff(stream.t_s)))
    times, values = even(stream.t_s, stream.values - zero_cN, step_s)
    return times, undo_play(undo_filter(values, step_s, 1e-3 * bench.force_filter_ms), bench.force_play_cN)


def _of_take(
    take: Take, bench: Bench, clock: ClockFit, axis: FloatArray | None, zero_cN: float
) -> list[RawPress]:
    depth = depth_of(take, axis)
    if depth is None or depth.t_s.size < LEAST_REST:
        return []
    frame_s = clock.board_s(depth.t_s + 0.5e-3 * bench.exposure_ms)
    rough_mm = depth.depth_mm - np.quantile(depth.depth_mm, 0.15)
    spans = excursions(rough_mm)
    force = take.of(Quantity.FORCE)[0]
    t_s, force_cN = true_force_cN(force, bench, zero_cN)
    ends = [frame_s[0] - GUARD_s, *(frame_s[last] for _, last in spans)]
    begins = [*(frame_s[first] for first, _ in spans), frame_s[-1] + GUARD_s]
    closed, opened = take.times_s("closed"), take.times_s("open")
    presses = []
    for k, _ in enumerate(spans):
        rest_mm = _rest_mm(frame_s, depth, ends[k], begins[k], begins[0])
        low, high = ends[k] + GUARD_s, begins[k + 1] - GUARD_s
        seen = (frame_s >= low) & (frame_s <= high)
        in_window = (t_s >= low - TAIL_s) & (t_s <= high + TAIL_s)
        if in_window.sum() < LEAST_REST or seen.sum() < LEAST_REST:
            continue
        shut = closed[(closed >= low) & (closed <= high)]
        free = opened[(opened >= low) & (opened <= high)]
        presses.append(
            RawPress(
                take.number,
                k + 1,
                take.velocity_mm_s,
                t_s[in_window],
                force_cN[in_window],
                frame_s[seen],
                depth.depth_mm[seen] - rest_mm,
                depth.apart_mm[seen],
                float(shut[0]) if shut.size else None,
                float(free[-1]) if free.size else None,
            )
        )
    return presses


def _rest_mm(frame_s: FloatArray, depth: Depth, after_s: float, before_s: float, first_s: float) -> float:
    """Return the rest position before a press, else before the first, else of the shallowest frames."""
    for low, high in ((after_s + GUARD_s, before_s - 2 * GUARD_s), (frame_s[0], first_s - 2 * GUARD_s)):
        rest = depth.depth_mm[(frame_s >= low) & (frame_s <= high)]
        if rest.size >= LEAST_REST:
            return float(np.median(rest[-40:]))
    return float(np.quantile(depth.depth_mm, 0.1))


@dataclass(frozen=True, eq=False)
class EdgeBounds:
    """Edges of a light as a camera bounds them, less the fitted line.

    Attributes
    ----------
    board_s : (n,) when each was switched, on the board's clock.
    low_s, high_s : (n,) what the frames bound it by, on the camera's clock, less where the line puts it.
        An edge agrees with the line where low_s <= 0 <= high_s.
    """

    board_s: FloatArray
    low_s: FloatArray
    high_s: FloatArray


def edge_bounds(recording: Recording, clock: ClockFit) -> EdgeBounds | None:
    """Return the bounds of every edge that both clocks have; None where no light joined them.

    Each switching is paired with the nearest edge of its direction that was seen, as the line leads.
    """
    lights = [s.clock for take in recording.takes for s in take.of(Quantity.LIGHT)]
    marks = [m.clock for take in recording.takes for m in take.marks if m.name.startswith("light")]
    if not clock.edges or not lights or not marks:
        return None
    edges, frame_s, light = light_edges(recording, marks[0], lights[0])
    seen = find_edges(frame_s, light, 1e-3 * recording.bench.exposure_ms)
    columns = []
    for direction in (True, False):
        board_s = edges.t_s[edges.on == direction]
        there = np.flatnonzero(seen.on == direction)
        if not there.size or not board_s.size:
            continue
        line_s = clock.offset_s + clock.rate * board_s
        nearest = there[np.abs(seen.t_s[there][None, :] - line_s[:, None]).argmin(axis=1)]
        columns.append(np.stack([board_s, seen.low_s[nearest] - line_s, seen.high_s[nearest] - line_s]))
    table: FloatArray = np.concatenate(columns, axis=1).astype(np.float64)
    return EdgeBounds(*table[:, np.argsort(table[0])])
