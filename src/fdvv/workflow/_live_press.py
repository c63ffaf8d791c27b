"""A simulated rig that is pressed live: led from outside, moved on in stretches, told as columns."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from fdvv.core import Ask
from fdvv.device import FaultReport
from fdvv.errors import DeviceError
from fdvv.protocol import NONE, CN64_PER_cN, Fault, Mode, Refusal, UM16_PER_mm
from fdvv.twin import LedRig, LedTicks, NEAR_1_s
from fdvv.units import mm_from_m
from fdvv.workflow._live_event import Descent, LiveEvent, LiveEventKind, stretches
from fdvv.workflow._press_replay import LeadPath, path_of
from fdvv.workflow._press_subject import PressSubject
from fdvv.workflow._press_trace import PressTrace

PACE_mm_s = (5.0, 1000.0)
"""Speeds of a press that the next one may be announced with."""


class LivePress:
    """A button under a finger that is led while it is pressed. Simulated.

    Parameters
    ----------
    subject : what is pressed, on which rig.
    seed : of everything random; None: nothing is.

    Time passes in advance() only. Not to be used from two threads at once.
    """

    def __init__(self, subject: PressSubject, seed: int | None = 0) -> None:
        self.subject = subject
        self.rig = LedRig(subject.image, subject.rig, subject.finger, subject.settings, seed)
        self._tick_s = subject.rig.controller.tick_s
        self._latency_s = subject.rig.exciter.latency_s
        self._due_s = 0.0
        self._key, self._faulted = 0, False
        self._path: LeadPath | None = None
        self._descent = Descent()

    @property
    def time_s(self) -> float:
        """Simulated time since the beginning."""
        return self.rig.time_s

    @property
    def due_s(self) -> float:
        """Time that was let pass since the beginning; less than a tick of it is not simulated yet."""
        return self._due_s

    @property
    def replaying(self) -> bool:
        """Whether a trace leads the finger."""
        return self._path is not None

    def lead(self, referent_mm: float, velocity_mm_s: float = 0.0, near_1_s: float = NEAR_1_s) -> None:
        """Lead the finger's referent to a place (0: the cap at rest, positive into the button)."""
        self._path = None
        self.rig.lead(referent_mm, velocity_mm_s, near_1_s)

    def push(self, force_cN: float) -> None:
        """Lead the force that the finger's muscle pushes with."""
        self._path = None
        self.rig.push(force_cN)

    def lift(self) -> None:
        """Take the finger off."""
        self._path = None
        self.rig.lift()

    def replay(self, trace: PressTrace) -> None:
        """Lead the finger along a recorded or drawn trace, from now on, and lift it after."""
        self._path = path_of(trace, self.subject, self.time_s)

    def event(self, number: int) -> None:
        """Tell the program of a host event, 0 to 31."""
        self.rig.core.event(number)

    def advance(self, duration_s: float) -> tuple[LedTicks, tuple[LiveEvent, ...]]:
        """Let time pass: every tick's columns, and what happened in them.

        Parts of a tick wait for the next call. ModelError if the motion diverged.
        """
        self._due_s += duration_s
        ticks = max(0, int((self._due_s - self.time_s) / self._tick_s + 1e-6))
        pieces: list[LedTicks] = []
        while ticks or not pieces:
            count = self._lead_along(ticks)
            pieces.append(self.rig.advance(count))
            ticks -= count
        columns = LedTicks.joined(pieces)
        return columns, self._events(columns)

    def fault(self) -> FaultReport:
        """Tell the latched fault."""
        core = self.rig.core
        found = core.evidence
        return FaultReport(
            core.fault,
            found.value,
            found.bound,
            found.time_us * 1e-6,
            found.displacement_um16 / UM16_PER_mm,
            found.commanded_cN64 / CN64_PER_cN,
            int(core.fault is not Fault.NONE),
        )

    def fail(self, fault: Fault) -> None:
        """Have the firmware find a fault, as a board would outside its tick: to see what it does then."""
        self.rig.core.fail(fault)

    def clear_fault(self) -> None:
        """Clear the latched fault and arm again, the finger lifted; DeviceError while its cause lasts."""
        core = self.rig.core
        if core.fault is Fault.NONE:
            return
        refusal = core.ask(Ask.CLEAR, core.fault)
        if refusal is not Refusal.NONE:
            raise DeviceError(
                f"the fault {core.fault.name.lower()} cannot be cleared: its cause is still there"
            )
        self.lift()
        core.arm()
        self._faulted = False

    def _lead_along(self, ticks: int) -> int:
        """Lead by the trace that is replayed, if any; give how many ticks may pass before the next lead."""
        if self._path is None or not ticks:
            return ticks
        step = self._path.at(self.time_s)
        if step is None:
            self.lift()
            return ticks
        self.rig.lead(step.referent_mm, step.velocity_mm_s, step.near_1_s)
        return min(ticks, max(1, round(step.holds_s / self._tick_s)))

    def _events(self, columns: LedTicks) -> tuple[LiveEvent, ...]:
        found = [*self._keys(columns), *self._vibrations(columns), *self._presses(columns)]
        found += self._faults(columns)
        return tuple(sorted(found, key=lambda event: event.t_s))

    def _keys(self, columns: LedTicks) -> list[LiveEvent]:
        if not columns.key.size:
            return []
        before = np.concatenate([[self._key], columns.key[:-1]])
        self._key = int(columns.key[-1])
        return [
            _event(_change(int(before[i]), int(columns.key[i])), columns, i, int(columns.key[i]))
            for i in np.flatnonzero(columns.key != before).tolist()
        ]

    def _vibrations(self, columns: LedTicks) -> list[LiveEvent]:
        started = np.flatnonzero(columns.slot != NONE)
        events = [_event(LiveEventKind.VIBRATION, columns, int(i), int(columns.slot[i])) for i in started]
        return [replace(event, t_s=event.t_s + self._latency_s) for event in events]

    def _presses(self, columns: LedTicks) -> list[LiveEvent]:
        """Tell presses that ended; the next one is announced at their speed."""
        found = [self._descent.take(t, x) for t, x in stretches(columns, self._descent.begun)]
        ended = [event for event in found if event]
        for event in ended:
            self.rig.announce(float(np.clip(event.velocity_mm_s, *PACE_mm_s)))
        return ended

    def _faults(self, columns: LedTicks) -> list[LiveEvent]:
        fell = np.flatnonzero(columns.mode == Mode.FAULT)
        if self._faulted or not fell.size:
            return []
        self._faulted = True
        event = _event(LiveEventKind.FAULT, columns, int(fell[0]), int(self.rig.core.fault))
        return [replace(event, told=str(self.fault()))]

    @property
    def travel_limit_mm(self) -> float:
        """Deepest place of the rig's stop."""
        return float(mm_from_m(self.subject.rig.stops.travel_limit_m))


def _change(was: int, key: int) -> LiveEventKind:
    if was and key:
        return LiveEventKind.LEVEL
    return LiveEventKind.RESET if was else LiveEventKind.ACTUATION


def _event(kind: LiveEventKind, columns: LedTicks, i: int, number: int) -> LiveEvent:
    return LiveEvent(
        kind,
        float(columns.t_s[i]),
        float(columns.displacement_mm[i]),
        float(columns.velocity_mm_s[i]),
        number,
    )
