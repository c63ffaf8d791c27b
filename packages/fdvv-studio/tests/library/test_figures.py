"""What a row says of a button: figures of closed forms, types by their facts, reasons for what is None."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from fdvv.button.fit import fit_file
from fdvv.button.kind import ButtonType
from fdvv.model.curve import ForceCurve, Stroke
from fdvv.model.file import builtin_names, load_builtin
from fdvv.model.landmarks import landmarks
from fdvv.model.model import FDVVModel
from fdvv.units import FloatArray
from fdvv_studio.library.figures import row_of_file
from fdvv_studio.library.row import NUMBERS as SHELF_NUMBERS
from fdvv_studio.library.row import Origin
from tests.support.buttons import write_cycle
from tests.support.catalog_rows import bumped, button, dome, row, spring


def test_a_straight_spring_is_linear_and_has_no_bump_but_a_reason() -> None:
    found = row(button(spring, lambda x: spring(x) - 2))
    assert found.kind is ButtonType.LINEAR
    assert found.peak_cN is found.drop_cN is found.snap_ratio is None
    assert "bump: not detected: the force never falls by 4 cN" in found.why
    assert found.bottom_out_cN == pytest.approx(55)
    assert found.work_mJ == pytest.approx(0.01 * (35 * 4 - 0.5 * 35 * 0.05 + 0.5 * 5 * 16), rel=1e-3)
    assert found.loss_mJ == pytest.approx(0.01 * 2 * 4, rel=1e-3)


def test_a_fall_that_press_and_release_share_is_tactile() -> None:
    found = row(button(bumped(15), bumped(12)))
    assert found.kind is ButtonType.TACTILE
    assert found.peak_mm == pytest.approx(1.5, abs=0.03)
    assert found.valley_mm == pytest.approx(1.9, abs=0.03)
    assert found.drop_cN == pytest.approx(15, abs=0.6)
    assert found.release_drop_cN == pytest.approx(12, abs=0.6)


def test_a_fall_within_50_um_is_marked_as_perhaps_clicky() -> None:
    found = row(button(bumped(20, 0.03), bumped(10, 0.3)))
    assert found.kind is ButtonType.CLICKY
    assert "does not tell the sound" in found.kind_reason


def test_a_slow_fall_that_snaps_back_elsewhere_is_clicky_as_a_click_jacket() -> None:
    def at(depth_mm: float, drop_cN: float) -> Callable[[FloatArray], FloatArray]:
        return lambda x: np.asarray(spring(x) + drop_cN * np.exp(-(((x - depth_mm) / 0.3) ** 2)))

    jacket, leaf = row(button(at(1.7, 15), at(0.9, 15))), row(button(at(1.7, 15), at(1.6, 15)))
    assert jacket.kind is ButtonType.CLICKY
    assert "the release 0.80 mm less deep" in jacket.kind_reason
    assert leaf.kind is ButtonType.TACTILE


def test_what_is_stated_comes_before_what_the_curve_suggests() -> None:
    found = row(button(bumped(15), bumped(12), "Cherry MX Blue"))
    assert found.kind is ButtonType.TACTILE
    assert found.stated == ("clicky",)
    assert found.kind_reason.startswith(
        "stated clicky by its maker; the curve suggests tactile, right for 98 %"
    )
    unknown = row(button(bumped(15), bumped(12), "mine"))
    assert unknown.kind_reason.startswith("right for 98 % of such curves: the press falls by")


def test_a_small_jump_is_unclear() -> None:
    assert row(button(bumped(8, 0.03), bumped(8, 0.03))).kind is ButtonType.UNCLEAR


def test_a_slow_build_up_and_a_long_collapse_are_marked_as_perhaps_a_dome() -> None:
    found = row(button(dome, lambda x: dome(x) - 5))
    assert found.kind is ButtonType.DOME
    assert row(button(bumped(15), bumped(12))).kind is not ButtonType.DOME


def test_breakaway_at_contact_that_the_release_does_not_repeat_is_linear() -> None:
    def sticky(x: FloatArray) -> FloatArray:
        return np.asarray(spring(x) + 6 * np.exp(-(((x - 0.08) / 0.06) ** 2)))

    found = row(button(sticky, lambda x: spring(x) - 3))
    assert found.kind is ButtonType.LINEAR
    assert "breakaway" in found.kind_reason


def test_a_fall_on_the_press_alone_is_unclear() -> None:
    assert row(button(bumped(8), lambda x: spring(x) - 8)).kind is ButtonType.UNCLEAR


def test_without_a_release_the_press_decides_and_the_type_is_less_sure() -> None:
    found = row(button(bumped(15)))
    assert found.kind is ButtonType.TACTILE
    assert "right for 80 % of such curves" in found.kind_reason
    assert found.loss_mJ is None
    assert "release: the source holds no release" in found.why


def test_a_fall_at_the_stop_is_no_bump() -> None:
    def turning(x: FloatArray) -> FloatArray:
        return np.asarray(spring(x) - 20 * np.clip((x - 3.95) / 0.05, 0, 1))

    assert row(button(turning, lambda x: spring(x) - 2)).peak_cN is None


def test_a_release_alone_has_no_figures_of_a_press_and_says_so() -> None:
    curve = ForceCurve(Stroke.RELEASE, None, 1, np.array([0.0, 0, 4, 4]), np.array([30.0, 50]))
    found = row(FDVVModel("half", 4.0, (curve,)))
    assert found.kind is ButtonType.UNCLEAR
    assert found.bottom_out_cN is None
    assert "press: the source holds no press" in found.why


@pytest.mark.parametrize("name", builtin_names())
def test_figures_of_a_model_are_its_landmarks(name: str) -> None:
    model = load_builtin(name)
    found, marks = row(model, f"builtin:{name}"), landmarks(model).to_dict()
    for figure in set(SHELF_NUMBERS) & set(marks):
        value = getattr(found, figure)
        assert value == (None if marks[figure] is None else pytest.approx(marks[figure], abs=0.25)), figure


def test_the_sketch_is_the_curve_at_64_places() -> None:
    model = load_builtin("mx-clear")
    found, curve = row(model), model.of(Stroke.PRESS)[0]
    expected = curve.force_cN(np.linspace(0, model.travel_mm, 64))
    np.testing.assert_allclose(0.1 * np.array(found.sketch.press_dcN), expected, atol=0.0501)


def test_a_measured_file_is_read_without_a_fit_and_agrees_with_it(tmp_path: Path) -> None:
    path = write_cycle(tmp_path / "linear silent.csv")
    found = row_of_file(path, "measured:0123456789abcdef", "mine/silent")
    marks = landmarks(fit_file(path).model)
    assert found.origin is Origin.MEASURED
    assert (found.cycles, found.used) == (1, 1)
    assert found.stated == ("linear", "silent")
    assert found.kind is ButtonType.TACTILE
    assert found.peak_cN == pytest.approx(marks.peak_cN, abs=0.3)
    assert found.valley_mm == pytest.approx(marks.valley_mm, abs=0.05)
    assert found.actuation_mm == pytest.approx(marks.actuation_mm, abs=1e-3)
    assert found.travel_mm == pytest.approx(marks.travel_mm, abs=1e-6)
    assert found.work_mJ == pytest.approx(marks.work_mJ, rel=0.005)


@pytest.mark.shared
def test_types_of_real_switches_are_those_their_measurer_states(shared_data: Path) -> None:
    lines = (shared_data / "tg-strokes" / "switchmeta.csv").read_text().splitlines()
    stated = dict(line.rsplit(",", 1) for line in lines if "," in line)
    agree, differ = 0, []
    for path in sorted((shared_data / "tg-tidy" / "data").glob("*.csv")):
        found = row_of_file(path, "measured:0", "")
        if found.name in stated and found.kind is not ButtonType.UNCLEAR:
            same = found.kind.value.rstrip("?") == stated[found.name].strip()
            agree += same
            differ += [] if same else [found.name]
    assert differ == []
    assert agree == 16
