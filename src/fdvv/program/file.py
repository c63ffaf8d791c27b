"""The ``*.fdvv-program.json`` file: versioned plain JSON with a published schema.

Only what differs from its default is written, in one order, numbers with the shortest digits that read back
to the same bits, a list of plain values to a line.
"""

from __future__ import annotations

import json
from collections.abc import Iterable
from pathlib import Path
from typing import Annotated, Any, Literal, get_args

import msgspec
from msgspec import Meta

from fdvv.errors import InputError, ModelError
from fdvv.io.documents import Kind, pretty, read_document, tidy_schema
from fdvv.io.files import read_limited, write_atomic
from fdvv.model.vibration import Mode
from fdvv.program.condition import BARE, Condition, Transition, When
from fdvv.program.program import During, Program, Signal, State, Velocity, VibrationEvent
from fdvv.program.surface import Surface

FORMAT = "fdvv-program"
VERSION = 1
"""Of the program file."""
Name = Annotated[str, Meta(min_length=1, max_length=40)]
Reference = Annotated[Name | None, Meta(description="a name, or null")]
ConditionName = Literal[
    "always",
    "deeper_than_mm",
    "shallower_than_mm",
    "turned_to_press",
    "turned_to_release",
    "faster_than_mm_s",
    "slower_than_mm_s",
    "after_ms",
    "host_event",
    "risen_by_mm",
    "fallen_by_mm",
]
ConditionRecord = Annotated[
    dict[ConditionName, float | Literal[True]],
    Meta(
        min_length=1,
        max_length=1,
        description="one condition and its value; true for always, turned_to_press and turned_to_release",
        extra_json_schema={"propertyNames": {"enum": list(get_args(ConditionName))}},
    ),
]
PROGRAM_SUFFIX = ".fdvv-program.json"
"""How a program file's name ends."""
LIMIT_bytes = 16_000_000
"""Far above any program (an image holds 7 kB), far below what would fill a machine's memory."""
_REMEDY = "compare with docs/reference/program-file.md"
_KIND = Kind(FORMAT, VERSION, "a program", _REMEDY)
_CHOICES = {"stroke": During, "velocity": Velocity}


class SurfaceRecord(msgspec.Struct, forbid_unknown_fields=True):
    """Force on displacement and velocity, bilinear between its points, its edges held outside."""

    name: Annotated[Name, Meta(description="how states refer to it")]
    displacement_mm: Annotated[list[float], Meta(min_length=2, description="rising, mm, in any steps")]
    velocity_mm_s: Annotated[list[float], Meta(min_length=1, description="rising from 0 or more, mm/s")]
    force_cN: Annotated[
        list[list[float]],
        Meta(min_length=1, description="a row of forces per velocity, cN; negative pulls the cap down"),
    ]


class ModeRecord(msgspec.Struct, forbid_unknown_fields=True):
    """One sinusoid of the cap's acceleration, amplitude exp(-decay t) sin(2 pi frequency t + phase)."""

    frequency_Hz: Annotated[float, Meta(gt=0, description="frequency, Hz")]
    amplitude_m_s2: Annotated[float, Meta(description="acceleration at the start, m/s²")]
    decay_1_s: Annotated[float, Meta(ge=0, description="decay, 1/s")]
    phase_rad: Annotated[float, Meta(description="phase at the start, rad")] = 0.0


class SignalRecord(msgspec.Struct, forbid_unknown_fields=True):
    """A short vibration of the cap, without a place."""

    name: Annotated[Name, Meta(description="how states, transitions and vibrations refer to it")]
    duration_s: Annotated[float, Meta(gt=0, description="length, s")]
    modes: Annotated[list[ModeRecord], Meta(min_length=1, description="the sinusoids that add up to it")]


class TransitionRecord(msgspec.Struct, forbid_unknown_fields=True):
    """The way to another state."""

    to: Annotated[Name, Meta(description="state to enter")]
    when: ConditionRecord
    only_if: Annotated[ConditionRecord | None, Meta(description="a second condition that must hold too")] = (
        None
    )
    signal: Annotated[
        Reference, Meta(description="played on the way, instead of the entered state's own")
    ] = None


