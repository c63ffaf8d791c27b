"""What a person does with a button, and how well it went: tasks, apart from who or what presses."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Protocol

import numpy as np

from fdvv.errors import ModelError
from fdvv.optimize.problem import Objective, Score
from fdvv.units import FloatArray


@dataclass(frozen=True)
class TaskPress:
    """One round of a task: when something was to happen, and what did.

    Attributes
    ----------
    target_s : when the key was to go down; None where the task sets no time. On the clock of activations_s.
    activations_s : when the key went down, rising; empty: it never did (a miss).
    effort_N_s : impulse of the finger on the cap, None where nothing measures it.
    """

    target_s: float | None
    activations_s: tuple[float, ...]
    effort_N_s: float | None = None


class Task(Protocol):
    """A task of some rounds, each one press or more."""

    @property
    def name(self) -> str:
        """Its name, as `--task` knows it."""

    @property
    def rounds(self) -> int:
        """How many rounds make a score."""

    @property
    def objectives(self) -> tuple[Objective, ...]:
        """What it scores, the first one foremost."""

    def scores(self, presses: Sequence[TaskPress]) -> dict[str, Score]:
        """Score the rounds, by objective, with standard errors. ModelError if there is nothing to score."""


def mean_score(values: FloatArray) -> Score:
    """Return the mean of (n,) values and its standard error (None of one). ModelError if there is none."""
    if not values.size:
        raise ModelError("there is nothing to score: no round was played")
    error = float(np.std(values, ddof=1) / np.sqrt(values.size)) if values.size > 1 else None
    return Score(float(np.mean(values)), error)


LEVELS_px_s = {"easy": 100.0, "hard": 150.0}
"""Speed of the bullet (CHI 2020)."""
LOST_ms = 400.0
"""What a lost round counts, and how far from the target a press may be: the penalty for an early release in
the first author's own toy of this task (bayes_temp_point); CHI 2020 states none."""
ASYNCHRONY = Objective("asynchrony_ms")
MORE = ("lost_ratio", "effort_N_s")
"""What else may be scored."""


def check_also(also: Sequence[str], known: Sequence[str]) -> None:
    """Raise ModelError where further objectives are unknown."""
    if unknown := [name for name in also if name not in known]:
        raise ModelError(f"also must be of {', '.join(known)}, got {unknown}")


@dataclass(frozen=True)
class TemporalPointing:
    """The task of CHI 2020: nothing shows the press, only the bullet is seen.

    Attributes
    ----------
    level : "easy" (100 pixels per second) or "hard" (150).
    rounds : presses of a score; the paper's 20.
    strip_px : length of the strip; a bullet starts every strip_px / speed. 144: one metre of the densest
        strip of the paper's kind (assumed, the paper states no length).
    target_px : the centre of the zone, counted from where bullets start (assumed).
    zone_px : width of the zone (assumed).
    quantised : the answer is in whole frames of the strip, one a pixel, as a board that counts frames
        tells it (10 and 6.7 ms); false: as exact as the times are, as a device's own clock tells it.
    also : further objectives, of MORE.

    A round counts |time of the key - time of the target|. A miss (no key within LOST_ms of the target) and a
    false trigger (a key before that, whatever follows) are lost: each counts LOST_ms.
    """

    level: str = "easy"
    rounds: int = 20
    strip_px: float = 144.0
    target_px: float = 100.0
    zone_px: float = 10.0
    quantised: bool = True
    also: tuple[str, ...] = field(default=())

    def __post_init__(self) -> None:
        if self.level not in LEVELS_px_s:
            raise ModelError(f"the level must be one of {', '.join(LEVELS_px_s)}, got {self.level!r}")
        if self.rounds < 1 or not 0 < self.zone_px < self.target_px <= self.strip_px:
            raise ModelError(f"temporal pointing needs a round and a zone on its strip, got {self}")
        check_also(self.also, MORE)

    @property
    def name(self) -> str:
        return f"pointing-{self.level}"

    @property
    def speed_px_s(self) -> float:
        return LEVELS_px_s[self.level]

    @property
    def frame_s(self) -> float:
        """How long a pixel is lit."""
        return 1.0 / self.speed_px_s

    @property
    def cue_s(self) -> float:
        """How long a bullet is seen before it is at the target."""
        return self.target_px / self.speed_px_s

    @property
    def zone_s(self) -> float:
        """How long the bullet is in the zone."""
        return self.zone_px / self.speed_px_s

    @property
    def period_s(self) -> float:
        return self.strip_px / self.speed_px_s

    @property
    def objectives(self) -> tuple[Objective, ...]:
        return (ASYNCHRONY, *map(Objective, self.also))

    def target_s(self, number: int) -> float:
        """Return when the bullet of a round, from 0, is at the target."""
        return number * self.period_s + self.cue_s

    def asynchrony_ms(self, press: TaskPress) -> float | None:
        """Return how late a press was (negative: early); None: the round is lost."""
        if press.target_s is None:
            raise ModelError("temporal pointing needs the time of the target")
        if not press.activations_s:
            return None
        late_ms = 1e3 * (min(press.activations_s) - press.target_s)
        if self.quantised:
            frame_ms = 1e3 * self.frame_s
            late_ms = frame_ms * round(late_ms / frame_ms)
        return late_ms if abs(late_ms) < LOST_ms else None

    def scores(self, presses: Sequence[TaskPress]) -> dict[str, Score]:
        """Score the rounds, with standard errors of the means. ModelError if there is nothing to score."""
        late_ms = [self.asynchrony_ms(press) for press in presses]
        columns = {
            ASYNCHRONY.name: [LOST_ms if late is None else abs(late) for late in late_ms],
            "lost_ratio": [float(late is None) for late in late_ms],
            "effort_N_s": [press.effort_N_s for press in presses if press.effort_N_s is not None],
        }
        names = (ASYNCHRONY.name, *self.also)
        return {name: mean_score(np.array(column)) for name, column in columns.items() if name in names}


