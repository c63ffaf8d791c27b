"""How a program is felt: force at the finger against what the active state intends, in true displacement."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from fdvv.compensation.presses import FROM_mm, STOP_GUARD_mm, split_strokes
from fdvv.errors import ModelError
from fdvv.model.curve import Stroke
from fdvv.model.noticeable import LITERATURE, Jnds
from fdvv.program.program import Program, State, Velocity
from fdvv.program.surface import Surface
from fdvv.twin.trace import Trace
from fdvv.units import FloatArray

BIN_mm = 0.05
AWAY_mm = 0.3
"""A finger that is further than this above the cap does not touch it on purpose: nothing is judged."""
FREE_s, LANDING_s = 0.002, 0.01
"""A cap that was free for so long meets the finger with an impact: of two masses, not of the program. For so
long after it nothing is judged, but the largest force is reported."""

BoolArray = npt.NDArray[np.bool_]


@dataclass(frozen=True, eq=False)
class StateError:
    """What one stroke in one state left, over all presses at one speed.

    Attributes
    ----------
    errors_cN : |intended - rendered| of every visited bin of 0.05 mm, over all presses, (bins,).
    errors_JND : the same in just noticeable differences of the intended force, (bins,).
    impact_cN : largest force with which a cap that was free met the finger; 0 without such an impact.
    """

    state: str
    stroke: Stroke
    velocity_mm_s: float
    errors_cN: FloatArray
    errors_JND: FloatArray
    impact_cN: float = 0.0

    @property
    def bins(self) -> int:
        return int(self.errors_cN.size)

    @property
    def median_cN(self) -> float:
        return float(np.median(self.errors_cN)) if self.bins else 0.0

    @property
    def mean_cN(self) -> float:
        return float(self.errors_cN.mean()) if self.bins else 0.0

    @property
    def max_cN(self) -> float:
        return float(self.errors_cN.max(initial=0.0))

    def to_dict(self) -> dict[str, Any]:
        """Return the figures, without the errors of single bins."""
        names = ("state", "velocity_mm_s", "bins", "median_cN", "mean_cN", "max_cN", "impact_cN")
        return {"stroke": str(self.stroke), **{name: getattr(self, name) for name in names}}


def program_force_cN(program: Program, trace: Trace, velocity_mm_s: float, release: BoolArray) -> FloatArray:
    """Return the force that the program intends at the true displacement of every row, (n,).

    velocity_mm_s : asked for, which chooses the row of surfaces unless a state looks at every instant's.
    release : rows of the release, (n,). A pull is felt as no force: a finger cannot be pulled.
    """
    force_cN = np.zeros(trace.t_s.size)
    edges = [0, *(1 + np.flatnonzero(np.diff(trace.state.astype(int)))), trace.t_s.size]
    last_cN = 0.0
    for first, end in pairwise(edges):
        rows = slice(first, end)
        state = program.states[int(trace.state[first])]
        spent_ms = 1000.0 * (trace.t_s[rows] - trace.t_s[first])
        whole = _state_cN(program, state, trace, rows, velocity_mm_s, release) + _bias_cN(state, spent_ms)
        part = np.clip(spent_ms / state.fade_ms, 0.0, 1.0) if state.fade_ms and first else 1.0
        force_cN[rows] = last_cN + part * (whole - last_cN)
        last_cN = float(force_cN[end - 1])
    return np.maximum(force_cN, 0.0)


def _state_cN(
    program: Program, state: State, trace: Trace, rows: slice, velocity_mm_s: float, release: BoolArray
) -> FloatArray:
    x_mm = trace.displacement_mm[rows]
    fast = np.abs(trace.cap_velocity_mm_s[rows])
    speed = fast if state.velocity is Velocity.CONTINUOUS else np.full(x_mm.size, velocity_mm_s)
    press, release_cN = (
        _surface_cN(program.surface(name), x_mm, speed) for name in (state.press, state.release)
    )
    return np.where(release[rows], release_cN, press)


def _surface_cN(surface: Surface, x_mm: FloatArray, speed_mm_s: FloatArray) -> FloatArray:
    table = np.array([surface.row_cN(row, x_mm) for row in range(len(surface.velocity_mm_s))])
    at = np.interp(speed_mm_s, surface.velocity_mm_s, np.arange(len(table)))
    low = np.minimum(at.astype(int), max(0, len(table) - 2))
    high = np.minimum(low + 1, len(table) - 1)
    column = np.arange(x_mm.size)
    return np.asarray(table[low, column] + (at - low) * (table[high, column] - table[low, column]))


def _bias_cN(state: State, spent_ms: FloatArray) -> FloatArray:
    part = np.clip(spent_ms / state.bias_ms, 0.0, 1.0) if state.bias_ms else np.zeros(spent_ms.size)
    return state.bias_cN + part * (state.bias_end_cN - state.bias_cN)


def judge_states(
    program: Program, traces: Sequence[Trace], velocity_mm_s: float, jnds: Jnds = LITERATURE
) -> list[StateError]:
    """Return the errors of every state and stroke that the presses at one speed went through.

    Judged from 0.3 mm to 0.1 mm before the stop, between the guards of each stroke, as fdvv probe does;
    rows are averaged over bins of 0.05 mm. jnds : what a finger notices.
    """
    groups: dict[tuple[int, Stroke], list[_Errors]] = {}
    for trace in traces:
        for key, errors in _press_errors(program, trace, velocity_mm_s, jnds):
            groups.setdefault(key, []).append(errors)
    return [
        StateError(
            program.states[number].name,
            stroke,
            velocity_mm_s,
            np.concatenate([part.cN for part in parts]),
            np.concatenate([part.JND for part in parts]),
            max(part.impact_cN for part in parts),
        )
        for (number, stroke), parts in sorted(groups.items(), key=lambda item: (item[0][0], str(item[0][1])))
    ]


class _Errors(NamedTuple):
    """Of one press in one state and stroke: errors by bin, (bins,) each, and the largest impact."""

    cN: FloatArray
    JND: FloatArray
    impact_cN: float


def _press_errors(
    program: Program, trace: Trace, velocity_mm_s: float, jnds: Jnds
) -> list[tuple[tuple[int, Stroke], _Errors]]:
    x_mm = trace.displacement_mm
    spans = split_strokes(x_mm, program.travel_mm)
    release = np.arange(x_mm.size) >= spans[1].start
    intended = program_force_cN(program, trace, velocity_mm_s, release)
    free, landing = _flights(trace, intended)
    near = (trace.force_cN > 0) | (x_mm - trace.finger_mm < AWAY_mm)
    judged = near & ~free & ~landing & (x_mm >= FROM_mm) & (x_mm <= program.travel_mm - STOP_GUARD_mm)
    rows = []
    for stroke, span in zip(Stroke, spans, strict=True):
        inside = np.zeros(x_mm.size, dtype=np.bool_)
        inside[span] = True
        for number in np.unique(trace.state[span]):
            here = inside & (trace.state == number)
            places = x_mm[here & judged]
            off_cN = np.abs(_bin_means(places, (trace.force_cN - intended)[here & judged]))
            jnd_cN = jnds.force_cN(_bin_means(places, intended[here & judged]))
            impact_cN = float(trace.force_cN[here & landing].max(initial=0.0))
            rows.append(((int(number), stroke), _Errors(off_cN, off_cN / jnd_cN, impact_cN)))
    return rows


def _flights(trace: Trace, intended: FloatArray) -> tuple[BoolArray, BoolArray]:
    """Return rows in which the cap is free because the program pulled it away, and those of its landing.

    A cap that is free although the program pushes is an error of rendering, and is judged.
    """
    free, landing = np.zeros((2, trace.t_s.size), dtype=np.bool_)
    step_s = float(trace.t_s[1] - trace.t_s[0])
    changes = np.flatnonzero(np.diff(np.hstack([False, trace.force_cN <= 0, False]).astype(int)))
    for first, end in zip(changes[::2], changes[1::2], strict=True):
        if (end - first) * step_s >= FREE_s and intended[first] <= 0:
            free[first:end] = True
            landing[end : end + round(LANDING_s / step_s)] = True
    return free, landing & ~free


def _bin_means(x_mm: FloatArray, off_cN: FloatArray) -> FloatArray:
    if not x_mm.size:
        return x_mm
    at = np.floor(x_mm / BIN_mm).astype(int)
    at -= at.min()
    count = np.bincount(at)
    return np.asarray((np.bincount(at, off_cN) / np.maximum(count, 1))[count > 0])


def all_errors_cN(states: Sequence[StateError]) -> FloatArray:
    """Return the errors of all bins of all states. ModelError if nothing was judged."""
    errors = np.concatenate([[], *(state.errors_cN for state in states)])
    if not errors.size:
        raise ModelError("no press touched the cap where it is judged")
    return errors
