"""A plan in sentences, for people who decide whether it is what they mean. In English."""

from __future__ import annotations

import functools
import tomllib
from collections.abc import Iterator
from importlib import resources

from fdvv.force_text import force_text
from fdvv.model.noticeable import DIMENSIONS
from fdvv_people.study.plan.plan import Item, Question, Rating, Stimulus, StudyPlan
from fdvv_people.study.plan.staircase import target_share
from fdvv_people.study.plan.task import LABELS
from fdvv_people.study.plan.tasks import task_of

JND_share = 0.75
"""Of the comparisons that notice one just noticeable difference."""


@functools.cache
def _words() -> dict[str, dict[str, dict[str, str]]]:
    text = resources.files("fdvv_people.study").joinpath("words.toml").read_text(encoding="utf-8")
    found: dict[str, dict[str, dict[str, str]]] = tomllib.loads(text)
    return found


def word_languages(kind: str = "realism") -> tuple[str, ...]:
    """Return the languages that have words for the question of a kind."""
    return tuple(sorted(task_of(kind).question or _words()["question"]["realism"]))


def question_text(plan: StudyPlan, language: str) -> str:
    """Return what is asked in a trial: the plan's own words, or those of its kind.

    A plan without words of its own in a language without any gets English ones; `plan_problems` lists it.
    """
    return plan.question.get(language) or _said("question", plan.kind, language)


def equal_text(plan: StudyPlan, language: str) -> str:
    """Return the words on the answer "equal"; "" where it is not offered."""
    return _said("equal", plan.kind, language) if offers_equal(plan) else ""


def offers_equal(plan: StudyPlan) -> bool:
    return task_of(plan.kind).offers_equal(plan.ties)


def asks_choice(plan: StudyPlan) -> bool:
    """Return whether a label is chosen in a trial; MUSHRA only rates."""
    return bool(task_of(plan.kind).choices)


def _said(part: str, kind: str, language: str) -> str:
    own = task_of(kind).question if part == "question" else {}
    words = own or _words()[part].get(kind, _words()[part].get("realism", {}))
    return words.get(language) or words["en"]


def task_text(plan: StudyPlan) -> str:
    names = [stimulus.name for stimulus in plan.items[0].stimuli]
    rendered = [item.reference is not None for item in plan.items]
    x = "rendered too" if all(rendered) else "rendered for some buttons" if any(rendered) else "a real button"
    return task_of(plan.kind).sentence.format(
        x=x,
        names=", ".join(names[:-1]) + f" and {names[-1]}",
        first=names[0],
        last=names[-1],
        labels=f"A to {LABELS[len(names) - 1]}",
    )


def asked_texts(plan: StudyPlan, language: str) -> tuple[str, ...]:
    answers = " / ".join(filter(None, (*task_of(plan.kind).choices, equal_text(plan, language))))
    questions = [f"{question_text(plan, language)}" + (f" {answers}" if asks_choice(plan) else "")]
    return (*questions, *(rating_text(rating, language) for rating in plan.ratings))


def rating_text(rating: Rating, language: str) -> str:
    words = rating.low.get(language), rating.high.get(language)
    low, high = (
        f"{end} ({word})" if word else f"{end}" for end, word in zip(rating.ends, words, strict=True)
    )
    return f"{rating.question[language]} {low} to {high}"


def question_line(question: Question, language: str) -> str:
    if question.choices:
        answers = " / ".join(question.choices[language])
    elif question.low is not None or question.high is not None:
        low = "" if question.low is None else f" from {question.low:g}"
        high = "" if question.high is None else f" to {question.high:g}"
        answers = f"a number{low}{high}"
    else:
        answers = "free text"
    return f"{question.question[language]} {answers}{'' if question.required else ', may be left out'}"


def stimulus_text(stimulus: Stimulus) -> str:
    text = f"{stimulus.button}, {stimulus.rendered}"
    for name in DIMENSIONS:
        ratio = getattr(stimulus, f"{name}_ratio")
        if ratio != 1.0:
            text += f", {ratio:g} times the {name}"
    return text + (f", compensated by {stimulus.actuation}" if stimulus.actuation else "")


def reference_text(plan: StudyPlan, item: Item) -> str:
    """Return what X is for an item; "" where there is none."""
    if item.reference:
        return stimulus_text(item.reference)
    task = task_of(plan.kind)
    shown = task.shown_reference(item)
    return shown.name if shown else task.real_reference


def exclusion_texts(plan: StudyPlan) -> tuple[str, ...]:
    rules = plan.exclusion
    texts = [
        f"a trial in which half the presses of a rendering missed by over {force_text(rules.error_cN)}, rms"
    ]
    if rules.presses:
        times = "once" if rules.presses == 1 else f"{rules.presses} times"
        texts.append(f"a trial in which a rendering was pressed less than {times}")
    if rules.fault:
        texts.append("a trial in which the device fell into a fault")
    texts.append(f"a person who then lacks more than {100 * rules.share_missing:g} % of the trials")
    if asks_choice(plan):
        texts.append(f"a person who gave one label in more than {100 * rules.same_choice:g} % of the trials")
    else:
        texts.append(
            "a person who rated the hidden reference below "
            f"{rules.reference_points:g} in more than 15 % of the trials"
        )
    return tuple(texts)


def claim_text(plan: StudyPlan) -> str:
    claim = plan.claim
    if claim is None:
        rule = plan.staircase
        share = target_share(rule) if rule else JND_share if plan.thresholds else None
        found = "" if share is None else f"; thresholds are found at {100 * share:.1f} % correct"
        return f"None{found}."
    if claim.measure != "choice":
        text = f"{claim.more} is rated above {claim.less} in {claim.measure}"
    elif not task_of(plan.kind).names_stimulus:
        text = f"{claim.more} and {claim.less} can be discriminated"
    else:
        text = f"{claim.more} is chosen above {claim.less}"
    return f"{text}; two-sided, at a level of {claim.alpha:g}."


def adaptive_texts(plan: StudyPlan) -> Iterator[str]:
    """Return how a threshold is approached; nothing of plans that approach none."""
    yield from _staircase_texts(plan)
    rule = plan.thresholds
    if rule:
        largest = (f"{100 * getattr(rule.largest_ratio, one):g} % more {one}" for one in rule.dimensions)
        several = ", in every third trial in several" if rule.combined and len(rule.dimensions) > 1 else ""
        yield (
            f"{rule.trials} trials. The comparison grows in one of {', '.join(rule.dimensions)}{several}, "
            "each time by what is expected to say most of the just noticeable differences; at most by "
            f"{', '.join(largest)}."
        )


def _staircase_texts(plan: StudyPlan) -> Iterator[str]:
    rule = plan.staircase
    if rule:
        steps = ", then ".join(f"{step:g}" for step in rule.steps_ratio)
        yield (
            f"From {100 * rule.start_ratio:g} % more force; divided by the step after {rule.down} correct in "
            f"a row, multiplied by it after a mistake; steps {steps} after the turns."
        )
        yield (
            f"Ends at {rule.reversals} turns or {rule.trials} trials; "
            f"the first {rule.dropped} turns do not count."
        )
