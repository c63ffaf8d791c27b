"""The statistics of a timing study: as in the paper, and by a mixed model with intervals."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from typing import TypeVar

import numpy as np

from fdvv.errors import ModelError
from fdvv.units import FloatArray
from fdvv_people.stats.anova import Anova, repeated_measures_anova
from fdvv_people.stats.effect_size import Estimate, reduction, rounds_as_people
from fdvv_people.stats.mixed import MixedContrast, MixedFit, fit_mixed, sign_flip_p
from fdvv_people.stats.post_hoc import PairedTest, holm, post_hoc
from fdvv_people.study.timing.plan import TimingPlan
from fdvv_people.study.timing.scores import TimingScores

Found = TypeVar("Found")
POWER_z = 1.96 + 0.84
"""Of a power of 0.8 at a level of 0.05, two-sided, in the normal approximation."""


@dataclass(frozen=True)
class ConditionMean:
    """How one condition did at one level.

    Attributes
    ----------
    mean : over people, in the score's unit. people_sd : between people, rounds averaged first. rounds_sd :
        between all rounds, as the paper's STD may be. lost_ratio : share of presses lost; nan of tapping.
    strokes_Hz : the finger's own strokes a second, mean over trials; nan but of tapping.
    people : with a score.
    """

    condition: str
    level: str
    mean: float
    people_sd: float
    rounds_sd: float
    lost_ratio: float
    strokes_Hz: float
    people: int


@dataclass(frozen=True)
class Rivalry:
    """The claimed condition against another, levels averaged.

    Attributes
    ----------
    mixed : the contrast of the mixed model, better minus rival. holm_p : corrected for all rivals.
    flip_p : of people's mean differences under flipped signs, uncorrected; None with fewer than 3 people.
    reduction_ratio : by which part the mean is below the rival's, with its BCa interval over people.
    """

    better: str
    rival: str
    mixed: MixedContrast
    holm_p: float
    flip_p: float | None
    reduction_ratio: Estimate | None


@dataclass(frozen=True)
class ReachedRate:
    """Whether people reach a rate of tapping. rate_Hz : mean over people, with its t interval."""

    condition: str
    at_least_Hz: float
    rate_Hz: Estimate
    people: int

    @property
    def reached(self) -> bool | None:
        """Whether the whole interval is above the claim, or below; None where it holds it."""
        if self.rate_Hz.low is None or self.rate_Hz.high is None:
            return None
        return (
            True
            if self.rate_Hz.low >= self.at_least_Hz
            else False
            if self.rate_Hz.high < self.at_least_Hz
            else None
        )


@dataclass(frozen=True, eq=False)
class TimingAnalysis:
    """Everything that was found.

    Attributes
    ----------
    scores : that were analysed. means : by level, then condition.
    anova : two-way over complete people, rounds averaged first; of tapping over buttons and rounds.
    rounds_anova : every round counted as a person, as the paper's F(5, 95) does; None with one round.
    pairs : all pairs of conditions, levels and rounds averaged. by_level : those of the claimed one.
    model : the mixed model. rivals : contrasts of the claimed condition. rate : of the claim about tapping.
    holds : whether the claim is supported; None where it could not be tested. notes : what could not be
        computed, and why.
    """

    scores: TimingScores
    means: tuple[ConditionMean, ...]
    anova: Anova | None
    rounds_anova: Anova | None
    pairs: tuple[PairedTest, ...]
    by_level: Mapping[str, tuple[PairedTest, ...]]
    model: MixedFit | None
    rivals: tuple[Rivalry, ...]
    rate: ReachedRate | None
    holds: bool | None
    notes: tuple[str, ...]

    @property
    def simulated(self) -> bool:
        return self.scores.simulated


def better_of(plan: TimingPlan) -> str:
    """Return the condition that everything is compared with: the claimed one, or the first."""
    return plan.claim.better if plan.claim else plan.conditions[0].name


def analyse_timing(scores: TimingScores, seed: int = 0) -> TimingAnalysis:
    """Analyse a validation. seed : of the intervals that are resampled.

    ModelError where nothing counts at all; what cannot be computed of few people is a note.
    """
    if not any(row.counts for row in scores.rows):
        raise ModelError("no trial of the validation counts")
    plan, trying = scores.plan, _Trying()
    left = sorted(set(scores.people) - set(scores.complete))
    if left:
        trying.notes.append(f"not complete, and only in the mixed model: {', '.join(left)}")
    cells = scores.array(scores.complete)
    averaged, names = cells.mean(axis=3), scores.conditions
    model = trying.this("mixed model", lambda: fitted(scores))
    rivals = trying.this("contrasts", lambda: _rivals(scores, averaged, seed)) or ()
    rate = trying.this("rate", lambda: _rate(scores))
    return TimingAnalysis(
        scores,
        tuple(_mean(scores, name, level) for level in plan.all_levels for name in names),
        *_variances(plan, cells, trying),
        trying.this("pairs", lambda: post_hoc(averaged.mean(axis=2), names, seed=seed)) or (),
        _by_level(plan, averaged, seed, trying),
        model,
        rivals,
        rate,
        _holds(scores, rivals, rate),
        tuple(dict.fromkeys(trying.notes)),
    )


class _Trying:
    """Computes what can be; the rest becomes notes."""

    def __init__(self) -> None:
        self.notes: list[str] = []

    def this(self, what: str, work: Callable[[], Found]) -> Found | None:
        try:
            return work()
        except (ModelError, np.linalg.LinAlgError) as error:
            self.notes.append(f"{what}: {error}")
            return None


def _variances(plan: TimingPlan, cells: FloatArray, trying: _Trying) -> tuple[Anova | None, Anova | None]:
    """Return the analyses of variance: people counted as people, and every round as a person."""
    factors = ("button", "round") if plan.tapping else ("button", "level")
    table = cells[:, :, 0] if plan.tapping else cells.mean(axis=3)
    people = trying.this("analysis of variance", lambda: repeated_measures_anova(table, factors))
    if plan.rounds == 1 or plan.tapping:
        return people, None
    as_people = rounds_as_people(cells)
    return people, trying.this("rounds as people", lambda: repeated_measures_anova(as_people, factors))


def _by_level(
    plan: TimingPlan, averaged: FloatArray, seed: int, trying: _Trying
) -> dict[str, tuple[PairedTest, ...]]:
    names, best = [one.name for one in plan.conditions], better_of(plan)
    found: dict[str, tuple[PairedTest, ...]] = {}
    for i, level in enumerate(plan.levels):
        column = averaged[:, :, i]
        pairs = trying.this(f"pairs at {level}", partial(post_hoc, column, names, best, seed))
        found[level] = pairs or ()
    return found


def _mean(scores: TimingScores, condition: str, level: str) -> ConditionMean:
    rows = [row for row in scores.rows if row.counts and (row.condition, row.level) == (condition, level)]
    people = sorted({row.person for row in rows})
    by_person = [np.mean([row.score for row in rows if row.person == name]) for name in people]
    lost = [row.lost_ratio for row in rows if math.isfinite(row.lost_ratio)]
    strokes = [row.strokes_Hz for row in rows if math.isfinite(row.strokes_Hz)]
    values = [row.score for row in rows]
    return ConditionMean(
        condition,
        level,
        float(np.mean(by_person)) if people else math.nan,
        float(np.std(by_person, ddof=1)) if len(people) > 1 else math.nan,
        float(np.std(values, ddof=1)) if len(values) > 1 else math.nan,
        float(np.mean(lost)) if lost else math.nan,
        float(np.mean(strokes)) if strokes else math.nan,
        len(people),
    )


def fitted(scores: TimingScores, conditions: Sequence[str] = ()) -> MixedFit:
    """Fit a mean of every condition and level, with random intercepts of people and, within, of each factor.

    conditions : that are fitted; all of none. Means are by level, then by condition in that order.
    ModelError where a condition has no score, and of fewer than 3 people.
    """
    names, levels = conditions or scores.conditions, scores.plan.all_levels
    rows = [row for row in scores.rows if row.counts and row.condition in names]
    design = np.zeros((len(rows), len(names) * len(levels)))
    for i, row in enumerate(rows):
        design[i, levels.index(row.level) * len(names) + names.index(row.condition)] = 1.0
    for column in np.flatnonzero(~design.any(axis=0)):
        level, condition = divmod(int(column), len(names))
        raise ModelError(f"nobody pressed {names[condition]} {levels[level]}".strip())
    effects = {"person × button": [f"{row.person} {row.condition}" for row in rows]}
    if len(levels) > 1:
        effects["person × level"] = [f"{row.person} {row.level}" for row in rows]
    return fit_mixed([row.score for row in rows], design, [row.person for row in rows], effects)


def _rivals(scores: TimingScores, averaged: FloatArray, seed: int) -> tuple[Rivalry, ...]:
    """Compare the claimed condition with each rival, each time by a model of these two alone.

    Buttons differ in how they spread, a random design by far the most: one model of all would lend that to
    every contrast.
    """
    names, best = scores.conditions, better_of(scores.plan)
    claim = scores.plan.claim
    others = (claim.than if claim else ()) or tuple(name for name in names if name != best)
    levels = len(scores.plan.all_levels)
    weights = np.tile([1.0, -1.0], levels) / levels
    contrasts = [fitted(scores, (best, other)).contrast(weights) for other in others]
    corrected = holm([one.p for one in contrasts])
    means = averaged.mean(axis=2)
    return tuple(
        Rivalry(best, other, contrast, p, *_of_people(means, names.index(best), names.index(other), seed))
        for other, contrast, p in zip(others, contrasts, corrected, strict=True)
    )


def _of_people(means: FloatArray, best: int, other: int, seed: int) -> tuple[float | None, Estimate | None]:
    """Return what people's own means say of two conditions; None of fewer than 3 complete people."""
    try:
        p = sign_flip_p(means[:, best] - means[:, other], seed)
        return p, reduction(means[:, best], means[:, other], seed)
    except ModelError:
        return None, None


