"""What a finger tells of a press, and how well: the most salient event sets when the press is felt."""

from __future__ import annotations

import math
from dataclasses import dataclass
from enum import StrEnum

import numpy as np

from fdvv.model.curve import Stroke
from fdvv.model.model import FDVVModel
from fdvv.protocol.tables import NONE
from fdvv_people.optimize.people.press_simulator import PressTrace
from fdvv_people.optimize.people.user import SimulatedUser

FAINTEST = 0.05
"""Salience that no press falls below: a finger knows about its movement without any event."""


class Cue(StrEnum):
    """Kinds of tactile events: the fall of force at a snap, the blow at the stop, the vibration."""

    SNAP = "snap"
    IMPACT = "impact"
    VIBRATION = "vibration"


@dataclass(frozen=True)
class TactileEvent:
    """Something that a finger may feel in a press.

    Attributes
    ----------
    cue : its kind. time_s : when, on the clock of the press.
    strength : fall of force (cN), speed at the stop (mm/s) or acceleration (m/s²).
    """

    cue: Cue
    time_s: float
    strength: float


@dataclass(frozen=True)
class Percept:
    """When a press is felt, and with what spread (s)."""

    time_s: float
    spread_s: float


def salience(user: SimulatedUser, event: TactileEvent) -> float:
    """Return how much an event stands out, 1 at the strength that the person has for its kind."""
    units = {Cue.SNAP: user.snap_cN, Cue.IMPACT: user.impact_mm_s, Cue.VIBRATION: user.vibration_m_s2}
    return max(0.0, event.strength) / units[event.cue]


def percept_of(user: SimulatedUser, events: tuple[TactileEvent, ...], end_s: float) -> Percept:
    """Return what is felt: the most salient event, spread by percept_ms / sqrt(salience), or the end."""
    best = max(events, key=lambda event: salience(user, event), default=None)
    clear = salience(user, best) if best else 0.0
    time_s = best.time_s if best and clear > FAINTEST else end_s
    return Percept(time_s, 1e-3 * user.percept_ms / math.sqrt(max(clear, FAINTEST)))


SNAP_s = 0.015
"""A fall of force is felt as one event if it takes no longer (assumed)."""
SMOOTH_s = 0.003
EDGE_mm = 0.1
"""So near to the top and the stop a fall of force is no snap."""


def tactile_events(press: PressTrace, model: FDVVModel, latency_s: float) -> tuple[TactileEvent, ...]:
    """List what may be felt of a press on the way down; latency_s: of the vibration board."""
    found = (_snap(press, model), _impact(press, model), _vibration(press, model, latency_s))
    return tuple(event for event in found if event is not None)


def bottom_at(press: PressTrace, travel_mm: float) -> int | None:
    """Return the tick at which the cap first touches the stop; None if it never does."""
    deep = press.ticks.displacement_mm >= travel_mm
    return int(np.argmax(deep)) if deep.any() else None


def _snap(press: PressTrace, model: FDVVModel) -> TactileEvent | None:
    """Find the largest fall of the contact's force within SNAP_s, between the top and the stop."""
    ticks, t = press.ticks, press.t_s
    tick_s = float(t[1] - t[0])
    x = ticks.displacement_mm[: bottom_at(press, model.travel_mm - EDGE_mm)]
    start = int(np.argmax(x > EDGE_mm)) if (x > EDGE_mm).any() else x.size
    force, count = ticks.force_cN[start : x.size], max(1, round(SMOOTH_s / tick_s))
    if force.size >= count:
        force = np.convolve(force, np.full(count, 1 / count), mode="valid")
    span = min(round(SNAP_s / tick_s), force.size - 1)
    if span < 1:
        return None
    fall = force[:-span] - force[span:]
    at = int(np.argmax(fall))
    if fall[at] <= 0:
        return None
    return TactileEvent(Cue.SNAP, float(t[start + at + span // 2]), float(fall[at]))


def _impact(press: PressTrace, model: FDVVModel) -> TactileEvent | None:
    at = bottom_at(press, model.travel_mm)
    if at is None:
        return None
    # the tick before: at the stop the cap has lost its speed
    return TactileEvent(Cue.IMPACT, float(press.t_s[at]), float(press.ticks.velocity_mm_s[max(0, at - 1)]))


def _vibration(press: PressTrace, model: FDVVModel, latency_s: float) -> TactileEvent | None:
    """Take the vibration as the model means it, from where the core starts it."""
    started = np.flatnonzero(press.ticks.slot != NONE)
    vibration = model.vibration(Stroke.PRESS, 0.0)
    if not started.size or vibration is None:
        return None
    strength = sum(abs(mode.amplitude_m_s2) for mode in vibration.modes)
    return TactileEvent(Cue.VIBRATION, float(press.t_s[started[0]]) + latency_s, strength)
