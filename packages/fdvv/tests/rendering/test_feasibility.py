"""Can a known rig render a button: the report, and whether the twin agrees. Simulated."""

from __future__ import annotations

import json
from dataclasses import replace

import numpy as np
import pytest

from fdvv.compensation.feasibility.limits import Motion
from fdvv.compensation.feasibility.stability import NominalFinger, SampledLoop, stiffness_limit_N_m
from fdvv.compensation.feasibility.verdict import Following
from fdvv.compensation.identification.rig_model import RigModel
from fdvv.device.contract import DeviceInfo
from fdvv.device.twin import TwinDevice
from fdvv.errors import InputError, ModelError
from fdvv.model.curve import Stroke
from fdvv.model.edit import remove_curve
from fdvv.model.file import load_builtin
from fdvv.model.model import FDVVModel
from fdvv.model.surface import ForceSurface
from fdvv.rendering.compensate import start_surface
from fdvv.rendering.feasibility import FeasibilityReport, feasibility, feasible_curves
from fdvv.rendering.probe import fd_only, probe
from fdvv.twin.finger import Finger
from fdvv.twin.rig import Rig
from fdvv.twin.settings import settings_of
from tests.support.held import swings_held
from tests.support.rig_truth import draw_fast_rig, rig_truth

SPEEDS = (50.0, 200.0)
Drawn = tuple[Rig, Finger, RigModel]


@pytest.fixture(scope="module")
def drawn() -> Drawn:
    rig, finger = draw_fast_rig(401, "voltage")
    return rig, finger, rig_truth(rig)


@pytest.fixture(scope="module")
def model() -> FDVVModel:
    return load_builtin("mx-clear")


@pytest.fixture(scope="module")
def report(drawn: Drawn, model: FDVVModel) -> FeasibilityReport:
    rig, _, known = drawn
    return feasibility(model, known, settings_of(rig), (200.0, 50.0))


def test_every_stroke_and_speed_is_judged_in_order(report: FeasibilityReport) -> None:
    judged = [(c.stroke, c.velocity_mm_s) for c in report.curves]
    assert judged == [(stroke, speed) for stroke in Stroke for speed in SPEEDS]
    assert report.velocity_mm_s == SPEEDS
    assert len(report.doses) == 2


def test_a_slow_press_of_a_good_rig_is_followed_and_meets_the_model(
    report: FeasibilityReport, model: FDVVModel
) -> None:
    slow = report.curves[0]
    assert slow.verdict.following is Following.FOLLOWS
    x = slow.reached.displacement_mm
    np.testing.assert_allclose(slow.reached.intended_cN, model.force_cN(x, 50.0, "press"))
    assert slow.reached.shortfall_cN < 0.3


def test_more_is_asked_of_a_rig_the_faster_the_press(report: FeasibilityReport) -> None:
    slow, fast = report.curves[0], report.curves[1]
    assert fast.expected.mean_cN > slow.expected.mean_cN
    assert fast.reached.lag_mm == pytest.approx(4 * slow.reached.lag_mm)


def test_the_step_between_strokes_is_reported_with_the_release_alone(report: FeasibilityReport) -> None:
    steps = [curve.stable.step_cN for curve in report.curves]
    assert steps[:2] == [0.0, 0.0]
    assert min(steps[2:]) > 10.0


def test_the_report_is_a_document_without_nan(report: FeasibilityReport) -> None:
    read = json.loads(json.dumps(report.to_dict(), allow_nan=False))
    assert read == report.to_dict()
    assert [c["verdict"] for c in read["curves"]] == [str(c.verdict.following) for c in report.curves]
    assert read["curves"][0]["measured"] is None
    assert read["curves"][0]["stability"]["margin"] > 1


def test_a_weak_coil_is_named_by_its_limit_and_a_strong_one_is_not(drawn: Drawn, model: FDVVModel) -> None:
    rig, _, known = drawn
    weak = replace(settings_of(rig), force_limit_cN64=64 * 60)
    cut, whole = (feasibility(model, known, s, [50.0]).curves[0] for s in (weak, settings_of(rig)))
    assert "the limit is 60" in cut.verdict.reasons[0]
    assert cut.reached.saturated.any()
    assert not whole.reached.saturated.any()


