"""Messages about programs: kept, checked, made from a recipe."""

from __future__ import annotations

from typing import Annotated, Literal

from msgspec import Meta, Struct

Id = Annotated[str, Meta(max_length=80)]
Title = Annotated[str, Meta(max_length=80)]


class ProgramsAsk(Struct, frozen=True, forbid_unknown_fields=True):
    """Ask for every program there is, and the recipes."""


class ProgramRow(Struct, frozen=True, forbid_unknown_fields=True):
    """A program to choose.

    id : ``shipped:NAME`` or ``own:NAME``. problem : why its file cannot be read, else empty.
    """

    id: str
    name: str
    summary: str
    states: int
    transitions: int
    problem: str


class ProgramParameter(Struct, frozen=True, forbid_unknown_fields=True):
    """A number that a recipe takes, over the base that was asked for; its unit ends its name."""

    name: str
    default: float
    whole: bool
    low: float
    high: float


class ProgramRecipe(Struct, frozen=True, forbid_unknown_fields=True):
    """A program before it is made."""

    name: str
    summary: str
    details: str
    parameters: list[ProgramParameter]


class ProgramRows(Struct, frozen=True, forbid_unknown_fields=True):
    """Every program, every recipe, and the buttons that recipes may stand on."""

    programs: list[ProgramRow]
    recipes: list[ProgramRecipe]
    bases: list[str]


class ProgramAsk(Struct, frozen=True, forbid_unknown_fields=True):
    """Ask for a program by its id."""

    program: Id


class ProgramText(Struct, frozen=True, forbid_unknown_fields=True):
    """A program as its file holds it. revision : of that file; empty for a shipped one."""

    program: str
    text: str
    revision: str


class SaveProgram(Struct, frozen=True, forbid_unknown_fields=True):
    """Write a program of the person's. revision : of the file that was opened; empty for a new one."""

    program: Id
    text: str
    revision: Title = ""


class KeepProgram(Struct, frozen=True, forbid_unknown_fields=True):
    """Keep a text as a new program of the person's, under its own name or the next free one."""

    text: str


class CopyProgram(Struct, frozen=True, forbid_unknown_fields=True):
    """Copy a program. name : of the copy; empty: the next free one."""

    program: Id
    name: Title = ""


class DeleteProgram(Struct, frozen=True, forbid_unknown_fields=True):
    """Move a program to the trash. revision : of the file as it was last seen."""

    program: Id
    revision: Title


class ThrownProgram(Struct, frozen=True, forbid_unknown_fields=True):
    """The name of a program in the trash, by which it can be taken out again."""

    thrown: Title


class CheckProgram(Struct, frozen=True, forbid_unknown_fields=True):
    """Check a program as it is being edited."""

    text: str


class ProgramFinding(Struct, frozen=True, forbid_unknown_fields=True):
    """One thing that is wrong or doubtful.

    path : of the part it concerns, such as ``states[1].transitions[0]``; empty for the whole program.
    at_mm : the displacement it is about, or null.
    """

    severity: Literal["refused", "warning"]
    path: str
    state: str
    place: str
    reason: str
    remedy: str
    at_mm: float | None


class ProgramSize(Struct, frozen=True, forbid_unknown_fields=True):
    """How much of something a program takes, and how much a device holds; null if it cannot be told yet."""

    what: str
    taken: int | None
    most: int


class ProgramSurfaceSize(Struct, frozen=True, forbid_unknown_fields=True):
    """What a surface becomes in an image."""

    name: str
    columns: int
    rows: int
    error_cN: float


class ProgramCheck(Struct, frozen=True, forbid_unknown_fields=True):
    """What a check found, and what compiling would give.

    return_s : bound of the time in which the cap comes back; null if unproven.
    """

    accepted: bool
    findings: list[ProgramFinding]
    sizes: list[ProgramSize]
    surfaces: list[ProgramSurfaceSize]
    return_s: float | None
    stiffness_cN_mm: float | None
    rise_K: float | None


class MakeProgram(Struct, frozen=True, forbid_unknown_fields=True):
    """Make a program by a recipe over a button. parameters : those that differ from their defaults."""

    recipe: Title
    base: Id
    parameters: Annotated[dict[str, float], Meta(max_length=20)]


class MadeProgram(Struct, frozen=True, forbid_unknown_fields=True):
    """The text of a program that was made; it is not kept."""

    text: str


class RangesAsk(Struct, frozen=True, forbid_unknown_fields=True):
    """Ask between what a recipe's parameters may be over a button. levels : of multi-level."""

    recipe: Title
    base: Id
    levels: Annotated[int, Meta(ge=1, le=8)] = 1


class ProgramRanges(Struct, frozen=True, forbid_unknown_fields=True):
    """A recipe's parameters over a button."""

    parameters: list[ProgramParameter]


class SurfaceAsk(Struct, frozen=True, forbid_unknown_fields=True):
    """Ask for the forces of one stroke of a button, to put them into a program."""

    button: Id
    stroke: Literal["press", "release"]


class ProgramSurface(Struct, frozen=True, forbid_unknown_fields=True):
    """Force on displacement, a row per velocity, as a program's file holds it."""

    displacement_mm: list[float]
    velocity_mm_s: list[float]
    force_cN: list[list[float]]
