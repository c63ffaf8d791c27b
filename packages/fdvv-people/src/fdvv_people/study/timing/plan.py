"""What a timing study is: declared in a file that people write, and frozen before the first person."""

from __future__ import annotations

from typing import Annotated, Any, Literal

from msgspec import Meta, Struct

from fdvv.program.library import names_program
from fdvv_people.study.plan.plan import Name, Page
from fdvv_people.task.pointing import LEVELS_px_s, TemporalPointing
from fdvv_people.task.tapping import RapidTapping

TaskName = Literal["temporal-pointing", "tapping"]
Level = Literal["easy", "hard"]
ConditionKind = Literal["optimised", "random", "button", "program", "switch", "key"]
"""optimised: what the engine recommends for the person and level. random: a random design of the same space,
drawn for each person. button, program: one that is rendered. switch: a mechanical switch on the table, wired
to a board that reports it as a key. key: a key of the person's own keyboard."""
ON_THE_TABLE: tuple[ConditionKind, ...] = ("switch", "key")
DESIGNED: tuple[ConditionKind, ...] = ("optimised", "random")
KEYS: dict[str, str] = {"switch": "F13", "key": "Space"}
"""`KeyboardEvent.code` by kind, where the plan names none."""
DAY_s = 86_400.0  # 24 h: gaps are counted from hour to hour, not by the calendar


class Condition(Struct, frozen=True, forbid_unknown_fields=True, kw_only=True):
    """Something that is pressed in the validation.

    Attributes
    ----------
    name : what analyses call it; of a switch or key its person reads it too.
    kind : see ConditionKind.
    button : of the kind button a built-in one or a model file beside the study, of program a program; of
        switch and key the model that stands for it in simulations.
    key : `KeyboardEvent.code` that a switch or key reports; "": by kind, see KEYS.
    latency_ms, latency_error_ms : of a switch or key, from contact to the browser's event, and how far that
        may be off; None: what the page states for a keyboard.
    """

    name: Name
    kind: ConditionKind
    button: str = ""
    key: Annotated[str, Meta(max_length=40)] = ""
    latency_ms: Annotated[float, Meta(ge=0, le=1000)] | None = None
    latency_error_ms: Annotated[float, Meta(ge=0, le=1000)] | None = None

    @property
    def on_the_table(self) -> bool:
        """Whether it is a mechanical one, which nothing hides."""
        return self.kind in ON_THE_TABLE

    @property
    def code(self) -> str:
        """The key that counts; empty of what is rendered."""
        return self.key or KEYS.get(self.kind, "")


class TrainingPlan(Struct, frozen=True, forbid_unknown_fields=True, kw_only=True):
    """The search for a person's own buttons.

    Attributes
    ----------
    trials : of each level. engine, options : what suggests designs of the paper's space.
    """

    trials: Annotated[int, Meta(ge=1, le=1000)] = 27
    engine: str = "gp"
    options: dict[str, Any] = {}


class TimingClaim(Struct, frozen=True, forbid_unknown_fields=True, kw_only=True):
    """The main claim, stated before the first person.

    Attributes
    ----------
    better : the condition that is claimed to have the better score. than : every one of these, () for all
        others. at_least_Hz : of tapping: the rate that people reach with it. alpha : level of the tests.
    """

    better: Name
    than: tuple[Name, ...] = ()
    at_least_Hz: Annotated[float, Meta(gt=0, le=100)] | None = None
    alpha: Annotated[float, Meta(gt=0, lt=1)] = 0.05


class TimingPlan(Struct, frozen=True, forbid_unknown_fields=True, kw_only=True):
    """A timing study as it is declared; `plan_problems` lists what is wrong with it.

    Attributes
    ----------
    name, title : of the study; title by language. task : what people do.
    conditions : what is compared, in an order that means nothing.
    levels : of temporal pointing, see `fdvv_people.task.pointing.LEVELS_px_s`. presses : of a trial.
    tap_s : how long a trial of tapping lasts; each whole second is one round.
    rounds : how often every condition appears per level. people : that are planned.
    training : the search before; None: there is none, and no gap.
    gap_days : the validation begins no sooner after the training. due_days : who has not come back by then is
        overdue. reminder : by language, with {date} and {person}.
    break_every_min, break_min : the first trial boundary after so long begins a break of so long.
    languages : the first is the default. pages : outside the trials, in order. claim : see there.
    """

    format: Literal["fdvv-timing"] = "fdvv-timing"
    version: Literal[1] = 1
    name: Name
    title: dict[str, str]
    task: TaskName = "temporal-pointing"
    conditions: tuple[Condition, ...]
    levels: tuple[Level, ...] = ()
    presses: Annotated[int, Meta(ge=2, le=1000)] = 20
    tap_s: Annotated[int, Meta(ge=3, le=120)] = 10
    rounds: Annotated[int, Meta(ge=1, le=20)] = 2
    people: Annotated[int, Meta(ge=1, le=1000)] = 12
    training: TrainingPlan | None = None
    gap_days: Annotated[float, Meta(ge=0, le=365)] = 7.0
    due_days: Annotated[float, Meta(ge=0, le=730)] = 14.0
    reminder: dict[str, str] = {}
    break_every_min: Annotated[float, Meta(ge=0)] = 15.0
    break_min: Annotated[float, Meta(ge=0)] = 3.0
    languages: tuple[str, ...] = ("en",)
    pages: tuple[Page, ...] = ()
    claim: TimingClaim | None = None

    @property
    def kind(self) -> str:
        """What a list of studies calls it."""
        return "tapping" if self.tapping else "timing"

    @property
    def named(self) -> frozenset[str]:
        """Built-in buttons, and the files beside the study, that the plan names; no shipped programs."""
        names = {one.button for one in self.conditions if one.button}
        return frozenset(one for one in names if "." in one or not names_program(one))

    @property
    def tapping(self) -> bool:
        return self.task == "tapping"

    @property
    def all_levels(self) -> tuple[str, ...]:
        """The levels; of a task without any the one that has no name."""
        return self.levels or ("",)

    @property
    def trial_rounds(self) -> int:
        """How many rounds a trial has: presses, or seconds of tapping."""
        return self.tap_s if self.tapping else self.presses

    @property
    def trials(self) -> int:
        """How many trials a person has: training, then validation."""
        return self.training_trials + self.rounds * len(self.all_levels) * len(self.conditions)

    @property
    def training_trials(self) -> int:
        return len(self.all_levels) * self.training.trials if self.training else 0

    def condition(self, name: str) -> Condition:
        """Return a condition by its name. KeyError."""
        return {one.name: one for one in self.conditions}[name]

    def pointing(self, level: str) -> TemporalPointing:
        """Return the task of a level, as clocks time it: not in whole frames of a strip."""
        return TemporalPointing(level, self.presses, quantised=False, also=("lost_ratio",))

    def task_of(self, level: str) -> TemporalPointing | RapidTapping:
        return RapidTapping(max(3, self.tap_s)) if self.tapping else self.pointing(level)

    def round_s(self, level: str) -> float:
        """Return how long a round takes."""
        return 1.0 if self.tapping else self.pointing(level).period_s

    @property
    def score(self) -> str:
        """Name of what a trial scores first."""
        return self.task_of(next(iter(LEVELS_px_s))).objectives[0].name
