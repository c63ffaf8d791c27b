"""Review a study before it is frozen: its file, and whether what it names can be rendered."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from itertools import combinations
from pathlib import Path
from types import MappingProxyType

import numpy as np
from msgspec import structs

from fdvv.errors import DeviceError, FdvvError, InputError
from fdvv.force_text import force_text
from fdvv.model.curve import Stroke
from fdvv.model.model import FDVVModel
from fdvv.program.surface import Limits
from fdvv_people.study.files.layout import BUTTONS, kept_path, named_files
from fdvv_people.study.plan.plan import Item, Stimulus, StudyPlan
from fdvv_people.study.plan.plan_check import plan_problems
from fdvv_people.study.plan.plan_file import read_plan
from fdvv_people.study.plan.staircase import LARGEST_ratio
from fdvv_people.study.plan.tasks import task_of
from fdvv_people.study.plan.threshold_trials import grown_stimulus, largest_change
from fdvv_people.study.stimulus.program import trial_program
from fdvv_people.study.stimulus.renderer import prepare_stimulus, stimulus_actuation, stimulus_model
from fdvv_studio.live.press_subject import TABLES_RIG

SPEEDS_mm_s = (50.0, 100.0, 150.0, 200.0)
"""Of presses at which renderings are compared: the paper's."""

STEP_mm = 0.05
ALIKE_cN = 1.0
"""Below this, rms, nobody is expected to feel a difference of force: 2 % of a light key."""


@dataclass(frozen=True)
class StudyReview:
    """What was found of a study.

    Attributes
    ----------
    plan, folder : of the study.
    problems : for which it cannot be run as it says. notes : what may not be meant.
    differences_cN : by item, how far apart its renderings are: rms of press and release over the paper's
        speeds, of the two that are nearest; none where they cannot be opened, or a threshold is sought.
    models : what of its stimuli could be opened.
    """

    plan: StudyPlan
    folder: Path
    problems: tuple[str, ...]
    notes: tuple[str, ...]
    differences_cN: dict[str, float]
    models: dict[Stimulus, FDVVModel]


def review_study(path: Path) -> StudyReview:
    """Read a study's file, or that in a folder, and open everything that it names.

    InputError where the file itself cannot be read; what is wrong inside is among the problems.
    """
    plan, file = read_plan(path)
    return review_plan(plan, file.parent)


def review_plan(plan: StudyPlan, folder: Path) -> StudyReview:
    """Open everything that a plan names. folder : of the study, where its files are."""
    problems, notes, differences = (
        list(plan_problems(plan)),
        list(_shadowed(plan, folder)),
        dict[str, float](),
    )
    opened = dict[Stimulus, FDVVModel]()
    known = tuple(problems)
    for item in plan.items:
        if any(problem.startswith(f"items ({item.name!r})") for problem in known):
            continue
        try:
            models = {s: opened.get(s) or _opened(s, folder) for s in item.rendered}
            _check_growth(plan, item, folder)
        except FdvvError as error:
            problems.append(f"items ({item.name!r}): {error}")
            continue
        opened |= models
        if not task_of(plan.kind).adaptive:
            problems += _alike(item, models)
            differences[item.name] = least_difference_cN([models[s] for s in item.stimuli])
        notes += _doubts(item, differences.get(item.name))
    return StudyReview(plan, folder, tuple(dict.fromkeys(problems)), tuple(notes), differences, opened)


def _check_growth(plan: StudyPlan, item: Item, folder: Path) -> None:
    """Raise InputError on a button that cannot grow as far as thresholds may ask of it."""
    if plan.thresholds:
        for stimulus in _strongest(plan, item):
            stimulus_model(stimulus, folder)


def least_difference_cN(models: list[FDVVModel]) -> float:
    """Return the rms difference of force of the two models that are nearest to each other."""
    return min((_difference_cN(*pair) for pair in combinations(models, 2)), default=0.0)


def _shadowed(plan: StudyPlan, folder: Path) -> Iterator[str]:
    try:
        names = named_files(plan)
    except InputError:
        return  # reported with its item
    for name in names:
        beside, kept = folder / name, kept_path(folder, name)
        if (
            beside != kept
            and beside.is_file()
            and kept.is_file()
            and beside.read_bytes() != kept.read_bytes()
        ):
            yield f"{name} beside the study differs from the one in {BUTTONS}/, and that one is rendered"


