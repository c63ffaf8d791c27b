"""Temporal pointing: the key is to go down just as a bullet on a strip of lights reaches its zone."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np

from fdvv.errors import ModelError
from fdvv.optimize._engine import Objective
from fdvv.optimize._task import TaskPress, mean_score
from fdvv.optimize._trial import Score
from fdvv.units import FloatArray

LEVELS_px_s = {"easy": 100.0, "hard": 150.0}
"""Speed of the bullet (CHI 2020)."""
LOST_ms = 400.0
"""What a lost round counts, and how far from the target a press may be: the penalty for an early release in
the first author's own toy of this task (bayes_temp_point); CHI 2020 states none."""
ASYNCHRONY = Objective("asynchrony_ms")
MORE = {
    "lost_ratio": Objective("lost_ratio"),
    "effort_N_s": Objective("effort_N_s"),
}
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
    quantised : the answer is told in whole frames of the strip, one a pixel, as a board that counts frames
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
        unknown = [name for name in self.also if name not in MORE]
        if unknown:
            raise ModelError(f"also must be of {', '.join(MORE)}, got {unknown}")

    @property
    def name(self) -> str:
        """Get its name."""
        return f"pointing-{self.level}"

    @property
    def speed_px_s(self) -> float:
        """Get the speed of the bullet."""
        return LEVELS_px_s[self.level]

    @property
    def frame_s(self) -> float:
        """Get how long a pixel is lit."""
        return 1.0 / self.speed_px_s

    @property
    def cue_s(self) -> float:
        """Get how long a bullet is seen before it is at the target."""
        return self.target_px / self.speed_px_s

    @property
    def zone_s(self) -> float:
        """Get how long the bullet is in the zone."""
        return self.zone_px / self.speed_px_s

    @property
    def period_s(self) -> float:
        """Get the time from bullet to bullet."""
        return self.strip_px / self.speed_px_s

    @property
    def objectives(self) -> tuple[Objective, ...]:
        """Get what it scores."""
        return (ASYNCHRONY, *(MORE[name] for name in self.also))

    def target_s(self, number: int) -> float:
        """Give when the bullet of a round, from 0, is at the target."""
        return number * self.period_s + self.cue_s

    def asynchrony_ms(self, press: TaskPress) -> float | None:
        """Give how late a press was (negative: early); None: the round is lost."""
        if press.target_s is None:
            raise ModelError("temporal pointing needs the time of the target")
        if not press.activations_s:
            return None
        late_ms = 1e3 * (min(press.activations_s) - press.target_s)
        if self.quantised:
            frame_ms = 1e3 * self.frame_s
            late_ms = frame_ms * round(late_ms / frame_ms)
        return late_ms if abs(late_ms) < LOST_ms else None

    def counted_ms(self, presses: Sequence[TaskPress]) -> FloatArray:
        """Give what each round counts, (n,)."""
        found = [self.asynchrony_ms(press) for press in presses]
        return np.array([LOST_ms if late is None else abs(late) for late in found])

    def scores(self, presses: Sequence[TaskPress]) -> dict[str, Score]:
        """Score the rounds, with standard errors of the means. ModelError if there is nothing to score."""
        columns = {"asynchrony_ms": self.counted_ms(presses)}
        if "lost_ratio" in self.also:
            columns["lost_ratio"] = np.array([self.asynchrony_ms(press) is None for press in presses], float)
        if "effort_N_s" in self.also:
            columns["effort_N_s"] = np.array([p.effort_N_s for p in presses if p.effort_N_s is not None])
        return {name: mean_score(column) for name, column in columns.items()}
