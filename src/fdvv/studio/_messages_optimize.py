"""Messages of the page on which buttons are optimised: runs, their trials, comparisons, what is found."""

from __future__ import annotations

from typing import Annotated, Any, Literal

from msgspec import Meta, Struct

from fdvv.optimize import Answer, TrialState
from fdvv.studio._messages_documents import ButtonId

Number = Annotated[int, Meta(ge=0, le=2**31)]
Name = Annotated[str, Meta(max_length=100)]
Level = Literal["easy", "hard"]


class OptimizeOffersAsk(Struct, frozen=True, forbid_unknown_fields=True):
    """Ask what a run can be made of."""


class OptimizeOffer(Struct, frozen=True):
    """Something to choose: its name for the server, and what it is."""

    name: str
    told: str


class OptimizeOffers(Struct, frozen=True):
    """What a run can be made of.

    engines : read scores. pair_engines : read preferences. spaces : of designs. objectives : beside the
    first. starts : buttons that a run may start from. others : grids of the project that a run in the
    paper's space may begin from.
    """

    engines: list[OptimizeOffer]
    pair_engines: list[OptimizeOffer]
    spaces: list[OptimizeOffer]
    rigs: list[OptimizeOffer]
    levels: list[OptimizeOffer]
    objectives: list[OptimizeOffer]
    starts: list[OptimizeOffer]
    others: list[OptimizeOffer]


class OptimizeDevicesAsk(Struct, frozen=True, forbid_unknown_fields=True):
    """Ask what a person can press beside the page."""


class OptimizeDevices(Struct, frozen=True):
    """Devices that a person presses, as there are just now."""

    devices: list[OptimizeOffer]


class OptimizeCreate(Struct, frozen=True, forbid_unknown_fields=True):
    """Begin a run.

    title : for people. engine, space : of the offers. preference : designs are compared, not scored.
    simulated : a simulated person plays, not whoever sits here. level : of temporal pointing.
    also : objectives beside asynchrony. start : a button; None starts from what the engine suggests.
    rig : must be able to render every design; None asks for none. budget : trials, or comparisons.
    task_presses : of a score, 20 in the paper. others : a grid to begin from, in the paper's space; None
    begins from nothing.
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
    budget: Annotated[int, Meta(ge=1, le=500)]
    task_presses: Annotated[int, Meta(ge=2, le=100)] = 20
    others: Annotated[str, Meta(max_length=300)] | None = None


class OptimizeListAsk(Struct, frozen=True, forbid_unknown_fields=True):
    """Ask for the runs there are."""


class OptimizeScore(Struct, frozen=True):
    """A score and its standard error."""

    value: float
    error: float | None


class OptimizeRow(Struct, frozen=True):
    """A run in short.

    spent : trials, or comparisons, that count. problem : why it cannot be read; empty if it can.
    best : the least score of the first objective. simulated : played by a simulated person. made : when, UTC.
    """

    run: int
    title: str
    engine: str
    preference: bool
    simulated: bool
    level: str
    spent: int
    budget: int
    best: OptimizeScore | None
    made: str
    problem: str


class OptimizeRows(Struct, frozen=True):
    """All runs, the newest first."""

    rows: list[OptimizeRow]


class OptimizeAsk(Struct, frozen=True, forbid_unknown_fields=True):
    """Name a run."""

    run: Number


class OptimizeCurve(Struct, frozen=True):
    """The press of a design, for a small picture."""

    step_mm: float
    force_cN: list[float]
    actuation_mm: float | None


class OptimizeTrial(Struct, frozen=True):
    """A trial. front : no other one is better in every objective; False where there is one objective."""

    number: int
    design: dict[str, float]
    edited: bool
    state: TrialState
    scores: dict[str, OptimizeScore]
    reason: str
    origin: str
    curve: OptimizeCurve
    front: bool


class OptimizePair(Struct, frozen=True):
    """Two designs and what was said of them."""

    number: int
    first: dict[str, float]
    second: dict[str, float]
    first_curve: OptimizeCurve
    second_curve: OptimizeCurve
    answer: Answer | None


class OptimizeParameter(Struct, frozen=True):
    """A parameter and its bounds."""

    name: str
    low: float
    high: float


class OptimizeObjective(Struct, frozen=True):
    """What is scored."""

    name: str
    larger_is_better: bool


class OptimizeStrip(Struct, frozen=True):
    """The strip of temporal pointing, in pixels from where bullets start."""

    pixels: int
    zone_px: int
    zone_half_px: int
    speed_px_s: float


class OptimizeSimulated(Struct, frozen=True):
    """A simulated person who plays: how far, and whether still at it. told : of the person."""

    running: bool
    done: int
    total: int
    told: str
    fault: str


class OptimizeDetail(Struct, frozen=True):
    """A run and all of its trials.

    rounds : presses of a score. rules : what every design must hold. start : the design the run began with,
    None while there is none. start_name : the button it is near; empty if an engine chose it.
    others : what it began from; empty if from nothing. playable : a person can play its task here.
    """

    row: OptimizeRow
    seed: int
    parameters: list[OptimizeParameter]
    rules: list[str]
    objectives: list[OptimizeObjective]
    rounds: int
    strip: OptimizeStrip
    trials: list[OptimizeTrial]
    pairs: list[OptimizePair]
    start: dict[str, float] | None
    start_name: str
    others: str
    simulated: OptimizeSimulated | None
    playable: bool


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


class OptimizeSimulate(Struct, frozen=True, forbid_unknown_fields=True):
    """Have a simulated person play so many trials. person : seed that draws them."""

    run: Number
    person: Number
    trials: Annotated[int, Meta(ge=1, le=500)]


class OptimizeWatch(Struct, frozen=True, forbid_unknown_fields=True, tag="watch"):
    """Tell of every change of any run from now on."""


class OptimizeWatching(Struct, frozen=True, tag="watching"):
    """The watch is in force."""


class OptimizeChanged(Struct, frozen=True, tag="changed"):
    """A run is not what it was."""

    run: int