class StateRecord(msgspec.Struct, forbid_unknown_fields=True):
    """What is felt and reported until a transition leads on."""

    name: Annotated[Name, Meta(description="how transitions refer to it")]
    press: Annotated[Name, Meta(description="surface looked up while the cap goes down")]
    release: Annotated[Name, Meta(description="surface looked up while it comes up")]
    key: Annotated[
        int, Meta(ge=0, le=255, description="reported to the host: 0 up, else the level that is down")
    ] = 0
    velocity: Annotated[Velocity, Meta(description="which velocity chooses the row of the surfaces")] = (
        Velocity.DECIDED
    )
    enter_signal: Annotated[Reference, Meta(description="played on entering")] = None
    repeat_signal: Annotated[Reference, Meta(description="played again and again in the state")] = None
    repeat_ms: Annotated[int, Meta(ge=0, le=65_535, description="its period, ms; 0 with none")] = 0
    fade_ms: Annotated[
        int, Meta(ge=0, le=2000, description="time in which the force moves to this state's, ms")
    ] = 0
    bias_cN: Annotated[float, Meta(description="added to the surface's force, cN")] = 0.0
    bias_end_cN: Annotated[float, Meta(description="what the bias has become after bias_ms, cN")] = 0.0
    bias_ms: Annotated[
        int, Meta(ge=0, le=65_535, description="time over which the bias changes, ms; 0: it does not")
    ] = 0
    transitions: Annotated[
        list[TransitionRecord], Meta(description="tried in this order; the first that holds is taken")
    ] = []


class VibrationRecord(msgspec.Struct, forbid_unknown_fields=True):
    """A signal felt at a displacement, once per stroke."""

    signal: Annotated[Name, Meta(description="what is played")]
    at_mm: Annotated[float, Meta(description="where it is to be felt, mm")]
    stroke: Annotated[During, Meta(description="in which direction")] = During.PRESS
    slowest_mm_s: Annotated[float | None, Meta(description="only at or above this velocity, mm/s")] = None
    fastest_mm_s: Annotated[float | None, Meta(description="only below this velocity, mm/s")] = None
    states: Annotated[list[Name], Meta(description="only in these states; empty: in all")] = []


class ProgramRecord(msgspec.Struct, forbid_unknown_fields=True):
    """A button as a machine of states."""

    format: Annotated[Literal["fdvv-program"], Meta(description="tells the file from other JSON")]
    version: Annotated[Literal[1], Meta(description="of this format")]
    name: Annotated[Name, Meta(description="short, as a file would be called")]
    travel_mm: Annotated[float, Meta(gt=0, description="where the bottom stop is set, mm")]
    start: Annotated[Name, Meta(description="state entered first")]
    states: Annotated[list[StateRecord], Meta(min_length=1, description="no two of one name")]
    surfaces: Annotated[list[SurfaceRecord], Meta(min_length=1, description="no two of one name")]
    signals: Annotated[list[SignalRecord], Meta(description="no two of one name")] = []
    vibrations: Annotated[list[VibrationRecord], Meta(description="signals tied to displacements")] = []
    description: Annotated[str, Meta(description="what the button does, for people")] = ""


def schema() -> dict[str, Any]:
    """Return the JSON schema of the file, as published in docs/reference/fdvv-program.schema.json."""
    found = msgspec.json.schema(ProgramRecord)
    return {"$schema": "https://json-schema.org/draft/2020-12/schema", **tidy_schema(found)}


def program_to_json(program: Program) -> str:
    """Write a program as the text of a ``*.fdvv-program.json`` file."""
    record = ProgramRecord(
        "fdvv-program",
        1,
        program.name,
        program.travel_mm,
        program.start,
        [_state_record(state) for state in program.states],
        [
            SurfaceRecord(s.name, list(s.displacement_mm), list(s.velocity_mm_s), _rows(s))
            for s in program.surfaces
        ],
        [
            SignalRecord(s.name, s.duration_s, [ModeRecord(**vars(mode)) for mode in s.modes])
            for s in program.signals
        ],
        [VibrationRecord(**{**vars(v), "states": list(v.states)}) for v in program.vibrations],
        program.description,
    )
    return pretty(_without_defaults(record), one_line=list(When)) + "\n"


def _rows(surface: Surface) -> list[list[float]]:
    return [list(row) for row in surface.force_cN]


