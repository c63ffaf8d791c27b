"""What is wrong with a plan that reads well: what could not be run, or not be analysed, as it says."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from pathlib import PurePosixPath

import msgspec

from fdvv.model.file import MODEL_SUFFIX, builtin_names
from fdvv_people.study.plan.plan import Item, Stimulus, StudyPlan
from fdvv_people.study.plan.plan_words import word_languages
from fdvv_people.study.plan.task import LABELS
from fdvv_people.study.plan.tasks import task_of
from fdvv_people.study.plan.text_check import (
    LANGUAGE,
    Text,
    language_problems,
    name_problems,
    names_problems,
    number_problems,
    page_problems,
    page_texts,
    text_problems,
)
from fdvv_people.study.plan.trial import EQUAL

ACTUATION_SUFFIX = ".actuation.json"
MOST_TRIALS = 2000  # the paper's 36 take an hour: so many are a slip in the plan


def _kind(plan: StudyPlan) -> Iterator[str]:
    """List where a plan does not fit its kind."""
    task = task_of(plan.kind)
    low, high = task.stimuli
    wanted = f"exactly {low}" if high == low else f"{low} to {high}, the reference among them"
    for item in plan.items:
        if not low <= len(item.stimuli) <= high:
            yield f"items ({item.name!r}): {plan.kind} needs {wanted} stimuli, got {len(item.stimuli)}"
    for item in plan.items:
        if item.reference and task.no_reference:
            yield f"items ({item.name!r}), reference: {plan.kind} has none: {task.no_reference}"
    for name, rule in (("staircase", plan.staircase), ("thresholds", plan.thresholds)):
        if rule and plan.kind != name:
            yield f"{name}: {plan.kind} has none"
    yield from task.problems(plan)


def _languages(plan: StudyPlan) -> Iterator[str]:
    """List text that is missing in a language, or there in one that is not declared."""
    yield from language_problems(plan.languages)
    for language in filter(LANGUAGE.fullmatch, plan.languages):
        if language not in word_languages(plan.kind) and language not in plan.question:
            known = ", ".join(word_languages(plan.kind))
            yield f"question: fdvv has no words in {language!r} (it has {known}); write question.{language}"
    yield from text_problems(_texts(plan), plan.languages)


def _texts(plan: StudyPlan) -> Iterator[Text]:
    """Return every text of a plan: its place, its words by language, and whether it must be there at all."""
    yield "title", plan.title, True
    yield "question", plan.question, False
    for rating in plan.ratings:
        place = f"ratings ({rating.name!r})"
        yield f"{place}, question", rating.question, True
        yield f"{place}, low", rating.low, False
        yield f"{place}, high", rating.high, False
    yield from page_texts(plan.pages)


def plan_problems(plan: StudyPlan) -> tuple[str, ...]:
    """List what is wrong, each as "place: reason"; empty where the plan can be run and analysed.

    Looks at the plan alone: whether the files it names are there and what they hold is for who has them.
    """
    return (
        *number_problems(plan, ""),
        *_names(plan),
        *_languages(plan),
        *(problem for item in plan.items for problem in _item(plan, item)),
        *page_problems(plan.pages, [(f"ratings ({one.name!r})", one.name) for one in plan.ratings]),
        *_colliding_names(plan),
        *_kind(plan),
        *_claim(plan),
        *_extent(plan),
    )


def is_file(button: str) -> bool:
    """Return whether a button's name is that of a file beside the study."""
    return button.endswith(MODEL_SUFFIX) or "/" in button or "\\" in button


def _names(plan: StudyPlan) -> Iterator[str]:
    if not plan.items:
        yield "items: there is none; write [[items]]"
    yield from name_problems("name", plan.name)
    groups: dict[str, Iterable[str]] = {
        "items": [item.name for item in plan.items],
        "ratings": [rating.name for rating in plan.ratings],
        "pages": [page.name for page in plan.pages],
        "languages": plan.languages,
    }
    groups |= {f"items ({i.name!r}), stimuli": [s.name for s in i.stimuli] for i in plan.items}
    yield from names_problems(groups)


def _item(plan: StudyPlan, item: Item) -> Iterator[str]:
    place = f"items ({item.name!r})"
    if [s.name for s in item.stimuli] != [s.name for s in plan.items[0].stimuli]:
        yield f"{place}: its stimuli must have the names and the order of the first item's"
    for stimulus in item.rendered:
        yield from _stimulus(f"{place}, {stimulus.name!r}", stimulus)
    seen: dict[Stimulus, str] = {}
    for stimulus in () if task_of(plan.kind).adaptive else item.stimuli:
        same = msgspec.structs.replace(stimulus, name="same")
        if same in seen:
            yield f"{place}: {seen[same]!r} and {stimulus.name!r} are one and the same rendering"
        seen[same] = stimulus.name


def _stimulus(place: str, stimulus: Stimulus) -> Iterator[str]:
    if stimulus.name.casefold() == EQUAL or stimulus.name.upper() in [*LABELS, "X"]:
        yield f"{place}: a stimulus may not be called {stimulus.name!r}, which is an answer or a label"
    if not is_file(stimulus.button) and stimulus.button not in builtin_names():
        known = ", ".join(builtin_names())
        yield f"{place}: {stimulus.button!r} is neither built in ({known}) nor a *{MODEL_SUFFIX} file"
    files = [(stimulus.button, MODEL_SUFFIX)] if is_file(stimulus.button) else []
    files += [(stimulus.actuation, ACTUATION_SUFFIX)] if stimulus.actuation else []
    for name, suffix in files:
        path = PurePosixPath(name)
        if path.is_absolute() or ".." in path.parts or "\\" in name or ":" in name or not name.isprintable():
            yield f"{place}: {name!r:.70} must lie beside the study or in a folder there, written with /"
        if not name.endswith(suffix):
            yield f"{place}: {name!r:.70} does not end in {suffix}"


def _colliding_names(plan: StudyPlan) -> Iterator[str]:
    stimuli = [s for item in plan.items for s in item.rendered]
    names = {n for s in stimuli for n in (s.button if is_file(s.button) else "", s.actuation) if n}
    for bare in sorted(names):
        if f"buttons/{bare}" in names:
            yield f"items: {bare!r} and 'buttons/{bare}' would be kept under one name; rename one"


def _claim(plan: StudyPlan) -> Iterator[str]:
    if not plan.claim or not plan.items:
        return
    names = [stimulus.name for stimulus in plan.items[0].stimuli]
    for name in (plan.claim.more, plan.claim.less):
        if name not in names:
            yield f"claim: {name!r} is not one of the stimuli ({', '.join(names)})"
    if plan.claim.more == plan.claim.less:
        yield "claim: more and less are the same stimulus"
    measures = [
        *(["choice"] if task_of(plan.kind).choices else []),
        *(rating.name for rating in plan.ratings),
    ]
    if plan.claim.measure not in measures:
        yield f"claim: measure {plan.claim.measure!r} is not asked (asked is {', '.join(measures)})"


def _extent(plan: StudyPlan) -> Iterator[str]:
    count = plan.trials + plan.practice
    if count > MOST_TRIALS:
        yield f"rounds: {count} trials of one person are more than {MOST_TRIALS}"
    if plan.break_every_min > 0 and plan.break_min == 0:
        yield "break_min: a break of no length; for no breaks write break_every_min = 0"
