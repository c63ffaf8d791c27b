"""What scores say of designs, whichever engine suggested them: the smoothed best, not the luckiest."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from fdvv.errors import ModelError
from fdvv.optimize._engine import Objective, Problem
from fdvv.optimize._gp import Observed, believe
from fdvv.optimize._space import DesignSpace
from fdvv.optimize._trial import Trial, TrialState


def finished(problem: Problem, trials: Sequence[Trial]) -> list[Trial]:
    """Give the trials that have a score for every objective."""
    names = [one.name for one in problem.objectives]
    return [t for t in trials if t.state is TrialState.DONE and all(name in t.scores for name in names)]


def observed(space: DesignSpace, objective: Objective, done: Sequence[Trial]) -> Observed:
    """Gather the scores of finished trials, turned so that smaller is better."""
    sign = -1.0 if objective.larger_is_better else 1.0
    scores = [trial.scores[objective.name] for trial in done]
    return Observed(
        space.to_unit([trial.design for trial in done]),
        np.array([sign * score.value for score in scores]),
        np.array([np.nan if score.error is None else score.error for score in scores]),
    )


def believed_best(problem: Problem, trials: Sequence[Trial]) -> dict[str, float]:
    """Recommend the design tried whose posterior mean is best (see fdvv.optimize._gp). ModelError."""
    done = best_of(problem, trials)
    means, _ = believe(observed(problem.space, problem.objectives[0], done)).predict(
        problem.space.to_unit([trial.design for trial in done])
    )
    return dict(done[int(np.argmin(means))].design)


def best_of(problem: Problem, trials: Sequence[Trial]) -> list[Trial]:
    """Give the finished trials that one is to be recommended of. ModelError if there is no such one."""
    if len(problem.objectives) != 1:
        raise ModelError("several objectives have no single best design; choose from the Pareto front")
    done = finished(problem, trials)
    if not done:
        raise ModelError("no trial is done yet, so there is no best design")
    return done
