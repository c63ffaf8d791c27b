"""The judge, on devices whose error is known."""

import json

import numpy as np
import pytest

from fdvv.device.twin import TwinDevice
from fdvv.errors import InputError
from fdvv.model.curve import Stroke
from fdvv.model.file import load_builtin
from fdvv.model.press import Press
from fdvv.model.surface import ForceSurface
from fdvv.rendering.probe import fd_only, probe
from fdvv.rendering.session_run import PressDone
from fdvv.testing.scripted import ScriptedDevice

MODEL = load_builtin("mx-clear")
SPEEDS = [50.0, 200.0]
SURFACE = ForceSurface.of_model(MODEL, SPEEDS)


def test_a_device_that_adds_a_force_is_wrong_by_that_force() -> None:
    # slow, so that the cap moves by a hundredth of a millimetre between ticks of the device
    slow = ForceSurface.of_model(MODEL, [10.0])
    for curve in probe(ScriptedDevice(offset_cN=7.0), MODEL, slow, [10.0], 3).curves:
        np.testing.assert_allclose(curve.rendered_cN - curve.target_cN, 7.0, atol=1.5)
        assert (curve.rendered_cN - curve.target_cN).mean() == pytest.approx(7.0, abs=0.1)


def test_an_error_of_one_slope_is_scored_by_its_mean_and_its_largest() -> None:
    flat = ForceSurface(SURFACE.displacement_mm, np.array([50.0]), *(np.zeros((1, 81)) for _ in range(2)))
    curve = probe(ScriptedDevice(), MODEL, flat, [50.0], 2).curves[0]
    target = MODEL.force_cN(curve.displacement_mm, 50.0, "press")
    np.testing.assert_allclose(curve.mean_errors_cN, np.abs(target).mean())
    np.testing.assert_allclose(curve.max_errors_cN, np.abs(target).max())
    np.testing.assert_allclose(curve.error_cN, 0.7 * np.abs(target).mean() + 0.3 * np.abs(target).max())


def test_the_error_is_scored_in_true_displacement_not_in_the_sensed_one() -> None:
    class Blind(ScriptedDevice):
        def press(self, velocity_mm_s: float) -> Press:
            press = super().press(velocity_mm_s)
            assert press.sensed_mm is not None
            press.sensed_mm[:] = 0.0
            return press

    plain, blind = (probe(d, MODEL, SURFACE, SPEEDS, 2) for d in (ScriptedDevice(), Blind()))
    assert plain.to_dict() == blind.to_dict()


def test_the_range_judged_is_declared_and_kept() -> None:
    result = probe(ScriptedDevice(), MODEL, SURFACE, [50.0], 1)
    np.testing.assert_allclose(result.range_mm, (0.3, 3.9))
    for curve in result.curves:
        assert curve.displacement_mm[0] == pytest.approx(0.3)
        assert curve.displacement_mm[-1] == pytest.approx(3.9)
        # the last half bin lies beyond the stroke's guard
        assert curve.reached_ratio > 0.98


def test_the_achieved_speed_is_measured_and_offered_as_target() -> None:
    curve = probe(ScriptedDevice(pace_spread_ratio=0.2, seed=4), MODEL, SURFACE, SPEEDS, 5).curves[1]
    assert curve.achieved_mm_s.std() > 5
    expected = MODEL.force_cN(curve.displacement_mm, curve.achieved_mm_s[2], "press")
    np.testing.assert_allclose(curve.at_achieved_cN[2], expected)


def test_where_the_cap_did_not_come_back_the_finger_felt_nothing() -> None:
    low = np.where(SURFACE.displacement_mm < 2.5, 5.0, 60.0)[np.newaxis]
    stuck = ForceSurface(SURFACE.displacement_mm, np.array([50.0]), SURFACE.press_cN[:1], low)
    release = probe(TwinDevice(seed=3), MODEL, stuck, [50.0], 2).curves[1]
    assert release.reached_ratio < 0.9
    assert (release.rendered_cN[:, 0] == 0).all()


def test_the_report_has_the_agreed_shape() -> None:
    report = json.loads(json.dumps(probe(ScriptedDevice(), MODEL, SURFACE, SPEEDS, 3).to_dict()))
    assert report["simulated"] is True
    assert report["presses"] == 6
    assert len(report["curves"]) == 4
    for curve in report["curves"]:
        assert len(curve["error_cN"]) == 3
        assert curve["mean_error_cN"] <= curve["max_error_cN"]
        low, high = curve["mean_error_quartiles_cN"]
        assert low <= curve["mean_error_cN"] <= high


def test_progress_counts_fresh_presses() -> None:
    events: list[PressDone] = []
    probe(ScriptedDevice(), MODEL, SURFACE, SPEEDS, 3, events.append)
    assert [e.presses_done for e in events] == [1, 2, 3, 4, 5, 6]
    assert {e.stage for e in events} == {"probe"}


def test_fd_only_is_the_slowest_curve_of_each_stroke_at_every_speed() -> None:
    reduced = fd_only(MODEL)
    x = np.linspace(0.0, 4.0, 50)
    for stroke in Stroke:
        slow = MODEL.force_cN(x, 0.5, stroke)
        np.testing.assert_array_equal(reduced.force_cN(x, 200.0, stroke), slow)
        assert len(reduced.of(stroke)) == 1
    assert reduced.vibrations == ()
    assert "FD only" in reduced.name


def test_no_speed_is_refused() -> None:
    with pytest.raises(InputError):
        probe(ScriptedDevice(), MODEL, SURFACE, [], 2)
