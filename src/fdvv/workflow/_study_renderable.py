"""Whether everything that a study names can be rendered, found out before the first person."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from pathlib import Path
from types import MappingProxyType

from msgspec import structs

from fdvv.errors import DeviceError, InputError
from fdvv.model import FDVVModel
from fdvv.program import Limits
from fdvv.study import Item, LARGEST_ratio, Stimulus, StudyPlan
from fdvv.workflow._press_subject import PRESS_RIGS
from fdvv.workflow._study_program import trial_program
from fdvv.workflow._study_stage_subject import staged


def twin_problems(
    plan: StudyPlan,
    folder: Path,
    rig_name: str = PRESS_RIGS[0],
    opened: Mapping[Stimulus, FDVVModel] = MappingProxyType({}),
) -> tuple[str, ...]:
    """List what of a study the twin cannot render, in one line each; empty if it renders all.

    folder : of the study, where its files are. rig_name : for stimuli with an actuation. opened : models
        of stimuli that were opened before.
    """
    return tuple(
        problem
        for item in plan.items
        for stimulus in _strongest(plan, item)
        for problem in _tried(item, lambda: staged(stimulus, folder, rig_name, opened.get(stimulus)))  # noqa: B023
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


def _strongest(plan: StudyPlan, item: Item) -> tuple[Stimulus, ...]:
    """Give all that is rendered of an item, the comparison of a staircase as strong as it may become."""
    rendered = item.rendered
    if plan.kind == "staircase" and len(item.stimuli) > 1:
        force_ratio = rendered[1].force_ratio * (1.0 + LARGEST_ratio)
        rendered = (rendered[0], structs.replace(rendered[1], force_ratio=force_ratio), *rendered[2:])
    return rendered


def _labels(plan: StudyPlan, item: Item) -> dict[str, Stimulus]:
    return {str(place): one for place, one in enumerate(_strongest(plan, item))}


def _tried(item: Item, work: Callable[[], object]) -> Iterator[str]:
    try:
        work()
    except (InputError, DeviceError) as error:
        yield f"item {item.name!r}: {error}"