def test_a_button_without_a_release_is_judged_with_its_press_for_both(drawn: Drawn, model: FDVVModel) -> None:
    rig, _, known = drawn
    single = fd_only(model)
    single = remove_curve(single, *next((c.stroke, c.velocity_mm_s) for c in single.of("release")))
    report = feasibility(single, known, settings_of(rig), [50.0])
    press, release = report.curves
    np.testing.assert_array_equal(press.reached.intended_cN, release.reached.intended_cN)
    assert release.stable.step_cN == 0.0


def test_a_travel_beyond_the_device_is_refused_by_its_verdict(drawn: Drawn, model: FDVVModel) -> None:
    rig, _, known = drawn
    short = DeviceInfo("short", False, 440.0, 3.0, 2.5e-4)
    report = feasibility(model, known, settings_of(rig), [50.0], info=short)
    assert all(c.verdict.following is Following.CANNOT for c in report.curves)
    assert report.device_name == "short"


def test_a_motion_that_is_known_takes_the_place_of_minimum_jerk(drawn: Drawn, model: FDVVModel) -> None:
    rig, _, known = drawn
    lasts_s = model.travel_mm / 200.0
    t = np.linspace(0.0, lasts_s, 800)
    even = Motion(Stroke.PRESS, t, 200.0 * t, np.full(800, 200.0), np.zeros(800))
    report = feasibility(model, known, settings_of(rig), [200.0], motions={(Stroke.PRESS, 200.0): even})
    press = report.curves[0].reached
    opposed = known.opposing_cN(np.full(401, 200.0), np.zeros(401), press.displacement_mm)
    wanted = (press.intended_cN - opposed) / known.gain_at(press.displacement_mm)
    np.testing.assert_allclose(press.command_cN, wanted, atol=0.05)


def test_bad_speeds_and_a_model_without_a_press_are_refused(drawn: Drawn, model: FDVVModel) -> None:
    rig, _, known = drawn
    with pytest.raises(InputError, match="speeds cannot be"):
        feasibility(model, known, settings_of(rig), [])
    with pytest.raises(ModelError, match="no press curve"):
        feasibility(replace(model, curves=model.of("release")), known, settings_of(rig), [50.0])


def test_what_presses_measured_stands_beside_what_was_computed(drawn: Drawn, model: FDVVModel) -> None:
    rig, finger, known = drawn
    device = TwinDevice(rig, finger, 3)
    found = probe(device, model, start_surface(device, model, [50.0]), [50.0], 2)
    report = feasibility(model, known, device.settings(), [50.0, 100.0], found, device.info())
    measured = [curve.measured for curve in report.curves]
    assert measured[0] is found.curves[0]
    assert measured[2] is found.curves[1]
    assert measured[1] is None
    assert measured[3] is None
    drawn_curves = feasible_curves(report)
    assert [c.simulated for c in drawn_curves] == [True, False, True, False]
    assert drawn_curves[0].band is not None
    np.testing.assert_array_equal(
        drawn_curves[0].band.mean_cN, np.median(found.curves[0].rendered_cN, axis=0)
    )


@pytest.mark.parametrize("seed", [400, 401, 402])
def test_a_held_finger_is_quiet_well_below_the_onset_and_swings_well_above(seed: int) -> None:
    rig, finger = draw_fast_rig(seed, "voltage" if seed % 2 else "current")
    known, x = rig_truth(rig), 0.05 * np.arange(81.0)
    onset = stiffness_limit_N_m(SampledLoop.of_rig(known, 2.5e-4, 2.0, NominalFinger(), 60.0))

    def swings(ratio: float) -> bool:
        wanted = (60.0 + 0.1 * ratio * onset * (x - 2.0) + known.weight_cN) / known.gain_at(x)
        table = np.clip(wanted, -440.0, 440.0)[np.newaxis]
        return swings_held(rig, finger, ForceSurface(x, np.array([50.0]), table, table), 4.0, 2.0, 60.0)

    assert [swings(ratio) for ratio in (0.3, 0.6, 2.0, 3.0)] == [False, False, True, True]
