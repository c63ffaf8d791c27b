"""What a person does with a button, and how well it went: tasks, apart from who or what presses."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Protocol

import numpy as np

from fdvv.errors import ModelError
from fdvv.units import FloatArray
from fdvv_people.task.score import Objective, Score


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


def check_also(also: Sequence[str], known: Sequence[str]) -> None:
    """Raise ModelError where further objectives are unknown."""
    if unknown := [name for name in also if name not in known]:
        raise ModelError(f"also must be of {', '.join(known)}, got {unknown}")
