"""Messages of the page on which a button is pressed; every figure of them is simulated."""

from __future__ import annotations

from typing import Annotated, Any

from msgspec import Meta, Struct

from fdvv.workflow import LiveEventKind, PressMode

Count = Annotated[int, Meta(ge=0, le=2**53)]
Number = Annotated[float, Meta(ge=-1e6, le=1e6)]


class PressListAsk(Struct, frozen=True, forbid_unknown_fields=True):
    """Ask what can be pressed."""


class PressItem(Struct, frozen=True, forbid_unknown_fields=True):
    """A button or a program: what the page asks for, what it shows, what to try."""

    id: str
    name: str
    hint: str


class TraceItem(Struct, frozen=True, forbid_unknown_fields=True):
    """A trace that can be replayed, thinned for a small picture."""

    name: str
    told: str
    duration_s: float
    t_s: list[float]
    displacement_mm: list[float]


class PressList(Struct, frozen=True, forbid_unknown_fields=True):
    """What can be pressed, replayed, and on which rigs."""

    buttons: list[PressItem]
    programs: list[PressItem]
    traces: list[TraceItem]
    rigs: list[str]


class TraceReadAsk(Struct, frozen=True, forbid_unknown_fields=True):
    """Read a file of a key's travel. name : of the file, for messages only."""

    name: Annotated[str, Meta(max_length=200)]
    text: Annotated[str, Meta(max_length=4_000_000)]


class TraceRead(Struct, frozen=True, forbid_unknown_fields=True):
    """A trace that was read, ready to be replayed."""

    name: str
    told: str
    t_s: list[float]
    displacement_mm: list[float]


class PressStart(Struct, frozen=True, forbid_unknown_fields=True, tag="start"):
    """Put something under the finger: one of button, program (ids), model or code (documents).

    seed : of everything random.
    """

    button: str | None = None
    program: str | None = None
    model: dict[str, Any] | None = None
    code: dict[str, Any] | None = None
    mode: PressMode = PressMode.INTENDED
    rig: str = "paper"
    seed: Count = 0


class PressLead(Struct, frozen=True, forbid_unknown_fields=True, tag="lead"):
    """Lead the finger to a place that moves at a speed.

    near_1_s : rate at which it nears that place, critically damped. sequence : told back by the first frame
    after it.
    """

    referent_mm: Number
    velocity_mm_s: Number
    sequence: Count
    near_1_s: Annotated[float, Meta(ge=1, le=1000)] = 125.0


class PressPush(Struct, frozen=True, forbid_unknown_fields=True, tag="push"):
    """Push with a force."""

    force_cN: Number
    sequence: Count


class PressLift(Struct, frozen=True, forbid_unknown_fields=True, tag="lift"):
    """Take the finger off."""

    sequence: Count


class PressReplay(Struct, frozen=True, forbid_unknown_fields=True, tag="replay"):
    """Lead the finger along a trace: a shipped one by its name, or the given columns."""

    name: Annotated[str, Meta(max_length=200)]
    t_s: list[float] | None = None
    displacement_mm: list[float] | None = None


class PressHostEvent(Struct, frozen=True, forbid_unknown_fields=True, tag="event"):
    """Tell the program of a host event."""

    number: Annotated[int, Meta(ge=0, le=31)]


class PressHere(Struct, frozen=True, forbid_unknown_fields=True, tag="here"):
    """Somebody looks at the page."""


class PressPause(Struct, frozen=True, forbid_unknown_fields=True, tag="pause"):
    """Nobody looks at the page."""


class PressStop(Struct, frozen=True, forbid_unknown_fields=True, tag="stop"):
    """Take everything away."""


class PressFail(Struct, frozen=True, forbid_unknown_fields=True, tag="fail"):
    """Have the firmware find its position sensor dead, to see what it does."""


class PressClear(Struct, frozen=True, forbid_unknown_fields=True, tag="clear"):
    """Clear the latched fault."""


class ShakeMode(Struct, frozen=True, forbid_unknown_fields=True):
    """One decaying sine of a signal."""

    frequency_Hz: float
    amplitude_m_s2: float
    decay_1_s: float
    phase_rad: float


class ShakeSignal(Struct, frozen=True, forbid_unknown_fields=True):
    """What the vibration board plays from one slot."""

    name: str
    duration_s: float
    modes: list[ShakeMode]


class PressPlace(Struct, frozen=True, forbid_unknown_fields=True):
    """A place in the stroke that a reader wants to see."""

    label: str
    place_mm: float


class PressMeant(Struct, frozen=True, forbid_unknown_fields=True, tag="meant"):
    """The force that is meant to be felt in a press at a speed."""

    velocity_mm_s: float
    displacement_mm: list[float]
    press_cN: list[float]
    release_cN: list[float]


class PressReady(Struct, frozen=True, forbid_unknown_fields=True, tag="ready"):
    """Something is under the finger. told : what is between the two."""

    name: str
    told: str
    mode: PressMode
    rig: str
    travel_mm: float
    actuation_mm: float | None
    reset_mm: float | None
    places: list[PressPlace]
    states: list[str]
    signals: list[ShakeSignal]
    meant: PressMeant


class PressHappened(Struct, frozen=True, forbid_unknown_fields=True):
    """An event: fields as fdvv.workflow.LiveEvent."""

    kind: LiveEventKind
    t_s: float
    displacement_mm: float
    velocity_mm_s: float
    number: int
    told: str


class PressFrame(Struct, frozen=True, forbid_unknown_fields=True, tag="frame"):
    """What happened since the last frame.

    Columns have a row a millisecond; velocity_mm_s, state, key, mode, warm_K are those of the last tick.
    sequence : of the last lead that had taken effect. dropped_s : not simulated, since the start.
    """

    t_s: list[float]
    displacement_mm: list[float]
    force_cN: list[float]
    finger_mm: list[float]
    velocity_mm_s: float
    commanded_cN: float
    state: int
    key: int
    mode: int
    saturated: bool
    warm_K: float
    events: list[PressHappened]
    sequence: int
    dropped_s: float
    busy_ratio: float
    replaying: bool


class PressRefused(Struct, frozen=True, forbid_unknown_fields=True, tag="refused"):
    """Something that was asked for could not be done; the rest goes on."""

    reason: str


class PressOver(Struct, frozen=True, forbid_unknown_fields=True, tag="over"):
    """Nothing is under the finger any more. reason : one line, empty if it was asked for."""

    reason: str
