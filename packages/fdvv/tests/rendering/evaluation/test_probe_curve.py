"""What a probe takes for the rendered force of one stroke."""

from __future__ import annotations

import numpy as np
import pytest

from fdvv.model.file import load_builtin
from fdvv.model.press import Press
from fdvv.rendering.evaluation.probe_curve import ProbeCurve, judge_curves

MODEL = load_builtin("mx-red")
SPEED_mm_s, REST_mm = 50.0, 0.6


def judged(rests_cN: float) -> list[ProbeCurve]:
    """Judge a press that renders the model exactly, from a cap that a finger rests on at REST_mm."""
    press_s = (MODEL.travel_mm - REST_mm) / SPEED_mm_s
    t_s = np.arange(0.0, 0.1 + 2 * press_s, 1e-4)
    down = np.clip((t_s - 0.03) / press_s, 0, 1) - np.clip((t_s - 0.07 - press_s) / press_s, 0, 1)
    x_mm = REST_mm + (MODEL.travel_mm - REST_mm) * down
    pressing = t_s < 0.05 + press_s
    force_cN = np.where(
        pressing, MODEL.force_cN(x_mm, SPEED_mm_s, "press"), MODEL.force_cN(x_mm, SPEED_mm_s, "release")
    )
    force_cN[x_mm <= REST_mm] = rests_cN
    return judge_curves(MODEL, SPEED_mm_s, [Press(t_s, x_mm, force_cN, SPEED_mm_s)])


def test_a_cap_that_a_heavy_finger_has_sunk_renders_what_the_button_would_give_way_to() -> None:
    for curve in judged(60.0):
        assert curve.max_errors_cN[0] < 1.0
        assert curve.reached_ratio < 0.92


def test_a_cap_that_sinks_under_a_light_finger_lacks_the_rest_of_the_models_force() -> None:
    for curve in judged(10.0):
        above = curve.displacement_mm < REST_mm - 0.06
        lacking = np.maximum(curve.target_cN[above] - 10.0, 0.0)
        assert np.abs(curve.rendered_cN[0] - curve.target_cN)[above] == pytest.approx(lacking)


def test_where_nobody_rests_on_a_cap_that_hangs_there_is_no_force() -> None:
    for curve in judged(0.0):
        assert (curve.rendered_cN[0][curve.displacement_mm < REST_mm - 0.06] == 0).all()
