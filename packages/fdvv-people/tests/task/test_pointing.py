"""Temporal pointing: what a round counts, and what is lost."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from fdvv.errors import ModelError
from fdvv_people.task.pointing import LOST_ms, TemporalPointing
from fdvv_people.task.score import Score
from fdvv_people.task.task import TaskPress

EXACT = TemporalPointing("easy", quantised=False)


def test_the_papers_levels_light_a_pixel_for_10_and_for_6_7_ms() -> None:
    assert TemporalPointing("easy").frame_s == pytest.approx(0.010)
    assert TemporalPointing("hard").frame_s == pytest.approx(0.0067, abs=5e-5)


def test_bullets_follow_each_other_by_the_length_of_the_strip() -> None:
    task = TemporalPointing("easy")
    assert task.target_s(0) == pytest.approx(1.0)
    assert task.target_s(3) - task.target_s(2) == pytest.approx(1.44)


@given(st.lists(st.floats(-0.39, 0.39), min_size=2, max_size=30))
def test_the_score_is_the_mean_absolute_asynchrony_with_its_standard_error(late_s: list[float]) -> None:
    presses = [TaskPress(EXACT.target_s(i), (EXACT.target_s(i) + late,)) for i, late in enumerate(late_s)]
    score = EXACT.scores(presses)["asynchrony_ms"]
    counted = 1e3 * np.abs(late_s)
    assert score.value == pytest.approx(counted.mean(), abs=1e-6)
    assert score.error == pytest.approx(counted.std(ddof=1) / np.sqrt(len(late_s)), abs=1e-6)


@given(st.floats(-0.39, 0.39))
def test_a_strip_tells_whole_frames_which_is_off_by_half_a_frame_at_most(late_s: float) -> None:
    task = TemporalPointing("hard")
    asynchrony_ms = task.asynchrony_ms(TaskPress(1.0, (1.0 + late_s,)))
    assert asynchrony_ms is not None
    assert abs(asynchrony_ms - 1e3 * late_s) <= 500 * task.frame_s + 1e-9
    assert asynchrony_ms / (1e3 * task.frame_s) == pytest.approx(
        round(asynchrony_ms / (1e3 * task.frame_s)), abs=1e-6
    )


def test_a_miss_and_a_false_trigger_are_lost_whatever_follows() -> None:
    missed, late = TaskPress(1.0, ()), TaskPress(1.0, (1.5,))
    false = TaskPress(1.0, (0.3, 1.0))
    assert [EXACT.asynchrony_ms(press) for press in (missed, late, false)] == [None] * 3
    assert EXACT.scores([missed, false])["asynchrony_ms"] == Score(LOST_ms, 0.0)


def test_losses_and_effort_are_scored_where_asked_for() -> None:
    task = TemporalPointing("easy", also=("lost_ratio", "effort_N_s"))
    presses = [TaskPress(1.0, (1.0,), 0.02), TaskPress(2.0, (), None)]
    scores = task.scores(presses)
    assert scores["lost_ratio"].value == 0.5
    assert scores["effort_N_s"].value == 0.02
    assert list(scores) == [one.name for one in task.objectives]


def test_nothing_played_is_nothing_scored() -> None:
    with pytest.raises(ModelError, match="no round"):
        EXACT.scores([])


@pytest.mark.parametrize("wrong", [{"level": "medium"}, {"rounds": 0}, {"zone_px": 200}, {"also": ("joy",)}])
def test_an_impossible_task_is_refused(wrong: dict[str, object]) -> None:
    with pytest.raises(ModelError):
        TemporalPointing(**wrong)  # type: ignore[arg-type]
