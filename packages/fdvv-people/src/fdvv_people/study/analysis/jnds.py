"""Just noticeable differences of people, from trials that were chosen by what they would say of them."""

from __future__ import annotations

from collections.abc import Mapping
from itertools import combinations
from pathlib import Path

import numpy as np

from fdvv.errors import InputError
from fdvv.model.landmarks import landmarks
from fdvv.model.model import FDVVModel
from fdvv.model.noticeable import DIMENSIONS, Dimension
from fdvv.units import FloatArray
from fdvv_people.study.analysis.ratings import spread_of
from fdvv_people.study.analysis.records import JndResult, JndSurface, Spread
from fdvv_people.study.plan.answers import Answers, means_by
from fdvv_people.study.plan.plan import StudyPlan, Thresholds
from fdvv_people.study.plan.threshold_trials import threshold_estimate
from fdvv_people.study.stimulus.renderer import stimulus_model
from fdvv_people.thresholds.belief import Trial

UNITS: Mapping[Dimension, str] = {"force": "cN", "snap": "cN", "vibration": "m/s²"}
PACE_mm_s = 100.0
"""Of presses, at which the standard's force, snap and vibration are read."""


def jnd_results(answers: Answers, rule: Thresholds | None) -> tuple[JndResult, ...]:
    """Estimate the JNDs of every person and button from the trials that count.

    rule : of the plan; without one the usual one, about the dimensions that were changed.
    """
    if answers.change is None:
        return ()
    rule = rule or Thresholds(dimensions=_grown(answers.change))
    counted = answers.counts & np.isfinite(answers.change).all(axis=1) & np.isfinite(answers.correct)
    keys = list(zip(answers.person.tolist(), answers.item.tolist(), strict=True))
    found = []
    for key in dict.fromkeys(keys):
        rows = counted & np.array([one == key for one in keys])
        if rows.any():
            found.append(_result(*key, answers.change[rows], answers.correct[rows], rule))
    return tuple(found)


def _grown(change: FloatArray) -> tuple[Dimension, ...]:
    grows = np.any(change > 0, axis=0)
    return tuple(one for one, there in zip(DIMENSIONS, grows, strict=True) if there)


def _result(person: str, button: str, change: FloatArray, correct: FloatArray, rule: Thresholds) -> JndResult:
    history: list[Trial] = []
    for (force, snap, vibration), right in zip(change.tolist(), correct.tolist(), strict=True):
        history.append(((force, snap, vibration), bool(right)))
    found = threshold_estimate(rule, history)
    surfaces = tuple(JndSurface(*pair, found.surface(*pair)) for pair in combinations(rule.dimensions, 2))
    return JndResult(person, button, found.jnds, surfaces, len(history), float(correct.mean()))


def jnds_over_people(found: tuple[JndResult, ...]) -> dict[Dimension, Spread]:
    """Summarise JNDs over people by dimension, buttons averaged first on the logarithm.

    Mean and interval are geometric; sd is that of the natural logarithm.
    """
    summary: dict[Dimension, Spread] = {}
    people = np.array([one.person for one in found])
    for name in found[0].jnds if found else ():
        spread = spread_of(means_by(np.log([one.jnds[name].ratio for one in found]), people))
        mean, low, high, median = np.exp([spread.mean, spread.low, spread.high, spread.median]).tolist()
        summary[name] = Spread(spread.people, mean, low, high, spread.sd, median)
    return summary


def standards_of(plan: StudyPlan, folder: Path) -> dict[str, dict[Dimension, float]]:
    """Return the sizes of every button of a study of thresholds, by button; without those not to be opened.

    folder : of the study.
    """
    found = {}
    for item in plan.items if plan.thresholds else ():
        try:
            found[item.name] = standard_sizes(stimulus_model(item.stimuli[0], folder))
        except InputError:
            continue  # ratios need no standard
    return found


def standard_sizes(model: FDVVModel) -> dict[Dimension, float]:
    """Return what a JND is a part of, in the units of `UNITS`, without what the button lacks.

    The force at the peak, or at bottom-out without one; the fall of force behind it; the largest amplitude
    of the vibration's modes.
    """
    marks = landmarks(model, PACE_mm_s)
    found: dict[Dimension, float] = {"force": marks.peak_cN or marks.bottom_out_cN}
    if marks.peak_cN is not None and marks.valley_cN is not None:
        found["snap"] = marks.peak_cN - marks.valley_cN
    vibration = model.vibration("press", PACE_mm_s)
    if vibration is not None:
        found["vibration"] = max(mode.amplitude_m_s2 for mode in vibration.modes)
    return found
