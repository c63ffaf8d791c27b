"""Optimisation runs on the page: list, details, and simulated players."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Literal

from msgspec import Meta, field

from fdvv.errors import FdvvError
from fdvv_people.optimize.problem import TrialState
from fdvv_people.optimize.run.session import Optimization
from fdvv_people.optimize.run.verdict import verdict_sentence
from fdvv_people.optimize.space import Parameter
from fdvv_people.pages.api.optimize_ending import OptimizeRetest, compromise, retest_state
from fdvv_people.pages.api.optimize_tried import (
    OptimizeLine,
    OptimizePair,
    OptimizeTrial,
    line_list,
    pair_list,
    trial_list,
)
from fdvv_people.pages.optimizations import Optimizations, OptimizeChanged
from fdvv_people.pages.played_trial import PlayStrip, playable, pointing_of, strip_of
from fdvv_people.pages.rated_trial import waiting_trial
from fdvv_people.task.pointing import TemporalPointing
from fdvv_people.task.questionnaire import HIGHEST, ITEMS, LOWEST
from fdvv_people.task.rounds import read_rounds
from fdvv_people.task.score import Objective
from fdvv_studio.studio.contract import Empty, Message, call, error_line, message_of, watch_channel

Number = Annotated[int, Meta(ge=0, le=2**31)]
Name = Annotated[str, Meta(max_length=100)]
Level = Literal["easy", "hard"]


class OptimizeRow(Message):
    """A run in short.

    spent : trials, comparisons or lines that count. problem : why it cannot be read; empty if it can.
    sentence : what was found, None before the end. simulated : a simulated person plays. made : when, UTC.
    """

    run: int
    title: str
    engine: str
    preference: bool
    simulated: bool
    level: str
    spent: int
    budget: int
    sentence: str | None
    made: str
    problem: str


class OptimizeRows(Message):
    """All runs, the newest first."""

    rows: list[OptimizeRow]


class OptimizeAsk(Message):
    """Name a run."""

    run: Number


class OptimizeSimulated(Message):
    """A simulated person who plays: how far, and whether still at it. about : the person."""

    running: bool
    done: int
    total: int
    about: str = field(name="told")
    fault: str


class OptimizeItem(Message):
    """A question of the questionnaire, and what its lowest and highest answers mean."""

    question: str
    lowest: str
    highest: str


class OptimizeQuestions(Message):
    """The questionnaire after a trial.

    items : its questions. least, most : ends of their scale. trial : that waits for answers; None while none
    does.
    """

    items: list[OptimizeItem]
    least: int
    most: int
    trial: int | None


class OptimizeDetail(Message):
    """A run and all of its trials.

    rounds : presses of a score. rules : what every design must hold. start : the design the run began with,
    None while there is none. start_name : the button it is. start_button : its id; empty if there is none.
    on_lines : designs are compared along lines, not in pairs.
    searched : the budget is spent; what is left is the retest.
    others : what it began from; empty if from nothing. playable : a person can play its task here.
    questions : asked after every trial; None where nothing is asked. compromise : number of the trial whose
    design is recommended, of several objectives once the search is over; else None.
    """

    row: OptimizeRow
    seed: int
    parameters: list[Parameter]
    rules: list[str]
    objectives: list[Objective]
    rounds: int
    strip: PlayStrip
    trials: list[OptimizeTrial]
    pairs: list[OptimizePair]
    on_lines: bool
    lines: list[OptimizeLine]
    start: dict[str, float] | None
    start_name: str
    start_button: str
    searched: bool
    retest: OptimizeRetest
    others: str
    simulated: OptimizeSimulated | None
    playable: bool
    questions: OptimizeQuestions | None
    compromise: int | None


class OptimizeSimulate(OptimizeAsk):
    """Have a simulated person play so many trials. person : seed that draws them."""

    person: Number
    trials: Annotated[int, Meta(ge=1, le=2000)]


TITLE, START, OTHERS = "title", "start", "others"
"""Where a setup keeps what people call a run, the button it starts from, whose scores it begins from."""


def run_row(run: int, session: Optimization) -> OptimizeRow:
    setup, trials = session.setup, session.trials
    tried = sum(one.state is not TrialState.ABANDONED for one in trials)
    return message_of(
        OptimizeRow,
        setup,
        run=run,
        title=str(setup.about.get(TITLE, "")) or f"run {run}",
        level=setup.level or "",
        spent=session.answered if setup.preference else tried,
        sentence=verdict_sentence(session),
        made=setup.created,
        problem="",
    )


@call("optimize.list")
def rows(optimizations: Optimizations, _ask: Empty) -> OptimizeRows:
    return OptimizeRows([_row(optimizations, run) for run in optimizations.runs()])


def _row(optimizations: Optimizations, run: int) -> OptimizeRow:
    try:
        with optimizations.session(run) as session:
            return run_row(run, session)
    except FdvvError as error:
        return OptimizeRow(run, f"run {run}", "", False, False, "", 0, 0, None, "", error_line(error))


@call("optimize.detail")
def detail(optimizations: Optimizations, ask: OptimizeAsk) -> OptimizeDetail:
    with optimizations.session(ask.run) as session:
        setup, space = session.setup, session.space
        play = optimizations.simulated(ask.run)
        return OptimizeDetail(
            run_row(ask.run, session),
            setup.seed,
            list(space.parameters),
            [one.text for one in space.constraints],
            list(session.problem.objectives),
            pointing_of(setup).rounds if playable(setup) else 0,
            strip_of(pointing_of(setup) if playable(setup) else TemporalPointing()),
            trial_list(session),
            pair_list(session),
            session.asks_for == "line",
            line_list(session),
            session.start,
            setup.start_name,
            str(setup.about.get(START) or ""),
            session.searched,
            retest_state(session),
            str(setup.about.get(OTHERS) or ""),
            message_of(OptimizeSimulated, play, about=f"simulated person {play.person}") if play else None,
            playable(setup),
            questions(session, optimizations.folder(ask.run)),
            compromise(session),
        )


def questions(session: Optimization, folder: Path) -> OptimizeQuestions | None:
    if not session.setup.asks_liking:
        return None
    waiting = waiting_trial(session, read_rounds(folder))
    items = [message_of(OptimizeItem, item) for item in ITEMS]
    return OptimizeQuestions(items, LOWEST, HIGHEST, waiting.number if waiting else None)


@call("optimize.simulate")
def simulate(optimizations: Optimizations, ask: OptimizeSimulate) -> OptimizeAsk:
    optimizations.simulate(ask.run, ask.person, ask.trials)
    return OptimizeAsk(ask.run)


@call("optimize.halt")
def halt(optimizations: Optimizations, ask: OptimizeAsk) -> OptimizeAsk:
    play = optimizations.simulated(ask.run)
    if play:
        play.close()
    return ask


CHANNEL = watch_channel("optimize", Optimizations, OptimizeChanged)