RATE, UNEVEN = Objective("rate_Hz", larger_is_better=True), Objective("interval_spread_ratio")


@dataclass(frozen=True)
class RapidTapping:
    """Tap as fast as possible.

    Attributes
    ----------
    rounds : taps of a score, three at least.

    Scores the rate of activations and the spread of their intervals over their mean. Taps that the key does
    not tell make an interval longer; fewer than three activations are a rate of 0 and a spread of 1.
    """

    rounds: int = 20

    def __post_init__(self) -> None:
        if self.rounds < 3:
            raise ModelError(f"rapid tapping needs three taps at least, got {self.rounds}")

    @property
    def name(self) -> str:
        return "tapping"

    @property
    def objectives(self) -> tuple[Objective, ...]:
        return (RATE, UNEVEN)

    def scores(self, presses: Sequence[TaskPress]) -> dict[str, Score]:
        """Score the taps; errors as of independent intervals. ModelError if there is nothing to score."""
        if not presses:
            raise ModelError("there is nothing to score: no round was played")
        keys = np.sort([key for press in presses for key in press.activations_s])
        intervals = np.diff(keys)
        if intervals.size < 2:
            return {RATE.name: Score(0.0), UNEVEN.name: Score(1.0)}
        ratio = float(np.std(intervals, ddof=1) / np.mean(intervals))
        rate = float(1 / np.mean(intervals))
        return {
            RATE.name: Score(rate, rate * ratio / float(np.sqrt(intervals.size))),
            UNEVEN.name: Score(ratio, ratio / float(np.sqrt(2 * intervals.size))),
        }


ERRORS = Objective("errors_ratio")
PARTS = ("false_ratio", "missed_ratio")


@dataclass(frozen=True)
class Accuracy:
    """Go or no-go.

    Attributes
    ----------
    rounds : of a score. go_ratio : share of rounds that ask for a press. seed : of their order.
    also : further objectives, of PARTS: false triggers over no-go rounds, misses over go rounds.

    A round without a target is no-go: any activation is a false trigger. In a go round a miss is no
    activation from the target on.
    """

    rounds: int = 40
    go_ratio: float = 0.5
    seed: int = 0
    also: tuple[str, ...] = field(default=())

    def __post_init__(self) -> None:
        if not (0 < self.go_ratio < 1 and 1 <= round(self.go_ratio * self.rounds) < self.rounds):
            raise ModelError(f"accuracy needs rounds of go and of no-go, got {self}")
        check_also(self.also, PARTS)

    @property
    def name(self) -> str:
        return "accuracy"

    @property
    def objectives(self) -> tuple[Objective, ...]:
        return (ERRORS, *map(Objective, self.also))

    def goes(self) -> tuple[bool, ...]:
        """Return for each round whether it asks for a press."""
        go = np.arange(self.rounds) < round(self.go_ratio * self.rounds)
        return tuple(np.random.default_rng(self.seed).permutation(go).tolist())

    def scores(self, presses: Sequence[TaskPress]) -> dict[str, Score]:
        """Score the rounds; errors as of Agresti and Coull, so that none of few is not certain."""
        false = [bool(press.activations_s) for press in presses if press.target_s is None]
        missed = [
            not any(key >= press.target_s for key in press.activations_s)
            for press in presses
            if press.target_s is not None
        ]
        wrong = {ERRORS.name: false + missed, "false_ratio": false, "missed_ratio": missed}
        return {one.name: _share(wrong[one.name]) for one in self.objectives}


def _share(wrong: list[bool]) -> Score:
    if not wrong:
        raise ModelError("there is nothing to score: no round was played")
    likely, count = (sum(wrong) + 2) / (len(wrong) + 4), len(wrong) + 4
    return Score(sum(wrong) / len(wrong), float(np.sqrt(likely * (1 - likely) / count)))
