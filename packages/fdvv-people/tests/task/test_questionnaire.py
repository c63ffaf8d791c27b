"""Answers to a questionnaire are whole points of its scale, and their mean is a score."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from fdvv.errors import InputError
from fdvv_people.task.questionnaire import HIGHEST, ITEMS, LIKING, LOWEST, liking_score

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
