"""A readable account of a study before it is frozen: what a person goes through, and what will count."""

from __future__ import annotations

from dataclasses import asdict
from typing import Any

import msgspec

from fdvv.plot import Section, Table, render_html
from fdvv.study import (
    Item,
    Page,
    PlanAccount,
    StudyPlan,
    asked_texts,
    claim_text,
    exclusion_texts,
    item_orders,
    plan_account,
    question_line,
    reference_text,
    staircase_texts,
    stimulus_text,
    task_text,
)
from fdvv.workflow._study_look import StudyLook

SHOWN = 12
"""People whose orders are listed."""
ORDERS_WIDE = 84
"""Characters of a line that orders may take."""
EXCERPT = 60
"""Characters of a page's text that are shown."""
MEANT = "FD: one curve for all speeds, no vibration. FDVV: the whole model."


def preview_sections(look: StudyLook) -> tuple[Section, ...]:
    """Tell a study in sections of text and tables. For a plan without problems."""
    plan, account = look.plan, plan_account(look.plan)
    notes = (*look.notes, *account.notes)
    return (
        Section("A person", _person(plan, account), (), (_pages(plan),) if plan.pages else ()),
        Section("A trial", (task_text(plan), *staircase_texts(plan)), (), (_asked(plan),)),
        Section("Buttons", (), (), (_items(look),)),
        Section("Orders", _order_texts(plan, account), (), _orders(plan)),
        Section("What will not count", tuple(f"– {text}" for text in exclusion_texts(plan))),
        Section("The claim", (claim_text(plan),)),
        *([Section("To think about", tuple(f"– {note}" for note in notes))] if notes else ()),
    )


def preview_title(plan: StudyPlan) -> str:
    """Name a study with its title, in its first language."""
    return plan.title[plan.languages[0]]


def preview_summary(plan: StudyPlan) -> str:
    """Tell in a line what the study is."""
    languages = ", ".join(plan.languages)
    kind = f"kind {plan.kind}, {plan.people} people planned"
    return f"Study {plan.name!r}, {kind}, in {languages}. Nothing is drawn yet."


def preview_html(look: StudyLook) -> str:
    """Write the account as one page."""
    plan = look.plan
    return render_html(preview_title(plan), preview_summary(plan), preview_sections(look))


def preview_dict(look: StudyLook) -> dict[str, Any]:
    """Give the account for programs, the plan with every default filled in among it."""
    account = plan_account(look.plan)
    return {
        **asdict(account),
        "notes": [*look.notes, *account.notes],
        "differences_cN": look.differences_cN,
        "plan": msgspec.to_builtins(look.plan),
    }


def _person(plan: StudyPlan, account: PlanAccount) -> tuple[str, ...]:
    buttons = f"{len(plan.items)} buttons, {plan.rounds} rounds"
    if plan.staircase:
        count = len(plan.items) * plan.rounds
        trials = f"{count} staircases of at most {plan.staircase.trials} trials ({buttons})"
    else:
        trials = f"{account.trials} trials ({buttons})"
    practice = f"{account.practice} trials of practice, then " if account.practice else ""
    most = "at most " if plan.staircase else ""
    return (
        f"{practice}{trials}: {most}about {account.minutes:.0f} minutes, pages and breaks included "
        f"(assumed: {account.trial_s:.0f} s a trial).",
        _break_text(plan, account),
        f"Every change of what is rendered takes {plan.switch_s:g} s.",
    )


def _break_text(plan: StudyPlan, account: PlanAccount) -> str:
    if plan.break_every_min == 0:
        return "No breaks."
    due = {0: "none falls due", 1: "one falls due"}.get(account.breaks, f"{account.breaks} fall due")
    return (
        f"A break of {plan.break_min:g} minutes after the first trial that ends {plan.break_every_min:g} "
        f"minutes after the beginning or the last break: {due}."
    )


def _pages(plan: StudyPlan) -> Table:
    rows = [row for page in plan.pages for row in _page_rows(plan, page)]
    return Table(("page", "when", "what is on it"), tuple(rows), "Pages outside the trials.")


def _page_rows(plan: StudyPlan, page: Page) -> list[tuple[str, str, str]]:
    language = plan.languages[0]
    text = " ".join(page.text.get(language, "").split())
    told = [text[:EXCERPT] + "…" if len(text) > EXCERPT else text] if text else []
    told += ["asks for agreement"] if page.when == "consent" else []
    told += [question_line(question, language) for question in page.questions]
    rows = enumerate(told or [page.title[language]])
    return [("" if i else page.name, "" if i else page.when, line) for i, line in rows]


def _asked(plan: StudyPlan) -> Table:
    rows = []
    for language in plan.languages:
        lines = asked_texts(plan, language)
        rows += [(language if not i else "", line) for i, line in enumerate(lines)]
    return Table(("language", "asked"), tuple(rows), "What is asked in every trial.")


def _items(look: StudyLook) -> Table:
    rows = [row for item in look.plan.items for row in _item_rows(look, item)]
    if not look.differences_cN:
        return Table(("button", "what", "rendered"), tuple(row[:3] for row in rows), MEANT)
    told = f"{MEANT} Apart: rms difference of force of the two nearest, both strokes at 50 to 200 mm/s."
    return Table(("button", "what", "rendered", "apart (cN)"), tuple(rows), told)


def _item_rows(look: StudyLook, item: Item) -> list[tuple[str, str, str, str]]:
    x = reference_text(look.plan, item)
    rows = [("X", x)] if x else []
    rows += [(stimulus.name, stimulus_text(stimulus)) for stimulus in item.stimuli]
    apart = look.differences_cN.get(item.name)
    told = "" if apart is None else f"{apart:.1f}"
    return [(item.name if not i else "", *row, told if not i else "") for i, row in enumerate(rows)]


def _order_texts(plan: StudyPlan, account: PlanAccount) -> tuple[str, ...]:
    if account.places is None:
        return ("One button." if len(plan.items) == 1 else "Drawn at random for every round.",)
    assert account.follows is not None
    return (
        f"Williams' orders over people and rounds. With {plan.people} people each button stands "
        f"{_span(account.places)} in every place of a round, and follows every other one "
        f"{_span(account.follows)}.",
    )


def _orders(plan: StudyPlan) -> tuple[Table, ...]:
    """List orders of items, which are no secret; what labels hide is drawn when a person comes."""
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
