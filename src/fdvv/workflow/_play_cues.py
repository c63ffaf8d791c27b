"""What a finger may feel in a press on the twin: the snap, the blow at the stop, the vibration. Simulated."""

from __future__ import annotations

import numpy as np

from fdvv.model import FDVVModel, Stroke
from fdvv.optimize import Cue, TactileEvent
from fdvv.protocol import NONE
from fdvv.units import FloatArray
from fdvv.workflow._play_bench import PlayedPress

SNAP_s = 0.015
"""A fall of force is felt as one event if it takes no longer (assumed)."""
SMOOTH_s = 0.003
EDGE_mm = 0.1
"""So near to the top and the stop a fall of force is no snap."""


def tactile_events(press: PlayedPress, model: FDVVModel, latency_s: float) -> tuple[TactileEvent, ...]:
    """List what may be felt of a press on the way down; latency_s: of the vibration board."""
    found = (_snap(press, model), _impact(press, model), _vibration(press, model, latency_s))
    return tuple(event for event in found if event is not None)


def bottom_at(press: PlayedPress, travel_mm: float) -> int | None:
    """Give the tick at which the cap first touches the stop; None if it never does."""
    deep = press.ticks.displacement_mm >= travel_mm
    return int(np.argmax(deep)) if deep.any() else None


def _snap(press: PlayedPress, model: FDVVModel) -> TactileEvent | None:
    """Find the largest fall of the contact's force within SNAP_s, between the top and the stop."""
    ticks, t = press.ticks, press.t_s
    tick_s = float(t[1] - t[0])
    x = ticks.displacement_mm[: bottom_at(press, model.travel_mm - EDGE_mm)]
    start = int(np.argmax(x > EDGE_mm)) if (x > EDGE_mm).any() else x.size
    force = _smooth(ticks.force_cN[start : x.size], max(1, round(SMOOTH_s / tick_s)))
    span = min(round(SNAP_s / tick_s), force.size - 1)
    if span < 1:
        return None
    fall = force[:-span] - force[span:]
    at = int(np.argmax(fall))
    if fall[at] <= 0:
        return None
    return TactileEvent(Cue.SNAP, float(t[start + at + span // 2]), float(fall[at]))


def _smooth(force_cN: FloatArray, count: int) -> FloatArray:
    if force_cN.size < count:
        return force_cN
    return np.convolve(force_cN, np.full(count, 1 / count), mode="valid")


def _impact(press: PlayedPress, model: FDVVModel) -> TactileEvent | None:
    at = bottom_at(press, model.travel_mm)
    if at is None:
        return None
    return TactileEvent(Cue.IMPACT, float(press.t_s[at]), float(press.ticks.velocity_mm_s[max(0, at - 1)]))


def _vibration(press: PlayedPress, model: FDVVModel, latency_s: float) -> TactileEvent | None:
    """Take the vibration as the model means it, from where the core starts it."""
    started = np.flatnonzero(press.ticks.slot != NONE)
    vibration = model.vibration(Stroke.PRESS, 0.0)
    if not started.size or vibration is None:
        return None
    strength = sum(abs(mode.amplitude_m_s2) for mode in vibration.modes)
    return TactileEvent(Cue.VIBRATION, float(press.t_s[started[0]]) + latency_s, strength)
