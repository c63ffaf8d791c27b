"""What each label of a trial makes felt, and how far its staircase has come. **Secret**, all of it."""

from __future__ import annotations

from collections.abc import Sequence

import msgspec

from fdvv.errors import ModelError
from fdvv.study import Answered, Item, SessionState, Stimulus, StudyPlan, StudyTrial, next_ratio


def trial_stimuli(plan: StudyPlan, trial: StudyTrial) -> dict[str, Stimulus]:
    """Give what is felt under each label, in the labels' order; X too where it is rendered.

    The comparison of a staircase, its second stimulus, is stronger by the trial's ratio.
    """
    item = item_of(plan, trial.item)
    named = {stimulus.name: stimulus for stimulus in item.stimuli}
    if plan.kind == "staircase":
        second = item.stimuli[1]
        ratio = second.force_ratio * (1.0 + trial.ratio)
        named[second.name] = msgspec.structs.replace(second, force_ratio=ratio)
    found = {label: named[name] for label, name in trial.labels.items()}
    reference = item.reference or (item.stimuli[0] if plan.kind == "mushra" else None)
    if reference and "X" not in found:
        found["X"] = reference
    return dict(sorted(found.items()))


def item_of(plan: StudyPlan, name: str) -> Item:
    """Give an item by its name. ModelError."""
    found = next((item for item in plan.items if item.name == name), None)
    if found is None:
        raise ModelError(f"the plan has no item {name}")
    return found


def with_ratio(
    plan: StudyPlan, schedule: Sequence[StudyTrial], state: SessionState, number: int
) -> StudyTrial:
    """Give a trial with the ratio that its staircase has come to; of other kinds it is as drawn."""
    trial = schedule[number]
    if plan.kind != "staircase" or plan.staircase is None or trial.practice:
        return trial
    ratio = next_ratio(plan.staircase, _history(plan, schedule, state, trial))
    if ratio is None:
        raise ModelError(f"the staircase of trial {number} has ended")
    return msgspec.structs.replace(trial, ratio=ratio)


def has_settled(plan: StudyPlan, schedule: Sequence[StudyTrial], state: SessionState, number: int) -> bool:
    """Tell whether the staircase of a trial has ended, with its answer if it has one."""
    trial = schedule[number]
    if plan.kind != "staircase" or plan.staircase is None or trial.practice:
        return False
    return next_ratio(plan.staircase, _history(plan, schedule, state, trial)) is None


def _history(
    plan: StudyPlan, schedule: Sequence[StudyTrial], state: SessionState, trial: StudyTrial
) -> list[tuple[float, bool]]:
    """Follow a staircase through its answered trials: ratios are not kept, they follow from the answers."""
    assert plan.staircase is not None
    history: list[tuple[float, bool]] = []
    for one in schedule:
        answered = state.answers.get(one.number)
        if answered and _same_staircase(one, trial):
            ratio = next_ratio(plan.staircase, history)
            assert ratio is not None
            history.append((ratio, _is_right(answered, one)))
    return history


def _same_staircase(one: StudyTrial, other: StudyTrial) -> bool:
    return not one.practice and (one.item, one.round) == (other.item, other.round)


def _is_right(answered: Answered, trial: StudyTrial) -> bool:
    return answered.answer.choice == trial.correct
