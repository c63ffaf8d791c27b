"""What can be wrong with the plan of a timing study, all of it at once."""

from __future__ import annotations

from collections.abc import Iterator

from fdvv.model.file import MODEL_SUFFIX, builtin_names
from fdvv.program.file import PROGRAM_SUFFIX
from fdvv.program.library import names_program
from fdvv_people.optimize.engines.registry import engine_names
from fdvv_people.study.plan.text_check import (
    Text,
    language_problems,
    name_problems,
    names_problems,
    number_problems,
    page_problems,
    page_texts,
    text_problems,
)
from fdvv_people.study.timing.plan import DESIGNED, Condition, TimingPlan

MOST_TRIALS = 2000
FIELDS = {"date": "", "person": ""}
"""What a reminder may name."""


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
    yield from name_problems("name", plan.name)
    groups = {
        "conditions": [one.name for one in plan.conditions],
        "pages": [page.name for page in plan.pages],
        "languages": plan.languages,
        "levels": plan.levels,
    }
    yield from names_problems(groups)


def _texts(plan: TimingPlan) -> Iterator[Text]:
    yield "title", plan.title, True
    yield "reminder", plan.reminder, plan.training is not None
    yield from page_texts(plan.pages)


def _pages(plan: TimingPlan) -> Iterator[str]:
    yield from page_problems(plan.pages)
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
