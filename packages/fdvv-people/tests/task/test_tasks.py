"""Rapid tapping and accuracy: what is scored."""

from __future__ import annotations

import numpy as np
import pytest

from fdvv.errors import ModelError
from fdvv_people.task.accuracy import Accuracy
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
