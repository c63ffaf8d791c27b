"""What there is to press: buttons, programs and traces by id."""

from __future__ import annotations

from dataclasses import dataclass

from fdvv.errors import InputError
from fdvv.model import SUFFIX, builtin_names
from fdvv.workflow._press_trace import PressTrace, drawn_traces
from fdvv.workflow._program_shelf import ProgramShelf
from fdvv.workflow._shelf import BUTTONS, Shelf

TRY = {
    "shipped:button": "Press it as any key: the others are told against this one.",
    "shipped:dwell-ticks": "Hold it at the bottom and count the ticks with your finger.",
    "shipped:fast-tapping": "Push past 1 mm and let it take over: it drops, kicks back and is ready again.",
    "shipped:multi-level": "Sink slowly and stop at each click: three key levels lie on the way.",
    "shipped:non-newtonian": "Press gently, then hit it: the faster, the stiffer.",
    "shipped:rapid-trigger": "Stay deep and waggle by a few tenths of a millimetre: up and down each time.",
    "shipped:returning-later": "Press once and let go: it stays down for a second and a half.",
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
    own = sorted(path.name.removesuffix(SUFFIX) for path in (shelf.project / BUTTONS).glob(f"*{SUFFIX}"))
    return (
        *(PressChoice(f"builtin:{name}", name, "built-in") for name in builtin_names()),
        *(PressChoice(f"own:{name}", name, "your own") for name in own),
    )


def program_choices(shelf: ProgramShelf) -> tuple[PressChoice, ...]:
    """List the shipped programs and the person's own, but for files that cannot be read."""
    return tuple(
        PressChoice(entry.id, entry.name, TRY.get(entry.id, entry.summary))
        for entry in shelf.entries()
        if not entry.problem
    )


def drawn_trace(name: str) -> PressTrace:
    """Give a shipped trace by its name. Raises InputError."""
    for trace in drawn_traces():
        if trace.name == name:
            return trace
    raise InputError("trace", name, "no such trace", "choose one from the list")
