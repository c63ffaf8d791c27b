"""What lies behind the conditions of a timing study: models, programs, a person's own designs."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

from fdvv.button.open import open_button
from fdvv.errors import FdvvError
from fdvv.model.file import builtin_names, load_builtin
from fdvv.model.model import FDVVModel
from fdvv.program.library import open_program
from fdvv.program.program import Program
from fdvv_people.study.files.layout import study_file
from fdvv_people.study.timing.plan import Condition, TimingPlan

Button = FDVVModel | Program


def opened_button(folder: Path, condition: Condition) -> Button:
    """Return the button or program that a condition names. folder : of the study. InputError."""
    name = condition.button
    if condition.kind == "program":
        return open_program(name if "." not in name else str(study_file(folder, name)))
    if name in builtin_names():
        return load_builtin(name)
    return open_button(str(study_file(folder, name)))


def button_problems(plan: TimingPlan, folder: Path) -> Iterator[str]:
    """List buttons and programs of a plan that cannot be opened."""
    for one in plan.conditions:
        try:
            if one.button:
                opened_button(folder, one)
        except (FdvvError, OSError) as error:
            yield f"conditions ({one.name!r}): {error}"
