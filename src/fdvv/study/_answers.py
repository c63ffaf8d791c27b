"""Unsealed or foreign answers as columns: what every analysis begins with."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from fdvv.errors import ModelError
from fdvv.units import FloatArray


@dataclass(frozen=True, eq=False)
class Answers:
    """A row for every trial that was planned; what a person did not do is missing, not left out.

    Attributes
    ----------
    kind : of the study, see StudyKind. stimuli : names, in the order of rating columns; of two the second is
        the one that a preference counts for.
    person, item : names, (n,) of str. round : (n,) of int.
    choice : (n,) of str: a stimulus's name, "equal", or "" where missing or not asked.
    correct : (n,) 1, 0, or nan where there is no right answer, or none was given.
    ratings : by name, (n, stimuli), nan where missing.
    ratio : (n,) staircase level, nan elsewhere. time_s : (n,) nan where unknown.
    excluded : (n,) of str: why a row does not count; "" where it does.
    simulated : the answers are those of simulated participants.

    ModelError where columns differ in length.
    """

    kind: str
    stimuli: tuple[str, ...]
    person: np.ndarray
    item: np.ndarray
    round: np.ndarray
    choice: np.ndarray
    correct: FloatArray
    ratings: dict[str, FloatArray] = field(default_factory=dict)
    ratio: FloatArray | None = None
    time_s: FloatArray | None = None
    excluded: np.ndarray | None = None
    simulated: bool = False

    def __post_init__(self) -> None:
        n = len(self.person)
        columns = [self.item, self.round, self.choice, self.correct, *self.ratings.values()]
        columns += [one for one in (self.ratio, self.time_s, self.excluded) if one is not None]
        if any(len(one) != n for one in columns):
            raise ModelError(f"columns of answers differ in length from its {n} persons")

    @property
    def counts(self) -> np.ndarray:
        """Tell which rows count, (n,) of bool."""
        return np.ones(len(self.person), bool) if self.excluded is None else self.excluded == ""
