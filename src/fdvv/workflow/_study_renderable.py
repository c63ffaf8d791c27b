"""Whether everything that a study names can be rendered, found out before the first person."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from pathlib import Path

from msgspec import structs

from fdvv.errors import DeviceError, InputError
from fdvv.program import Limits
from fdvv.study import Item, LARGEST_ratio, Stimulus, StudyPlan
from fdvv.workflow._press_subject import PRESS_RIGS
from fdvv.workflow._study_program import trial_program
from fdvv.workflow._study_stage_subject import staged


def twin_problems(plan: StudyPlan, folder: Path, rig_name: str = PRESS_RIGS[0]) -> tuple[str, ...]:
    """List what of a study the twin cannot render, in one line each; empty if it renders all.

    folder : of the study, where its files are. rig_name : for stimuli with an actuation.
    """
    return tuple(
        problem
        for item in plan.items
        for stimulus in stimuli_of(plan, item)
        for problem in _tried(item, lambda: staged(stimulus, folder, rig_name))  # noqa: B023
    )


def device_problems(plan: StudyPlan, folder: Path, limits: Limits | None = None) -> tuple[str, ...]:
    """List the items whose labels a device cannot hold side by side, so that it could not hide a change.

    limits : of the rig; those of the paper's if None.
    """
    limits = limits or Limits()
    return tuple(
        problem
        for item in plan.items
        for problem in _tried(
            item,
            lambda: trial_program(_labels(plan, item), folder, limits),  # noqa: B023
        )
    )


def stimuli_of(plan: StudyPlan, item: Item) -> tuple[Stimulus, ...]:
    """Give all that is rendered of an item: what is compared, and its reference where that is rendered.

    The comparison of a staircase is the strongest one that it may come to.
    """
    stimuli = item.stimuli
    if plan.kind == "staircase" and len(stimuli) > 1:
        strongest = stimuli[1].force_ratio * (1.0 + LARGEST_ratio)
        stimuli = (stimuli[0], structs.replace(stimuli[1], force_ratio=strongest), *stimuli[2:])
    return stimuli if item.reference is None else (*stimuli, item.reference)


def _labels(plan: StudyPlan, item: Item) -> dict[str, Stimulus]:
    return {str(place): one for place, one in enumerate(stimuli_of(plan, item))}


def _tried(item: Item, work: Callable[[], object]) -> Iterator[str]:
    try:
        work()
    except (InputError, DeviceError) as error:
        yield f"item {item.name!r}: {error}"
