"""A simulated rig under a finger that is controlled from outside, in steps, with columns of every tick."""

from __future__ import annotations

from bisect import bisect_right
from collections import deque
from collections.abc import Iterator
from enum import StrEnum
from operator import attrgetter
from threading import Lock

import numpy as np
from msgspec import Struct, field
from msgspec.structs import replace

from fdvv.device.contract import FaultReport, FREE_CELL_cN
from fdvv.errors import DeviceError
from fdvv.firmware.core import CoreRequest
from fdvv.force_text import force_text
from fdvv.protocol.messages import CN64_PER_cN, UM16_PER_mm
from fdvv.protocol.tables import NONE, Fault, LoopFault, Mode, Refusal
from fdvv.twin.interactive import InteractiveRig, InteractiveTicks
from fdvv.twin.plant import NEAR_1_s
from fdvv.units import FloatArray
from fdvv_studio.live.press_replay import DisplacementPath, KeyFollower, path_of
from fdvv_studio.live.press_subject import PressSubject
from fdvv_studio.live.press_trace import PressTrace

TOP_mm, DEEP_mm = 0.1, 0.3
"""A press begins where the cap passes the first; it counts once it was deeper than the second."""
STEP_mm = 0.02
DOWN_RATIO = 0.9
"""Of its depth: there a press counts as down; what follows may be a finger that holds."""


class LiveEventKind(StrEnum):
    """What a live press reports besides its columns.

    actuation, reset : the key went down, came up. level : it changed from one level to another.
    vibration : a signal starts at the cap. pressed : a press is over. fault : the firmware fell to no force.
    loop : the firmware opened its force loop by itself; it stays open, which is said again after each press,
        until LivePress.check_cell().
    """

    ACTUATION = "actuation"
    RESET = "reset"
    LEVEL = "level"
    VIBRATION = "vibration"
    PRESSED = "pressed"
    FAULT = "fault"
    LOOP = "loop"


class LiveEvent(Struct, frozen=True):
    """Something that happened at one moment, simulated.

    Attributes
    ----------
    kind : what. t_s : when; of a vibration, when it starts at the cap, the board's latency included.
    displacement_mm : of the cap then; of a press, how deep it went.
    velocity_mm_s : of the cap, positive downward; of a press, its mean speed from 0.1 mm to nine tenths of
        its depth.
    number : key level, or slot of the vibration's signal. message : the reason of a fault or an open loop.
    """

    kind: LiveEventKind
    t_s: float
    displacement_mm: float
    velocity_mm_s: float
    number: int
    message: str = field(name="told")


class Descent:
    """The descent of the current press: the first time at every depth."""

    def __init__(self) -> None:
        self._t_s: list[float] = []
        self._x_mm: list[float] = []

    def __bool__(self) -> bool:
        """Whether the cap is down."""
        return bool(self._t_s)

    def take(self, t_s: FloatArray, x_mm: FloatArray) -> LiveEvent | None:
        """Add samples on one side of TOP_mm; return the press that they ended, if any."""
        if x_mm[0] <= TOP_mm:
            return self._over(float(t_s[0]))
        steps = np.floor(x_mm / STEP_mm)
        deepest = np.floor(self._x_mm[-1] / STEP_mm) if self._x_mm else -1.0
        deeper = steps > np.maximum.accumulate(np.append(deepest, steps[:-1]))
        self._t_s += t_s[deeper].tolist()
        self._x_mm += x_mm[deeper].tolist()
        return None

    def _over(self, now_s: float) -> LiveEvent | None:
        t, x = np.array(self._t_s), np.array(self._x_mm)
        self._t_s, self._x_mm = [], []
        if not x.size or x[-1] < DEEP_mm:
            return None
        down = int(np.argmax(x >= DOWN_RATIO * x[-1]))
        # a cap that is down within a tick moved at the highest measurable speed
        speed = float((x[down] - x[0]) / max(t[down] - t[0], 1e-4))
        return LiveEvent(LiveEventKind.PRESSED, now_s, float(x[-1]), speed, 0, "")


def stretches(columns: InteractiveTicks, was_down: bool) -> Iterator[tuple[FloatArray, FloatArray]]:
    """Yield time and displacement of the cap, split where it passes TOP_mm; was_down : its state before."""
    deep = columns.displacement_mm > TOP_mm
    before = np.concatenate([[was_down], deep[:-1]])
    for piece in np.split(np.arange(deep.size), np.flatnonzero(deep != before)):
        if piece.size:
            yield columns.t_s[piece], columns.displacement_mm[piece]


PACE_mm_s = (5.0, 1000.0)
"""Speeds of a press that the next one may be announced with."""
STILL_s = 0.02
"""A key of which nothing more is said moves on for so long."""
HEARD_s = 0.01
"""Presses that ended are looked for this often, however time is cut; the next is announced at their speed."""


