"""What simulated people like: an ideal of their own, apart from how they press."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from fdvv.model.file import load_builtin
from fdvv_people.optimize.paper_space import paper_model
from fdvv_people.optimize.people.taste import Taste, draw_taste, expected_liking, item_points, rate
from fdvv_people.optimize.people.user import draw_user
from fdvv_people.task.questionnaire import HIGHEST, ITEMS, LOWEST, liking_score

BROWN = load_builtin("mx-brown")
DESIGN = {"x1_mm": 0.5, "x2_mm": 2.0, "x3_mm": 4.0, "y1_cN": 60.0, "y2_cN": 50.0, "y3_cN": 70.0}


def button(**changed: float) -> object:
    return paper_model({**DESIGN, "actuation_mm": 1.8, "vibration_mm": 1.8, **changed})


def test_every_item_has_an_answer_on_the_scale() -> None:
    found = [rate(BROWN, draw_taste(0, person), 1) for person in range(40)]
    assert {len(answers) for answers in found} == {len(ITEMS)}
    assert {LOWEST <= one <= HIGHEST for answers in found for one in answers} == {True}
    assert len(set(found)) > 10


def test_the_same_person_answers_alike_and_the_next_trial_differs() -> None:
    taste = draw_taste(0, 3)
    assert rate(BROWN, taste, 7) == rate(BROWN, draw_taste(0, 3), 7)
    assert len({rate(BROWN, taste, seed) for seed in range(20)}) > 1


def test_who_presses_is_who_they_were_before_anybody_asked() -> None:
    """The numbers of a person who was drawn when there was no taste."""
    user = draw_user(1, 2000)
    draw_taste(1, 2000)
    assert draw_user(1, 2000) == user
    assert (user.clock_ratio, user.pace_mm_s) == pytest.approx((0.11014668451684, 75.38126196864))


@pytest.mark.parametrize(
    ("near", "far"),
    [
        ({"y1_cN": 60.0}, {"y1_cN": 180.0}),
        ({"actuation_mm": 1.8}, {"actuation_mm": 4.5}),
        ({"y2_cN": 45.0}, {"y2_cN": 60.0}),
    ],
)
def test_liking_falls_with_the_distance_from_the_ideal(near: dict[str, float], far: dict[str, float]) -> None:
    assert expected_liking(button(**near), Taste()) > expected_liking(button(**far), Taste())  # type: ignore[arg-type]


def test_a_bump_larger_than_the_ideal_costs_comfort_and_no_accuracy() -> None:
    plain, lover = (item_points(BROWN, replace(Taste(), bump_cN=cN)) for cN in (0.0, 20.0))
    assert plain[1] >= lover[1]


def test_the_score_of_many_answers_is_the_expected_liking_and_its_error_is_of_the_size_stated() -> None:
    taste = replace(Taste(), shift=-0.5)
    scores = [liking_score(rate(BROWN, taste, seed)) for seed in range(400)]
    values = np.array([one.value for one in scores])
    # the ends of the scale cut a little off
    assert values.mean() == pytest.approx(expected_liking(BROWN, taste), abs=0.15)
    stated = float(np.mean([one.error or 0.0 for one in scores]))
    assert 0.5 < values.std() / stated < 2.0
