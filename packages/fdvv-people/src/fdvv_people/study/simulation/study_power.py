"""The power of a study's claim, from its file: what a number of people could show. Simulated."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

import msgspec

from fdvv.errors import InputError
from fdvv_people.study.plan.plan import Claim, Item, Stimulus, StudyPlan
from fdvv_people.study.plan.plan_file import check_plan, read_plan
from fdvv_people.study.plan.tasks import task_of
from fdvv_people.study.simulation.people import ProxySettings
from fdvv_people.study.simulation.perception import (
    HapticFeatures,
    Senses,
    haptic_features,
    perceived_difference,
)
from fdvv_people.study.simulation.power import ItemEffect, PowerDesign, PowerTable, power_table
from fdvv_people.study.stimulus.renderer import stimulus_model

SHARE_NAMES = ("for", "equal", "against")


def power_design(plan: StudyPlan, folder: Path, senses: Senses | None = None) -> PowerDesign:
    """Return what a plan's power hangs on: its claim, and how far what it compares is apart in every item.

    folder : of the files that the plan names. Raises InputError where there is no claim, or it is not about
    stimuli and ratings of the plan.
    """
    claim = claim_of(plan)
    effects = tuple(_effect(plan, item, claim, folder, senses or Senses()) for item in plan.items)
    return PowerDesign(plan.kind, effects, plan.rounds, plan.ties, claim.alpha, _points(plan, claim))


def reference_of(plan: StudyPlan, item: Item, first: Stimulus) -> Stimulus:
    """Return the stimulus that X is: rendered, or the real button, taken to be as its whole model.

    first : whose button that is. In MUSHRA the first stimulus is the reference.
    """
    return task_of(plan.kind).shown_reference(item) or Stimulus(name="X", button=first.button)


def claim_of(plan: StudyPlan) -> Claim:
    """Return what a plan claims; of an ABX study without a claim, that its stimuli can be discriminated.

    Raises InputError where there is no claim, or none that can be upheld.
    """
    task = task_of(plan.kind)
    if task.no_power:
        raise InputError(plan.name, "claim", task.no_power, "try it out with fdvv study simulate")
    if plan.claim is None and task.hides_x:
        less, more = plan.items[0].stimuli
        return Claim(more=more.name, less=less.name)
    if plan.claim is None:
        reason = "there is none, so there is nothing to find"
        raise InputError(plan.name, "claim", reason, "add [claim] with more, less and measure")
    if task.asks_second and plan.claim.more != plan.items[0].stimuli[1].name:
        reason = f"what {plan.kind} asks for is the second stimulus, so more must be that one"
        raise InputError(plan.name, "claim", reason, "exchange more and less, or the stimuli")
    return plan.claim


def _effect(plan: StudyPlan, item: Item, claim: Claim, folder: Path, senses: Senses) -> ItemEffect:
    more, less = (_named(plan, item, name) for name in (claim.more, claim.less))
    reference = reference_of(plan, item, more)
    compared = (more, less, reference)
    of_more, of_less, of_reference = (stimulus_features(one, folder, senses) for one in compared)
    return ItemEffect(
        item.name,
        perceived_difference(of_more, of_less, senses),
        perceived_difference(of_more, of_reference, senses),
        perceived_difference(of_less, of_reference, senses),
    )


def stimulus_features(stimulus: Stimulus, folder: Path, senses: Senses) -> HapticFeatures:
    return haptic_features(stimulus_model(stimulus, folder), senses)


def _named(plan: StudyPlan, item: Item, name: str) -> Stimulus:
    found = [stimulus for stimulus in item.stimuli if stimulus.name == name]
    if not found:
        reason = f"{name!r} is no stimulus of the item {item.name!r}"
        raise InputError(plan.name, "claim", reason, "name stimuli that every item has")
    return found[0]


def _points(plan: StudyPlan, claim: Claim) -> int | None:
    """Return the points of the claim's rating; None where it is about choices."""
    if claim.measure == "choice":
        return None
    points = {rating.name: rating.points for rating in plan.ratings}
    if claim.measure not in points:
        raise InputError(plan.name, "claim", f"there is no rating {claim.measure!r}", 'name one, or "choice"')
    return points[claim.measure]


@dataclass(frozen=True, eq=False)
class StudyPower:
    """What a plan can show. **Simulated**: the word of proxies, for planning; never evidence.

    Attributes
    ----------
    plan : that it is of. table : see there. given_JND : difference that was assumed; None: as the proxies
        feel the plan's own stimuli.
    """

    plan: StudyPlan
    table: PowerTable
    given_JND: float | None = None

    def to_dict(self) -> dict[str, Any]:
        return {
            "simulated": True,
            "study": self.plan.name,
            "kind": self.plan.kind,
            "planned_people": self.plan.people,
            "claim": msgspec.to_builtins(claim_of(self.plan)),
            "test": "signed rank of people's means, exact, two-sided",
            "studies": self.table.studies,
            "seed": self.table.seed,
            "given_JND": self.given_JND,
            "enough_people": self.table.enough(),
            "items": self._items(),
            "rows": [asdict(row) for row in self.table.rows],
            "proxy": asdict(self.table.settings),
        }

    def _items(self) -> list[dict[str, Any]]:
        found = []
        for effect, shares in zip(self.table.design.effects, self.table.shares.tolist(), strict=True):
            between = effect.between
            parts = {"force_JND": between.force_JND, "speed_JND": between.speed_JND}
            parts |= {"vibration_JND": between.vibration_JND, "total_JND": between.total_JND}
            values = (share if math.isfinite(share) else None for share in shares)
            found.append({"item": effect.item, **parts, **dict(zip(SHARE_NAMES, values, strict=True))})
        return found


def study_power(
    path: Path,
    people: Sequence[int],
    studies: int = 2000,
    seed: int = 0,
    settings: ProxySettings | None = None,
    given_JND: float | None = None,
    progress: Callable[[str, int, int], None] = lambda _label, _done, _total: None,
) -> StudyPower:
    """Plan a study: the power of its claim for every number of people.

    path : the file of a study, or its folder. given_JND : one difference for all items in place of what the
    proxies feel. The rest as in power_table. InputError on a plan that cannot be read or claims nothing.
    """
    settings = settings or ProxySettings()
    plan, folder = open_plan(path)
    design = power_design(plan, folder, settings.senses)
    design = design if given_JND is None else design.of_size(given_JND)
    return StudyPower(
        plan, power_table(design, people, studies, seed, settings, progress=progress), given_JND
    )


def open_plan(path: Path) -> tuple[StudyPlan, Path]:
    """Read and check the plan of a file, or of a study's folder; return its folder too. InputError."""
    plan, file = read_plan(path)
    check_plan(plan, file)
    return plan, file.parent
