"""A readable preview of a study before it is frozen: what a person goes through, and what will count."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import asdict, dataclass
from itertools import pairwise
from typing import Any

import msgspec
import numpy as np

from fdvv.force_text import force_number, force_unit
from fdvv.report.report import Section, Table, render_html
from fdvv_people.stats.orders import williams_orders
from fdvv_people.study.admin.review import StudyReview
from fdvv_people.study.kind import Account
from fdvv_people.study.plan import plan_words
from fdvv_people.study.plan.plan import StudyPlan
from fdvv_people.study.plan.schedule import item_orders
from fdvv_people.study.plan.tasks import task_of

PAGE_s, QUESTION_s = 60.0, 10.0
"""What a page and each question on it takes (assumed)."""

SHARE = 0.7
"""Of answers for the claim, in truth: what a study is sized for."""
ALIKE = 0.1
"""How alike the answers of one person are (intraclass correlation, assumed)."""

SHOWN = 12
"""People whose orders are listed."""

ORDERS_WIDE = 84
"""Characters of a line that orders may take."""

EXCERPT = 60
"""Characters of a page's text that are shown."""

MEANT = "FD: one curve for all speeds, no vibration. FDVV: the whole model."


@dataclass(frozen=True)
class PlanSummary:
    """What one person goes through, and how well the whole is balanced.

    Attributes
    ----------
    trials : of a person without practice, at most. trial_s : that one takes (assumed). breaks : that fall
        due. minutes : of a person, pages and breaks included.
    places, follows : fewest and most times that a button has a place in a round, and that it follows
        another one, over all people and rounds; None where orders are random or there is one button.
    notes : what is allowed but may not be meant.
    """

    trials: int
    practice: int
    trial_s: float
    breaks: int
    minutes: float
    places: tuple[int, int] | None
    follows: tuple[int, int] | None
    notes: tuple[str, ...]


def summarise_plan(plan: StudyPlan) -> PlanSummary:
    """Work out what a checked plan comes to."""
    task = task_of(plan.kind)
    trial_s = task.trial_s + task.stimulus_s * len(plan.items[0].stimuli)
    breaks = _breaks(plan, trial_s)
    page_s = sum(PAGE_s + QUESTION_s * len(page.questions) for page in plan.pages)
    whole_s = page_s + (plan.trials + plan.practice) * trial_s + 60.0 * breaks * plan.break_min
    places, follows = _balance(plan)
    notes = tuple(_notes(plan, places))
    return PlanSummary(plan.trials, plan.practice, trial_s, breaks, whole_s / 60.0, places, follows, notes)


