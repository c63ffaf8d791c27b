"""Differences between buttons whose differences are known."""

from __future__ import annotations

import json

import numpy as np
import pytest

from fdvv.button.compare import compare
from fdvv.errors import ModelError
from fdvv.model.curve import Stroke
from fdvv.model.file import MODEL_SUFFIX, load_builtin
from fdvv.model.landmarks import landmark_errors, landmarks
from fdvv.model.model import FDVVModel
from tests.support.buttons import line_model
from tests.support.captures import recorded


def test_a_button_does_not_differ_from_itself() -> None:
    button = load_builtin("mx-clear")
    for difference in compare([button, button]).differences:
        assert (difference.rms_cN, difference.mean_cN, difference.max_cN) == (0, 0, 0)


def test_a_shifted_button_differs_by_the_shift() -> None:
    found = compare([line_model("a", 40), line_model("b", 47)]).differences
    assert [d.stroke for d in found] == [Stroke.PRESS, Stroke.RELEASE]
    for difference in found:
        for value in (difference.rms_cN, difference.mean_cN, difference.max_cN):
            assert value == pytest.approx(7)
    back = compare([line_model("b", 47), line_model("a", 40)]).differences
    assert [d.mean_cN for d in back] == pytest.approx([-7, -7])
    assert [d.max_cN for d in back] == pytest.approx([7, 7])


def test_a_steeper_button_differs_as_the_integral_says() -> None:
    # 2 cN/mm more over 4 mm: mean 4, root mean square 8 / sqrt(3), most at the end
    (press, _) = compare([line_model("a", 40, 5), line_model("b", 40, 7)]).differences
    assert press.mean_cN == pytest.approx(4)
    assert press.rms_cN == pytest.approx(8 / np.sqrt(3), rel=1e-2)
    assert (press.max_cN, press.max_mm) == pytest.approx((8, 4))


def test_differences_are_over_the_range_both_have() -> None:
    short = line_model("short", 40, travel_mm=3.0)
    for pair in ([line_model("long", 40), short], [short, line_model("long", 40)]):
        for difference in compare(pair).differences:
            assert (difference.from_mm, difference.to_mm) == (0, 3)


def test_every_button_is_compared_with_the_first() -> None:
    found = compare([line_model("a", 40), line_model("b", 41), line_model("c", 45)])
    assert found.names == ("a", "b", "c")
    assert [(d.index, d.name) for d in found.differences] == [(1, "b"), (1, "b"), (2, "c"), (2, "c")]
    assert [d.mean_cN for d in found.differences] == pytest.approx([1, 1, 5, 5])


def test_a_stroke_that_one_button_lacks_is_not_compared() -> None:
    both = line_model("both", 40)
    lone = FDVVModel("lone", 4.0, both.of("press"))
    assert [d.stroke for d in compare([both, lone]).differences] == [Stroke.PRESS]


def test_a_velocity_chooses_the_curves_that_are_compared() -> None:
    clear = load_builtin("mx-clear")
    at = {v: compare([line_model("line", 40), clear], v).differences[0].mean_cN for v in (0.5, 200.0)}
    x = np.linspace(0, 4.0, 401)
    line = 40 + 5 * x
    for velocity, mean_cN in at.items():
        expected = float(np.mean(clear.force_cN(x, velocity, "press") - line))
        assert mean_cN == pytest.approx(expected, abs=1e-6)
    assert at[0.5] != at[200.0]


def test_without_a_press_nothing_is_compared() -> None:
    both = line_model("both", 40)
    with pytest.raises(ModelError, match="no press curve"):
        compare([both, FDVVModel("lone", 4.0, both.of("release"))])


def test_standard_errors_stand_beside_the_landmarks_of_measured_buttons() -> None:
    model = recorded().model
    result = compare([load_builtin("mx-red"), model], 150.0)
    assert result.errors == ({}, landmark_errors(model, 150.0))
    peak = result.to_dict()["buttons"][1]["landmark_errors"]["peak_cN"]
    assert peak == {"error": result.errors[1]["peak_cN"].error, "presses": 6}


def test_the_report_is_plain_json_with_every_landmark() -> None:
    models = [load_builtin("mx-blue"), load_builtin("mx-red")]
    report = compare(models).to_dict()
    assert json.loads(json.dumps(report, allow_nan=False)) == report
    for entry, model in zip(report["buttons"], models, strict=True):
        assert entry == {"name": model.name, **landmarks(model).to_dict(), "landmark_errors": {}}
    assert {d["stroke"] for d in report["differences"]} == {"press", "release"}
    assert MODEL_SUFFIX not in report["reference"]
