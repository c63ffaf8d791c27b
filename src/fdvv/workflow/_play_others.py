"""Rapid tapping and accuracy as a simulated person plays them on the twin. Simulated."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from fdvv.optimize import Accuracy, RapidTapping, TaskPress, TemporalPointing, tiredness
from fdvv.twin import Gesture
from fdvv.workflow._play_bench import PlayBench
from fdvv.workflow._play_hand import Hand

DWELL_s, PAUSE_s = 0.03, 0.02
"""At the bottom and between two taps of one who hurries (assumed)."""
EASED, REACHED, LEAST = 0.95, 1.2, 0.2
"""By how much the next stroke is shorter after a tap that the key told, longer after one it did not, and the
shortest in proportion to a whole one (assumed)."""
ROUND_s, CUE_s, REACTION_s, REACTION_SPREAD_s = 2.0, 1.0, 0.3, 0.05
"""Of the accuracy task: from round to round, the go in it, and when a movement follows it (assumed)."""
TWITCH_cN, TWITCH_s = 15.0, 0.05
"""Mean of the force, exponential, that a held-back press has beyond rest, and its time to grow (assumed)."""


def unplayed(task: TemporalPointing | RapidTapping | Accuracy) -> tuple[TaskPress, ...]:
    """Give the rounds of a task on a design that nobody can press."""
    if isinstance(task, TemporalPointing):
        return tuple(TaskPress(task.target_s(number), ()) for number in range(task.rounds))
    if isinstance(task, RapidTapping):
        return (TaskPress(None, ()),) * task.rounds
    return tuple(TaskPress(n * ROUND_s + CUE_s if go else None, ()) for n, go in enumerate(task.goes()))


def tap(
    task: RapidTapping, bench: PlayBench, random: np.random.Generator, before: int
) -> tuple[TaskPress, ...]:
    """Tap on one rig without a break, as shallowly as the key lets one.

    A cap that has not come up is pressed from where it is. A shorter stroke is made at the same speed, so
    that it takes less time.
    """
    user, push = bench.user, Hand(bench, random).push_ratio
    rig, found, start_s, reach = bench.settled(random, 1), [], 0.0, 1.0
    for number in range(task.rounds):
        strength = max(0.1, 1.0 - tiredness(user, before + number))
        gesture = _shortened(bench.draw(random, push * strength, strength), reach)
        cycle_s = 2 * gesture.press_s + DWELL_s + PAUSE_s
        clock, motor = random.standard_normal(2).tolist()
        late_s = user.clock_ratio * cycle_s * clock + 1e-3 * user.motor_ms * motor
        onset_s = max(0.0, PAUSE_s + late_s)
        gesture = replace(gesture, onset_s=onset_s, dwell_s=DWELL_s, release_s=gesture.press_s)
        count = bench.ticks_in(onset_s + 2 * gesture.press_s + DWELL_s)
        rig = rig.copy(bench.noise(random, count))
        rig.press(gesture)
        ticks = rig.advance(count)
        down = np.flatnonzero((ticks.key[1:] > 0) & (ticks.key[:-1] == 0)) + 1
        keys = tuple((start_s + bench.tick_s * down).tolist())
        start_s += count * bench.tick_s
        reach = min(1.0, max(LEAST, reach * (EASED if keys else REACHED)))
        found.append(TaskPress(None, keys, float(np.sum(ticks.force_cN)) * 0.01 * bench.tick_s))
    return tuple(found)


def _shortened(gesture: Gesture, reach: float) -> Gesture:
    way = reach * (gesture.end_m - gesture.start_m)
    return replace(gesture, end_m=gesture.start_m + way, press_s=reach * gesture.press_s)


def go_or_hold(
    task: Accuracy, bench: PlayBench, random: np.random.Generator, before: int
) -> tuple[TaskPress, ...]:
    """Press on go; on no-go a press that is held back still twitches."""
    hand, found = Hand(bench, random), []
    for number, go in enumerate(task.goes()):
        start_s = number * ROUND_s
        onset_s = start_s + CUE_s + REACTION_s + REACTION_SPREAD_s * float(random.standard_normal())
        if not go:
            found.append(TaskPress(None, tuple(start_s + CUE_s + key for key in _twitch(bench, random))))
            continue
        press = hand.press(max(0.1, 1.0 - tiredness(bench.user, before + number)))
        keys = () if press is None else tuple(onset_s + key for key in press.keys_s)
        early = (start_s,) if press and press.early else ()
        found.append(TaskPress(start_s + CUE_s, (*early, *keys), press.effort_N_s if press else None))
    return tuple(found)


def _twitch(bench: PlayBench, random: np.random.Generator) -> tuple[float, ...]:
    """Give when the key goes down in a round that asks for no press; at its beginning if it was down."""
    rest, more = random.standard_normal(), random.exponential(TWITCH_cN)
    user = bench.user
    rest_cN = max(0.0, user.rest_cN + user.rest_spread_cN * float(np.clip(rest, -3, 3)))
    gesture = bench.resting(rest_cN, rest_cN + more, TWITCH_s)
    count = bench.ticks_in(gesture.onset_s + 3 * TWITCH_s)
    rig = bench.settled(random, count)
    rig.press(gesture)
    key = rig.advance(count).key > 0
    return (float(np.argmax(key)) * bench.tick_s,) if key.any() else ()
