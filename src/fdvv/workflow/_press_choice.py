"""What there is to press: buttons, programs and traces by id."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from fdvv.errors import InputError
from fdvv.model import SUFFIX, builtin_names
from fdvv.program import SUFFIX as PROGRAM_SUFFIX
from fdvv.program import Program, load_program, load_shipped, programs
from fdvv.workflow._press_trace import PressTrace, drawn_traces
from fdvv.workflow._shelf import BUTTONS, Shelf

PROGRAMS = "programs"
"""Folder of a project that holds the person's own programs."""
TRY = {
    "button": "Press it as any key: the others are told against this one.",
    "dwell-ticks": "Hold it at the bottom and count the ticks with your finger.",
    "fast-tapping": "Push past 1 mm and let it take over: it drops, kicks back and is ready again.",
    "multi-level": "Sink slowly and stop at each click: three key levels lie on the way.",
    "non-newtonian": "Press gently, then hit it: the faster, the stiffer.",
    "rapid-trigger": "Stay deep and waggle by a few tenths of a millimetre: it goes up and down each time.",
    "returning-later": "Press once and let go: it stays down for a second and a half, then comes back.",
}
"""What to do with each shipped program, in one line."""


@dataclass(frozen=True)
class PressChoice:
    """Something to press: its id, its name for people, and what to try."""

    id: str
    name: str
    hint: str


def button_choices(shelf: Shelf) -> tuple[PressChoice, ...]:
    """List the built-in buttons and the person's own."""
    own = _names(shelf.project / BUTTONS, SUFFIX)
    return (
        *(PressChoice(f"builtin:{name}", name, "built-in") for name in builtin_names()),
        *(PressChoice(f"own:{name}", name, "your own") for name in own),
    )


def program_choices(project: Path) -> tuple[PressChoice, ...]:
    """List the shipped programs and the person's own."""
    shipped = (PressChoice(f"shipped:{r.name}", r.name, TRY.get(r.name, r.summary)) for r in programs())
    own = _names(project / PROGRAMS, PROGRAM_SUFFIX)
    return (*shipped, *(PressChoice(f"own:{name}", name, "your own") for name in own))


def program_of(project: Path, program_id: str) -> Program:
    """Give the program of an id such as ``shipped:multi-level`` or ``own:my-program``. Raises InputError."""
    kind, _, name = program_id.partition(":")
    if kind == "shipped":
        return load_shipped(name)
    found = _names(project / PROGRAMS, PROGRAM_SUFFIX)
    if kind == "own" and name in found:
        return load_program(found[name])
    raise InputError("studio", program_id, "no such program", "choose one from the list")


def drawn_trace(name: str) -> PressTrace:
    """Give a shipped trace by its name. Raises InputError."""
    for trace in drawn_traces():
        if trace.name == name:
            return trace
    raise InputError("trace", name, "no such trace", "choose one from the list")


def _names(folder: Path, suffix: str) -> dict[str, Path]:
    """Find files: names are looked up here, never joined to a path."""
    return {path.name.removesuffix(suffix): path for path in sorted(folder.glob(f"*{suffix}"))}
