"""Temporal pointing: the key goes down as a bullet reaches its target."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np

from fdvv.errors import ModelError
from fdvv_people.task.score import Objective, Score
from fdvv_people.task.task import TaskPress, check_also, mean_score

LEVELS_px_s = {"easy": 100.0, "hard": 150.0}
"""Speed of the bullet (CHI 2020)."""
LOST_ms = 400.0
"""What a lost round counts, and how far from the target a press may be: the penalty for an early release in
the first author's own toy of this task (bayes_temp_point); CHI 2020 states none."""
ASYNCHRONY = Objective("asynchrony_ms")
MORE = ("lost_ratio", "effort_N_s")
"""What else may be scored."""


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