def _opened(stimulus: Stimulus, folder: Path) -> FDVVModel:
    """Open a stimulus as it will be rendered, its actuation too. InputError."""
    model = stimulus_model(stimulus, folder)
    if stimulus.actuation:
        stimulus_actuation(stimulus, folder, model)
    return model


def _alike(item: Item, models: dict[Stimulus, FDVVModel]) -> Iterator[str]:
    for one, other in combinations(item.stimuli, 2):
        if models[one].renamed("same") == models[other].renamed("same") and one.actuation == other.actuation:
            why = "its model has one speed and no vibration" if one.button == other.button else "same models"
            yield f"items ({item.name!r}): {one.name!r} and {other.name!r} feel the same: {why}"


def _doubts(item: Item, difference_cN: float | None) -> Iterator[str]:
    if difference_cN is not None and difference_cN < ALIKE_cN:
        yield (
            f"items ({item.name!r}): forces of two renderings differ by {force_text(difference_cN, '.2f')} "
            "only, rms; "
            "if vibration does not tell them apart, nothing does"
        )
    if len({bool(stimulus.actuation) for stimulus in item.rendered}) > 1:
        yield f"items ({item.name!r}): some renderings have an actuation and others none; on a rig that tells"


def _difference_cN(one: FDVVModel, other: FDVVModel) -> float:
    """Return the rms difference of force over both strokes, the paper's speeds and the longer travel."""
    x = np.arange(0.0, max(one.travel_mm, other.travel_mm), STEP_mm)
    v = np.array(SPEEDS_mm_s)[:, np.newaxis]
    found = [_force_cN(one, x, v, stroke) - _force_cN(other, x, v, stroke) for stroke in Stroke]
    return float(np.sqrt(np.mean(np.square(found))))


def _force_cN(model: FDVVModel, x: np.ndarray, v: np.ndarray, stroke: Stroke) -> np.ndarray:
    return np.asarray(model.force_cN(x, v, stroke if model.of(stroke) else Stroke.PRESS))


def twin_problems(
    plan: StudyPlan,
    folder: Path,
    rig_name: str = TABLES_RIG,
    opened: Mapping[Stimulus, FDVVModel] = MappingProxyType({}),
) -> tuple[str, ...]:
    """List what of a study the twin cannot render, in one line each; empty if it renders all.

    folder : of the study, where its files are. rig_name : for stimuli with an actuation. opened : models
        of stimuli that were opened before.
    """
    problems: list[str] = []
    for item in plan.items:
        for stimulus in _strongest(plan, item):
            try:
                prepare_stimulus(stimulus, folder, rig_name, opened.get(stimulus))
            except (InputError, DeviceError) as error:
                problems.append(f"item {item.name!r}: {error}")
    return tuple(problems)


def device_problems(plan: StudyPlan, folder: Path, limits: Limits | None = None) -> tuple[str, ...]:
    """List the items whose labels a device cannot hold side by side, so that it could not hide a change.

    limits : of the rig; those of the paper's if None.
    """
    problems: list[str] = []
    for item in plan.items:
        labels = {str(place): stimulus for place, stimulus in enumerate(_strongest(plan, item))}
        try:
            trial_program(labels, folder, limits or Limits())
        except (InputError, DeviceError) as error:
            problems.append(f"item {item.name!r}: {error}")
    return tuple(problems)


def _strongest(plan: StudyPlan, item: Item) -> tuple[Stimulus, ...]:
    rendered = item.rendered
    # the second stimulus grows, up to this: then it must still be renderable
    if plan.thresholds and len(item.stimuli) > 1:
        return (rendered[0], grown_stimulus(rendered[1], largest_change(plan.thresholds)), *rendered[2:])
    if plan.staircase and len(item.stimuli) > 1:
        force_ratio = rendered[1].force_ratio * (1.0 + LARGEST_ratio)
        rendered = (rendered[0], structs.replace(rendered[1], force_ratio=force_ratio), *rendered[2:])
    return rendered
