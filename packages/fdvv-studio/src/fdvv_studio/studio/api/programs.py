"""The programs page: stored programs, checks at every edit, recipes."""

from __future__ import annotations

from typing import Annotated, Literal

from msgspec import Meta

from fdvv.errors import InputError
from fdvv.program.button import ranges
from fdvv.program.file import program_to_json
from fdvv.program.library import Recipe, make, programs
from fdvv.program.surface import of_model
from fdvv_studio.live.press_subject import button_choices
from fdvv_studio.project.program_check import ProgramCheckResult, check_program_text
from fdvv_studio.project.programs import KeptProgram, ProgramEntry, read_program
from fdvv_studio.studio.contract import Empty, Message, call, message_of
from fdvv_studio.studio.studio import Studio

Id = Annotated[str, Meta(max_length=80)]
Title = Annotated[str, Meta(max_length=80)]


class ProgramParameter(Message):
    """A number that a recipe takes, over the base that was asked for; its unit ends its name."""

    name: str
    default: float
    whole: bool
    low: float
    high: float


class ProgramRecipe(Message):
    """A program before it is made."""

    name: str
    summary: str
    details: str
    parameters: list[ProgramParameter]


class ProgramRows(Message):
    """Every program, every recipe, and the buttons that recipes may stand on."""

    programs: list[ProgramEntry]
    recipes: list[ProgramRecipe]
    bases: list[str]


class ProgramAsk(Message):
    """Ask for a program by its id."""

    program: Id


class SaveProgram(ProgramAsk):
    """Write a program of the person's. revision : of the file that was opened; empty for a new one."""

    text: str
    revision: Title = ""


class CopyProgram(ProgramAsk):
    """Copy a program. name : of the copy; empty: the next free one."""

    name: Title = ""


class DeleteProgram(ProgramAsk):
    """Move a program to the trash. revision : of the file as it was last seen."""

    revision: Title


class ThrownProgram(Message):
    """The name of a program in the trash, by which it can be taken out again."""

    thrown: Title


class MakeProgram(Message):
    """Make a program by a recipe over a button. parameters : those that differ from their defaults."""

    recipe: Title
    base: Id
    parameters: Annotated[dict[str, float], Meta(max_length=20)]


class ProgramSource(Message):
    """The text of a program that is not kept, or not yet."""

    text: str


class RangesAsk(Message):
    """Ask between what a recipe's parameters may be over a button. levels : of multi-level."""

    recipe: Title
    base: Id
    levels: Annotated[int, Meta(ge=1, le=8)] = 1


class ProgramRanges(Message):
    """A recipe's parameters over a button."""

    parameters: list[ProgramParameter]


class SurfaceAsk(Message):
    """Ask for the forces of one stroke of a button, to put them into a program."""

    button: Id
    stroke: Literal["press", "release"]


class ProgramSurface(Message):
    """Force on displacement, a row per velocity, as a program's file holds it."""

    displacement_mm: tuple[float, ...]
    velocity_mm_s: tuple[float, ...]
    force_cN: tuple[tuple[float, ...], ...]


PLAINEST = "builtin:mx-red"
"""The button that recipes stand on by default: linear, so that nothing distracts."""


@call("program.list")
def list_programs(studio: Studio, _ask: Empty) -> ProgramRows:
    recipes = [
        ProgramRecipe(r.name, r.summary, r.details, _parameters(studio, r, PLAINEST)) for r in programs()
    ]
    return ProgramRows(
        list(studio.programs.entries()), recipes, [b.id for b in button_choices(studio.catalog)]
    )


def _parameters(studio: Studio, recipe: Recipe, base: str, levels: int = 1) -> list[ProgramParameter]:
    allowed = ranges(recipe.name, studio.catalog.model(base), levels=levels)
    return [
        ProgramParameter(p.name, float(p.default), isinstance(p.default, int), *allowed[p.name])
        for p in recipe.parameters
    ]


@call("program.open")
def open_program(studio: Studio, ask: ProgramAsk) -> KeptProgram:
    return studio.programs.open(ask.program)


@call("program.save")
def save_program(studio: Studio, ask: SaveProgram) -> KeptProgram:
    """Write a program, unless its file has changed since it was opened."""
    return studio.programs.save(ask.program, ask.text, ask.revision)


@call("program.keep")
def keep_program(studio: Studio, ask: ProgramSource) -> KeptProgram:
    """Keep a text as a new program of the person's, under its own name or the next free one."""
    name = studio.programs.free_name(read_program(ask.text, "file").name)
    return studio.programs.save(f"own:{name}", ask.text)


@call("program.copy")
def copy_program(studio: Studio, ask: CopyProgram) -> KeptProgram:
    return studio.programs.copy(ask.program, ask.name)


@call("program.delete")
def delete_program(studio: Studio, ask: DeleteProgram) -> ThrownProgram:
    return ThrownProgram(studio.programs.delete(ask.program, ask.revision))


@call("program.restore")
def restore_program(studio: Studio, ask: ThrownProgram) -> KeptProgram:
    return studio.programs.restore(ask.thrown)


@call("program.check")
def check_program(_studio: Studio, ask: ProgramSource) -> ProgramCheckResult:
    """Check a text as far as it goes; what is wrong with it is the answer, not an error."""
    return check_program_text(ask.text)


@call("program.recipe")
def make_program(studio: Studio, ask: MakeProgram) -> ProgramSource:
    """Make a program by a recipe; it is not kept."""
    return ProgramSource(program_to_json(make(ask.recipe, studio.catalog.model(ask.base), **ask.parameters)))


@call("program.ranges")
def parameter_ranges(studio: Studio, ask: RangesAsk) -> ProgramRanges:
    recipe = next((r for r in programs() if r.name == ask.recipe), None)
    if recipe is None:
        raise InputError("studio", "recipe", f"none is called {ask.recipe!r}", "choose one from the list")
    return ProgramRanges(_parameters(studio, recipe, ask.base, ask.levels))


@call("program.surface")
def button_surface(studio: Studio, ask: SurfaceAsk) -> ProgramSurface:
    return message_of(ProgramSurface, of_model(studio.catalog.model(ask.button), ask.stroke))