def _breaks(plan: StudyPlan, trial_s: float) -> int:
    if plan.break_every_min == 0:
        return 0
    # the first trial that ends after so long
    between = max(1, -int(-60.0 * plan.break_every_min // trial_s))
    return max(0, (plan.trials + plan.practice - 1) // between)


def _balance(plan: StudyPlan) -> tuple[tuple[int, int] | None, tuple[int, int] | None]:
    count = len(plan.items)
    if plan.order == "random" or count == 1:
        return None, None
    orders = [order for person in range(plan.people) for order in item_orders(plan, person)]
    places = Counter((place, one) for order in orders for place, one in enumerate(order))
    follows = Counter(pair for order in orders for pair in pairwise(order))
    stood = [places[place, one] for place in range(count) for one in range(count)]
    followed = [follows[one, other] for one in range(count) for other in range(count) if one != other]
    return (min(stood), max(stood)), (min(followed), max(followed))


def _notes(plan: StudyPlan, places: tuple[int, int] | None) -> Iterator[str]:
    if places and places[0] != places[1]:
        rows = len(williams_orders(len(plan.items)))
        yield (
            f"orders are not balanced exactly: people times rounds would have to be a multiple of {rows}, "
            f"{plan.people} times {plan.rounds} is {plan.people * plan.rounds}"
        )
    if not any(page.when == "consent" for page in plan.pages):
        yield "there is no consent page"
    task = task_of(plan.kind)
    if plan.claim is None and not task.adaptive:
        yield "there is no claim: what is tested is then chosen after the answers are seen"
    if plan.rounds == 2 and task.choices and not task.adaptive:
        yield "with two rounds, who sees through a label of the first knows that of the second"
    if plan.practice == 0:
        yield "there is no practice: first trials differ from later ones"
    if plan.switch_s == 0:
        yield "switch_s = 0: how long a change of what is rendered takes may tell which it is"
    yield from task.doubts(plan)


def planned_power(plan: StudyPlan) -> float | None:
    """Return the power to find that SHARE of the answers are for a claim about choices; None of any other.

    Exact binomial, two-sided at the claim's level, of as many independent answers as those of all people come
    to; nobody answers "equal". `fdvv study power` simulates people instead.
    """
    from scipy.stats import binom

    from fdvv_people.stats.share import binomial_p

    task = task_of(plan.kind)
    if plan.claim is None or plan.claim.measure != "choice" or task.adaptive or not task.choices:
        return None
    n = max(2, round(plan.people * plan.trials / (1 + (plan.trials - 1) * ALIKE)))
    counts = np.arange(math.floor(n / 2) + 1, n + 1)
    found = counts[binomial_p(counts, np.full_like(counts, n)) <= plan.claim.alpha]
    return float(binom.pmf(found, n, SHARE).sum())


def account_of(review: StudyReview) -> Account:
    """Return what a plan comes to, or what is wrong with it."""
    if review.problems:
        return Account(review.problems, review.notes)
    plan, summary = review.plan, summarise_plan(review.plan)
    trials = f"{summary.trials} trial{'s' * (summary.trials != 1)} a person"
    text = f"{trials}, about {summary.minutes:.0f} minutes (assumed), {plan.people} people"
    return Account((), (*review.notes, *summary.notes), text, preview_sections(review))


def preview_sections(review: StudyReview) -> tuple[Section, ...]:
    """Return a study in sections of text and tables. For a plan without problems."""
    plan, summary = review.plan, summarise_plan(review.plan)
    notes = (*review.notes, *summary.notes)
    trial = (plan_words.task_text(plan), *plan_words.adaptive_texts(plan))
    return (
        Section("A person", _person(plan, summary), (), (_pages(plan),) if plan.pages else ()),
        Section("A trial", trial, (), (_questions(plan),)),
        Section("Buttons", (), (), (_items(review),)),
        Section("Orders", _order_texts(plan, summary), (), _orders(plan)),
        Section("What will not count", tuple(f"– {text}" for text in plan_words.exclusion_texts(plan))),
        Section("The claim", (plan_words.claim_text(plan),)),
        *([Section("To think about", tuple(f"– {note}" for note in notes))] if notes else ()),
    )


def preview_title(plan: StudyPlan) -> str:
    """Name a study with its title, in its first language."""
    return plan.title[plan.languages[0]]


def preview_summary(plan: StudyPlan) -> str:
    languages = ", ".join(plan.languages)
    kind = f"kind {plan.kind}, {plan.people} people planned"
    return f"Study {plan.name!r}, {kind}, in {languages}. Nothing is drawn yet."


def preview_html(review: StudyReview) -> str:
    plan = review.plan
    return render_html(preview_title(plan), preview_summary(plan), preview_sections(review))


def preview_dict(review: StudyReview) -> dict[str, Any]:
    """Return the preview for programs, the plan with every default filled in among it."""
    summary = summarise_plan(review.plan)
    return {
        **asdict(summary),
        "notes": [*review.notes, *summary.notes],
        "differences_cN": review.differences_cN,
        "plan": msgspec.to_builtins(review.plan),
    }


def _person(plan: StudyPlan, summary: PlanSummary) -> tuple[str, ...]:
    buttons = f"{len(plan.items)} buttons, {plan.rounds} rounds"
    if plan.staircase:
        count = len(plan.items) * plan.rounds
        trials = f"{count} staircases of at most {plan.staircase.trials} trials ({buttons})"
    else:
        trials = f"{summary.trials} trials ({buttons})"
    practice = f"{summary.practice} trials of practice, then " if summary.practice else ""
    most = "at most " if plan.staircase else ""
    return (
        f"{practice}{trials}: {most}about {summary.minutes:.0f} minutes, pages and breaks included "
        f"(assumed: {summary.trial_s:.0f} s a trial).",
        _break_text(plan, summary),
        f"Every change of what is rendered takes {plan.switch_s:g} s.",
    )


def _break_text(plan: StudyPlan, summary: PlanSummary) -> str:
    if plan.break_every_min == 0:
        return "No breaks."
    due = {0: "none falls due", 1: "one falls due"}.get(summary.breaks, f"{summary.breaks} fall due")
    return (
        f"A break of {plan.break_min:g} minutes after the first trial that ends {plan.break_every_min:g} "
        f"minutes after the beginning or the last break: {due}."
    )


def _pages(plan: StudyPlan) -> Table:
    language, rows = plan.languages[0], list[tuple[str, ...]]()
    for page in plan.pages:
        text = " ".join(page.text.get(language, "").split())
        lines = [text[:EXCERPT] + "…" if len(text) > EXCERPT else text] if text else []
        lines += ["asks for agreement"] if page.when == "consent" else []
        lines += [plan_words.question_line(question, language) for question in page.questions]
        rows += _named([page.name, page.when], [[line] for line in lines or [page.title[language]]])
    return Table(("page", "when", "what is on it"), tuple(rows), "Pages outside the trials.")


def _named(names: Sequence[str], rows: Sequence[Sequence[str]]) -> list[tuple[str, ...]]:
    """Put names before the first of some rows, and blanks before the others."""
    return [(*(names if i == 0 else [""] * len(names)), *row) for i, row in enumerate(rows)]


def _questions(plan: StudyPlan) -> Table:
    rows = list[tuple[str, ...]]()
    for language in plan.languages:
        rows += _named([language], [[line] for line in plan_words.asked_texts(plan, language)])
    return Table(("language", "asked"), tuple(rows), "What is asked in every trial.")


def _items(review: StudyReview) -> Table:
    rows = list[tuple[str, ...]]()
    for item in review.plan.items:
        x = plan_words.reference_text(review.plan, item)
        what = [["X", x]] if x else []
        what += [[stimulus.name, plan_words.stimulus_text(stimulus)] for stimulus in item.stimuli]
        rows += _named([item.name], what)
    if not review.differences_cN:
        return Table(("button", "what", "rendered"), tuple(rows), MEANT)
    apart = {name: force_number(value, ".1f") for name, value in review.differences_cN.items()}
    caption = f"{MEANT} Apart: rms difference of force of the two nearest, both strokes at 50 to 200 mm/s."
    columns = ("button", "what", "rendered", f"apart ({force_unit()})")
    return Table(columns, tuple((*row, apart.get(row[0], "")) for row in rows), caption)


def _order_texts(plan: StudyPlan, summary: PlanSummary) -> tuple[str, ...]:
    if summary.places is None:
        return ("One button." if len(plan.items) == 1 else "Drawn at random for every round.",)
    assert summary.follows is not None
    return (
        f"Williams' orders over people and rounds. With {plan.people} people each button stands "
        f"{_span(summary.places)} in every place of a round, and follows every other one "
        f"{_span(summary.follows)}.",
    )


def _orders(plan: StudyPlan) -> tuple[Table, ...]:
    if plan.order == "random" or len(plan.items) == 1:
        return ()
    shown = max(1, min(plan.rounds, ORDERS_WIDE // (max(2 * len(plan.items) - 1, 8) + 2)))
    rows = tuple(
        (
            f"{person + 1}",
            *("-".join(f"{i + 1}" for i in order) for order in item_orders(plan, person)[:shown]),
        )
        for person in range(min(plan.people, SHOWN))
    )
    columns = ("person", *(f"round {i + 1}" for i in range(shown)))
    named = ", ".join(f"{i + 1} {item.name}" for i, item in enumerate(plan.items))
    return (Table(columns, rows, f"Orders of buttons in the first rounds and people: {named}."),)


def _span(counts: tuple[int, int]) -> str:
    low, high = counts
    return f"{low} times" if low == high else f"{low} to {high} times"
