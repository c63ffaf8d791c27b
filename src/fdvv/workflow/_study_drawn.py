"""Figures of an analysis: its records as what fdvv.plot draws."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from fdvv.plot import (
    ChoiceRow,
    ForestRow,
    RatingBars,
    ScoreBars,
    SpecificationCurve,
    StaircaseTrack,
    plot_choices,
    plot_forest,
    plot_rating_bars,
    plot_score_bars,
    plot_specifications,
    plot_tracks,
)
from fdvv.study import Answers, Multiverse
from fdvv.units import FloatArray
from fdvv.workflow._experiment_words import stars
from fdvv.workflow._study_ratings import people_means, spread_of
from fdvv.workflow._study_records import StudyAnalysis, TimingResult
from fdvv.workflow._study_sentences import name_rows
from fdvv.workflow._study_words import button_name

MOST_TRACKS = 12
"""Staircases that are drawn; more would be too small to read."""


def drawn_ratings(found: StudyAnalysis, rating: str, scale: tuple[float, float]) -> Any:
    """Draw mean ratings by button, marks of Holm's correction above."""
    answers = found.screening.answers
    shown = _shown_stimuli(found)
    columns = answers.ratings[rating][:, [answers.stimuli.index(name) for name in shown]]
    means = people_means(answers, columns)
    spreads = [[spread_of(means[:, i, j]) for j in range(len(shown))] for i in range(len(found.buttons))]
    marks = {one.button: stars(one.p_holm) for one in found.tests if one.rating == rating and one.test.n > 1}
    if found.rated:
        marks = {}
    bars = RatingBars(
        found.buttons,
        shown,
        means,
        np.array([[one.low for one in row] for row in spreads]),
        np.array([[one.high for one in row] for row in spreads]),
        scale,
        tuple(marks.get(name, "") for name in found.buttons) if marks else (),
    )
    return plot_rating_bars(bars, rating, found.simulated)


def _shown_stimuli(found: StudyAnalysis) -> tuple[str, ...]:
    """Give the stimuli of a figure: those of the claim, what it is held against first; else all."""
    if found.claim is None or found.kind == "mushra":
        return found.stimuli
    return found.claim.claim.less, found.claim.claim.more


def scale_of(answers: Answers, rating: str, points: int | None) -> tuple[float, float]:
    """Give the ends of a rating's axis: the scale's, or, where none is known, what holds every answer."""
    if points:
        return (0.0, 100.0) if points == 101 else (1.0, float(points))
    values = answers.ratings[rating]
    low, high = float(np.nanmin(values)), float(np.nanmax(values))
    if low >= 1 and high <= 9:
        return 1.0, max(7.0, math.ceil(high))
    if low >= 0 and high <= 100:
        return 0.0, 100.0 if high > 10 else math.ceil(high) or 1.0
    return math.floor(low), math.ceil(high)


def drawn_choices(found: StudyAnalysis) -> Any:
    """Draw what was chosen, all buttons and each."""
    rows = name_rows(found)
    drawn = [
        ChoiceRow(
            button_name(one), one.less_count, one.equal_count, one.more_count,
            one.share.share, one.interval.low, one.interval.high,
        )
        for one in rows
    ]  # fmt: skip
    return plot_choices(drawn, rows[0].less, rows[0].more, simulated=found.simulated)


def drawn_distances(found: StudyAnalysis) -> Any:
    """Draw d' by button, all buttons as a diamond."""
    rows = [
        ForestRow(button_name(one), one.d[0].d, one.d[0].low, one.d[0].high, not one.button)
        for one in name_rows(found)
    ]
    return plot_forest(rows, "d′ (standard deviations)", "distance felt", simulated=found.simulated)


def drawn_people(found: StudyAnalysis) -> Any:
    """Draw every person's share, and that of all."""
    rows = [
        ForestRow(one.person, 100 * one.share, math.nan, math.nan)
        for one in found.people
        if not one.reason and not math.isnan(one.share)
    ]
    whole = found.preference
    assert whole is not None
    middle = ForestRow("all people", 100 * whole.split, math.nan, math.nan, True)
    axis = f"answers for {whole.more}, ties as halves (%)"
    return plot_forest([*rows, middle], axis, "person by person", 50.0, found.simulated)


def drawn_tracks(found: StudyAnalysis) -> Any:
    """Draw the first staircases."""
    several = len(found.buttons) > 1
    tracks = [
        StaircaseTrack(
            f"{one.person}, {one.button}" if several else one.person,
            one.ratios,
            one.correct,
            one.threshold.value,
        )
        for one in found.thresholds[:MOST_TRACKS]
    ]
    return plot_tracks(tracks, found.simulated)


def drawn_thresholds(found: StudyAnalysis) -> Any:
    """Draw every threshold with its interval, and the mean over people."""
    several = len(found.buttons) > 1
    rows = [
        ForestRow(
            f"{one.person}, {one.button}" if several else one.person,
            100 * one.threshold.value, _percent(one.threshold.low), _percent(one.threshold.high),
        )
        for one in found.thresholds
    ]  # fmt: skip
    if found.threshold is not None:
        mean = found.threshold
        rows.append(ForestRow("all people", 100 * mean.mean, 100 * mean.low, 100 * mean.high, True))
    return plot_forest(rows, "force added that is told apart (%)", "thresholds", None, found.simulated)


def _percent(value: float | None) -> float:
    return math.nan if value is None else 100 * value


def drawn_timing(found: TimingResult, simulated: bool) -> Any:
    """Draw mean scores by level."""
    panels = [
        ScoreBars(level, found.buttons, found.scores[:, :, i], _sd(found.scores[:, :, i]))
        for i, level in enumerate(found.levels)
    ]
    return plot_score_bars(panels, found.measure_text, simulated=simulated)


def _sd(scores: FloatArray) -> FloatArray:
    return scores.std(axis=0, ddof=1) if len(scores) > 1 else np.zeros(scores.shape[1])


def drawn_multiverse(found: Multiverse, registered: bool, claim: str, simulated: bool) -> Any:
    """Draw the specification curve, the registered way marked."""
    ways = found.specifications
    names = {
        "left out": "exclusions", "measure": "measure",
        "counted as one": "unit", "ties": "ties", "test": "test",
    }  # fmt: skip
    curve = SpecificationCurve(
        np.array([100 * one.share for one in ways]),
        np.array([100 * one.low for one in ways]),
        np.array([100 * one.high for one in ways]),
        np.array([one.p < found.alpha for one in ways]),
        ways.index(found.registered),
        {name: tuple(getattr(one, field) for one in ways) for name, field in names.items()},
    )
    marked = "as registered" if registered else "main analysis (not registered)"
    return plot_specifications(curve, f"{claim} (%)", marked, 50.0, simulated)
