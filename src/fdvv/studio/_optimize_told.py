"""From what a run holds to what the page is told of it."""

from __future__ import annotations

import numpy as np

from fdvv.model import FDVVModel, Stroke
from fdvv.optimize import Score, TemporalPointing, TrialState
from fdvv.studio import _messages_optimize as m
from fdvv.studio._pointing import playable, pointing_of
from fdvv.studio._simulated_play import SimulatedPlay
from fdvv.workflow import OptimizeSession, OptimizeSetup

PICTURE_POINTS = 40
DIGITS = 3
TITLE, START, OTHERS = "title", "start", "others"
"""Where a setup keeps what people call a run, the button it starts from, whose scores it begins from."""


def row(run: int, session: OptimizeSession) -> m.OptimizeRow:
    """Tell a run in short."""
    setup, trials = session.setup, session.trials
    counting = sum(one.state is not TrialState.ABANDONED for one in trials)
    answered = sum(one.answer is not None for one in session.comparisons)
    name = setup.objectives[0].name
    scores = [one.scores[name] for one in trials if one.state is TrialState.DONE and name in one.scores]
    best = min(scores, key=lambda score: score.value, default=None)
    return m.OptimizeRow(
        run,
        str(setup.about.get(TITLE, "")) or f"run {run}",
        setup.engine,
        setup.preference,
        setup.simulated,
        setup.level or "",
        answered if setup.preference else counting,
        setup.budget,
        None if best is None else _score(best),
        setup.created,
        "",
    )


def broken(run: int, reason: str) -> m.OptimizeRow:
    """Tell a run that cannot be read."""
    return m.OptimizeRow(run, f"run {run}", "", False, False, "", 0, 0, None, "", reason)


def strip(setup: OptimizeSetup) -> m.OptimizeStrip:
    """Tell the strip of a run's task; that of temporal pointing where it is another task."""
    task = pointing_of(setup) if playable(setup) else TemporalPointing()
    half_px = int(task.zone_px // 2)
    return m.OptimizeStrip(round(task.strip_px), round(task.target_px), half_px, task.speed_px_s)


def trials(session: OptimizeSession) -> list[m.OptimizeTrial]:
    """Tell every trial."""
    several = len(session.problem.objectives) > 1
    front = {one.number for one in session.front().trials} if several else set()
    return [
        m.OptimizeTrial(
            one.number,
            one.design,
            one.suggested is not None,
            one.state,
            {name: _score(score) for name, score in one.scores.items()},
            one.reason,
            one.origin,
            curve(session.model(one.design)),
            one.number in front,
        )
        for one in session.trials
    ]


def pairs(session: OptimizeSession) -> list[m.OptimizePair]:
    """Tell every comparison."""
    return [
        m.OptimizePair(
            one.number,
            one.first,
            one.second,
            curve(session.model(one.first)),
            curve(session.model(one.second)),
            one.answer,
        )
        for one in session.comparisons
    ]


def curve(model: FDVVModel) -> m.OptimizeCurve:
    """Sample a button's slow press for a small picture."""
    x = np.linspace(0.0, model.travel_mm, PICTURE_POINTS)
    force = model.force_cN(x, 0.0, Stroke.PRESS)
    return m.OptimizeCurve(float(x[1]), force.round(DIGITS).tolist(), model.actuation_mm)


def simulated(play: SimulatedPlay | None) -> m.OptimizeSimulated | None:
    """Tell who plays a run."""
    if play is None:
        return None
    told = f"simulated person {play.person}"
    return m.OptimizeSimulated(play.running, play.done, play.total, told, play.fault)


def _score(score: Score) -> m.OptimizeScore:
    return m.OptimizeScore(score.value, score.error)
