"""What a study of thresholds or staircases measured, as the file by which a project judges."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np

from fdvv.errors import InputError
from fdvv.model.jnd_file import JndRecord, MeasuredJnd
from fdvv.model.model import FDVVModel
from fdvv.model.noticeable import DIMENSIONS, Dimension, acceleration_above_threshold
from fdvv_people.study.admin.study import Study
from fdvv_people.study.analysis.analyse import analyse
from fdvv_people.study.analysis.jnds import PACE_mm_s, standard_sizes
from fdvv_people.study.analysis.ratings import spread_of
from fdvv_people.study.analysis.read_answers import read_answers
from fdvv_people.study.analysis.records import StudyAnalysis
from fdvv_people.study.plan.answers import means_by
from fdvv_people.study.plan.plan import Item, StudyPlan
from fdvv_people.study.plan.plan_words import JND_share, question_text
from fdvv_people.study.plan.staircase import target_share
from fdvv_people.study.plan.tasks import task_of
from fdvv_people.study.stimulus.renderer import stimulus_model

RATE_Hz = 8000.0
"""At which a vibration is sampled to say how far above the faintest it is."""

Found = tuple[str, float, float | None, float | None, int]
"""Of one staircase, or of one person's trials: the person, the threshold with its interval, the trials."""


def jnd_record(study: Study) -> JndRecord:
    """Return what an unsealed study measured. InputError where it measures no JND, or found none."""
    plan, folder = study.plan, study.folder
    if not task_of(plan.kind).adaptive:
        reason = f"a study of kind {plan.kind} measures no JND"
        raise InputError(folder, "study", reason, "name one of kind staircase or thresholds")
    share = _share_correct(plan, folder)
    found = analyse(read_answers(folder), plan)
    jnds = [
        jnd
        for item in plan.items
        for dimension in DIMENSIONS
        if (jnd := _measured(item, dimension, folder, _thresholds(found, item.name, dimension))) is not None
    ]
    if not jnds:
        raise InputError(folder, "study", "no threshold was found in its answers", "measure more people")
    return JndRecord(
        format="fdvv-jnds",
        version=1,
        study=plan.name,
        kind=plan.kind,
        fingerprint=study.fingerprint,
        simulated=found.simulated,
        task=question_text(plan, plan.languages[0]),
        share_correct=share,
        velocity_mm_s=PACE_mm_s,
        people=max(one.people for one in jnds),
        trials=int(found.screening.counted),
        jnds=jnds,
    )


def _share_correct(plan: StudyPlan, folder: Path) -> float:
    if plan.staircase is None:
        return JND_share
    if plan.staircase.down == 1:
        reason = "1 down settles where answers are right by chance, which is no JND"
        raise InputError(folder, "staircase.down", reason, "declare a study with 2 or 3 down")
    return target_share(plan.staircase)


def _thresholds(found: StudyAnalysis, button: str, dimension: Dimension) -> list[Found]:
    """Return the thresholds of a button in one dimension that were found, in the order of the answers."""
    jnds = [
        (one.person, one.jnds[dimension])
        for one in found.jnds
        if one.button == button and dimension in one.jnds
    ]
    thresholds: list[Found] = [(person, jnd.ratio, jnd.low, jnd.high, jnd.trials) for person, jnd in jnds]
    if dimension == "force":
        thresholds += [
            (one.person, one.threshold.value, one.threshold.low, one.threshold.high, one.ratios.size)
            for one in found.thresholds
            if one.button == button and np.isfinite(one.threshold.value)
        ]
    return thresholds


def _measured(item: Item, dimension: Dimension, folder: Path, found: Sequence[Found]) -> MeasuredJnd | None:
    """Summarise thresholds over people, a person's own averaged first, on the logarithm; None without any."""
    if not found:
        return None
    model = stimulus_model(item.stimuli[0], folder)
    people = np.array([one[0] for one in found])
    spread = spread_of(means_by(np.log([one[1] for one in found]), people))
    own = found[0][2:4] if len(found) == 1 else (None, None)
    low, high = np.exp([spread.low, spread.high]).tolist() if spread.people > 1 else own
    return MeasuredJnd(
        dimension=dimension,
        button=item.name,
        condition=item.stimuli[0].name,
        standard=standard_sizes(model)[dimension],
        unit="m/s²" if dimension == "vibration" else "cN",
        ratio=float(np.exp(spread.mean)),
        low=low,
        high=high,
        people=spread.people,
        trials=sum(one[4] for one in found),
        above=_above_faintest(model) if dimension == "vibration" else None,
    )


def _above_faintest(model: FDVVModel) -> float:
    """Return how far the vibration of a press is above the faintest that is felt."""
    vibration = model.vibration("press", PACE_mm_s)
    assert vibration is not None  # it was made stronger in the study
    t_s = np.arange(0.0, vibration.duration_s, 1 / RATE_Hz)
    return acceleration_above_threshold(vibration.acceleration_m_s2(t_s), RATE_Hz)
