"""Presses of one person on one button, made once and scored often. Simulated."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fdvv.errors import InputError, ModelError
from fdvv.model import FDVVModel
from fdvv.optimize import (
    LOST_ms,
    SimulatedUser,
    TemporalPointing,
    aim_s,
    folded_normal_mean,
    timing_spread_s,
)
from fdvv.units import FloatArray
from fdvv.workflow._play_bench import PlayBench, known_rig
from fdvv.workflow._play_hand import Hand


@dataclass(frozen=True, eq=False)
class PressTable:
    """Presses, simulated; every column (n,), times from the onset of the movement.

    Attributes
    ----------
    user : who pressed. key_s : when the key went down; NaN: never, or before the movement.
    felt_s, felt_spread_s : when the press was felt, and how well.
    """

    user: SimulatedUser
    key_s: FloatArray
    felt_s: FloatArray
    felt_spread_s: FloatArray

    def halves(self) -> tuple[PressTable, PressTable]:
        """Split it in two, the later presses second."""
        columns = (self.key_s, self.felt_s, self.felt_spread_s)
        parts = zip(*(np.array_split(column, 2) for column in columns), strict=True)
        first, second = (PressTable(self.user, *part) for part in parts)
        return first, second


def press_table(
    model: FDVVModel, user: SimulatedUser, count: int, seed: int, rig: str = "ideal"
) -> PressTable:
    """Press count times; a design that cannot be held never activates. InputError on an unknown rig."""
    known_rig(rig)
    try:
        hand = Hand(PlayBench(model, user, rig), np.random.default_rng([seed, user.number]))
    except (InputError, ModelError):
        return PressTable(user, np.full(count, np.nan), np.zeros(count), np.ones(count))
    rows = []
    for _ in range(count):
        press = hand.press()
        if press is None:
            rows.append((np.nan, 0.0, 1.0))
            continue
        key = press.keys_s[0] if press.keys_s and not press.early else np.nan
        rows.append((key, press.percept.time_s, press.percept.spread_s))
    return PressTable(user, *np.array(rows).T)


def expected_ms(table: PressTable, task: TemporalPointing, bias_ms: float) -> float:
    """Give the mean asynchrony of one who does not adapt: folded normals about the table's presses."""
    user = table.user
    spread_s = np.hypot(timing_spread_s(user, task.cue_s, task.period_s), 1e-3 * user.motor_ms)
    late_ms = bias_ms + user.bias_ms - user.anticipated_ms + 1e3 * (aim_s(user, task.zone_s) + table.key_s)
    counted = np.minimum(folded_normal_mean(late_ms, 1e3 * spread_s), LOST_ms)
    return float(np.mean(np.where(np.isnan(counted), LOST_ms, counted)))


def adapted_ms(
    table: PressTable, task: TemporalPointing, bias_ms: float, gain: float, runs: int, seed: int
) -> float:
    """Give the mean asynchrony of one who adapts by this gain: runs of the task on presses of the table."""
    user, random = table.user, np.random.default_rng([seed, table.user.number])
    spread_s = np.hypot(timing_spread_s(user, task.cue_s, task.period_s), 1e-3 * user.motor_ms)
    which = random.integers(table.key_s.size, size=(task.rounds, runs))
    scatter, touch = random.standard_normal((2, task.rounds, runs))
    aim, plan = aim_s(user, task.zone_s), np.full(runs, -1e-3 * user.anticipated_ms)
    counted = np.empty((task.rounds, runs))
    for i in range(task.rounds):
        moved_s = plan + spread_s * scatter[i]
        felt_s = moved_s + table.felt_s[which[i]] + table.felt_spread_s[which[i]] * touch[i]
        counted[i] = np.abs(1e3 * (aim + moved_s + table.key_s[which[i]]) + bias_ms + user.bias_ms)
        plan = plan - gain * felt_s
    return float(np.mean(np.where(counted < LOST_ms, counted, LOST_ms)))
