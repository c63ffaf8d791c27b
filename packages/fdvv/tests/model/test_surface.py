from typing import Any

import numpy as np
import pytest

from fdvv.errors import ModelError
from fdvv.model.curve import Stroke
from fdvv.model.file import load_builtin
from fdvv.model.model import FDVVModel
from fdvv.model.surface import ForceSurface

CLEAR = load_builtin("mx-clear")


def surface(**fields: Any) -> ForceSurface:
    whole: dict[str, Any] = {
        "displacement_mm": [0.0, 0.5, 1.0],
        "velocity_mm_s": [50.0, 100.0],
        "press_cN": np.ones((2, 3)),
        "release_cN": np.zeros((2, 3)),
    }
    return ForceSurface(**{**whole, **fields})


@pytest.mark.parametrize(
    ("fields", "said"),
    [
        ({"press_cN": np.ones((3, 2))}, r"tables must be \(2, 3\), got \(3, 2\)"),
        ({"release_cN": np.ones((2, 2))}, r"tables must be \(2, 3\)"),
        ({"press_cN": np.full((2, 3), np.nan)}, "press_cN must be finite"),
        ({"displacement_mm": [0.0, 0.5, 1.1]}, "equal rising steps"),
        ({"displacement_mm": [1.0, 0.5, 0.0]}, "equal rising steps"),
        ({"velocity_mm_s": [100.0, 50.0]}, "velocity_mm_s must rise strictly"),
        ({"velocity_mm_s": [50.0, 50.0]}, "velocity_mm_s must rise strictly"),
    ],
)
def test_tables_that_are_no_surface_are_refused(fields: dict[str, Any], said: str) -> None:
    with pytest.raises(ModelError, match=said):
        surface(**fields)


def test_one_displacement_is_no_surface() -> None:
    with pytest.raises(ModelError, match="at least 2 points"):
        ForceSurface(np.zeros(1), np.ones(1), np.ones((1, 1)), np.ones((1, 1)))


def test_a_surface_of_a_model_is_the_model_at_every_grid_point() -> None:
    speeds = np.linspace(0.5, 300, 17)
    table = ForceSurface.of_model(CLEAR, speeds, step_mm=0.1)
    assert table.press_cN.shape == (17, 41)
    for stroke in Stroke:
        for i, j in ((0, 0), (3, 7), (16, 40)):
            at = (table.displacement_mm[j], speeds[i], stroke)
            assert table.table_cN(stroke)[i, j] == CLEAR.force_cN(*at)


def test_a_model_without_a_release_serves_both_strokes_with_its_press() -> None:
    half = FDVVModel("half", 4.0, CLEAR.of(Stroke.PRESS))
    table = ForceSurface.of_model(half, [50.0, 120.0])
    np.testing.assert_array_equal(table.press_cN, table.release_cN)
    np.testing.assert_array_equal(table.press_cN[0], CLEAR.of("press")[1].force_cN(table.displacement_mm))


def test_a_model_without_a_press_cannot_be_tabulated() -> None:
    with pytest.raises(ModelError, match="has no press curve"):
        ForceSurface.of_model(FDVVModel("half", 4.0, CLEAR.of(Stroke.RELEASE)), [50.0])
