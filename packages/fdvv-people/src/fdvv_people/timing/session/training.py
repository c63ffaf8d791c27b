"""A person's own buttons: what the engine suggests next, and what it recommends, from what is on record."""

from __future__ import annotations

from fdvv.errors import ModelError
from fdvv.model.model import FDVVModel
from fdvv_people.optimize.engines.registry import engine_of
from fdvv_people.optimize.paper_space import paper_model, paper_space
from fdvv_people.optimize.people.week import random_design
from fdvv_people.optimize.problem import Problem, Trial, TrialState
from fdvv_people.optimize.run.player import play_seed
from fdvv_people.task.pointing import ASYNCHRONY
from fdvv_people.timing.plan.session import TimingState


def trials_of(state: TimingState, level: str) -> tuple[Trial, ...]:
    """Return the training of a level so far, as engines read it."""
    faces = [one for one in state.started.trials if one.phase == "training" and one.level == level]
    return tuple(_trial(state, one.number, i) for i, one in enumerate(faces) if one.number in state.designs)


def _trial(state: TimingState, number: int, place: int) -> Trial:
    found = state.designs[number]
    done, failed = state.scores.get(number), state.failed.get(number)
    now = TrialState.DONE if done else TrialState.FAILED if failed is not None else TrialState.SUGGESTED
    return Trial(place, found.design, now, dict(done or {}), reason=failed or "", origin=found.origin)


def suggested(state: TimingState, level: str) -> dict[str, float]:
    """Return the next design of a level. InputError, BuildError where the engine is not installed."""
    training = state.plan.training
    if training is None:
        raise ModelError("the study has no training")
    engine = engine_of(training.engine, training.options)
    (design,) = engine.suggest(_problem(state, level), trials_of(state, level))
    return design


def recommended(state: TimingState, level: str) -> dict[str, float]:
    """Return the design that the engine believes to be best. ModelError where none was scored."""
    training = state.plan.training
    if training is None:
        raise ModelError("the study has no training")
    engine = engine_of(training.engine, training.options)
    return engine.best(_problem(state, level), trials_of(state, level))


def own_button(state: TimingState, level: str) -> FDVVModel:
    return paper_model(recommended(state, level), "optimised")


def random_button(seed: int) -> FDVVModel:
    return paper_model(random_design(paper_space(), seed, 0), "random")


def _problem(state: TimingState, level: str) -> Problem:
    seed = play_seed(state.started.seed, state.plan.all_levels.index(level))
    return Problem(paper_space(), (ASYNCHRONY,), seed)
