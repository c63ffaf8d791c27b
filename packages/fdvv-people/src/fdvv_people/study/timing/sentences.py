"""What a timing study found, in sentences: the verdict, and what to do next."""

from __future__ import annotations

import math

from fdvv_people.report.prose import interval_text, listed, p_text
from fdvv_people.study.timing.analyse import (
    ConditionMean,
    Rivalry,
    TimingAnalysis,
    better_of,
    people_needed,
)
from fdvv_people.study.timing.plan import TimingPlan
from fdvv_people.task.tapping import REPEAT_s

VISIBLE_ratio = 0.95
"""Of the presses of a key: where fewer are strokes of the finger, sentences say so."""


def measure_of(plan: TimingPlan) -> tuple[str, str]:
    """Return what a study scores, in words, and its unit."""
    return ("taps a second", "1/s") if plan.tapping else ("mean asynchrony", "ms")


def better_word(plan: TimingPlan) -> str:
    return "more taps a second" if plan.tapping else "a smaller mean asynchrony"


def verdict_sentence(found: TimingAnalysis) -> str:
    """Return what became of the claim, in one sentence."""
    plan = found.scores.plan
    simulated = "Simulated: " if found.simulated else ""
    if plan.claim is None:
        return f"{simulated}the study claims nothing; read its tables."
    if found.holds is None:
        return f"{simulated}the claim could not be tested: {'; '.join(found.notes) or 'too few people'}."
    won, open_, lost = _parted(found)
    best, word = better_of(plan), better_word(plan)
    if found.holds:
        return f"{simulated}the claim holds: {best} has {word} than {listed(_names(won))}{_rate_part(found)}."
    parts = [
        *([f"{word} than {listed(_names(won))}"] if won else ()),
        *([f"no reliable difference to {listed(_names(open_))}"] if open_ else ()),
        *([f"a worse score than {listed(_names(lost))}"] if lost else ()),
    ]
    return f"{simulated}the claim is not supported: {best} has {listed(parts)}{_rate_part(found)}."


def _parted(found: TimingAnalysis) -> tuple[list[Rivalry], list[Rivalry], list[Rivalry]]:
    """Return the rivals that the claimed condition beats, those it does not, and those that beat it."""
    plan = found.scores.plan
    alpha = plan.claim.alpha if plan.claim else 0.05
    sign = plan.task_of("easy").objectives[0].sign
    sure = [one for one in found.rivals if one.holm_p < alpha]
    won = [one for one in sure if sign * one.mixed.value.value < 0]
    return won, [one for one in found.rivals if one.holm_p >= alpha], [one for one in sure if one not in won]


def _names(rivals: list[Rivalry]) -> list[str]:
    return [one.rival for one in rivals]


def _rate_part(found: TimingAnalysis) -> str:
    rate = found.rate
    if rate is None:
        return ""
    word = {True: "reaches", False: "does not reach", None: "may or may not reach"}[rate.reached]
    value = interval_text(rate.rate_Hz, 2)
    own = [one for one in repeated(found) if one.condition == rate.condition]
    strokes = f", by {own[0].strokes_Hz:.2f} strokes of the finger" if own else ""
    return f"; its rate, {value} taps a second{strokes}, {word} the claimed {rate.at_least_Hz:g}"


def repeated(found: TimingAnalysis) -> tuple[ConditionMean, ...]:
    """Return the buttons of a tapping study that pressed their own key, visibly more than the finger did."""
    return tuple(one for one in found.means if one.strokes_Hz < VISIBLE_ratio * one.mean)


def strokes_sentence(found: TimingAnalysis) -> str:
    """Return how many strokes the finger made where the key went down more often; empty where it did not."""
    if not (own := repeated(found)):
        return ""
    strokes = listed([f"{one.strokes_Hz:.2f} on {one.condition}" for one in own])
    return (
        f"Not every press of a key is a stroke: those within {1e3 * REPEAT_s:.0f} ms of a stroke came from "
        f"the button, which kicked or bounced. The finger made {strokes} a second."
    )


def next_sentence(found: TimingAnalysis) -> str:
    """Return the next step."""
    scores = found.scores
    people, planned = len(scores.people), scores.plan.people
    if found.simulated:
        return "Nothing here is evidence. Declare the study anew, freeze it, and invite people."
    if people < planned:
        return f"{people} of {planned} planned people are in: this is a look in between, not the result."
    if found.holds:
        return "Report the contrasts with their intervals, and preserve the study's folder."
    open_ = _parted(found)[1]
    needed = [n for one in open_ if (n := people_needed(one, people)) is not None]
    if needed:
        return (
            f"About {max(needed)} people would find differences as large as the open ones seem, with a power "
            "of 0.8; plan that as a new study."
        )
    return "Report what was found; another claim needs a new study."


def rival_sentences(found: TimingAnalysis) -> tuple[str, ...]:
    """Return a sentence for every contrast of the mixed model."""
    _, unit = measure_of(found.scores.plan)
    return tuple(
        f"{one.better} minus {one.rival}: {interval_text(one.mixed.value, 2)} {unit}, "
        f"t({one.mixed.df}) = {one.mixed.t:.2f}, Holm's {p_text(one.holm_p)}."
        for one in found.rivals
    )


def gap_sentence(found: TimingAnalysis) -> str:
    """Return how long the gap was; empty where the study has none."""
    days = [row.gap_days for row in found.scores.rows if math.isfinite(row.gap_days)]
    if not days:
        return ""
    simulated = "simulated " if found.simulated else ""
    span = " to ".join(dict.fromkeys(f"{day:.1f}" for day in (min(days), max(days))))
    return f"The validation was {span} {simulated}days after the training."