def _state_record(state: State) -> StateRecord:
    transitions = [
        TransitionRecord(
            t.to, _condition_record(t.when), _condition_record(t.only_if) if t.only_if else None, t.signal
        )
        for t in state.transitions
    ]
    return StateRecord(**{**vars(state), "transitions": transitions})


def _condition_record(condition: Condition) -> ConditionRecord:
    value = True if condition.when in BARE else float(condition.value)
    return {str(condition.when): value}  # type: ignore[dict-item]


def _without_defaults(value: Any) -> Any:
    """Turn records into plain values, leaving out fields that have their default."""
    if isinstance(value, msgspec.Struct):
        found = {}
        for field in msgspec.structs.fields(value):
            held = getattr(value, field.name)
            default = [] if field.default_factory is list else field.default
            if held != default:
                found[field.name] = _without_defaults(held)
        return found
    if isinstance(value, list):
        return [_without_defaults(item) for item in value]
    return str(value) if isinstance(value, str) else value


def program_from_json(text: str | bytes, source: object = "program") -> Program:
    """Read a program from the text of a ``*.fdvv-program.json`` file.

    Raises InputError that names source, the place in it and the remedy.
    """
    return read_document(
        text,
        source,
        _KIND,
        lambda data: _program(msgspec.json.decode(data, type=ProgramRecord), source),
        _choices,
    )


def _choices(place: str) -> Iterable[str] | None:
    return _CHOICES.get(place.rpartition(".")[2], When if "key" in place else None)


class _Reader:
    """Builds the parts of a program and remembers where it is, for the message of what fails."""

    def __init__(self) -> None:
        self.place = "$"

    def surface(self, i: int, record: SurfaceRecord) -> Surface:
        self.place = f"$.surfaces[{i}]"
        rows = tuple(tuple(row) for row in record.force_cN)
        return Surface(record.name, tuple(record.displacement_mm), rows, tuple(record.velocity_mm_s))

    def signal(self, i: int, record: SignalRecord) -> Signal:
        self.place = f"$.signals[{i}]"
        modes = tuple(Mode(**msgspec.structs.asdict(mode)) for mode in record.modes)
        return Signal(record.name, record.duration_s, modes)

    def state(self, i: int, record: StateRecord) -> State:
        transitions = []
        for j, t in enumerate(record.transitions):
            self.place = f"$.states[{i}].transitions[{j}]"
            guard = self.condition(t.only_if) if t.only_if else None
            transitions.append(Transition(t.to, self.condition(t.when), guard, t.signal))
        self.place = f"$.states[{i}]"
        return State(**{**msgspec.structs.asdict(record), "transitions": tuple(transitions)})

    def condition(self, record: ConditionRecord) -> Condition:
        ((name, value),) = record.items()
        when = When(name)
        if (value is True) != (when in BARE):
            wanted = "true" if when in BARE else "a number"
            raise ModelError(f"{name} takes {wanted}, got {json.dumps(value)}")
        return Condition(when, 0.0 if value is True else value)

    def vibration(self, i: int, record: VibrationRecord) -> VibrationEvent:
        self.place = f"$.vibrations[{i}]"
        return VibrationEvent(**{**msgspec.structs.asdict(record), "states": tuple(record.states)})


def _program(record: ProgramRecord, source: object) -> Program:
    """Build the program from a record of the right shape; each failure names its place."""
    reader = _Reader()
    try:
        states = tuple(reader.state(i, s) for i, s in enumerate(record.states))
        surfaces = tuple(reader.surface(i, s) for i, s in enumerate(record.surfaces))
        signals = tuple(reader.signal(i, s) for i, s in enumerate(record.signals))
        vibrations = tuple(reader.vibration(i, v) for i, v in enumerate(record.vibrations))
        reader.place = "$"
        return Program(
            record.name,
            record.travel_mm,
            record.start,
            states,
            surfaces,
            signals,
            vibrations,
            record.description,
        )
    except ModelError as error:
        raise InputError(source, reader.place, str(error), _REMEDY) from error


def save_program(program: Program, path: Path | str) -> None:
    """Write a program to a ``*.fdvv-program.json`` file, whole or not at all. Raises OSError."""
    write_atomic(Path(path), program_to_json(program))


def load_program(path: Path | str) -> Program:
    """Read a program from a ``*.fdvv-program.json`` file. Raises InputError, also where it cannot be read."""
    return program_from_json(read_limited(path, LIMIT_bytes, "pass a program file"), path)
