"""Which change the next trial of a study of thresholds has, and what its trials say."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from msgspec import structs

from fdvv.model.noticeable import DIMENSIONS
from fdvv_people.study.plan.plan import Stimulus, Thresholds
from fdvv_people.thresholds.belief import Change, Trial
from fdvv_people.thresholds.choose import next_change
from fdvv_people.thresholds.estimate import ThresholdEstimate, estimate

PRACTICE_JND = 4.0
"""By how much of the expected JND a button grows in practice: nearly everybody feels it."""


def practice_change(rule: Thresholds, number: int) -> Change:
    """Return the change of a trial of practice: one dimension after the other, clearly felt."""
    grows = DIMENSIONS.index(rule.dimensions[number % len(rule.dimensions)])
    sizes = np.minimum(PRACTICE_JND * np.array(rule.expected_ratio.all), rule.largest_ratio.all)
    force, snap, vibration = np.where(np.arange(len(DIMENSIONS)) == grows, sizes, 0.0).tolist()
    return force, snap, vibration


def grown_stimulus(stimulus: Stimulus, change: Sequence[float]) -> Stimulus:
    """Return a stimulus whose force, snap and vibration have grown by a change."""
    force, snap, vibration = (1.0 + one for one in change)
    return structs.replace(
        stimulus,
        force_ratio=stimulus.force_ratio * force,
        snap_ratio=stimulus.snap_ratio * snap,
        vibration_ratio=stimulus.vibration_ratio * vibration,
    )


def largest_change(rule: Thresholds) -> Change:
    """Return the largest change of every dimension that is measured, 0 of the others."""
    force, snap, vibration = (
        largest if name in rule.dimensions else 0.0
        for name, largest in zip(DIMENSIONS, rule.largest_ratio.all, strict=True)
    )
    return force, snap, vibration


def trial_change(rule: Thresholds, history: Sequence[Trial]) -> Change:
    """Return the change of the trial after a history; it follows from the plan and the history alone."""
    return next_change(history, rule.prior, rule.dimensions, rule.largest_ratio.all, rule.combined)


def replayed_change(rule: Thresholds, answers: Sequence[bool]) -> Change:
    """Return the change of the trial after answers, right or not, whose own changes are found again."""
    history: list[Trial] = []
    for correct in answers:
        history.append((trial_change(rule, history), correct))
    return trial_change(rule, history)


def threshold_estimate(rule: Thresholds, history: Sequence[Trial]) -> ThresholdEstimate:
    """Return what a person's trials say of the JNDs that the rule measures."""
    return estimate(history, rule.prior, rule.dimensions)
