"""What was tried in a run, as its page shows it: trials with their pictures."""

from __future__ import annotations

import numpy as np

from fdvv.model.curve import Stroke
from fdvv.model.model import FDVVModel
from fdvv_people.optimize.problem import Answer, Trial, TrialState
from fdvv_people.optimize.run.session import Optimization
from fdvv_people.task.score import Score
from fdvv_studio.studio.contract import Message, message_of

PICTURE_POINTS = 40  # the page draws it 72 pixels wide (score_chart.ts)
DIGITS = 3  # of cN, as `fdvv_studio.studio.rounding` has it: beyond any line's width


class OptimizeCurve(Message):
    """The press of a design, for a small picture."""

    step_mm: float
    force_cN: list[float]
    actuation_mm: float | None


class OptimizeTrial(Message):
    """A trial.

    front : no other one is better in every objective, by expected scores; False where there is one
    objective. expected : its posterior means with their deviations; empty unless it is on the front.
    """

    number: int
    design: dict[str, float]
    edited: bool
    state: TrialState
    scores: dict[str, Score]
    reason: str
    origin: str
    curve: OptimizeCurve
    front: bool
    expected: dict[str, Score]


class OptimizePair(Message):
    """Two designs and what was said of them."""

    number: int
    first: dict[str, float]
    second: dict[str, float]
    first_curve: OptimizeCurve
    second_curve: OptimizeCurve
    answer: Answer | None


class OptimizeLine(Message):
    """A line. stops : its designs in order. best : which is liked best, from 0; None: not yet answered."""

    number: int
    stops: list[dict[str, float]]
    best: int | None


def trial_list(session: Optimization) -> list[OptimizeTrial]:
    front = {one.number: one for one in session.front().trials} if session.setup.several else {}
    return [
        message_of(
            OptimizeTrial,
            one,
            edited=one.suggested is not None,
            curve=press_picture(session.model(one.design)),
            front=one.number in front,
            expected=front[one.number].scores if one.number in front else {},
        )
        for one in session.trials
        if not one.beside
    ]


def pair_list(session: Optimization) -> list[OptimizePair]:
    """Return the comparisons of the search and of its retest."""
    search = session.trials if session.asks_for == "comparison" else ()
    return [_pair(session, one) for one in (*search, *session.retests) if one.beside]


def _pair(session: Optimization, trial: Trial) -> OptimizePair:
    first, second = trial.designs
    first_curve, second_curve = (press_picture(session.model(design)) for design in trial.designs)
    return OptimizePair(trial.number, first, second, first_curve, second_curve, trial.answer)


def press_picture(model: FDVVModel) -> OptimizeCurve:
    """Sample a button's slow press for a small picture."""
    x = np.linspace(0.0, model.travel_mm, PICTURE_POINTS)
    force = model.force_cN(x, 0.0, Stroke.PRESS)
    return OptimizeCurve(float(x[1]), force.round(DIGITS).tolist(), model.actuation_mm)


def line_list(session: Optimization) -> list[OptimizeLine]:
    return [
        OptimizeLine(one.number, list(one.designs), one.best[0] if one.best else None)
        for one in session.trials
        if session.asks_for == "line"
    ]
