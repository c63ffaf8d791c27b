"""Moves of a hand, made later: their order, and the time between them."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest

from fdvv_studio.live.hand_moves import HandMove, HandMoves, LONGEST_s, UP_s

STEP_s = 0.004


def made(moves: list[HandMove], came_s: list[float]) -> list[tuple[HandMove, float]]:
    """Return each move with the simulated time at which it is made; it came at came_s. Time goes in steps."""
    queue, found = HandMoves(), list[tuple[HandMove, float]]()
    waiting = list(zip(moves, came_s, strict=True))
    for step in range(20_000):
        now_s = STEP_s * step
        while waiting and waiting[0][1] <= now_s:
            queue.add(waiting.pop(0)[0], now_s)
        while move := queue.due(now_s):
            found.append((move, now_s))
    assert not queue
    return found


def moves_at(*at_s: float) -> list[HandMove]:
    """Return a hand that presses at the first time, lets go at the second, and so on."""
    return [HandMove(i % 2 == 0, at) for i, at in enumerate(at_s)]


def times(found: list[tuple[HandMove, float]]) -> list[float]:
    return [at for _, at in found]


def test_what_comes_in_time_is_made_within_a_step() -> None:
    at_s = [1.0, 1.083, 1.401, 1.48]
    assert times(made(moves_at(*at_s), at_s)) == pytest.approx(at_s, abs=2 * STEP_s)


@pytest.mark.parametrize("seed", range(5))
def test_late_moves_keep_their_order_and_no_press_is_shorter_than_the_hand_s(seed: int) -> None:
    random = np.random.default_rng(seed)
    moves = moves_at(*(1.0 + np.cumsum(random.uniform(0.02, 0.09, 60))).tolist())
    came_s = np.maximum.accumulate([move.hand_s + random.exponential(0.05) for move in moves])
    found = made(moves, came_s.tolist())
    assert [move for move, _ in found] == moves
    for (move, at_s), (after, after_s) in pairwise(found):
        shortest_s = min(after.hand_s - move.hand_s, UP_s if after.down else LONGEST_s)
        assert after_s - at_s > shortest_s - STEP_s


def test_steps_of_time_do_not_add_up_to_a_lag() -> None:
    hand_s = (1.0 + 0.0457 * np.arange(200)).tolist()
    found = made(moves_at(*hand_s), hand_s)
    assert np.subtract(times(found), hand_s).max() < 2 * STEP_s


def test_a_lag_is_made_up_for_while_the_hand_is_up() -> None:
    hand_s = (1.0 + 0.1 * np.arange(40)).tolist()
    came_s = [max(at, 1.3) for at in hand_s]
    late_s = np.subtract(times(made(moves_at(*hand_s), came_s)), hand_s)
    assert late_s[0] == pytest.approx(0.3, abs=STEP_s)
    assert late_s[-10:].max() < 2 * STEP_s


def test_no_hold_lasts_for_ever_whatever_is_said_of_it() -> None:
    down_s, up_s = times(made(moves_at(1.0, 1e6), [1.0, 1.1]))
    assert up_s - down_s == pytest.approx(LONGEST_s, abs=STEP_s)
