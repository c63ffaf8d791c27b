"""Trials and comparisons of a run: suggested, edited, answered, and what they recommend."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from typing import Annotated, Any

from msgspec import Meta, Struct

from fdvv.errors import InputError
from fdvv.optimize.problem import Answer
from fdvv.optimize.run.session import Optimization
from fdvv.project.patch import record_of
from fdvv.studio.api.optimize import Name, Number, OptimizeAsk
from fdvv.studio.contract import Call
from fdvv.studio.optimizations import Optimizations
from fdvv.studio.played_trial import open_trials
from fdvv.studio.studio import Studio


class OptimizeBest(Struct, frozen=True):
    """The design that a run recommends; None while nothing is done."""

    design: dict[str, float] | None


class OptimizeTrialAsk(Struct, frozen=True, forbid_unknown_fields=True):
    """Name a trial of a run."""

    run: Number
    trial: Number


class OptimizeEdit(Struct, frozen=True, forbid_unknown_fields=True):
    """Put a person's own design in the place of a suggestion that was not shown yet."""

    run: Number
    trial: Number
    design: Annotated[dict[str, float], Meta(max_length=100)]


class OptimizeAnswer(Struct, frozen=True, forbid_unknown_fields=True):
    """Say which of two designs is preferred."""

    run: Number
    pair: Number
    answer: Answer


class OptimizePairAsk(Struct, frozen=True):
    """Name a comparison of a run."""

    run: int
    pair: int


class OptimizeModelAsk(Struct, frozen=True, forbid_unknown_fields=True):
    """Ask for the button of a design."""

    run: Number
    design: Annotated[dict[str, float], Meta(max_length=100)]
    name: Name


class OptimizeModel(Struct, frozen=True):
    """A button as its file holds it."""

    model: dict[str, Any]


def best(studio: Studio, ask: OptimizeAsk) -> OptimizeBest:
    optimizations = studio.part(Optimizations)
    with optimizations.session(ask.run) as session:
        return OptimizeBest(optimizations.found(ask.run, session))


@contextmanager
def _changed(studio: Studio, run: int) -> Iterator[Optimization]:
    """Open a run to change it, and inform all pages if that succeeds."""
    optimizations = studio.part(Optimizations)
    with optimizations.session(run) as session:
        yield session
    optimizations.announce(run)


def next_trial(studio: Studio, ask: OptimizeAsk) -> OptimizeTrialAsk:
    """Return the open trial, or ask the engine for one."""
    with _changed(studio, ask.run) as session:
        waiting = open_trials(session) or session.ask()
        if not waiting:
            remedy = "look at what was found, or begin another run"
            raise InputError("optimise", f"run {ask.run}", "its trials are all played", remedy)
        return OptimizeTrialAsk(ask.run, waiting[0].number)


def edit(studio: Studio, ask: OptimizeEdit) -> OptimizeTrialAsk:
    with _changed(studio, ask.run) as session:
        session.edit(ask.trial, ask.design)
    return OptimizeTrialAsk(ask.run, ask.trial)


def abandon(studio: Studio, ask: OptimizeTrialAsk) -> OptimizeTrialAsk:
    """Stop a trial; it teaches nothing and does not count."""
    with _changed(studio, ask.run) as session:
        session.abandon(ask.trial, "stopped on the page")
    return ask


def next_pair(studio: Studio, ask: OptimizeAsk) -> OptimizePairAsk:
    """Return the open comparison, or ask the engine for one."""
    with _changed(studio, ask.run) as session:
        waiting = session.compare()
        if waiting is None:
            reason = "its comparisons are all made"
            raise InputError("optimise", f"run {ask.run}", reason, "look at what was found")
        return OptimizePairAsk(ask.run, waiting.number)


def answer(studio: Studio, ask: OptimizeAnswer) -> OptimizePairAsk:
    with _changed(studio, ask.run) as session:
        session.answer(ask.pair, ask.answer)
    return OptimizePairAsk(ask.run, ask.pair)


def model(studio: Studio, ask: OptimizeModelAsk) -> OptimizeModel:
    with studio.part(Optimizations).session(ask.run) as session:
        found = session.model(session.space.checked(ask.design), ask.name or "design")
    return OptimizeModel(record_of(found))


CALLS = (
    Call("optimize.best", OptimizeAsk, OptimizeBest, best),
    Call("optimize.next", OptimizeAsk, OptimizeTrialAsk, next_trial),
    Call("optimize.edit", OptimizeEdit, OptimizeTrialAsk, edit),
    Call("optimize.abandon", OptimizeTrialAsk, OptimizeTrialAsk, abandon),
    Call("optimize.pair", OptimizeAsk, OptimizePairAsk, next_pair),
    Call("optimize.answer", OptimizeAnswer, OptimizePairAsk, answer),
    Call("optimize.model", OptimizeModelAsk, OptimizeModel, model),
)
