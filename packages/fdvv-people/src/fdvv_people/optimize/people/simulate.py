"""A simulated person plays a task on a design. Simulated."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from fdvv.errors import InputError, ModelError
from fdvv.model.model import FDVVModel
from fdvv.program.program import Program
from fdvv_people.optimize.people.percept import Percept, bottom_at, percept_of, tactile_events
from fdvv_people.optimize.people.press_simulator import PressSimulator, PressTrace, known_rig
from fdvv_people.optimize.people.user import SimulatedUser, aim_s, spread_factor, timing_spread_s, tiredness
from fdvv_people.task.accuracy import Accuracy
from fdvv_people.task.pointing import TemporalPointing
from fdvv_people.task.score import Score
from fdvv_people.task.tapping import RapidTapping
from fdvv_people.task.task import Task, TaskPress

TRIES, HARDEST = 4, 6.0
"""Presses on a new button that do not count, at most; the hardest press, in proportion to the person's usual
push (assumed)."""


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

    def __init__(self, bench: PressSimulator, random: np.random.Generator) -> None:
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

    def _learn(self, press: PressTrace) -> bool:
        """Push harder from now on if the press did not reach the stop; return whether so."""
        weak = bottom_at(press, self._bench.travel_mm) is None
        if weak:
            self.push_ratio = min(HARDEST, self._bench.user.harder_ratio * self.push_ratio)
        return weak

    def _felt(self, press: PressTrace) -> Percept:
        bench = self._bench
        events = tactile_events(press, bench.model, bench.rig.exciter.latency_s)
        return percept_of(bench.user, events, float(press.t_s[-1]))

    def _effort_N_s(self, press: PressTrace, start: int) -> float:
        end = bottom_at(press, self._bench.travel_mm)
        tick_s = float(press.t_s[1] - press.t_s[0])
        return float(np.sum(press.ticks.force_cN[start:end])) * 0.01 * tick_s


DWELL_s, PAUSE_s = 0.03, 0.02
"""At the bottom and between two taps of one who hurries (assumed)."""
EASED, REACHED, LEAST = 0.95, 1.2, 0.2
"""Change of the next stroke after a tap that closed the key and after one that did not, and the shortest
stroke, each in proportion (assumed)."""
ROUND_s, CUE_s, REACTION_s, REACTION_SPREAD_s = 2.0, 1.0, 0.3, 0.05
"""Of the accuracy task: from round to round, the go in it, and when a movement follows it (assumed)."""
TWITCH_cN, TWITCH_s = 15.0, 0.05
"""Mean of the force, exponential, that a held-back press has beyond rest, and its time to grow (assumed)."""


def unplayed(task: TemporalPointing | RapidTapping | Accuracy) -> tuple[TaskPress, ...]:
    """Return the rounds of a task on a design that nobody can press."""
    if isinstance(task, TemporalPointing):
        return tuple(TaskPress(task.target_s(number), ()) for number in range(task.rounds))
    if isinstance(task, RapidTapping):
        return (TaskPress(None, ()),) * task.rounds
    return tuple(TaskPress(n * ROUND_s + CUE_s if go else None, ()) for n, go in enumerate(task.goes()))


def tap(
    task: RapidTapping, bench: PressSimulator, random: np.random.Generator, before: int
) -> Iterator[TaskPress]:
    """Tap on one rig without a break, as shallowly as the key lets one.

    A cap that has not come up is pressed from where it is. A shorter stroke is made at the same speed, so
    that it takes less time; who has a limit of strokes a second waits for the rest of the cycle.
    """
    user, push = bench.user, Hand(bench, random).push_ratio
    shortest_s = 1 / user.strokes_Hz if user.strokes_Hz else 0.0
    rig, start_s, reach = bench.settled(random, 1), 0.0, 1.0
    for number in range(task.rounds):
        strength = max(0.1, 1.0 - tiredness(user, before + number))
        whole = bench.draw(random, push * strength, strength)
        press_s, end_m = reach * whole.press_s, whole.start_m + reach * (whole.end_m - whole.start_m)
        pause_s = max(PAUSE_s, shortest_s - 2 * press_s - DWELL_s)
        cycle_s = 2 * press_s + DWELL_s + pause_s
        clock, motor = random.standard_normal(2).tolist()
        late_s = user.clock_ratio * cycle_s * clock + 1e-3 * user.motor_ms * motor
        onset_s = max(0.0, pause_s + late_s)
        gesture = replace(
            whole, end_m=end_m, onset_s=onset_s, press_s=press_s, dwell_s=DWELL_s, release_s=press_s
        )
        count = bench.ticks_in(onset_s + 2 * press_s + DWELL_s)
        rig = rig.copy(bench.noise(random, count))
        rig.press(gesture)
        ticks = rig.advance(count)
        down = np.flatnonzero((ticks.key[1:] > 0) & (ticks.key[:-1] == 0)) + 1
        keys = tuple((start_s + bench.tick_s * down).tolist())
        start_s += count * bench.tick_s
        reach = min(1.0, max(LEAST, reach * (EASED if keys else REACHED)))
        yield TaskPress(None, keys, float(np.sum(ticks.force_cN)) * 0.01 * bench.tick_s)


def go_or_hold(
    task: Accuracy, bench: PressSimulator, random: np.random.Generator, before: int
) -> Iterator[TaskPress]:
    """Press on go; on no-go a press that is held back still twitches."""
    hand = Hand(bench, random)
    for number, go in enumerate(task.goes()):
        start_s = number * ROUND_s
        onset_s = start_s + CUE_s + REACTION_s + REACTION_SPREAD_s * float(random.standard_normal())
        if not go:
            yield TaskPress(None, tuple(start_s + CUE_s + key for key in _twitch(bench, random)))
            continue
        press = hand.press(max(0.1, 1.0 - tiredness(bench.user, before + number)))
        keys = () if press is None else tuple(onset_s + key for key in press.keys_s)
        early = (start_s,) if press and press.early else ()
        yield TaskPress(start_s + CUE_s, (*early, *keys), press.effort_N_s if press else None)


def _twitch(bench: PressSimulator, random: np.random.Generator) -> tuple[float, ...]:
    """Return when the key goes down in a round that asks for no press; at its beginning if it was down."""
    rest, more = random.standard_normal(), random.exponential(TWITCH_cN)
    user = bench.user
    rest_cN = max(0.0, user.rest_cN + user.rest_spread_cN * float(np.clip(rest, -3, 3)))
    gesture = bench.resting(rest_cN, rest_cN + more, TWITCH_s)
    count = bench.ticks_in(gesture.onset_s + 3 * TWITCH_s)
    rig = bench.settled(random, count)
    rig.press(gesture)
    key = rig.advance(count).key > 0
    return (float(np.argmax(key)) * bench.tick_s,) if key.any() else ()


def simulate_task(
    task: Task,
    button: FDVVModel | Program,
    user: SimulatedUser,
    seed: int,
    *,
    rig: str = "ideal",
    presses_before: int = 0,
) -> tuple[TaskPress, ...]:
    """Simulate a person who does a task on a button, press by press: same arguments, same presses.

    button : of rapid tapping it may be a program.
    rig : name of a shipped rig (TASK_RIGS); on `ideal` the finger feels the model's own force.
    presses_before : made in this session before, for users who learn or tire.

    The firmware's own core decides when the key goes down. A design that the firmware cannot hold
    (refusal_of), or that never activates, gives rounds without an activation. InputError on an unknown rig,
    ModelError on a task that simulated people cannot play.
    """
    if not isinstance(task, TemporalPointing | RapidTapping | Accuracy):
        raise ModelError(f"simulated people cannot play {task.name}")
    if isinstance(button, Program) and not isinstance(task, RapidTapping):
        raise ModelError(f"simulated people only tap programs, they cannot play {task.name} on {button.name}")
    known_rig(rig)
    try:
        bench = PressSimulator(button, user, rig)
    except (InputError, ModelError):
        return unplayed(task)
    play: Any = {TemporalPointing: point, RapidTapping: tap, Accuracy: go_or_hold}[type(task)]
    return tuple(play(task, bench, np.random.default_rng([seed, user.number]), presses_before))


def score_design(
    task: Task,
    button: FDVVModel | Program,
    user: SimulatedUser,
    seed: int,
    *,
    rig: str = "ideal",
    presses_before: int = 0,
) -> dict[str, Score]:
    """Score a design as simulate_task plays it."""
    return task.scores(simulate_task(task, button, user, seed, rig=rig, presses_before=presses_before))


def point(
    task: TemporalPointing, bench: PressSimulator, random: np.random.Generator, before: int
) -> Iterator[TaskPress]:
    """Press at each bullet; the felt error of a press moves the plan of the next."""
    user, hand = bench.user, Hand(bench, random)
    spread_s = timing_spread_s(user, task.cue_s, task.period_s)
    aim = aim_s(user, task.zone_s)
    anticipated_s = 1e-3 * user.anticipated_ms + user.anticipated_ratio * bench.usual_press_s
    shift_ms = user.block_ms * float(random.standard_normal()) if user.block_ms else 0.0
    for number in range(task.rounds):
        clock, motor, touch = random.standard_normal(3).tolist()
        target_s = task.target_s(number)
        scatter_s = spread_factor(user, before + number) * spread_s * clock + 1e-3 * user.motor_ms * motor
        onset_s = target_s + aim - anticipated_s + scatter_s
        press = hand.press(max(0.1, 1.0 - tiredness(user, before + number)))
        if press is None:
            yield TaskPress(target_s, ())
            continue
        felt_s = onset_s + press.percept.time_s + press.percept.spread_s * touch
        anticipated_s += user.adaptation_ratio * (felt_s - target_s - aim)
        keys = tuple(onset_s + 1e-3 * (user.bias_ms + shift_ms) + key_s for key_s in press.keys_s)
        # a key that is down under the resting finger went down as the bullet started
        early = (target_s - task.cue_s,) if press.early else ()
        yield TaskPress(target_s, (*early, *keys), press.effort_N_s)
