"""What each kind of study needs of its plan."""

from __future__ import annotations

from collections.abc import Iterator

import msgspec

from fdvv.study._plan import StudyPlan
from fdvv.study._schedule import LABELS


def kind_problems(plan: StudyPlan) -> Iterator[str]:
    """List where a plan does not fit its kind, each as "place: reason"."""
    yield from _counts(plan)
    yield from _references(plan)
    yield from _ratings(plan)
    yield from _staircase(plan)
    if plan.kind == "2ac" and not plan.ties:
        yield 'ties: 2ac asks "or no difference"; without ties it is kind = "2afc"'


def _counts(plan: StudyPlan) -> Iterator[str]:
    low, high = (3, len(LABELS)) if plan.kind == "mushra" else (2, 2)
    wanted = "exactly 2" if high == 2 else f"{low} to {high}, the reference among them"
    for item in plan.items:
        if not low <= len(item.stimuli) <= high:
            yield f"items ({item.name!r}): {plan.kind} needs {wanted} stimuli, got {len(item.stimuli)}"


def _references(plan: StudyPlan) -> Iterator[str]:
    """X is something of its own in the paper's task only."""
    reasons = {
        "abx": "X is one of the two stimuli",
        "mushra": "the first stimulus is the reference, named and hidden",
    }
    for item in plan.items:
        if item.reference and plan.kind != "realism":
            reason = reasons.get(plan.kind, "nothing is compared with a third")
            yield f"items ({item.name!r}), reference: {plan.kind} has none: {reason}"


def _ratings(plan: StudyPlan) -> Iterator[str]:
    if plan.kind == "mushra" and not plan.ratings:
        yield "ratings: mushra only rates; write [[ratings]], with points = 101 for a slider"
    if plan.kind == "staircase" and plan.ratings:
        yield "ratings: a staircase asks which one is stronger and nothing else"


def _staircase(plan: StudyPlan) -> Iterator[str]:
    if plan.kind != "staircase":
        if plan.staircase:
            yield f"staircase: {plan.kind} has none"
        return
    if plan.staircase is None:
        yield "staircase: there is none; write [staircase]"
    elif plan.staircase.dropped > plan.staircase.reversals - 2:
        yield "staircase: dropped must leave at least 2 of the reversals"
    if plan.claim:
        yield "claim: a staircase finds a threshold and decides nothing; leave it out"
    for item in plan.items:
        same = {msgspec.structs.replace(s, name="same", force_ratio=1.0) for s in item.stimuli}
        if len(same) > 1 or any(s.force_ratio != 1.0 for s in item.stimuli):
            reason = "both stimuli must be the same rendering; the staircase makes the second one stronger"
            yield f"items ({item.name!r}): {reason}"
