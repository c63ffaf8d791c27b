"""Simulated people for benchmarks of engines: noisy scores of 20 presses, and what they are expected to be.

Simulated. People and presses of seeds below FIRST_SEED are for tuning; those from it on judge.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import lru_cache

import numpy as np
from scipy.special import ndtri

from fdvv.model.model import FDVVModel
from fdvv.units import FloatArray
from fdvv_people.optimize.paper_space import paper_model
from fdvv_people.optimize.people.groups import PAPER_GROUP, group_named
from fdvv_people.optimize.people.simulate import score_design, simulate_task
from fdvv_people.optimize.people.user import SimulatedUser, draw_user, spread_factor, timing_spread_s
from fdvv_people.optimize.space import Design
from fdvv_people.task.pointing import LOST_ms, TemporalPointing
from fdvv_people.task.score import Score

FIRST_SEED = 2000
"""Below it seeds were used to tune, or were looked at while an engine was changed."""
SESSIONS, TRUE_SEED = 2, 7_000_000
PRACTISED = 600
"""Presses before those that a design is truly judged by: those of 30 trials."""
NODES = ndtri((np.arange(200) + 0.5) / 200)
"""Of a normal distribution, each as likely as the next."""
SHIFTED: Mapping[str, float] = {"pace_mm_s": 1.3, "stiffness_N_m": 0.7, "push_cN": 0.75, "bias_ms": 1.4}
"""Ratios of people who are not those that are judged: quicker, softer, weaker, later."""


@dataclass(frozen=True)
class Person:
    """A simulated person at a level.

    Attributes
    ----------
    seed, number : of the draw. group : of people, see fdvv_people.optimize.people.groups.
    """

    seed: int
    number: int
    level: str
    group: str = PAPER_GROUP

    @property
    def user(self) -> SimulatedUser:
        """Draw the person."""
        return _user(self.seed, self.number, self.group)

    @property
    def task(self) -> TemporalPointing:
        """Get what is played."""
        return TemporalPointing(self.level)

    def score(self, design: Design, seed: int) -> dict[str, Score]:
        """Score 20 presses."""
        return score_design(self.task, paper_model(design), self.user, seed)

    def expected_ms(self, design: Design) -> float:
        """Return the expected score; presses are the same for every design."""
        return expected_ms(self.task, paper_model(design), self.user)


@lru_cache(maxsize=256)
def _user(seed: int, number: int, group: str) -> SimulatedUser:
    return draw_user(number, seed, group_named(group))


def expected_ms(
    task: TemporalPointing, model: FDVVModel, user: SimulatedUser, sessions: int = SESSIONS
) -> float:
    """Return what a score is on average: over sessions on the twin, in closed form over the timing's scatter.

    A movement's scatter only shifts a press in time, and so does what a person makes up for, a sum of what
    was felt before. Sessions are played without any scatter and it is added as its distribution.
    """
    still = replace(user, clock_ratio=1e-9, motor_ms=0.0, percept_ms=0.0, block_ms=0.0)
    exact = replace(task, quantised=False)
    counted = []
    for session in range(sessions):
        presses = simulate_task(exact, model, still, TRUE_SEED + session, presses_before=PRACTISED)
        for press, sd_ms in zip(presses, _sd_ms(task, user), strict=True):
            assert press.target_s is not None
            late = 1e3 * (press.activations_s[0] - press.target_s) if press.activations_s else np.inf
            scatter = NODES * sd_ms if late > -1e3 * task.cue_s + 1e-6 else np.zeros(1)
            counted.append(_counted(task, late + scatter))
    return float(np.mean(counted))


def _sd_ms(task: TemporalPointing, user: SimulatedUser) -> list[float]:
    """Return the scatter of each press of a session: its own, and that of what earlier ones made up for."""
    clock_ms = 1e3 * timing_spread_s(user, task.cue_s, task.period_s) * spread_factor(user, PRACTISED)
    own = clock_ms**2 + user.motor_ms**2
    found, made_up = [], 0.0
    for _ in range(task.rounds):
        found.append(float(np.sqrt(own + made_up + user.block_ms**2)))
        # of the percept only the spread at salience 1 is known here; its share is small
        share = user.adaptation_ratio
        made_up = (1 - share) ** 2 * made_up + share**2 * (own + user.percept_ms**2)
    return found


def _counted(task: TemporalPointing, late_ms: FloatArray) -> float:
    frame_ms = 1e3 * task.frame_s
    shown_ms = np.where(np.isfinite(late_ms), frame_ms * np.round(late_ms / frame_ms), np.inf)
    return float(np.mean(np.where(np.abs(shown_ms) < LOST_ms, np.abs(shown_ms), LOST_ms)))
