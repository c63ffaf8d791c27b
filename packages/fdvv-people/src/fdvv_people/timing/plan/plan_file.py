"""The file of a timing study, TOML that people write: reading, checking, and the shipped templates."""

from __future__ import annotations

import tomllib
from collections.abc import Iterator
from importlib import resources
from pathlib import Path

from fdvv.errors import InputError
from fdvv.io.files import write_atomic
from fdvv.model.file import MODEL_SUFFIX, builtin_names
from fdvv.program.file import PROGRAM_SUFFIX
from fdvv.program.library import names_program
from fdvv_people.optimize.engines.registry import engine_names
from fdvv_people.study.plan.plan_file import STUDY_FILE, called, read_declared, refuse_problems
from fdvv_people.study.plan.text_check import (
    Text,
    column_problems,
    language_problems,
    name_problems,
    number_problems,
    page_texts,
    question_problems,
    text_problems,
    twice_problems,
)
from fdvv_people.timing.plan.plan import DESIGNED, FORMAT, Condition, TimingPlan

TEMPLATES = resources.files("fdvv_people.timing").joinpath("templates")
TEMPLATE_NAMES = ("timing", "tapping")
"""The shipped studies, by kind."""
MOST_TRIALS = 2000
FIELDS = {"date": "", "person": ""}
"""What a reminder may name."""


def is_timing(folder: Path) -> bool:
    """Whether a folder, or a file, declares a timing study; False of what cannot be read."""
    path = folder / STUDY_FILE if folder.is_dir() else folder
    try:
        return tomllib.loads(path.read_text(encoding="utf-8-sig")).get("format") == FORMAT
    except (OSError, ValueError):
        return False


def read_timing_plan(text: str | bytes, source: object) -> TimingPlan:
    """Read the TOML text of a timing study, unchecked. InputError, see `read_declared`."""
    return read_declared(text, source, TimingPlan, FORMAT)


def check_timing_plan(plan: TimingPlan, source: object) -> None:
    """Raise InputError on a plan that cannot be run or analysed as it says, with all that is wrong."""
    refuse_problems(plan_problems(plan), source)


def timing_template(name: str, folder: Path, study_name: str | None = None) -> Path:
    """Write a shipped study into a folder; return its file. InputError where it is there already. OSError."""
    path = folder / STUDY_FILE
    if path.exists():
        raise InputError(path, "output", "is there already", "name another folder")
    text = TEMPLATES.joinpath(f"{name}.toml").read_text(encoding="utf-8")
    write_atomic(path, text if study_name is None else called(text, study_name))
    return path


def plan_problems(plan: TimingPlan) -> tuple[str, ...]:
    """List what is wrong, each as "place: reason"; empty where the plan can be run and analysed.

    Looks at the plan alone: whether the files it names are there is for who has them.
    """
    return (
        *number_problems(plan, ""),
        *_names(plan),
        *language_problems(plan.languages),
        *text_problems(_texts(plan), plan.languages),
        *_pages(plan),
        *_conditions(plan),
        *_levels(plan),
        *_training(plan),
        *_claim(plan),
    )


def _names(plan: TimingPlan) -> Iterator[str]:
    groups = {
        "conditions": [one.name for one in plan.conditions],
        "pages": [page.name for page in plan.pages],
        "languages": plan.languages,
        "levels": plan.levels,
    }
    yield from name_problems("name", plan.name)
    for place, names in groups.items():
        for name in names:
            yield from name_problems(place, name)
        yield from twice_problems(place, names)


def _texts(plan: TimingPlan) -> Iterator[Text]:
    yield "title", plan.title, True
    yield "reminder", plan.reminder, plan.training is not None
    yield from page_texts(plan.pages)


def _pages(plan: TimingPlan) -> Iterator[str]:
    for page in plan.pages:
        for question in page.questions:
            yield from question_problems(f"pages ({page.name!r}), questions ({question.name!r})", question)
    named = [(f"pages ({p.name!r}), questions", q.name) for p in plan.pages for q in p.questions]
    yield from column_problems(named)
    for language, text in plan.reminder.items():
        try:
            text.format(**FIELDS)
        except (KeyError, IndexError, ValueError):
            yield f"reminder, {language}: only {{date}} and {{person}} may stand in braces"


def _conditions(plan: TimingPlan) -> Iterator[str]:
    if len(plan.conditions) < 2:
        yield f"conditions: at least two are compared, got {len(plan.conditions)}"
    for one in plan.conditions:
        yield from _condition(plan, one, f"conditions ({one.name!r})")
    for kind in DESIGNED:
        if sum(one.kind == kind for one in plan.conditions) > 1:
            yield f"conditions: only one may be of the kind {kind}"


def _condition(plan: TimingPlan, one: Condition, place: str) -> Iterator[str]:
    if one.kind == "optimised" and plan.training is None:
        yield f"{place}: nothing is optimised without [training]"
    if one.kind in DESIGNED and one.button:
        yield f"{place}: its button follows from the study; leave out button"
    if one.kind == "program":
        if not (names_program(one.button) or one.button.endswith(PROGRAM_SUFFIX)):
            yield f"{place}: {one.button!r} is neither a shipped program nor a *{PROGRAM_SUFFIX} file"
        if not plan.tapping:
            yield f"{place}: programs are pressed in tapping only; a timing study compares buttons"
    elif one.kind not in DESIGNED and not _is_button(one.button):
        known = ", ".join(builtin_names())
        yield f"{place}: {one.button!r} is neither built in ({known}) nor a *{MODEL_SUFFIX} file"
    if not one.on_the_table and (one.key or one.latency_ms is not None or one.latency_error_ms is not None):
        yield f"{place}: key and latency are those of a switch or a key; leave them out"
    if (one.latency_ms is None) != (one.latency_error_ms is None):
        yield f"{place}: latency_ms and latency_error_ms belong together; write both"
    if one.kind == "switch" and one.latency_ms is None:
        yield f"{place}: write latency_ms and latency_error_ms of the board that reports the switch"


def _is_button(name: str) -> bool:
    return name in builtin_names() or name.endswith(MODEL_SUFFIX)


def _levels(plan: TimingPlan) -> Iterator[str]:
    if plan.tapping and plan.levels:
        yield "levels: tapping has none; leave them out"
    if not plan.tapping and not plan.levels:
        yield 'levels: there is none; write levels = ["easy", "hard"]'
    if plan.trials > MOST_TRIALS:
        yield f"rounds: {plan.trials} trials of one person are more than {MOST_TRIALS}"
    if plan.break_every_min > 0 and plan.break_min == 0:
        yield "break_min: a break of no length; for no breaks write break_every_min = 0"


def _training(plan: TimingPlan) -> Iterator[str]:
    if plan.training is None:
        return
    if plan.tapping:
        yield "training: buttons are optimised for temporal pointing only; leave it out"
    if plan.training.engine not in engine_names():
        known = ", ".join(engine_names())
        yield f"training, engine: {plan.training.engine!r} is none of {known}"
    if plan.due_days < plan.gap_days:
        yield f"due_days: {plan.due_days:g} is before the gap of {plan.gap_days:g} days is over"


def _claim(plan: TimingPlan) -> Iterator[str]:
    claim = plan.claim
    if claim is None:
        return
    names = [one.name for one in plan.conditions]
    for name in (claim.better, *claim.than):
        if name not in names:
            yield f"claim: {name!r} is not one of the conditions ({', '.join(names)})"
    if claim.better in claim.than:
        yield f"claim: {claim.better!r} cannot be better than itself"
    if claim.at_least_Hz is not None and not plan.tapping:
        yield "claim: at_least_Hz is a rate of tapping"
