"""The ``*.fdvv-program.json`` file: versioned plain JSON with a published schema.

Only what differs from its default is written, in one order, numbers with the shortest digits that read back
to the same bits, a list of plain values to a line.
"""

from __future__ import annotations

import json
from collections.abc import Iterable
from pathlib import Path
from typing import Any

import msgspec

from fdvv.documents import Kind, pretty, read_document
from fdvv.errors import InputError, ModelError
from fdvv.files import read_limited, write_atomic
from fdvv.model import Mode
from fdvv.program._condition import BARE, Condition, Transition, When
from fdvv.program._program import During, Program, Signal, State, Velocity, VibrationEvent
from fdvv.program._records import (
    FORMAT,
    VERSION,
    ConditionRecord,
    ModeRecord,
    ProgramRecord,
    SignalRecord,
    StateRecord,
    SurfaceRecord,
    TransitionRecord,
    VibrationRecord,
)
from fdvv.program._surface import Surface

SUFFIX = ".fdvv-program.json"
"""How a program file's name ends."""
LIMIT_bytes = 16_000_000
"""Far above any program (an image holds 7 kB), far below what would fill a machine's memory."""

_REMEDY = "compare with docs/reference/program-file.md"
_KIND = Kind(FORMAT, VERSION, "a program", _REMEDY)
_CHOICES = {"stroke": During, "velocity": Velocity}


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
