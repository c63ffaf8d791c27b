"""The ``*.fdvv-program.json`` file: versioned plain JSON with a published schema.

Only what differs from its default is written, in one order, numbers with the shortest digits that read back
to the same bits, a list of plain values to a line.
"""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from typing import Annotated, Any, Literal, TypeVar

import msgspec
from msgspec import Meta

from fdvv.errors import InputError, ModelError
from fdvv.io.documents import Kind, pretty, read_document, tidy_schema
from fdvv.io.files import read_limited, write_atomic
from fdvv.model.file import ModeRecord
from fdvv.program.condition import BARE, Condition, When
from fdvv.program.program import During, Program, State, Velocity

R = TypeVar("R")
FORMAT = "fdvv-program"
VERSION = 1
"""Of the program file."""
Name = Annotated[str, Meta(min_length=1, max_length=40)]
Reference = Annotated[Name | None, Meta(description="a name, or null")]
ConditionRecord = Annotated[
    dict[When, float | Literal[True]],
    Meta(
        min_length=1,
        max_length=1,
        description="one condition and its value; true for always, turned_to_press and turned_to_release",
        extra_json_schema={"propertyNames": {"enum": list(map(str, When))}},
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
    del found["$defs"]["When"]  # nothing refers to it: each condition lists its names
    return {"$schema": "https://json-schema.org/draft/2020-12/schema", **tidy_schema(found)}


def program_to_json(program: Program) -> str:
    record = _record(
        ProgramRecord,
        program,
        format=FORMAT,
        version=VERSION,
        states=[_state_record(state) for state in program.states],
        surfaces=[_record(SurfaceRecord, s, force_cN=list(map(list, s.force_cN))) for s in program.surfaces],
        signals=[
            _record(SignalRecord, s, modes=[_record(ModeRecord, m) for m in s.modes]) for s in program.signals
        ],
        vibrations=[_record(VibrationRecord, event) for event in program.vibrations],
    )
    return pretty(_without_defaults(record), one_line=list(When)) + "\n"


def _record(kind: Callable[..., R], part: object, **changed: object) -> R:
    """Return the record of a part, whose fields have the same names."""
    fields = {name: list(value) if isinstance(value, tuple) else value for name, value in vars(part).items()}
    return kind(**(fields | changed))


def _state_record(state: State) -> StateRecord:
    transitions = [
        _record(TransitionRecord, t, when=_condition_record(t.when), only_if=_condition_record(t.only_if))
        for t in state.transitions
    ]
    return _record(StateRecord, state, transitions=transitions)


def _condition_record(condition: Condition | None) -> ConditionRecord | None:
    if condition is None:
        return None
    return {condition.when: True if condition.when in BARE else float(condition.value)}


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
        lambda place: _CHOICES.get(place.rpartition(".")[2], When if "key" in place else None),
    )


def _program(record: ProgramRecord, source: object) -> Program:
    """Build the program from a record of the right shape; each failure names its place."""
    fields = msgspec.to_builtins(record)
    for i, state in enumerate(fields["states"]):
        for j, transition in enumerate(state["transitions"]):
            try:
                for name in ("when", "only_if"):
                    transition[name] = _condition(transition[name])
            except ModelError as error:
                raise InputError(source, f"$.states[{i}].transitions[{j}]", str(error), _REMEDY) from error
    # a ModelError of another part comes out as msgspec's own error, with the place of that part
    return msgspec.convert(fields, Program, from_attributes=True)


def _condition(record: dict[str, float | Literal[True]] | None) -> Condition | None:
    if record is None:
        return None
    ((name, value),) = record.items()
    when = When(name)
    if (value is True) != (when in BARE):
        wanted = "true" if when in BARE else "a number"
        raise ModelError(f"{name} takes {wanted}, got {json.dumps(value)}")
    return Condition(when, 0.0 if value is True else value)


def save_program(program: Program, path: Path | str) -> None:
    """Write a program to a ``*.fdvv-program.json`` file, whole or not at all. Raises OSError."""
    write_atomic(Path(path), program_to_json(program))


def load_program(path: Path | str) -> Program:
    """Read a program from a ``*.fdvv-program.json`` file. Raises InputError, also where it cannot be read."""
    return program_from_json(read_limited(path, LIMIT_bytes, "pass a program file"), path)
