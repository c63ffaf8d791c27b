"""New optimisation runs: what they can be made of, and their setup."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Annotated

from msgspec import Meta

from fdvv.errors import InputError, ModelError
from fdvv_people.optimize.engines.registry import engine_names, pair_engine_names
from fdvv_people.optimize.model_space import model_space, neutral_design
from fdvv_people.optimize.paper_space import paper_design_like, paper_space
from fdvv_people.optimize.people.groups import PAPER_GROUP
from fdvv_people.optimize.problem import PREFERENCE, Trial
from fdvv_people.optimize.run.begin import offered_grid, offered_grids
from fdvv_people.optimize.run.rivals import PEOPLE, SWITCHES, Rival, fixed_rivals, switch_rivals
from fdvv_people.optimize.run.settings import Budget, Presses, Retest
from fdvv_people.optimize.run.setup import OptimizeSetup, SpaceSetup, model_space_setup, wished
from fdvv_people.optimize.space import Design
from fdvv_people.pages.api.optimize import OTHERS, START, TITLE, Level, Name, Number, OptimizeAsk
from fdvv_people.pages.optimizations import Optimizations
from fdvv_people.pages.play_trials import pressed_devices
from fdvv_people.pages.played_trial import TASK, playable, pointing_of
from fdvv_people.task.pointing import ASYNCHRONY, LEVELS_px_s, TemporalPointing
from fdvv_people.task.questionnaire import ITEMS, LIKING
from fdvv_studio.live.press_subject import button_choices
from fdvv_studio.studio.api.documents import ButtonId
from fdvv_studio.studio.contract import Empty, Message, Offer, call
from fdvv_studio.studio.studio import Studio


class OptimizeOffers(Message):
    """What a run can be made of.

    engines : read scores. pair_engines : read which of two is preferred. line_engines : read where on a line
    it feels best. spaces : of designs. objectives : beside the first. starts : buttons that a run may start
    from. others : grids of the project that a run in the paper's space may begin from. switches : may be
    played at the end. round_s : of a press, by level.
    """

    engines: list[Offer]
    pair_engines: list[Offer]
    line_engines: list[Offer]
    spaces: list[Offer]
    rigs: list[Offer]
    levels: list[Offer]
    objectives: list[Offer]
    starts: list[Offer]
    others: list[Offer]
    switches: list[str]
    round_s: dict[str, float]


class OptimizeDevices(Message):
    """Devices that a person presses, as there are just now."""

    devices: list[Offer]


class OptimizeCreate(Message):
    """Begin a run.

    title : for people. engine, space : of the offers. preference : designs are compared, not scored.
    simulated : a simulated person plays. level : of temporal pointing.
    also : objectives beside asynchrony, of designs that are scored. start : a button; None starts from what
    the engine suggests. rig : must be able to render every design; None asks for none.
    budget : trials, comparisons or lines.
    task_presses : of a score, 20 in the paper. others : a grid to begin from, in the paper's space; None
    begins from nothing. retest : blocks of trials, or comparisons, of the result with the start.
    switches : the shipped switches are in these blocks too, and in the paper's space the best fixed design.
    """

    title: Name
    engine: Name
    space: Name
    preference: bool
    simulated: bool
    level: Level
    also: Annotated[list[Name], Meta(max_length=4)]
    start: ButtonId | None
    rig: Annotated[str, Meta(max_length=300)] | None
    seed: Number
    budget: Budget
    task_presses: Presses = 20
    others: Annotated[str, Meta(max_length=300)] | None = None
    retest: Retest = 6
    switches: bool = False


PAPER = "paper"
ENGINE_DESCRIPTIONS = {
    "random": "draws designs by lot",
    "sobol": "spreads designs evenly",
    "gp": "learns from every score, and knows how noisy each is",
    "botorch": "the strongest; needs the extra fdvv[botorch]",
    "preference": "learns from which of two you prefer",
    "preference-botorch": "the same, stronger; needs the extra fdvv[botorch]",
    "preference-line": "learns from where on a line you like it best",
}
SPACE_DESCRIPTIONS = {
    "FDV": "force, bump, actuation and vibration of your button, as real buttons have them",
    "FDVV": "the same and a scale of force for every speed it knows",
    PAPER: "the paper's eight parameters, 35 to 310 cN; begun near your button",
}
OBJECTIVE_DESCRIPTIONS = {
    "lost_ratio": "share of rounds lost",
    LIKING.name: f"how much you like it, {len(ITEMS)} questions after every trial",
}


@call("optimize.offers")
def offers(studio: Studio, _ask: Empty) -> OptimizeOffers:
    pairs = pair_engine_names()
    return OptimizeOffers(
        _engine_offers(engine_names()),
        _engine_offers(pairs),
        _engine_offers(name for name in engine_names(choices=True) if name not in pairs),
        [Offer(name, about) for name, about in SPACE_DESCRIPTIONS.items()],
        [Offer(entry.rig_id, entry.about) for entry in studio.rigs.entries()],
        [Offer(name, f"{speed:g} pixels per second") for name, speed in LEVELS_px_s.items()],
        [Offer(name, about) for name, about in OBJECTIVE_DESCRIPTIONS.items()],
        [Offer(choice.id, choice.name) for choice in button_choices(studio.catalog)],
        [Offer(name, grid.about) for name, grid in offered_grids(studio.project).items()],
        list(SWITCHES),
        {level: TemporalPointing(level).period_s for level in LEVELS_px_s},
    )


def _engine_offers(names: Iterable[str]) -> list[Offer]:
    return [Offer(name, ENGINE_DESCRIPTIONS.get(name, "")) for name in names]


@call("optimize.devices")
def devices(_studio: Studio, _ask: Empty) -> OptimizeDevices:
    return OptimizeDevices([Offer(name, about) for name, about in pressed_devices()])


@call("optimize.create")
def create(studio: Studio, ask: OptimizeCreate) -> OptimizeAsk:
    space, start = _space(studio, ask)
    others, prior = _others(studio, ask)
    also = () if ask.preference else ask.also
    setup = OptimizeSetup(
        space=space,
        engine=ask.engine,
        task=PREFERENCE if ask.preference else TASK,
        level=ask.level,
        simulated=ask.simulated,
        objectives=(ASYNCHRONY, *wished(also)),
        seed=ask.seed,
        budget=ask.budget,
        start=start,
        prior=prior,
        rivals=_rivals(ask, start),
        about={
            TITLE: ask.title.strip(),
            START: ask.start,
            OTHERS: others,
            OptimizeSetup.PRESSES: ask.task_presses,
            OptimizeSetup.RETEST: ask.retest,
            OptimizeSetup.NAME: _start_name(studio, ask),
        },
    )
    if playable(setup):
        try:
            pointing_of(setup)
        except ModelError as error:
            raise InputError("optimise", "setup", str(error), "choose another") from error
    return OptimizeAsk(studio.part(Optimizations).create(setup))


def _start_name(studio: Studio, ask: OptimizeCreate) -> str:
    if ask.start is None:
        return ""
    name = studio.catalog.model(ask.start).name
    names = {choice.id: choice.name for choice in button_choices(studio.catalog)}
    name = names.get(ask.start, name)
    return f"the paper's design nearest to {name}" if ask.space == PAPER else name


def _rivals(ask: OptimizeCreate, start: Design | None) -> tuple[Rival, ...]:
    """Return what is played at the end beside start and result; the paper's design near a switch is none."""
    if not ask.switches or ask.preference:
        return ()
    if ask.space != PAPER:
        return switch_rivals(SWITCHES, ((ask.start or "").removeprefix("builtin:"), start))
    group = PAPER_GROUP if ask.simulated else PEOPLE
    return switch_rivals(SWITCHES) + fixed_rivals(paper_space(), ask.level, group)


