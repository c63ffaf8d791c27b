"""From the takes of a recording to presses on one clock."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np

from fdvv.errors import ModelError
from fdvv.preprocess._clock import ClockFit, align_clocks
from fdvv.preprocess._edges import Edges
from fdvv.preprocess._force import even, undo_filter, undo_play
from fdvv.preprocess._markers import Depth, depth_of, press_axis
from fdvv.preprocess._press import GUARD_s, RawPress
from fdvv.preprocess._strokes import excursions
from fdvv.recording import Bench, Quantity, Recording, Stage, Stream, Take
from fdvv.units import FloatArray

LEAST_REST = 5
"""Fewer frames tell no place of rest."""

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
    lost: tuple[str, ...] = field(default_factory=tuple)


def presses_of(recording: Recording) -> Presses:
    """Find the presses of a recording: clocks joined, the force sensor's filter and play undone, rest at 0.

    Raises ModelError if there is no force, nothing that shows displacement, or no way to join two clocks.
    """
    takes = [t for t in recording.takes if t.stage in (Stage.PRESS, Stage.UNKNOWN)]
    takes = [t for t in takes if t.of(Quantity.FORCE)]
    if not takes:
        raise ModelError(f"recording {recording.name!r} has no take with presses and a force stream")
    clock = join_clocks(recording)
    axis = press_axis(takes)
    zero_cN = idle_cN(recording)
    found: list[RawPress] = []
    lost: list[str] = []
    for take in takes:
        here = _of_take(take, recording.bench, clock, axis, zero_cN)
        found += here
        if not here:
            lost.append(f"take {take.number}: no press was seen")
    return Presses(tuple(found), clock, zero_cN, tuple(lost))


def join_clocks(recording: Recording) -> ClockFit:
    """Find how the clock of the displacement runs against that of the force, by the light both know."""
    pairs = [_clocks(take) for take in recording.takes if take.stage is not Stage.PROBE]
    known = {pair for pair in pairs if pair is not None}
    if not known:
        raise ModelError(f"recording {recording.name!r} has no stream that shows displacement")
    if len(known) > 1:
        told = ", ".join(sorted(f"{a} and {b}" for a, b in known))
        raise ModelError(f"recording {recording.name!r} changes its clocks: {told}")
    board, camera = known.pop()
    if board == camera:
        return ClockFit(0.0)
    edges, frame_s, light = switched_light(recording, board, camera)
    return align_clocks(edges, frame_s, light, 1e-3 * recording.bench.exposure_ms, camera)


def switched_light(recording: Recording, board: str, camera: str) -> tuple[Edges, FloatArray, FloatArray]:
    """Give when the light was switched, by one clock, and times and brightness of frames, by the other."""
    lights = [s for take in recording.takes for s in take.of(Quantity.LIGHT) if s.clock == camera]
    if not lights:
        raise ModelError(f"nothing joins the clocks {board!r} and {camera!r}: no stream shows the light")
    edges = Edges.of(
        _marked(recording.takes, "light on", board), _marked(recording.takes, "light off", board)
    )
    if not edges.t_s.size:
        raise ModelError(f"nothing joins the clocks {board!r} and {camera!r}: no mark tells of the light")
    return edges, *_in_order(lights)


def _clocks(take: Take) -> tuple[str, str] | None:
    forces = take.of(Quantity.FORCE)
    places = (*take.of(Quantity.DISPLACEMENT), *take.of(Quantity.MARKER))
    return (forces[0].clock, places[0].clock) if forces and places else None


def _marked(takes: Sequence[Take], name: str, clock: str) -> FloatArray:
    return np.unique([m.t_s for take in takes for m in take.marks if m.name == name and m.clock == clock])


def _in_order(streams: Sequence[Stream]) -> tuple[FloatArray, FloatArray]:
    times = np.concatenate([s.t_s for s in streams])
    values = np.concatenate([s.values for s in streams])
    times, first = np.unique(times, return_index=True)
    return times, values[first]


def idle_cN(recording: Recording) -> float:
    """Give what the force sensor reads when nobody touches anything; 0 if that was not recorded."""
    idle = [s.values for t in recording.takes if t.stage is Stage.REST for s in t.of(Quantity.FORCE)]
    return float(np.mean(np.concatenate(idle))) if idle else 0.0


def true_force_cN(stream: Stream, bench: Bench, zero_cN: float) -> tuple[FloatArray, FloatArray]:
    """Give even times and the force that the sensor felt: zero, filter and play taken back."""
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
    found = excursions(rough_mm)
    force = take.of(Quantity.FORCE)[0]
    t_s, force_cN = true_force_cN(force, bench, zero_cN)
    ends = [frame_s[0] - GUARD_s, *(frame_s[last] for _, last in found)]
    begins = [*(frame_s[first] for first, _ in found), frame_s[-1] + GUARD_s]
    closed, opened = take.times_s("closed"), take.times_s("open")
    presses = []
    for k, _ in enumerate(found):
        rest_mm = _rest_mm(frame_s, depth, ends[k], begins[k], begins[0])
        low, high = ends[k] + GUARD_s, begins[k + 1] - GUARD_s
        seen = (frame_s >= low) & (frame_s <= high)
        felt = (t_s >= low - TAIL_s) & (t_s <= high + TAIL_s)
        if felt.sum() < LEAST_REST or seen.sum() < LEAST_REST:
            continue
        shut = closed[(closed >= low) & (closed <= high)]
        free = opened[(opened >= low) & (opened <= high)]
        presses.append(
            RawPress(
                take.number,
                k + 1,
                take.velocity_mm_s,
                t_s[felt],
                force_cN[felt],
                frame_s[seen],
                depth.depth_mm[seen] - rest_mm,
                depth.apart_mm[seen],
                float(shut[0]) if shut.size else None,
                float(free[-1]) if free.size else None,
            )
        )
    return presses


def _rest_mm(frame_s: FloatArray, depth: Depth, after_s: float, before_s: float, first_s: float) -> float:
    """Tell where the cap rested before a press, else before the first, else from the shallowest frames."""
    for low, high in ((after_s + GUARD_s, before_s - 2 * GUARD_s), (frame_s[0], first_s - 2 * GUARD_s)):
        rest = depth.depth_mm[(frame_s >= low) & (frame_s <= high)]
        if rest.size >= LEAST_REST:
            return float(np.median(rest[-40:]))
    return float(np.quantile(depth.depth_mm, 0.1))
