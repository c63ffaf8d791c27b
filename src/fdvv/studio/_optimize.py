"""The part of the studio that optimises a button with a person, or a simulated one."""

from __future__ import annotations

from fdvv.errors import FdvvError, InputError, ModelError
from fdvv.optimize import ENGINES, PAIR_ENGINES, LEVELS_px_s, Trial, model_space, neutral_design
from fdvv.studio import _messages_optimize as m
from fdvv.studio import _optimize_told as t
from fdvv.studio._contract import Call, ChannelKind, Tell
from fdvv.studio._optimizations import Optimizations
from fdvv.studio._play import CHANNEL as PLAY
from fdvv.studio._play_device import pressed_devices
from fdvv.studio._played_trial import open_trials
from fdvv.studio._pointing import TASK, playable, pointing_of
from fdvv.studio._studio import Studio
from fdvv.studio._told import told
from fdvv.workflow import (
    ObjectiveSetup,
    OptimizeSession,
    OptimizeSetup,
    OthersShelf,
    RigShelf,
    SpaceSetup,
    button_choices,
    model_space_setup,
    paper_design_like,
    record_of,
)

PAPER = "paper"
ENGINES_TOLD = {
    "random": "draws designs by lot",
    "sobol": "spreads designs evenly",
    "tpe": "Optuna's; for many trials",
    "cmaes": "moves a cloud of designs towards the better ones",
    "nsga2": "breeds designs; for several objectives",
    "gp": "learns from every score, and knows how noisy each is",
    "gp-ei": "as in the paper: a Gaussian process and expected improvement",
    "botorch": "the strongest; needs the extra fdvv[botorch]",
}
SPACES_TOLD = {
    PAPER: "eight parameters of the paper, three points, activation, vibration",
    "FDV": "variations of the button you start from: force, bump, activation, vibration",
    "FDVV": "the same and a scale of force for every speed it knows",
}
PAIR_ENGINES_TOLD = {
    "preference": "learns from which of two you prefer",
    "preference-botorch": "the same, stronger; needs the extra fdvv[botorch]",
}
MORE_TOLD = {"lost_ratio": "share of rounds lost"}


def offers(studio: Studio, _ask: m.OptimizeOffersAsk) -> m.OptimizeOffers:
    """Tell what a run can be made of."""
    return m.OptimizeOffers(
        [m.OptimizeOffer(name, ENGINES_TOLD.get(name, "")) for name in ENGINES],
        [m.OptimizeOffer(name, PAIR_ENGINES_TOLD.get(name, "")) for name in PAIR_ENGINES],
        [m.OptimizeOffer(name, told) for name, told in SPACES_TOLD.items()],
        [m.OptimizeOffer(entry.rig_id, entry.about) for entry in RigShelf(studio.project).entries()],
        [m.OptimizeOffer(name, f"{speed:g} pixels per second") for name, speed in LEVELS_px_s.items()],
        [m.OptimizeOffer(name, MORE_TOLD[name]) for name in MORE_TOLD],
        [m.OptimizeOffer(choice.id, choice.name) for choice in button_choices(studio.shelf)],
        [m.OptimizeOffer(entry.name, entry.about) for entry in OthersShelf(studio.project).entries()],
    )


def devices(_studio: Studio, _ask: m.OptimizeDevicesAsk) -> m.OptimizeDevices:
    """Tell what a person can press beside the page."""
    return m.OptimizeDevices([m.OptimizeOffer(name, about) for name, about in pressed_devices()])


def create(studio: Studio, ask: m.OptimizeCreate) -> m.OptimizeAsk:
    """Begin a run."""
    space, start = _space(studio, ask)
    others, prior = _others(studio, ask)
    setup = OptimizeSetup(
        space=space,
        engine=ask.engine,
        task="preference" if ask.preference else TASK,
        level=ask.level,
        simulated=ask.simulated,
        objectives=tuple(ObjectiveSetup(name) for name in ("asynchrony_ms", *ask.also)),
        seed=ask.seed,
        budget=ask.budget,
        start=start,
        prior=prior,
        about={
            t.TITLE: ask.title.strip(),
            t.START: ask.start,
            t.OTHERS: others,
            OptimizeSetup.PRESSES: ask.task_presses,
        },
    )
    if playable(setup):
        try:
            pointing_of(setup)
        except ModelError as error:
            raise InputError("optimise", "setup", str(error), "choose another") from error
    return m.OptimizeAsk(studio.part(Optimizations).create(setup))