def _rate(scores: TimingScores) -> ReachedRate | None:
    from scipy.stats import t as student

    claim = scores.plan.claim
    if claim is None or claim.at_least_Hz is None:
        return None
    rows = [row for row in scores.rows if row.counts and row.condition == claim.better]
    people = sorted({row.person for row in rows})
    rates = np.array([np.mean([row.score for row in rows if row.person == name]) for name in people])
    if len(rates) < 3:
        raise ModelError(f"an interval needs at least 3 people, got {len(rates)}")
    mean, error = float(rates.mean()), float(rates.std(ddof=1)) / math.sqrt(len(rates))
    half = float(student.ppf(1 - claim.alpha / 2, len(rates) - 1)) * error
    return ReachedRate(claim.better, claim.at_least_Hz, Estimate(mean, mean - half, mean + half), len(rates))


def _holds(scores: TimingScores, rivals: tuple[Rivalry, ...], rate: ReachedRate | None) -> bool | None:
    claim = scores.plan.claim
    if claim is None or not rivals:
        return None
    sign = scores.plan.task_of("easy").objectives[0].sign
    better = all(one.holm_p < claim.alpha and sign * one.mixed.value.value < 0 for one in rivals)
    return better and (claim.at_least_Hz is None or bool(rate and rate.reached))


def people_needed(rival: Rivalry, people: int) -> int | None:
    """Return about how many people find a difference as large as this one with a power of 0.8.

    None where it is 0. In the normal approximation, from the contrast's own standard error.
    """
    if rival.mixed.value.value == 0:
        return None
    return math.ceil(people * (POWER_z * rival.mixed.error / rival.mixed.value.value) ** 2)