class LivePress:
    """A button under a finger that is led while it is pressed. Simulated.

    Parameters
    ----------
    subject : what is pressed, on which rig.
    seed : of everything random; None: nothing is.

    Attributes
    ----------
    due_s : time requested since the beginning; less than a tick of it is not simulated yet.

    Time passes in advance() only. Not to be used from two threads at once.
    """

    def __init__(self, subject: PressSubject, seed: int | None = 0) -> None:
        self.subject = subject
        runs = subject.image, subject.rig, subject.finger, subject.settings
        self.rig = InteractiveRig(*runs, seed, subject.loop)
        self._tick_s = subject.rig.controller.tick_s
        self._latency_s = subject.rig.exciter.latency_s
        self.due_s = 0.0
        self._key, self._faulted, self._opened = 0, False, False
        self._path: DisplacementPath | None = None
        self._follower: KeyFollower | None = None
        self._still_s: float | None = None
        self._still_mm = 0.0
        self._descent = Descent()

    @property
    def time_s(self) -> float:
        return self.rig.time_s

    @property
    def replaying(self) -> bool:
        return self._path is not None

    def lead(self, referent_mm: float, velocity_mm_s: float = 0.0, near_1_s: float = NEAR_1_s) -> None:
        """Lead the finger's referent to a place (0: the cap at rest, positive into the button)."""
        self._path = self._still_s = None
        self.rig.lead(referent_mm, velocity_mm_s, near_1_s)

    def push(self, force_cN: float) -> None:
        """Lead the force that the finger's muscle pushes with."""
        self._path = self._still_s = None
        self.rig.push(force_cN)

    def lift(self) -> None:
        self._path = self._still_s = None
        self.rig.lift()

    def follow(self, displacement_mm: float, velocity_mm_s: float) -> None:
        """Lead the finger so that the cap goes where a key elsewhere is now: 0 at rest, positive down.

        The finger knows the button's slow force and presses as much harder as it gives way under it. It
        stops where the key was last, STILL_s after that was said.
        """
        self._path = None
        self._follower = self._follower or KeyFollower(self.subject)
        step = self._follower.step(displacement_mm, velocity_mm_s)
        self.rig.lead(step.referent_mm, step.velocity_mm_s, step.near_1_s)
        self._still_s, self._still_mm = self.time_s + STILL_s, step.referent_mm

    def replay(self, trace: PressTrace) -> None:
        """Lead the finger along a recorded or drawn trace, from now on, and lift it after."""
        self._still_s = None
        self._path = path_of(trace, self.subject, self.time_s)

    def event(self, number: int) -> None:
        """Send a host event, 0 to 31, to the program."""
        self.rig.core.event(number)

    def advance(self, duration_s: float) -> tuple[InteractiveTicks, tuple[LiveEvent, ...]]:
        """Let time pass: every tick's columns, and what happened in them.

        Parts of a tick wait for the next call. ModelError if the motion diverged.
        """
        self.due_s += duration_s
        # the small number: sums of floats may end just below a whole tick
        ticks = max(0, int((self.due_s - self.time_s) / self._tick_s + 1e-6))
        pieces: list[InteractiveTicks] = []
        events: list[LiveEvent] = []
        while ticks or not pieces:  # a piece without a tick has columns as well
            count = self._until_heard(self._lead_along(ticks))
            pieces.append(self.rig.advance(count))
            events += self._events(pieces[-1])
            ticks -= count
        return InteractiveTicks.concatenate(pieces), tuple(events)

    def _until_heard(self, ticks: int) -> int:
        """Return how many of the ticks may pass before presses that ended are looked for, as by a clock."""
        every = max(1, round(HEARD_s / self._tick_s))
        return min(ticks, every - round(self.time_s / self._tick_s) % every)

    def fault(self) -> FaultReport:
        core = self.rig.core
        evidence = core.evidence
        return FaultReport(
            core.fault,
            evidence.value,
            evidence.bound,
            evidence.time_us * 1e-6,
            evidence.displacement_um16 / UM16_PER_mm,
            evidence.commanded_cN64 / CN64_PER_cN,
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
        refusal = core.ask(CoreRequest.CLEAR, core.fault)
        if refusal is not Refusal.NONE:
            name = core.fault.name.lower()
            raise DeviceError(f"the fault {name} cannot be cleared: its cause is still there")
        self.lift()
        self.rig.arm()
        self._faulted = False

    def check_cell(self) -> None:
        """Close the loop again that a fault of the cell opened, the finger lifted before.

        DeviceError if the cell of the free cap reads a force. One that passes and is broken opens the loop
        again in the next press.
        """
        if self.rig.loop_fault is LoopFault.SOUND:
            return
        if abs(reads_cN := self.rig.cell_cN) > FREE_CELL_cN:
            raise DeviceError(
                f"the load cell reads {force_text(reads_cN, '.1f')}; lift the finger, and if nothing touches "
                "the cap, "
                "mend or zero the cell"
            )
        self.rig.close_loop()
        self._opened = False

    def _lead_along(self, ticks: int) -> int:
        """Lead by the trace that is replayed, if any; return how many ticks may pass before the next lead."""
        if self._still_s is not None:
            return self._lead_still(ticks, self._still_s)
        if self._path is None or not ticks:
            return ticks
        step = self._path.at(self.time_s)
        if step is None:
            self.lift()
            return ticks
        self.rig.lead(step.referent_mm, step.velocity_mm_s, step.near_1_s)
        return min(ticks, max(1, round(step.holds_s / self._tick_s)))

    def _lead_still(self, ticks: int, still_s: float) -> int:
        """Stop where a key was last once nothing more is said of it; return how many ticks may pass."""
        rest = round((still_s - self.time_s) / self._tick_s)
        if rest > 0:
            return min(ticks, rest)
        self.rig.lead(self._still_mm, 0.0, NEAR_1_s)
        self._still_s = None
        return ticks

    def _events(self, columns: InteractiveTicks) -> tuple[LiveEvent, ...]:
        kinds = (self._keys, self._vibrations, self._loop, self._presses, self._faults)
        return tuple(sorted((event for of in kinds for event in of(columns)), key=attrgetter("t_s")))

    def _keys(self, columns: InteractiveTicks) -> list[LiveEvent]:
        if not columns.key.size:
            return []
        before = np.concatenate([[self._key], columns.key[:-1]])
        self._key = int(columns.key[-1])
        return [
            _event(_change(int(before[i]), int(columns.key[i])), columns, i, int(columns.key[i]))
            for i in np.flatnonzero(columns.key != before).tolist()
        ]

    def _vibrations(self, columns: InteractiveTicks) -> list[LiveEvent]:
        started = np.flatnonzero(columns.slot != NONE)
        events = [_event(LiveEventKind.VIBRATION, columns, int(i), int(columns.slot[i])) for i in started]
        return [replace(event, t_s=event.t_s + self._latency_s) for event in events]

    def _presses(self, columns: InteractiveTicks) -> list[LiveEvent]:
        """Return presses that ended; the next one is announced at their speed."""
        descents = [self._descent.take(t, x) for t, x in stretches(columns, bool(self._descent))]
        ended = [event for event in descents if event]
        for event in ended:
            self.rig.announce(float(np.clip(event.velocity_mm_s, *PACE_mm_s)))
        if ended:
            self._opened = False  # a loop that is still open is reported again
        return ended

    def _loop(self, columns: InteractiveTicks) -> list[LiveEvent]:
        fault = self.rig.loop_fault
        if self._opened or fault is LoopFault.SOUND or not columns.t_s.size:
            return []
        self._opened = True
        reason = fault.name.lower().replace("_", " ")
        event = _event(LiveEventKind.LOOP, columns, -1, int(fault))
        return [
            replace(
                event,
                message=f"the force loop opened, {reason}: tables render until the load cell is checked",
            )
        ]

    def _faults(self, columns: InteractiveTicks) -> list[LiveEvent]:
        fell = np.flatnonzero(columns.mode == Mode.FAULT)
        if self._faulted or not fell.size:
            return []
        self._faulted = True
        event = _event(LiveEventKind.FAULT, columns, int(fell[0]), int(self.rig.core.fault))
        return [replace(event, message=str(self.fault()))]


def _change(was: int, key: int) -> LiveEventKind:
    if was and key:
        return LiveEventKind.LEVEL
    return LiveEventKind.RESET if was else LiveEventKind.ACTUATION


def _event(kind: LiveEventKind, columns: InteractiveTicks, i: int, number: int) -> LiveEvent:
    c = columns
    where = float(c.displacement_mm[i]), float(c.velocity_mm_s[i])
    return LiveEvent(kind, float(c.t_s[i]), *where, number, "")


KEPT = 200
"""Of leads and activations; a round has a handful."""


class PressTimes:
    """Maps key activations to the clock of the input device, free of the latency to the simulation.

    A lead takes effect some milliseconds after the hand did it: network, waiting, steps of the run. What the
    button does from there on lasts as long in the simulation as it would in the hand. So an activation is as
    long after the hand as, in simulated time, after the lead that caused it: the way in between is taken out
    exactly, and no clock of the server is in it. Any thread may call.
    """

    def __init__(self) -> None:
        self._leads = deque[tuple[float, float]](maxlen=KEPT)
        self._activations_s = deque[float](maxlen=KEPT)
        self._lock = Lock()

    def note_lead(self, simulated_s: float, hand_s: float) -> None:
        """Note that a press of the hand at hand_s takes effect at a simulated time, later than the last."""
        with self._lock:
            self._leads.append((simulated_s, hand_s))

    def note_activation(self, simulated_s: float) -> None:
        """Note that the key went down; one that no lead came before is nobody's press."""
        with self._lock:
            at = bisect_right(self._leads, simulated_s, key=lambda lead: lead[0]) - 1
            if at >= 0:
                led_s, hand_s = self._leads[at]
                self._activations_s.append(hand_s + simulated_s - led_s)

    def note_press(self, hand_s: float) -> None:
        """Note that the hand's own key went down at a time of its clock."""
        with self._lock:
            self._activations_s.append(hand_s)

    def between(self, start_s: float, end_s: float) -> tuple[float, ...]:
        """Return the activations from start to end on the hand's clock, rising."""
        with self._lock:
            return tuple(sorted(at for at in self._activations_s if start_s <= at <= end_s))