def _space(studio: Studio, ask: m.OptimizeCreate) -> tuple[SpaceSetup, dict[str, float] | None]:
    """Give the space that is asked for, and the design in it that the run starts from. InputError."""
    base = None if ask.start is None else studio.shelf.model(ask.start)
    if ask.space == PAPER:
        return SpaceSetup(rig=ask.rig), None if base is None else paper_design_like(base)
    if ask.space not in SPACES_TOLD:
        raise InputError("optimise", ask.space, "there is no such space", f"use {', '.join(SPACES_TOLD)}")
    if base is None:
        raise InputError(
            "optimise", ask.space, "varies a button, and none was named", "choose one to start from"
        )
    setup = model_space_setup(base, (ask.space,), rig=ask.rig)
    return setup, neutral_design(model_space(base, (ask.space,)), base)


def _others(studio: Studio, ask: m.OptimizeCreate) -> tuple[str, tuple[Trial, ...]]:
    """Give what a run begins from, in words and as trials. InputError."""
    if ask.others is None:
        return "", ()
    if ask.preference or ask.space != PAPER:
        reason = f"others scored designs of the space {PAPER}"
        raise InputError("optimise", ask.others, reason, "begin from nothing, or choose that space")
    entry, prior = OthersShelf(studio.project).prior(ask.others)
    return entry.about, prior


def rows(studio: Studio, _ask: m.OptimizeListAsk) -> m.OptimizeRows:
    """List all runs."""
    optimizations = studio.part(Optimizations)
    return m.OptimizeRows([_row(optimizations, run) for run in optimizations.runs()])


def _row(optimizations: Optimizations, run: int) -> m.OptimizeRow:
    try:
        with optimizations.session(run) as session:
            return t.row(run, session)
    except FdvvError as error:
        return t.broken(run, told(error))


def detail(studio: Studio, ask: m.OptimizeAsk) -> m.OptimizeDetail:
    """Tell a run and all of its trials."""
    optimizations = studio.part(Optimizations)
    with optimizations.session(ask.run) as session:
        setup, space = session.setup, session.space
        objectives = [m.OptimizeObjective(o.name, o.larger_is_better) for o in session.problem.objectives]
        return m.OptimizeDetail(
            t.row(ask.run, session),
            setup.seed,
            [m.OptimizeParameter(one.name, one.low, one.high) for one in space.parameters],
            [one.told for one in space.constraints],
            objectives,
            pointing_of(setup).rounds if playable(setup) else 0,
            t.strip(setup),
            t.trials(session),
            t.pairs(session),
            _start(session),
            str(setup.about.get(t.START) or ""),
            str(setup.about.get(t.OTHERS) or ""),
            t.simulated(optimizations.simulated(ask.run)),
            playable(setup),
        )


def best(studio: Studio, ask: m.OptimizeAsk) -> m.OptimizeBest:
    """Tell what is recommended."""
    optimizations = studio.part(Optimizations)
    with optimizations.session(ask.run) as session:
        return m.OptimizeBest(optimizations.found(ask.run, session))


def _start(session: OptimizeSession) -> dict[str, float] | None:
    """Give what the run began with: the person's own button, or the first that was suggested."""
    if session.setup.start is not None:
        return session.setup.start
    if session.comparisons:
        return session.comparisons[0].first
    return session.trials[0].design if session.trials else None


def next_trial(studio: Studio, ask: m.OptimizeAsk) -> m.OptimizeTrialAsk:
    """Give the trial that is open, or ask the engine for one."""
    optimizations = studio.part(Optimizations)
    with optimizations.session(ask.run) as session:
        waiting = open_trials(session) or session.ask()
        if not waiting:
            remedy = "look at what was found, or begin another run"
            raise InputError("optimise", f"run {ask.run}", "its trials are all played", remedy)
        number = waiting[0].number
    optimizations.announce(ask.run)
    return m.OptimizeTrialAsk(ask.run, number)


def edit(studio: Studio, ask: m.OptimizeEdit) -> m.OptimizeTrialAsk:
    """Put a person's own design in the place of a suggestion."""
    optimizations = studio.part(Optimizations)
    with optimizations.session(ask.run) as session:
        session.edit(ask.trial, ask.design)
    optimizations.announce(ask.run)
    return m.OptimizeTrialAsk(ask.run, ask.trial)


