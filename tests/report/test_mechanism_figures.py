from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_array_equal

from fdvv.errors import ModelError
from fdvv.model.curve import Stroke
from fdvv_switch.figures import DesignedStroke, plot_mechanism, plot_parts
from fdvv_switch.section import Drawing, Outline

X_mm = np.linspace(0.0, 4.0, 41)
PRESS = DesignedStroke(Stroke.PRESS, X_mm, 40 + X_mm, 41 + X_mm, 38 + X_mm, 44 + X_mm)


def test_a_stroke_draws_design_target_twin_and_what_is_missed() -> None:
    pressed = replace(PRESS, twin_mm=X_mm, twin_cN=41.5 + X_mm)
    grid = plot_mechanism([pressed, replace(PRESS, stroke=Stroke.RELEASE)], 3.0, "name")
    drawn = [line.get_ydata() for line in grid[0, 0].get_lines()]
    for got, wanted in zip(drawn, (PRESS.design_cN, pressed.twin_cN, PRESS.target_cN), strict=True):
        assert_array_equal(got, wanted)
    missed = [line.get_ydata() for line in grid[1, 0].get_lines()]
    assert_array_equal(missed[0], PRESS.design_cN - PRESS.target_cN)
    assert [float(np.ravel(y)[0]) for y in missed[1:]] == [-3.0, 3.0]
    assert [ax.get_title(loc="right") for ax in grid[0]] == ["simulated", ""]


def test_parts_are_drawn_to_scale_and_closed_ones_come_round() -> None:
    square = np.array([[0.0, 0.0], [2.0, 0.0], [2.0, 1.0], [0.0, 1.0]])
    part = Drawing("plate", "plate", (Outline("A", square, True), Outline("B", square[:2], False)))
    (ax,) = plot_parts([part])
    first, second = ax.get_lines()
    assert_array_equal(first.get_xydata()[-1], square[0])
    assert len(second.get_xydata()) == 2
    assert ax.get_aspect() == 1.0


def test_columns_of_another_length_and_empty_figures_are_refused() -> None:
    with pytest.raises(ModelError, match="target_cN"):
        replace(PRESS, target_cN=X_mm[:-1])
    with pytest.raises(ModelError, match="places and forces"):
        replace(PRESS, twin_mm=X_mm)
    with pytest.raises(ModelError, match="at least one stroke"):
        plot_mechanism([], 3.0)
    with pytest.raises(ModelError, match="nothing to draw"):
        plot_parts([])
