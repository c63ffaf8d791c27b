"""Go or no-go: how often a button is triggered that should not be, or is not that should."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np

from fdvv.errors import ModelError
from fdvv_people.task.score import Objective, Score
from fdvv_people.task.task import TaskPress, check_also

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
