"""A simulated person plays a task on a design. Simulated."""

from __future__ import annotations

import numpy as np

from fdvv.errors import InputError, ModelError
from fdvv.model import FDVVModel
from fdvv.optimize import (
    Accuracy,
    RapidTapping,
    Score,
    SimulatedUser,
    Task,
    TaskPress,
    TemporalPointing,
    aim_s,
    spread_factor,
    timing_spread_s,
    tiredness,
)
from fdvv.workflow._play_bench import PlayBench, known_rig
from fdvv.workflow._play_hand import Hand
from fdvv.workflow._play_others import go_or_hold, tap, unplayed


def play(
    task: Task,
    model: FDVVModel,
    user: SimulatedUser,
    seed: int,
    *,
    rig: str = "ideal",
    presses_before: int = 0,
) -> tuple[TaskPress, ...]:
    """Let a person play a task on a button, press after press on the twin: same arguments, same presses.

    rig : name of a shipped rig (PLAY_RIGS); on `ideal` the finger feels the model's own force.
    presses_before : made in this session before, for users who learn or tire.

    The firmware's own core decides when the key goes down. A design that the firmware cannot hold
    (refusal_of), or that never activates, gives rounds without an activation. InputError on an unknown rig,
    ModelError on a task that nobody has taught simulated people.
    """
    if not isinstance(task, TemporalPointing | RapidTapping | Accuracy):
        raise ModelError(f"simulated people cannot play {task.name}")
    known_rig(rig)
    try:
        bench = PlayBench(model, user, rig)
    except (InputError, ModelError):
        return unplayed(task)
    random = np.random.default_rng([seed, user.number])
    if isinstance(task, TemporalPointing):
        return _point(task, bench, random, presses_before)
    if isinstance(task, RapidTapping):
        return tap(task, bench, random, presses_before)
    return go_or_hold(task, bench, random, presses_before)


def score_design(
    task: Task,
    model: FDVVModel,
    user: SimulatedUser,
    seed: int,
    *,
    rig: str = "ideal",
    presses_before: int = 0,
) -> dict[str, Score]:
    """Score a design as play() plays it."""
    return task.scores(play(task, model, user, seed, rig=rig, presses_before=presses_before))


def _point(
    task: TemporalPointing, bench: PlayBench, random: np.random.Generator, before: int
) -> tuple[TaskPress, ...]:
    """Press at each bullet; the felt error of a press moves the plan of the next."""
    user, found, hand = bench.user, [], Hand(bench, random)
    spread_s = timing_spread_s(user, task.cue_s, task.period_s)
    aim, anticipated_s = aim_s(user, task.zone_s), 1e-3 * user.anticipated_ms
    for number in range(task.rounds):
        clock, motor, touch = random.standard_normal(3).tolist()
        target_s = task.target_s(number)
        scatter_s = spread_factor(user, before + number) * spread_s * clock + 1e-3 * user.motor_ms * motor
        onset_s = target_s + aim - anticipated_s + scatter_s
        press = hand.press(max(0.1, 1.0 - tiredness(user, before + number)))
        if press is None:
            found.append(TaskPress(target_s, ()))
            continue
        felt_s = onset_s + press.percept.time_s + press.percept.spread_s * touch
        anticipated_s += user.adaptation_ratio * (felt_s - target_s - aim)
        keys = tuple(onset_s + 1e-3 * user.bias_ms + key_s for key_s in press.keys_s)
        # a key that is down under the resting finger went down as the bullet started
        early = (target_s - task.cue_s,) if press.early else ()
        found.append(TaskPress(target_s, (*early, *keys), press.effort_N_s))
    return tuple(found)
