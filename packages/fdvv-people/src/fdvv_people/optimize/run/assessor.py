"""A simulated person who says which designs of an optimisation they like better. Simulated."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from fdvv.units import FloatArray
from fdvv_people.optimize.people.taste import Taste, draw_taste, felt_liking
from fdvv_people.optimize.problem import Answer
from fdvv_people.optimize.run.player import person_of
from fdvv_people.optimize.run.session import Optimization
from fdvv_people.optimize.run.setup import OptimizeSetup
from fdvv_people.optimize.space import Design

EQUAL_points = 0.15
"""Two designs whose liking differs by less are called equal: half the noise of one. Assumed."""
LINE, PAIR = 41, 42
"""Streams of random numbers that nothing else draws from."""


@dataclass(frozen=True)
class SimulatedAssessor:
    """Somebody simulated who compares designs as they are; no rig renders them.

    Attributes
    ----------
    taste : what the person likes. seed : of the answers; each depends on it and on its number alone.
    """

    taste: Taste
    seed: int = 0

    def answer_next(self, session: Optimization) -> bool:
        """Answer the next trial of a run, then of its retest; False when both are over."""
        trial = session.next_trial()
        if trial is None:
            return False
        lines = len(session.trials) if session.asks_for == "line" else 0
        if trial.number < lines:
            liked = self._felt(session, trial.designs, LINE, trial.number)
            session.answer(trial.number, [int(liked.argmax())])
        else:
            answer = self.compare(session, trial.designs, trial.number - lines)
            session.answer(trial.number, answer.best)
        return True

    def compare(self, session: Optimization, designs: Sequence[Design], number: int) -> Answer:
        """Return which of two designs is liked better, in the comparison of that number."""
        more = float(np.subtract(*self._felt(session, designs, PAIR, number)))
        if abs(more) < EQUAL_points:
            return Answer.EQUAL
        return Answer.FIRST if more > 0 else Answer.SECOND

    def _felt(self, session: Optimization, designs: Sequence[Design], *path: int) -> FloatArray:
        random = np.random.default_rng([self.seed, *path])
        return np.array([felt_liking(session.model(one), self.taste, random) for one in designs])

    def play(self, session: Optimization, report: Callable[[], None] = lambda: None) -> None:
        """Answer until the run is over. An interrupted run continues with the same answers."""
        while self.answer_next(session):
            report()


def assessor_of(setup: OptimizeSetup) -> SimulatedAssessor:
    """Return the simulated person that a setup names. InputError where it names none: a human answers."""
    return SimulatedAssessor(draw_taste(0, person_of(setup)), setup.seed)
