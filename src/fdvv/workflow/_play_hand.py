"""A person's hand on a button: tries it, presses it, pushes harder where it must. Simulated."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fdvv.optimize import Percept, percept_of
from fdvv.workflow._play_bench import PlayBench, PlayedPress
from fdvv.workflow._play_cues import bottom_at, tactile_events

TRIES, HARDER, HARDEST = 4, 1.5, 6.0
"""Presses on a new button that do not count, at most; by how much harder each is after one that did not reach
the stop, and the hardest, in proportion to the person's usual push (assumed)."""


@dataclass(frozen=True)
class HandPress:
    """What became of one movement, its clock at 0 where it began.

    Attributes
    ----------
    keys_s : when the key went down. early : it was down before, under the resting finger.
    percept : when the press was felt, and how well. effort_N_s : impulse on the cap until it was at the stop.
    """

    keys_s: tuple[float, ...]
    early: bool
    percept: Percept
    effort_N_s: float


class Hand:
    """One person's hand on a new button, which it tries first.

    Attributes
    ----------
    push_ratio : how hard it has learned to push, in proportion to the person's usual push.
    """

    def __init__(self, bench: PlayBench, random: np.random.Generator) -> None:
        self._bench, self._random, self.push_ratio = bench, random, 1.0
        for _ in range(TRIES):
            press = bench.press(random, self.push_ratio)
            if press is None or not self._learn(press):
                break

    def press(self, strength: float = 1.0) -> HandPress | None:
        """Press, with this share of force and pace; None if the motion diverged."""
        press = self._bench.press(self._random, self.push_ratio * strength, strength)
        if press is None:
            return None
        self._learn(press)
        moving = int(np.argmax(press.t_s >= 0))
        key = press.ticks.key > 0
        rising = moving + np.flatnonzero(~key[moving:-1] & key[moving + 1 :]) + 1
        keys = tuple(press.t_s[rising].tolist())
        return HandPress(
            keys, bool(key[: moving + 1].any()), self._felt(press), self._effort_N_s(press, moving)
        )

    def _learn(self, press: PlayedPress) -> bool:
        """Push harder from now on if the press did not reach the stop; tell whether so."""
        weak = bottom_at(press, self._bench.stand.model.travel_mm) is None
        if weak:
            self.push_ratio = min(HARDEST, HARDER * self.push_ratio)
        return weak

    def _felt(self, press: PlayedPress) -> Percept:
        stand = self._bench.stand
        events = tactile_events(press, stand.model, stand.rig.exciter.latency_s)
        return percept_of(self._bench.user, events, float(press.t_s[-1]))

    def _effort_N_s(self, press: PlayedPress, start: int) -> float:
        end = bottom_at(press, self._bench.stand.model.travel_mm)
        tick_s = float(press.t_s[1] - press.t_s[0])
        return float(np.sum(press.ticks.force_cN[start:end])) * 0.01 * tick_s
