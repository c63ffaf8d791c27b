"""The press page: a button under the mouse, on a simulated rig in real time."""

from __future__ import annotations

from typing import Annotated, Any

import msgspec
import numpy as np
from msgspec import Meta, field

from fdvv.errors import InputError, ModelError
from fdvv.model.file import model_from_json
from fdvv.program.file import program_from_json
from fdvv.protocol.tables import Fault
from fdvv_studio.live.press import LiveEventKind, LivePress
from fdvv_studio.live.press_subject import (
    PRESS_RIGS,
    PressChoice,
    PressMode,
    PressSubject,
    button_choices,
    model_subject,
    program_choices,
    program_subject,
    trace_by_name,
)
from fdvv_studio.live.press_trace import PressTrace, read_press_trace, synthetic_traces
from fdvv_studio.live.run import LiveFrame, LiveRun
from fdvv_studio.studio.api.press_frames import (
    DIGITS,
    PressFrame,
    PressMeant,
    PressReady,
    press_frame,
    press_ready,
    target_force,
)
from fdvv_studio.studio.contract import ChannelKind, Empty, Here, Message, Over, Tell, call
from fdvv_studio.studio.rounding import round_row
from fdvv_studio.studio.studio import Studio

Count = Annotated[int, Meta(ge=0, le=2**53)]
Number = Annotated[float, Meta(ge=-1e6, le=1e6)]
Depth = Annotated[float, Meta(ge=-10, le=20)]
Speed = Annotated[float, Meta(ge=-1e4, le=1e4)]
"""Of a key of a keyboard, mm/s."""


FORCE_SPEEDS_mm_s = (0.0, 12.0, 25.0, 50.0, 75.0, 100.0, 150.0, 200.0, 300.0, 400.0)
"""At which forces are listed; dense where models change."""


class PressForcesAsk(Message):
    """What is pressed: one of button, program (ids), model or code (documents)."""

    button: str | None = None
    program: str | None = None
    model: dict[str, Any] | None = None
    code: dict[str, Any] | None = None


class PressForces(Message):
    """The target forces over displacement, at speeds from slow to fast."""

    speeds: list[PressMeant]


class TraceRead(Message):
    """A trace that was read, ready to be replayed."""

    name: str
    about: str = field(name="told")
    t_s: tuple[float, ...]
    displacement_mm: tuple[float, ...]


class TraceItem(TraceRead):
    """A shipped trace, thinned for a small picture."""

    duration_s: float


class PressList(Message):
    """What can be pressed, replayed, and on which rigs."""

    buttons: list[PressChoice]
    programs: list[PressChoice]
    traces: list[TraceItem]
    rigs: list[str]


class TraceReadAsk(Message):
    """Read a file of a key's travel. name : of the file, for messages only."""

    name: Annotated[str, Meta(max_length=200)]
    text: Annotated[str, Meta(max_length=4_000_000)]


class PressStart(Message, tag="start"):
    """Put something under the finger: one of button, program (ids), model or code (documents).

    seed : of everything random.
    """

    button: str | None = None
    program: str | None = None
    model: dict[str, Any] | None = None
    code: dict[str, Any] | None = None
    mode: PressMode = PressMode.INTENDED
    rig: str = PRESS_RIGS[0]
    seed: Count = 0


class PressLead(Message, tag="lead"):
    """Lead the finger to a place that moves at a speed.

    near_1_s : rate at which it nears that place, critically damped. sequence : repeated in the first frame
    after it.
    """

    referent_mm: Number
    velocity_mm_s: Number
    sequence: Count
    near_1_s: Annotated[float, Meta(ge=1, le=1000)] = 125.0


class PressFollow(Message, tag="follow"):
    """Lead the finger so that the cap goes where a key of the person's keyboard is, and as fast.

    displacement_mm : 0 at rest, positive down. sequence : as of lead.
    """

    displacement_mm: Depth
    velocity_mm_s: Speed
    sequence: Count


class PressPush(Message, tag="push"):
    """Push with a force."""

    force_cN: Number
    sequence: Count


class PressLift(Message, tag="lift"):
    """Take the finger off."""

    sequence: Count


class PressReplay(Message, tag="replay"):
    """Lead the finger along a trace: a shipped one by its name, or the given columns."""

    name: Annotated[str, Meta(max_length=200)]
    t_s: list[float] | None = None
    displacement_mm: list[float] | None = None


class PressHostEvent(Message, tag="event"):
    """Send the program a host event."""

    number: Annotated[int, Meta(ge=0, le=31)]


class PressPause(Message, tag="pause"):
    """The page is hidden."""


class PressStop(Message, tag="stop"):
    """Take everything away."""


class PressFail(Message, tag="fail"):
    """Have the firmware find its position sensor dead, to see what it does."""


class PressClear(Message, tag="clear"):
    """Clear the latched fault."""


class PressRefused(Message, tag="refused"):
    """A request could not be done; the press continues."""

    reason: str


PICTURE_POINTS = 60  # or up to twice as many: the page draws them 84 pixels wide (Replay.svelte)


