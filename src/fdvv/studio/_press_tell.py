"""From what a live press knows to what the page is told."""

from __future__ import annotations

from typing import Any

import numpy as np

from fdvv.program import Signal
from fdvv.studio import _messages_press as m
from fdvv.units import FloatArray
from fdvv.workflow import (
    PRESS_RIGS,
    LiveFrame,
    PressSubject,
    PressTrace,
    ProgramShelf,
    Shelf,
    button_choices,
    drawn_traces,
    program_choices,
)

ROW_s = 0.001
"""A page is shown a row so often."""
PICTURE_POINTS = 60
DIGITS = 4


def choices(shelf: Shelf, programs: ProgramShelf) -> m.PressList:
    """Tell what can be pressed."""
    return m.PressList(
        [m.PressItem(c.id, c.name, c.hint) for c in button_choices(shelf)],
        [m.PressItem(c.id, c.name, c.hint) for c in program_choices(programs)],
        [_trace(trace) for trace in drawn_traces()],
        list(PRESS_RIGS),
    )


def ready(subject: PressSubject) -> m.PressReady:
    """Tell what is under the finger."""
    return m.PressReady(
        subject.name,
        subject.told,
        subject.mode,
        subject.rig_name,
        subject.travel_mm,
        subject.actuation_mm,
        subject.reset_mm,
        [m.PressPlace(mark.label, mark.place_mm) for mark in subject.marks],
        list(subject.states),
        [shake_signal(signal) for signal in subject.signals],
        meant(subject, 0.0),
    )


def meant(subject: PressSubject, velocity_mm_s: float) -> m.PressMeant:
    """Tell what is meant to be felt in a press at a speed."""
    press, release = subject.meant_cN(velocity_mm_s)
    return m.PressMeant(
        velocity_mm_s, _column(subject.displacement_mm), _column(press, 2), _column(release, 2)
    )


def frame(seen: LiveFrame, replaying: bool) -> m.PressFrame:
    """Tell what happened since the last frame."""
    c = seen.columns
    rows = _rows(c.t_s)
    return m.PressFrame(
        t_s=_column(c.t_s[rows]),
        displacement_mm=_column(c.displacement_mm[rows]),
        force_cN=_column(c.force_cN[rows], 2),
        finger_mm=_column(c.finger_mm[rows]),
        velocity_mm_s=_last(c.velocity_mm_s),
        commanded_cN=_last(c.commanded_cN),
        state=int(_last(c.state)),
        key=int(_last(c.key)),
        mode=int(_last(c.mode)),
        saturated=bool(c.saturated.any()),
        warm_K=_last(c.warm_K),
        events=[
            m.PressHappened(e.kind, e.t_s, e.displacement_mm, e.velocity_mm_s, e.number, e.told)
            for e in seen.events
        ],
        sequence=seen.sequence,
        dropped_s=round(seen.dropped_s, DIGITS),
        busy_ratio=round(seen.busy_ratio, DIGITS),
        replaying=replaying,
    )


def _rows(t_s: FloatArray) -> Any:
    """Choose the first tick of every millisecond, and the last tick."""
    chosen = np.diff(np.floor(t_s / ROW_s + 1e-6), prepend=-1.0) > 0
    chosen[-1:] = True
    return chosen


def _column(values: FloatArray, digits: int = DIGITS) -> list[float]:
    return [float(value) for value in np.round(values, digits)]


def _last(values: Any) -> float:
    return round(float(values[-1]), DIGITS) if len(values) else 0.0


def shake_signal(signal: Signal) -> m.ShakeSignal:
    modes = [m.ShakeMode(o.frequency_Hz, o.amplitude_m_s2, o.decay_1_s, o.phase_rad) for o in signal.modes]
    return m.ShakeSignal(signal.name, signal.duration_s, modes)


def _trace(trace: PressTrace) -> m.TraceItem:
    every = max(1, trace.t_s.size // PICTURE_POINTS)
    thin = [_column(column[::every]) for column in (trace.t_s, trace.displacement_mm)]
    return m.TraceItem(trace.name, trace.told, trace.duration_s, *thin)
