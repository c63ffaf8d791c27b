"""Trials of a run: suggested, edited, answered, and what they recommend."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from typing import Annotated, Any

from msgspec import Meta

from fdvv.errors import InputError
from fdvv_people.optimize.run.session import Optimization
from fdvv_people.pages.api.optimize import Name, Number, OptimizeAsk
from fdvv_people.pages.optimizations import Optimizations
from fdvv_people.pages.rated_trial import rate_trial
from fdvv_studio.project.patch import record_of
from fdvv_studio.studio.contract import Message, call


class OptimizeBest(Message):
    """The design that a run recommends; None while nothing is done."""

    design: dict[str, float] | None


class OptimizeTrialAsk(OptimizeAsk):
    """Name a trial of a run."""

    trial: Number


class OptimizeEdit(OptimizeTrialAsk):
    """Put a person's own design in the place of a suggestion that was not shown yet."""

    design: Annotated[dict[str, float], Meta(max_length=100)]


class OptimizeRate(OptimizeTrialAsk):
    """Answer the questionnaire after a trial. answers : to its questions, in their order, from 1 to 7."""

    answers: Annotated[list[int], Meta(max_length=20)]


class OptimizeAnswer(OptimizeTrialAsk):
    """Say which designs of a trial are liked best, from 0; several where there is no difference."""

    best: Annotated[list[Number], Meta(min_length=1, max_length=100)]


class OptimizeModelAsk(OptimizeAsk):
    """Ask for the button of a design."""

    design: Annotated[dict[str, float], Meta(max_length=100)]
    name: Name


class OptimizeModel(Message):
    """A button as its file holds it."""

    model: dict[str, Any]


@call("optimize.best")
def best(optimizations: Optimizations, ask: OptimizeAsk) -> OptimizeBest:
    with optimizations.session(ask.run) as session:
        return OptimizeBest(session.recommended())


@contextmanager
def _changed(optimizations: Optimizations, run: int) -> Iterator[Optimization]:
    """Open a run to change it, and inform all pages if that succeeds."""
    with optimizations.session(run) as session:
        yield session
    optimizations.announce(run)


@call("optimize.next")
def next_trial(optimizations: Optimizations, ask: OptimizeAsk) -> OptimizeTrialAsk:
    """Return the open trial, or ask the engine for one."""
    with _changed(optimizations, ask.run) as session:
        trial = session.next_trial()
        if trial is None:
            remedy = "look at what was found, or begin another run"
            raise InputError("optimise", f"run {ask.run}", f"its {session.asks_for}s are all over", remedy)
        return OptimizeTrialAsk(ask.run, trial.number)


@call("optimize.answer")
def answer(optimizations: Optimizations, ask: OptimizeAnswer) -> OptimizeTrialAsk:
    with _changed(optimizations, ask.run) as session:
        session.answer(ask.trial, ask.best)
    return OptimizeTrialAsk(ask.run, ask.trial)


@call("optimize.edit")
def edit(optimizations: Optimizations, ask: OptimizeEdit) -> OptimizeTrialAsk:
    with _changed(optimizations, ask.run) as session:
        session.edit(ask.trial, ask.design)
    return OptimizeTrialAsk(ask.run, ask.trial)


@call("optimize.abandon")
def abandon(optimizations: Optimizations, ask: OptimizeTrialAsk) -> OptimizeTrialAsk:
    """Stop a trial; it teaches nothing and does not count."""
    with _changed(optimizations, ask.run) as session:
        session.give_up(ask.trial, "stopped on the page", failed=False)
    return ask


@call("optimize.rate")
def rate(optimizations: Optimizations, ask: OptimizeRate) -> OptimizeTrialAsk:
    rate_trial(optimizations, ask.run, ask.trial, ask.answers)
    optimizations.announce(ask.run)
    return OptimizeTrialAsk(ask.run, ask.trial)


@call("optimize.take")
def take(optimizations: Optimizations, ask: OptimizeTrialAsk) -> OptimizeTrialAsk:
    """Recommend another compromise of the front, before its retest."""
    optimizations.take(ask.run, ask.trial)
    return ask


@call("optimize.model")
def model(optimizations: Optimizations, ask: OptimizeModelAsk) -> OptimizeModel:
    with optimizations.session(ask.run) as session:
        found = session.model(session.space.checked(ask.design), ask.name or "design")
    return OptimizeModel(record_of(found))