def _trace_item(trace: PressTrace) -> TraceItem:
    every = max(1, trace.t_s.size // PICTURE_POINTS)
    t_s, displacement_mm = (round_row(c[::every], DIGITS) for c in (trace.t_s, trace.displacement_mm))
    return TraceItem(trace.name, trace.origin, t_s, displacement_mm, trace.duration_s)


@call("press.list")
def list_choices(studio: Studio, _ask: Empty) -> PressList:
    return PressList(
        list(button_choices(studio.catalog)),
        list(program_choices(studio.programs)),
        [_trace_item(trace) for trace in synthetic_traces()],
        list(PRESS_RIGS),
    )


@call("press.forces")
def list_forces(studio: Studio, ask: PressForcesAsk) -> PressForces:
    subject = subject_of(studio, PressStart(ask.button, ask.program, ask.model, ask.code))
    return PressForces([target_force(subject, speed) for speed in FORCE_SPEEDS_mm_s])


@call("press.trace")
def read_trace(_studio: Studio, ask: TraceReadAsk) -> TraceRead:
    trace = read_press_trace(ask.text.encode(), ask.name)
    return TraceRead(
        trace.name, trace.origin, tuple(trace.t_s.tolist()), tuple(trace.displacement_mm.tolist())
    )


def subject_of(studio: Studio, ask: PressStart) -> PressSubject:
    """Make ready what is asked for. Raises InputError."""
    given = [thing for thing in (ask.button, ask.program, ask.model, ask.code) if thing is not None]
    if len(given) != 1:
        raise InputError("press", "start", f"{len(given)} things to press were named", "name one")
    if ask.button is not None:
        return model_subject(studio.catalog.model(ask.button), ask.mode, ask.rig)
    if ask.model is not None:
        return model_subject(model_from_json(msgspec.json.encode(ask.model), "model"), ask.mode, ask.rig)
    if ask.program is not None:
        return program_subject(studio.programs.program(ask.program), ask.mode, ask.rig)
    return program_subject(program_from_json(msgspec.json.encode(ask.code), "program"), ask.mode, ask.rig)


class PressChannel:
    """What serves one page: nothing, or a run."""

    def __init__(self, studio: Studio, tell: Tell) -> None:
        self._studio, self._tell = studio, tell
        self._run: LiveRun | None = None

    def receive(self, ask: Message) -> None:
        """Do what the page asks; without a run most asks have come too late and do nothing."""
        match ask:
            case PressStart():
                self._start(ask)
            case PressStop():
                self.close()
                self._tell(Over(""))
            case _ if self._run:
                _lead(self._run, ask)

    def close(self) -> None:
        if self._run:
            self._run.close()
        self._run = None

    def _start(self, ask: PressStart) -> None:
        self.close()
        subject = subject_of(self._studio, ask)
        press = LivePress(subject, ask.seed)
        self._tell(press_ready(subject))
        self._run = LiveRun(
            press,
            lambda seen: self._show(press, seen),
            lambda line: self._tell(PressRefused(line)),
            lambda line: self._tell(Over(line)),
        )

    def _show(self, press: LivePress, seen: LiveFrame) -> None:
        """Send a frame, and after a press the intended force at its speed."""
        self._tell(press_frame(seen, press.replaying))
        for event in seen.events:
            if event.kind is LiveEventKind.PRESSED:
                self._tell(target_force(press.subject, round(event.velocity_mm_s, 1)))


def _lead(run: LiveRun, ask: Message) -> None:
    """Pass on what the page asks of a run."""
    match ask:
        case PressLead():
            run.ask(lambda press: press.lead(ask.referent_mm, ask.velocity_mm_s, ask.near_1_s), ask.sequence)
        case PressFollow():
            run.ask(lambda press: press.follow(ask.displacement_mm, ask.velocity_mm_s), ask.sequence)
        case PressPush():
            run.ask(lambda press: press.push(ask.force_cN), ask.sequence)
        case PressLift():
            run.ask(LivePress.lift, ask.sequence)
        case PressReplay():
            trace = _trace_of(ask)
            run.ask(lambda press: press.replay(trace))
        case PressHostEvent():
            run.ask(lambda press: press.event(ask.number))
        case PressFail():
            run.ask(lambda press: press.fail(Fault.POSITION_STUCK))
        case PressClear():
            run.ask(LivePress.clear_fault)
        case Here():
            run.here()
        case PressPause():
            run.pause()


def _trace_of(ask: PressReplay) -> PressTrace:
    if ask.t_s is None or ask.displacement_mm is None:
        return trace_by_name(ask.name)
    try:
        return PressTrace(ask.name, "", np.array(ask.t_s), np.array(ask.displacement_mm))
    except ModelError as error:
        raise InputError("trace", ask.name, str(error), "choose another") from error


ASKS = (
    *(PressStart, PressLead, PressFollow, PressPush, PressLift, PressReplay, PressHostEvent),
    *(Here, PressPause, PressStop, PressFail, PressClear),
)
TELLS = (PressReady, PressMeant, PressFrame, PressRefused, Over)
CHANNEL = ChannelKind("press", ASKS, TELLS, PressChannel)
