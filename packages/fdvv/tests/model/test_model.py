from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings

from fdvv.errors import ModelError
from fdvv.model.curve import ForceCurve, Stroke
from fdvv.model.file import load_builtin
from fdvv.model.model import FDVVModel
from fdvv.model.vibration import Mode, Vibration
from tests.model.strategies import models

CLEAR = load_builtin("mx-clear")


def flat(force_cN: float, velocity_mm_s: float | None = 50.0) -> ForceCurve:
    return ForceCurve(Stroke.PRESS, velocity_mm_s, 1, [0, 0, 4, 4], [force_cN] * 2)  # type: ignore[arg-type]


def buzz(velocity_mm_s: float | None) -> Vibration:
    return Vibration(Stroke.PRESS, velocity_mm_s, 2.0, 0.01, (Mode(239.0, 1.0, 10.0),))


def model(**fields: Any) -> FDVVModel:
    whole: dict[str, Any] = {"name": "flat", "travel_mm": 4.0, "curves": (flat(60),)}
    return FDVVModel(**{**whole, **fields})


@pytest.mark.parametrize(
    ("fields", "said"),
    [
        ({"name": ""}, "name must be text without spaces at its ends, got ''"),
        ({"name": " x"}, "name must be text without spaces at its ends, got ' x'"),
        ({"travel_mm": 0.0}, "travel_mm must be positive, got 0.0"),
        ({"travel_mm": np.nan}, "travel_mm must be positive, got nan"),
        ({"actuation_mm": 4.1}, "actuation_mm must lie within the travel of 4.0 mm, got 4.1"),
        ({"reset_mm": -0.1}, "reset_mm must lie within the travel of 4.0 mm, got -0.1"),
        ({"reset_mm": np.nan}, "reset_mm must lie within the travel of 4.0 mm, got nan"),
        ({"curves": ()}, "at least one curve, got none"),
        ({"curves": (flat(60), flat(70))}, "press has two curves at one velocity"),
        ({"curves": (flat(60), flat(70, velocity_mm_s=None))}, "unknown velocity must stand alone"),
        ({"vibrations": (buzz(None), buzz(None))}, "press has two vibrations at one velocity"),
        ({"vibrations": (buzz(None), buzz(50.0))}, "a press vibration of unknown velocity must stand alone"),
    ],
)
def test_what_is_no_model_is_refused(fields: dict[str, Any], said: str) -> None:
    with pytest.raises(ModelError, match=said):
        model(**fields)


@settings(max_examples=40, deadline=None)
@given(models())
def test_the_order_in_which_curves_are_given_does_not_matter(drawn: FDVVModel) -> None:
    again = replace(drawn, curves=tuple(reversed(drawn.curves)))
    assert again == drawn
    assert hash(again) == hash(drawn)
    speeds = drawn.velocities_mm_s("press")
    assert list(speeds) == sorted(speeds)


def test_the_vibration_nearest_in_velocity_is_taken() -> None:
    slow, fast = buzz(50.0), buzz(200.0)
    both = model(vibrations=(fast, slow))
    assert both.vibration("press", 10.0) is slow
    assert both.vibration("press", 140.0) is fast
    assert both.vibration("release", 140.0) is None


def test_a_vibration_of_unknown_velocity_serves_every_speed() -> None:
    assert model(vibrations=(buzz(None),)).vibration("press", 300.0) == buzz(None)
