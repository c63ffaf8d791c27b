"""The ``*.fdvv-program.json`` file: versioned plain JSON with a published schema.

Only what differs from its default is written, in one order, numbers with the shortest digits that read back
to the same bits, a list of plain values to a line.
"""

from __future__ import annotations

from dataclasses import Field
from pathlib import Path
from typing import Any

from fdvv.io.documents import Kind, Layout, decode, document, pretty, read_document
from fdvv.io.files import read_limited, write_atomic
from fdvv.program.condition import Condition, When
from fdvv.program.program import During, Program, Velocity

FORMAT = "fdvv-program"
VERSION = 1
"""Of the program file."""
PROGRAM_SUFFIX = ".fdvv-program.json"
"""How a program file's name ends."""
LIMIT_bytes = 16_000_000
"""Far above any program (an image holds 7 kB), far below what would fill a machine's memory."""
_REMEDY = "compare with docs/reference/program-file.md"
_KIND = Kind(FORMAT, VERSION, "a program", _REMEDY)
LAYOUT = Layout(last=("transitions", "force_cN"), needed=("velocity_mm_s",))
_CHOICES = {"stroke": During, "velocity": Velocity}


def schema() -> dict[str, Any]:
    """Return the JSON schema of the file, as published in docs/reference/fdvv-program.schema.json."""
    from fdvv.io.schema import schema_of

    schema = schema_of(Program, _KIND, LAYOUT)
    del schema["$defs"]["When"]  # nothing refers to it: each condition lists its names
    return schema


def program_to_json(program: Program) -> str:
    plain = document(program, _KIND, layout=LAYOUT, keep=_is_written, special=_state_condition)
    return pretty(plain, one_line=list(When)) + "\n"


def _is_written(field: Field[Any], value: object) -> bool:
    return value != field.default or field.name in LAYOUT.needed


def _state_condition(value: Any) -> Any:
    return value.to_dict() if isinstance(value, Condition) else value


def program_from_json(text: str | bytes, source: object = "program") -> Program:
    """Read a program from the text of a ``*.fdvv-program.json`` file.

    Raises InputError that names source, the place in it and the remedy.
    """
    return read_document(
        text,
        source,
        _KIND,
        lambda data: decode(data, Program, LAYOUT),
        lambda place: _CHOICES.get(place.rpartition(".")[2], When if "key" in place else None),
    )


def save_program(program: Program, path: Path | str) -> None:
    """Write a program to a ``*.fdvv-program.json`` file, whole or not at all. Raises OSError."""
    write_atomic(Path(path), program_to_json(program))


def load_program(path: Path | str) -> Program:
    """Read a program from a ``*.fdvv-program.json`` file. Raises InputError, also where it cannot be read."""
    return program_from_json(read_limited(path, LIMIT_bytes, "pass a program file"), path)
