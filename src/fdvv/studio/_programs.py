"""Programs: listed, kept, checked at every edit, made from recipes."""

from __future__ import annotations

from fdvv.errors import InputError
from fdvv.program import Recipe, make, of_model, program_to_json, programs, ranges
from fdvv.studio import _messages_programs as m
from fdvv.studio._contract import Call, ChannelKind
from fdvv.studio._studio import Studio
from fdvv.workflow import KeptProgram, ProgramShelf, button_choices, program_standing, read_program

PLAINEST = "builtin:mx-red"
"""The button that recipes stand on by default: linear, so that nothing distracts."""


class Programs:
    """The programs of a studio's project."""

    def __init__(self, studio: Studio) -> None:
        self.shelf = ProgramShelf(studio.project)


def _shelf(studio: Studio) -> ProgramShelf:
    return studio.part(Programs).shelf


def list_programs(studio: Studio, _ask: m.ProgramsAsk) -> m.ProgramRows:
    """List what there is to begin with."""
    rows = [
        m.ProgramRow(e.id, e.name, e.summary, e.states, e.transitions, e.problem)
        for e in _shelf(studio).entries()
    ]
    recipes = [
        m.ProgramRecipe(r.name, r.summary, r.details, _parameters(studio, r, PLAINEST)) for r in programs()
    ]
    return m.ProgramRows(rows, recipes, [b.id for b in button_choices(studio.shelf)])


def _parameters(studio: Studio, recipe: Recipe, base: str, levels: int = 1) -> list[m.ProgramParameter]:
    allowed = ranges(recipe.name, studio.shelf.model(base), levels=levels)
    return [
        m.ProgramParameter(p.name, float(p.default), isinstance(p.default, int), *allowed[p.name])
        for p in recipe.parameters
    ]


def _kept(kept: KeptProgram) -> m.ProgramText:
    return m.ProgramText(kept.id, kept.text, kept.revision)


def open_program(studio: Studio, ask: m.ProgramAsk) -> m.ProgramText:
    """Give a program's text."""
    return _kept(_shelf(studio).open(ask.program))


def save_program(studio: Studio, ask: m.SaveProgram) -> m.ProgramText:
    """Write a program, unless its file has changed since it was opened."""
    return _kept(_shelf(studio).save(ask.program, ask.text, ask.revision))


def keep_program(studio: Studio, ask: m.KeepProgram) -> m.ProgramText:
    """Keep a new program: one that was made, or a file that a person brought."""
    shelf = _shelf(studio)
    name = shelf.free_name(read_program(ask.text, "file").name)
    return _kept(shelf.save(f"own:{name}", ask.text))


def copy_program(studio: Studio, ask: m.CopyProgram) -> m.ProgramText:
    """Copy a program under a new name."""
    return _kept(_shelf(studio).copy(ask.program, ask.name))


def delete_program(studio: Studio, ask: m.DeleteProgram) -> m.ThrownProgram:
    """Move a program to the trash."""
    return m.ThrownProgram(_shelf(studio).delete(ask.program, ask.revision))


def restore_program(studio: Studio, ask: m.ThrownProgram) -> m.ProgramText:
    """Take a program out of the trash."""
    return _kept(_shelf(studio).restore(ask.thrown))


def check_program(_studio: Studio, ask: m.CheckProgram) -> m.ProgramCheck:
    """Check a text as far as it goes; what is wrong with it is the answer, not an error."""
    found = program_standing(ask.text)
    return m.ProgramCheck(
        found.accepted,
        [
            m.ProgramFinding(f.severity.value, f.path, f.state, f.place, f.reason, f.remedy, f.at_mm)
            for f in found.findings
        ],
        [m.ProgramSize(s.what, s.taken, s.most) for s in found.sizes],
        [m.ProgramSurfaceSize(s.name, s.columns, s.rows, s.error_cN) for s in found.surfaces],
        found.return_s,
        found.stiffness_cN_mm,
        found.rise_K,
    )


def make_program(studio: Studio, ask: m.MakeProgram) -> m.MadeProgram:
    """Make a program by a recipe; it is not kept."""
    return m.MadeProgram(program_to_json(make(ask.recipe, studio.shelf.model(ask.base), **ask.parameters)))


def parameter_ranges(studio: Studio, ask: m.RangesAsk) -> m.ProgramRanges:
    """Tell between what the parameters may be over another base."""
    recipe = next((r for r in programs() if r.name == ask.recipe), None)
    if recipe is None:
        raise InputError("studio", "recipe", f"none is called {ask.recipe!r}", "choose one from the list")
    return m.ProgramRanges(_parameters(studio, recipe, ask.base, ask.levels))


def button_surface(studio: Studio, ask: m.SurfaceAsk) -> m.ProgramSurface:
    """Sample one stroke of a button as a surface."""
    found = of_model(studio.shelf.model(ask.button), ask.stroke)
    rows = [list(row) for row in found.force_cN]
    return m.ProgramSurface(list(found.displacement_mm), list(found.velocity_mm_s), rows)


CALLS = (
    Call("program.list", m.ProgramsAsk, m.ProgramRows, list_programs),
    Call("program.open", m.ProgramAsk, m.ProgramText, open_program),
    Call("program.save", m.SaveProgram, m.ProgramText, save_program),
    Call("program.keep", m.KeepProgram, m.ProgramText, keep_program),
    Call("program.copy", m.CopyProgram, m.ProgramText, copy_program),
    Call("program.delete", m.DeleteProgram, m.ThrownProgram, delete_program),
    Call("program.restore", m.ThrownProgram, m.ProgramText, restore_program),
    Call("program.check", m.CheckProgram, m.ProgramCheck, check_program),
    Call("program.recipe", m.MakeProgram, m.MadeProgram, make_program),
    Call("program.ranges", m.RangesAsk, m.ProgramRanges, parameter_ranges),
    Call("program.surface", m.SurfaceAsk, m.ProgramSurface, button_surface),
)
CHANNELS: tuple[ChannelKind, ...] = ()
