"""Rendered and intended force on one grid."""

import numpy as np
import pytest

from fdvv.device.twin import TwinDevice
from fdvv.model.curve import Stroke
from fdvv.model.file import load_builtin
from fdvv.model.noticeable import LITERATURE
from fdvv.model.surface import ForceSurface
from fdvv.rendering.press_check import bin_press, noticeable_cN, target_press
from fdvv.rendering.probe import probe
from fdvv.rendering.session_run import PressDone

MODEL = load_builtin("mx-clear")


def test_the_rendered_force_is_what_a_probe_judges() -> None:
    device, surface = TwinDevice(seed=3), ForceSurface.of_model(MODEL, [100.0])
    made: list[PressDone] = []
    result = probe(device, MODEL, surface, [100.0], 1, made.append)
    press = made[0].press
    assert press
    found = bin_press(press, MODEL.travel_mm)
    for curve, force_cN in zip(result.curves, (found.press_cN, found.release_cN), strict=True):
        rows = np.searchsorted(found.displacement_mm, curve.displacement_mm - 1e-9)
        assert np.nan_to_num(force_cN[rows]) == pytest.approx(curve.rendered_cN[0])


def test_what_was_intended_is_the_models_force() -> None:
    found = target_press(MODEL, 80.0)
    assert found.displacement_mm[-1] == pytest.approx(MODEL.travel_mm, abs=0.03)
    assert found.press_cN == pytest.approx(MODEL.force_cN(found.displacement_mm, 80.0, Stroke.PRESS))


def test_what_is_noticeable_is_a_part_of_the_mean_force() -> None:
    down, up = noticeable_cN(MODEL, 100.0, LITERATURE)
    wanted = target_press(MODEL, 100.0)
    assert LITERATURE.force_cN(wanted.press_cN).min() < down < LITERATURE.force_cN(wanted.press_cN).max()
    assert 0 < up < down
