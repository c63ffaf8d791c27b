"""What a study's stimuli differ by, as simulated participants would feel it."""

from __future__ import annotations

from pathlib import Path

from fdvv.errors import InputError
from fdvv.study import (
    Claim,
    FeltFeatures,
    Item,
    ItemEffect,
    PowerDesign,
    Senses,
    Stimulus,
    StudyPlan,
    felt_difference,
    felt_features,
)
from fdvv.workflow._study_stage import stimulus_model


def power_design(plan: StudyPlan, folder: Path, senses: Senses | None = None) -> PowerDesign:
    """Give what a plan's power hangs on: its claim, and how far what it compares is apart in every item.

    folder : of the files that the plan names. Raises InputError where there is no claim, or it is not about
    stimuli and ratings of the plan.
    """
    claim = claim_of(plan)
    effects = tuple(_effect(plan, item, claim, folder, senses or Senses()) for item in plan.items)
    return PowerDesign(plan.kind, effects, plan.rounds, plan.ties, claim.alpha, _points(plan, claim))


def reference_of(plan: StudyPlan, item: Item, first: Stimulus) -> Stimulus:
    """Give what X is: what the plan renders as X; else the real button, taken to be as its whole model says.

    first : whose button that is. In MUSHRA the first stimulus is the reference.
    """
    if plan.kind == "mushra":
        return item.stimuli[0]
    return item.reference or Stimulus(name="X", button=first.button)


def claim_of(plan: StudyPlan) -> Claim:
    """Give what a plan claims; of an ABX study without a claim, that its stimuli can be told apart.

    Raises InputError where there is no claim, or none that can be upheld.
    """
    if plan.kind == "staircase":
        reason = "a staircase finds a threshold and claims nothing"
        raise InputError(plan.name, "claim", reason, "try it out with fdvv study simulate")
    if plan.claim is None and plan.kind == "abx":
        less, more = plan.items[0].stimuli
        return Claim(more=more.name, less=less.name)
    if plan.claim is None:
        reason = "there is none, so there is nothing to find"
        raise InputError(plan.name, "claim", reason, "add [claim] with more, less and measure")
    if plan.kind in ("2afc", "2ac") and plan.claim.more != plan.items[0].stimuli[1].name:
        reason = f"what {plan.kind} asks for is the second stimulus, so more must be that one"
        raise InputError(plan.name, "claim", reason, "exchange more and less, or the stimuli")
    return plan.claim


def _effect(plan: StudyPlan, item: Item, claim: Claim, folder: Path, senses: Senses) -> ItemEffect:
    more, less = (_named(plan, item, name) for name in (claim.more, claim.less))
    reference = reference_of(plan, item, more)
    of_more, of_less, of_reference = (_features(one, folder, senses) for one in (more, less, reference))
    return ItemEffect(
        item.name,
        felt_difference(of_more, of_less, senses),
        felt_difference(of_more, of_reference, senses),
        felt_difference(of_less, of_reference, senses),
    )


def _features(stimulus: Stimulus, folder: Path, senses: Senses) -> FeltFeatures:
    return felt_features(stimulus_model(stimulus, folder), senses)


def _named(plan: StudyPlan, item: Item, name: str) -> Stimulus:
    found = [stimulus for stimulus in item.stimuli if stimulus.name == name]
    if not found:
        reason = f"{name!r} is no stimulus of the item {item.name!r}"
        raise InputError(plan.name, "claim", reason, "name stimuli that every item has")
    return found[0]


def _points(plan: StudyPlan, claim: Claim) -> int | None:
    """Give the points of the claim's rating; None where it is about choices."""
    if claim.measure == "choice":
        return None
    points = {rating.name: rating.points for rating in plan.ratings}
    if claim.measure not in points:
        raise InputError(plan.name, "claim", f"there is no rating {claim.measure!r}", 'name one, or "choice"')
    return points[claim.measure]
