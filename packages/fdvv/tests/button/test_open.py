"""Buttons and parts of buttons by the words of a command line."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from fdvv.button.fit import fit_file
from fdvv.button.open import (
    button_files,
    merge_parts,
    one_curve,
    open_button,
    open_files,
    open_models,
    open_part,
)
from fdvv.errors import InputError, ModelError
from fdvv.model.curve import Stroke
from fdvv.model.file import MODEL_SUFFIX, load_builtin, save_model
from fdvv.model.model import FDVVModel
from fdvv.model.spread import CurveSpread
from fdvv.rendering.tuning import open_device
from tests.support.buttons import line_model, write_cycle


@pytest.fixture
def measured(tmp_path: Path) -> Path:
    return write_cycle(tmp_path / "switch.csv")


def saved(path: Path, model: FDVVModel) -> Path:
    save_model(model, path)
    return path


def test_a_button_is_a_builtin_a_model_file_or_a_measurement(tmp_path: Path, measured: Path) -> None:
    assert open_button("mx-red") == load_builtin("mx-red")
    model = line_model("line", 40)
    assert open_button(str(saved(tmp_path / f"line{MODEL_SUFFIX}", model))) == model
    assert open_button(str(measured)) == fit_file(measured).model


@pytest.mark.parametrize("spec", ["", "mx-blu", "gone.csv", "."])
def test_what_names_no_button_is_refused_with_those_there_are(spec: str) -> None:
    with pytest.raises(InputError, match="mx-black, mx-blue"):
        open_button(spec)


@pytest.mark.parametrize(
    ("number", "wild", "place"),
    [
        ('"travel_mm": 4.0', '"travel_mm": 2e3', r"\$: travel_mm must stay within 1000, got 2000"),
        ("[40.0", "[2e6", r"\$\.curves\[0\]: control_points_cN must stay within 1e\+06, got 2e\+06"),
    ],
)
def test_numbers_beyond_any_button_are_refused_by_place(
    tmp_path: Path, number: str, wild: str, place: str
) -> None:
    path = saved(tmp_path / f"wild{MODEL_SUFFIX}", line_model("wild", 40.0, 0.0))
    text = path.read_text()
    assert number in text
    path.write_text(text.replace(number, wild))
    with pytest.raises(InputError, match=place):
        open_button(str(path))


def test_a_folder_stands_for_its_models_else_for_its_measurements(tmp_path: Path, measured: Path) -> None:
    assert [m.name for m in open_models([str(tmp_path), "mx-red"])] == ["switch", "mx-red"]
    saved(tmp_path / f"b{MODEL_SUFFIX}", line_model("b", 30))
    saved(tmp_path / f"a{MODEL_SUFFIX}", line_model("a", 30))
    assert [m.name for m in open_models([str(tmp_path)])] == ["a", "b"]
    assert measured.is_file()


def test_a_folders_unusable_files_are_reported_and_skipped(tmp_path: Path) -> None:
    saved(tmp_path / f"a{MODEL_SUFFIX}", line_model("a", 30))
    (tmp_path / f"b{MODEL_SUFFIX}").write_text("{")
    refused: list[str] = []
    assert [m.name for m in open_models([str(tmp_path)], refused)] == ["a"]
    assert len(refused) == 1
    assert f"b{MODEL_SUFFIX}" in refused[0]
    assert [(b.file.name, b.model is None, b.reason) for b in open_files(button_files(tmp_path))] == [
        (f"a{MODEL_SUFFIX}", False, ""),
        (f"b{MODEL_SUFFIX}", True, refused[0]),
    ]


def test_a_part_is_cut_to_its_stroke_and_declared_to_be_of_its_velocity() -> None:
    assert [(c.stroke, c.velocity_mm_s) for c in open_part("mx-red:press@50").curves] == [
        (Stroke.PRESS, 50.0)
    ]
    assert [c.velocity_mm_s for c in open_part("mx-red@1e2").curves] == [100.0, 100.0]
    assert open_part("mx-red") == load_builtin("mx-red")
    clear = open_part("mx-clear:release")
    assert {c.stroke for c in clear.curves} == {Stroke.RELEASE}
    assert {v.stroke for v in clear.vibrations} <= {Stroke.RELEASE}


@pytest.mark.parametrize(
    ("measured_mm_s", "kept"), [(None, True), (50.0, True), (80.0, False)], ids=["unknown", "same", "another"]
)
def test_a_part_declared_to_be_of_another_velocity_is_not_what_was_measured(
    tmp_path: Path, measured_mm_s: float | None, kept: bool
) -> None:
    spread = CurveSpread(np.array([0.0, 3.0]), np.array([1.0, 2.0]), 15)
    model = line_model("line", 40)
    press = replace(model.of("press")[0], velocity_mm_s=measured_mm_s, spread=spread)
    path = saved(tmp_path / f"line{MODEL_SUFFIX}", replace(model, curves=(press,)))
    assert one_curve(str(path)).spread == spread
    assert one_curve(f"{path}@50").spread == (spread if kept else None)


@pytest.mark.parametrize(
    "name", ["a:b.csv", "a@b.csv", "c:press.csv", "d@50.csv", "e x.csv", "f:press@9.csv"]
)
def test_colons_and_at_signs_in_a_path_are_part_of_it(tmp_path: Path, name: str) -> None:
    path = write_cycle(tmp_path / name)
    assert len(open_part(str(path)).curves) == 2
    (curve,) = open_part(f"{path}:release@7").curves
    assert (curve.stroke, curve.velocity_mm_s) == (Stroke.RELEASE, 7.0)


@pytest.mark.parametrize("name", ["g@50", "h:press", "i:press@50"])
def test_a_file_whose_whole_name_reads_like_a_part_is_that_file(tmp_path: Path, name: str) -> None:
    path = write_cycle(tmp_path / name)
    assert [c.velocity_mm_s for c in open_part(str(path)).curves] == [None, None]


@pytest.mark.parametrize("velocity", ["0", "-5", "1e999", "5-5"])
def test_a_velocity_must_be_a_positive_number(velocity: str) -> None:
    with pytest.raises(InputError, match="is not a speed above 0 mm/s"):
        open_part(f"mx-red@{velocity}")


def test_of_several_velocities_one_is_chosen() -> None:
    whole = load_builtin("mx-clear")
    assert open_part("mx-clear:press@200").curves == (whole.nearest("press", 200.0),)
    both = open_part("mx-clear@50")
    assert both.curves == tuple(c for c in whole.curves if c.velocity_mm_s == 50.0)
    assert all(v.velocity_mm_s in (None, 50.0) for v in both.vibrations)
    assert one_curve("mx-clear:release@0.5") == whole.of("release")[0]
    with pytest.raises(InputError, match=r"no curve of 5 mm/s; choose one of @0.5, @50, @100, @150, @200"):
        open_part("mx-clear@5")


def test_what_is_missing_to_name_one_curve_is_said() -> None:
    with pytest.raises(InputError, match=r"needed; add the velocity, as @50\Z"):
        one_curve("mx-clear:press")
    with pytest.raises(InputError, match=r"needed; add :press or :release\Z"):
        one_curve("mx-clear@50")


def test_a_stroke_that_is_not_there_is_refused(tmp_path: Path) -> None:
    lone = replace(line_model("lone", 30), curves=line_model("lone", 30).of("press"))
    spec = f"{saved(tmp_path / f'lone{MODEL_SUFFIX}', lone)}:release"
    with pytest.raises(InputError, match="no release curve"):
        open_part(spec)


def test_one_curve_is_one_curve() -> None:
    (press,) = load_builtin("mx-red").of("press")
    assert (one_curve("mx-red:press").control_points_cN == press.control_points_cN).all()
    with pytest.raises(InputError, match="holds 2 curves"):
        one_curve("mx-red")


def test_merged_parts_keep_their_curves_bit_for_bit() -> None:
    merged = merge_parts(["mx-red@50", "mx-red@100"], "both")
    red = load_builtin("mx-red")
    assert [(c.stroke, c.velocity_mm_s) for c in merged.curves] == [
        (stroke, velocity) for stroke in Stroke for velocity in (50.0, 100.0)
    ]
    for curve in merged.curves:
        (original,) = red.of(curve.stroke)
        assert (curve.control_points_cN == original.control_points_cN).all()
    assert (merged.travel_mm, merged.actuation_mm) == (red.travel_mm, red.actuation_mm)


def test_parts_that_differ_need_a_decision() -> None:
    parts = ["mx-red:press@50", "mx-blue:press@100"]
    with pytest.raises(ModelError, match="travel_mm"):
        merge_parts(parts, "both")
    merged = merge_parts(parts, "both", travel_mm=3.5, actuation_mm=2.0, reset_mm=1.5)
    assert (merged.travel_mm, merged.actuation_mm, merged.reset_mm) == (3.5, 2.0, 1.5)


def test_two_curves_of_one_velocity_need_a_decision_too() -> None:
    parts = ["mx-red:press@50", "mx-blue:press@50"]
    points: dict[str, Any] = {"travel_mm": 3.5, "actuation_mm": 2.0, "reset_mm": 1.5}
    with pytest.raises(ModelError, match="two different curves"):
        merge_parts(parts, "both", **points)
    for conflict, name in (("first", "mx-red"), ("last", "mx-blue")):
        (curve,) = merge_parts(parts, "both", **points, conflict=conflict).curves
        (original,) = load_builtin(name).of("press")
        assert (curve.control_points_cN == original.control_points_cN).all()


def test_the_part_of_unknown_velocity_is_named() -> None:
    with pytest.raises(InputError, match="mx-blue: velocity: its press is of unknown velocity"):
        merge_parts(["mx-red@50", "mx-blue"], "both", travel_mm=3.5, actuation_mm=2, reset_mm=1)


def test_devices_are_opened_by_name() -> None:
    assert open_device("twin").info().simulated
    for name in ("robot", "serial", "serial:", "replay:", "host:1", ""):
        with pytest.raises(
            InputError, match="use one of twin, host, emulated, emulated:FILE, serial:PORT, replay:FILE"
        ):
            open_device(name)


def test_opening_a_folder_tells_how_far_it_is(tmp_path: Path) -> None:
    for name in "ab":
        saved(tmp_path / f"{name}{MODEL_SUFFIX}", line_model(name, 30))
    progress: list[tuple[int, int]] = []
    open_models(["mx-red", str(tmp_path)], None, lambda done, total: progress.append((done, total)))
    assert progress == [(1, 2), (2, 2)]
