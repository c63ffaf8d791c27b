"""Rapid tapping, accuracy and the questionnaire: what is scored."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from fdvv.errors import InputError, ModelError
from fdvv_people.task.accuracy import Accuracy
from fdvv_people.task.questionnaire import HIGHEST, ITEMS, LIKING, LOWEST, liking_score
from fdvv_people.task.tapping import RapidTapping, REPEAT_s, strokes_Hz
from fdvv_people.task.task import Task, TaskPress


def test_even_taps_have_their_rate_and_no_spread() -> None:
    task: Task = RapidTapping()
    scores = task.scores([TaskPress(None, (0.2 * i,)) for i in range(20)])
    assert scores["rate_Hz"].value == pytest.approx(5.0)
    assert scores["interval_spread_ratio"].value == pytest.approx(0.0, abs=1e-9)


def test_a_lost_tap_lowers_the_rate_and_spreads_the_intervals() -> None:
    presses = [TaskPress(None, (0.2 * i,) if i != 9 else ()) for i in range(20)]
    scores = RapidTapping().scores(presses)
    assert scores["rate_Hz"].value == pytest.approx(18 / 3.8)
    assert scores["interval_spread_ratio"].value > 0.1


def test_errors_of_a_rate_are_those_of_repeated_scores() -> None:
    random = np.random.default_rng(0)
    scores = []
    for _ in range(400):
        keys = np.cumsum(0.2 * (1 + 0.1 * random.standard_normal(20)))
        scores.append(RapidTapping().scores([TaskPress(None, (key,)) for key in keys.tolist()]))
    for name in ("rate_Hz", "interval_spread_ratio"):
        mean_error = np.mean([score[name].error for score in scores])
        assert mean_error == pytest.approx(np.std([score[name].value for score in scores]), rel=0.1)


def test_one_who_never_gets_through_has_a_rate_of_nothing() -> None:
    scores = RapidTapping().scores([TaskPress(None, ())] * 20)
    assert (scores["rate_Hz"].value, scores["interval_spread_ratio"].value) == (0.0, 1.0)
    with pytest.raises(ModelError, match="no round"):
        RapidTapping().scores([])


def test_strokes_are_the_presses_that_a_finger_can_make() -> None:
    strokes = [TaskPress(None, (0.2 * i,)) for i in range(20)]
    kicked = [TaskPress(None, (0.2 * i, 0.2 * i + 0.03, 0.2 * i + 0.06)) for i in range(20)]
    assert strokes_Hz(strokes) == strokes_Hz(kicked) == pytest.approx(5.0)
    assert RapidTapping().scores(kicked)["rate_Hz"].value == pytest.approx(59 / 3.86)


def test_a_button_that_repeats_by_itself_counts_no_faster_than_the_bound() -> None:
    itself = [TaskPress(None, tuple(0.025 * i for i in range(200)))]
    assert strokes_Hz(itself) <= 1 / REPEAT_s
    assert np.isnan(strokes_Hz([TaskPress(None, (0.0, 0.03, 0.2))]))


def test_false_triggers_and_misses_are_counted_each_over_its_own_rounds() -> None:
    task = Accuracy(rounds=8, also=("false_ratio", "missed_ratio"))
    go = [TaskPress(1.0, (1.3,)), TaskPress(3.0, ()), TaskPress(5.0, (4.5,)), TaskPress(7.0, (7.2,))]
    hold = [TaskPress(None, (8.0,)), *[TaskPress(None, ())] * 3]
    scores = task.scores([*go, *hold])
    assert scores["missed_ratio"].value == 0.5
    assert scores["false_ratio"].value == 0.25
    assert scores["errors_ratio"].value == pytest.approx(3 / 8)


def test_no_error_in_few_rounds_is_not_certain() -> None:
    error = Accuracy().scores([TaskPress(1.0, (1.3,)), TaskPress(None, ())])["errors_ratio"].error
    assert error is not None
    assert error > 0.1


def test_rounds_of_go_come_in_an_order_of_the_seed() -> None:
    assert sum(Accuracy().goes()) == 20
    assert Accuracy(seed=1).goes() != Accuracy(seed=2).goes()
    with pytest.raises(ModelError, match="no-go"):
        Accuracy(rounds=4, go_ratio=0.99)


answers = st.lists(st.integers(LOWEST, HIGHEST), min_size=len(ITEMS), max_size=len(ITEMS))


@given(answers)
def test_liking_is_the_mean_and_never_without_the_error_of_rounding(points: list[int]) -> None:
    score = liking_score(points)
    assert score.value == pytest.approx(sum(points) / len(points))
    assert score.error is not None
    assert score.error >= (1 / 12 / len(points)) ** 0.5 - 1e-12


def test_answers_that_differ_leave_the_standard_error_of_their_mean() -> None:
    # mean 4, squares 9, 1, 1, 9 over three degrees of freedom
    assert liking_score((1, 3, 5, 7)).error == pytest.approx((20 / 3 / 4) ** 0.5)
    assert LIKING.larger_is_better


@pytest.mark.parametrize("points", [(), (4, 4, 4), (4, 4, 4, 4, 4), (0, 4, 4, 4), (4, 4, 4, 8)])
def test_what_the_questionnaire_did_not_ask_is_refused(points: tuple[int, ...]) -> None:
    with pytest.raises(InputError, match="answers"):
        liking_score(points)