def _space(studio: Studio, ask: OptimizeCreate) -> tuple[SpaceSetup, dict[str, float] | None]:
    """Return the space, and the design in it that the run starts from. InputError."""
    base = None if ask.start is None else studio.catalog.model(ask.start)
    if ask.space == PAPER:
        return SpaceSetup(rig=ask.rig), None if base is None else paper_design_like(base)
    if ask.space not in SPACE_DESCRIPTIONS:
        raise InputError(
            "optimise", ask.space, "there is no such space", f"use {', '.join(SPACE_DESCRIPTIONS)}"
        )
    if base is None:
        reason = "varies a button, and none was named"
        raise InputError("optimise", ask.space, reason, "choose one to start from")
    setup = model_space_setup(base, (ask.space,), rig=ask.rig)
    return setup, neutral_design(model_space(base, (ask.space,), setup.bounds), base)


def _others(studio: Studio, ask: OptimizeCreate) -> tuple[str, tuple[Trial, ...]]:
    """Return the prior data of a run, in words and as trials. InputError."""
    if ask.others is None:
        return "", ()
    if ask.also:
        reason = "others scored asynchrony alone"
        raise InputError("optimise", ask.others, reason, "begin from nothing, or leave out other wishes")
    if ask.preference or ask.space != PAPER:
        reason = f"others scored designs of the space {PAPER}"
        raise InputError("optimise", ask.others, reason, "begin from nothing, or choose that space")
    grid = offered_grid(studio.project, ask.others)
    return grid.about, grid.prior()
