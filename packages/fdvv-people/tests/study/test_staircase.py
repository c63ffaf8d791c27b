"""Staircases against Levitt's rule and against listeners whose threshold is known."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from fdvv_people.study.plan.plan import Staircase
from fdvv_people.study.plan.staircase import staircase_state, target_share, threshold, threshold_interval
from tests.support.campaign import campaign


def run(staircase: Staircase, answers: str) -> list[tuple[float, bool]]:
    """Answer c (correct) or w (wrong) until the staircase or the answers end."""
    history: list[tuple[float, bool]] = []
    for answer in answers:
        ratio = staircase_state(staircase, history).ratio
        if ratio is None:
            break
        history.append((ratio, answer == "c"))
    return history


def test_two_correct_answers_make_it_harder_and_a_wrong_one_easier_by_the_step_of_the_turn() -> None:
    staircase = Staircase(start_ratio=0.32, steps_ratio=(2.0, 1.25), down=2)
    shown = [ratio for ratio, _ in run(staircase, "ccccwccw")]
    # down by 2 twice; the first turn at 0.08, and steps are 1.25 from there on
    assert np.allclose(shown, [0.32, 0.32, 0.16, 0.16, 0.08, 0.1, 0.1, 0.08])
    assert np.allclose(staircase_state(staircase, run(staircase, "ccccwccw")).turns, [0.08, 0.1, 0.08])


def test_it_ends_at_its_turns_or_at_its_trials() -> None:
    turning = Staircase(down=1, reversals=4, dropped=0)
    assert len(run(turning, "cwcwcwcwcw")) == 5
    assert len(run(Staircase(trials=7), "c" * 20)) == 7


def test_mistakes_at_the_largest_difference_keep_it_there() -> None:
    assert [ratio for ratio, _ in run(Staircase(start_ratio=1.0), "www")] == [1.0, 1.0, 1.0]


def test_its_interval_holds_the_threshold_of_nearly_all_simulated_listeners() -> None:
    from scipy.special import ndtr, ndtri

    staircase, random, held = Staircase(), np.random.default_rng(8), 0
    # d' grows with the ratio and is 1 at 0.1
    true = 0.1 * math.sqrt(2) * float(ndtri(target_share(staircase)))
    for _ in range(80):
        history: list[tuple[float, bool]] = []
        while (ratio := staircase_state(staircase, history).ratio) is not None:
            history.append((ratio, bool(random.random() < ndtr(ratio / 0.1 / math.sqrt(2)))))
        low, high = threshold_interval(history, target_share(staircase))
        held += low <= true <= high
    assert 72 <= held <= 80


def test_a_threshold_is_the_geometric_mean_of_the_turns_that_count() -> None:
    staircase = Staircase(start_ratio=0.4, steps_ratio=(2.0,), down=2, reversals=8, dropped=2)
    history = run(staircase, "cccccw" + "ccw" * 10)
    turns = staircase_state(staircase, history).turns
    assert len(turns) == 8
    found = threshold(staircase, history)
    assert found.value == pytest.approx(math.exp(np.mean(np.log(turns[2:]))))
    assert found.low is not None
    assert found.high is not None
    assert found.low <= found.value <= found.high


def test_of_an_odd_number_of_turns_one_more_is_dropped_and_without_any_there_is_no_value() -> None:
    staircase = Staircase(start_ratio=0.4, steps_ratio=(2.0,), down=1, reversals=5, dropped=0)
    history = run(staircase, "c" + "wc" * 5)
    turns = staircase_state(staircase, history).turns
    assert len(turns) == 5
    assert threshold(staircase, history).value == pytest.approx(math.exp(np.mean(np.log(turns[1:]))))
    assert threshold(staircase, history).low is None
    assert math.isnan(threshold(staircase, run(staircase, "cc")).value)


@given(st.text("cw", max_size=80), st.integers(1, 4), st.integers(2, 12))
def test_what_comes_next_follows_from_what_was_shown_and_never_leaves_its_range(
    answers: str, down: int, reversals: int
) -> None:
    staircase = Staircase(down=down, reversals=reversals, dropped=0)
    history = run(staircase, answers)
    assert all(0 < ratio <= 1 for ratio, _ in history)
    assert len(staircase_state(staircase, history).turns) <= reversals
    # a crash and a new beginning change nothing
    assert run(staircase, "".join("cw"[not right] for _, right in history)) == history


@campaign(("down", "share"), [(1, 0.5), (2, 0.7071), (3, 0.7937)], part=1)
def test_it_settles_where_the_rule_says(down: int, share: float) -> None:
    staircase = Staircase(down=down, reversals=40, dropped=4, trials=400, steps_ratio=(1.6, 1.1))
    assert target_share(staircase) == pytest.approx(share, abs=1e-4)
    random, found = np.random.default_rng(down), []
    for _ in range(20):
        history: list[tuple[float, bool]] = []
        while (ratio := staircase_state(staircase, history).ratio) is not None:
            # a psychometric function from 0 to 1, that of a person who never guesses: 1 - 2^-(x / 0.1)^2
            history.append((ratio, bool(random.random() < 1 - 2.0 ** -((ratio / 0.1) ** 2))))
        found.append(threshold(staircase, history).value)
    expected = 0.1 * math.sqrt(-math.log2(1 - share))
    assert np.exp(np.mean(np.log(found))) == pytest.approx(expected, rel=0.08)