def abandon(studio: Studio, ask: m.OptimizeTrialAsk) -> m.OptimizeTrialAsk:
    """Stop a trial; it teaches nothing and does not count."""
    optimizations = studio.part(Optimizations)
    with optimizations.session(ask.run) as session:
        session.abandon(ask.trial, "stopped on the page")
    optimizations.announce(ask.run)
    return ask


def next_pair(studio: Studio, ask: m.OptimizeAsk) -> m.OptimizePairAsk:
    """Give the two designs that wait for an answer, or ask the engine for two."""
    optimizations = studio.part(Optimizations)
    with optimizations.session(ask.run) as session:
        waiting = session.compare()
    if waiting is None:
        raise InputError(
            "optimise", f"run {ask.run}", "its comparisons are all made", "look at what was found"
        )
    optimizations.announce(ask.run)
    return m.OptimizePairAsk(ask.run, waiting.number)


def answer(studio: Studio, ask: m.OptimizeAnswer) -> m.OptimizePairAsk:
    """Keep which of two was preferred."""
    optimizations = studio.part(Optimizations)
    with optimizations.session(ask.run) as session:
        session.answer(ask.pair, ask.answer)
    optimizations.announce(ask.run)
    return m.OptimizePairAsk(ask.run, ask.pair)


def model(studio: Studio, ask: m.OptimizeModelAsk) -> m.OptimizeModel:
    """Give the button of a design."""
    with studio.part(Optimizations).session(ask.run) as session:
        found = session.model(session.space.checked(ask.design), ask.name or "design")
    return m.OptimizeModel(record_of(found))


def simulate(studio: Studio, ask: m.OptimizeSimulate) -> m.OptimizeAsk:
    """Have a simulated person play."""
    studio.part(Optimizations).simulate(ask.run, ask.person, ask.trials)
    return m.OptimizeAsk(ask.run)


def halt(studio: Studio, ask: m.OptimizeAsk) -> m.OptimizeAsk:
    """Stop the simulated person after the trial under way."""
    play = studio.part(Optimizations).simulated(ask.run)
    if play:
        play.close()
    return ask


class OptimizeChannel:
    """One page that follows the runs."""

    def __init__(self, studio: Studio, tell: Tell) -> None:
        self._optimizations, self._tell = studio.part(Optimizations), tell

    def receive(self, _ask: m.OptimizeWatch) -> None:
        """Begin."""
        self._optimizations.watchers.watch(self._tell)
        self._tell(m.OptimizeWatching())

    def close(self) -> None:
        """End."""
        self._optimizations.watchers.forget(self._tell)


CALLS = (
    Call("optimize.offers", m.OptimizeOffersAsk, m.OptimizeOffers, offers),
    Call("optimize.devices", m.OptimizeDevicesAsk, m.OptimizeDevices, devices),
    Call("optimize.create", m.OptimizeCreate, m.OptimizeAsk, create),
    Call("optimize.list", m.OptimizeListAsk, m.OptimizeRows, rows),
    Call("optimize.detail", m.OptimizeAsk, m.OptimizeDetail, detail),
    Call("optimize.best", m.OptimizeAsk, m.OptimizeBest, best),
    Call("optimize.next", m.OptimizeAsk, m.OptimizeTrialAsk, next_trial),
    Call("optimize.edit", m.OptimizeEdit, m.OptimizeTrialAsk, edit),
    Call("optimize.abandon", m.OptimizeTrialAsk, m.OptimizeTrialAsk, abandon),
    Call("optimize.pair", m.OptimizeAsk, m.OptimizePairAsk, next_pair),
    Call("optimize.answer", m.OptimizeAnswer, m.OptimizePairAsk, answer),
    Call("optimize.model", m.OptimizeModelAsk, m.OptimizeModel, model),
    Call("optimize.simulate", m.OptimizeSimulate, m.OptimizeAsk, simulate),
    Call("optimize.halt", m.OptimizeAsk, m.OptimizeAsk, halt),
)
CHANNELS = (
    ChannelKind("optimize", (m.OptimizeWatch,), (m.OptimizeWatching, m.OptimizeChanged), OptimizeChannel),
    PLAY,
)
