"""From a file of known curves to a model of those curves."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from fdvv.button.fit import FitSettings, fit_file
from fdvv.errors import InputError
from fdvv.model.curve import Stroke
from fdvv.model.file import load_builtin, save_model
from fdvv.model.fit import FitMethod
from tests.support.buttons import (
    CLOSES_mm,
    CONTACT_mm,
    OPENS_mm,
    STOP_mm,
    bench_mm,
    known_cN,
    write_columns,
    write_cycle,
)

STEP_mm = 0.005
STOP_WINDOW_mm = 0.02
"""Length over which the stop's slope is taken, which the found stop may precede the true one by."""


@pytest.fixture
def cycle(tmp_path: Path) -> Path:
    return write_cycle(tmp_path / "cycle.csv")


def test_zero_is_contact_and_travel_ends_at_the_stop(cycle: Path) -> None:
    model = fit_file(cycle).model
    assert model.curves[0].start_mm == 0.0
    assert model.travel_mm == pytest.approx(STOP_mm - CONTACT_mm, abs=STOP_WINDOW_mm)


def test_both_strokes_follow_the_known_curve(cycle: Path) -> None:
    found = fit_file(cycle)
    x = np.linspace(0.1, 3.9, 300)
    for stroke in Stroke:
        force = found.model.force_cN(x, 1.0, stroke)
        assert np.sqrt(np.mean((force - known_cN(x + CONTACT_mm, stroke)) ** 2)) < 0.3
    assert [f.curve.stroke for f in found.fits] == [Stroke.PRESS, Stroke.RELEASE]


def test_the_reported_error_is_that_of_the_model_on_the_raw_samples(cycle: Path) -> None:
    found = fit_file(cycle)
    for fit, raw, curve in zip(found.fits, found.measured, found.model.curves, strict=True):
        x, force, _ = raw.by_displacement()
        residual = curve.force_cN(x) - force
        assert fit.rmse_cN == pytest.approx(float(np.sqrt(np.mean(residual**2))), rel=1e-6)
        assert fit.max_cN == pytest.approx(float(np.abs(residual).max()), rel=1e-6)


def test_contact_points_come_from_the_electrical_column(cycle: Path) -> None:
    found = fit_file(cycle)
    assert found.model.actuation_mm == pytest.approx(CLOSES_mm - CONTACT_mm, abs=2 * STEP_mm)
    assert found.model.reset_mm == pytest.approx(OPENS_mm - CONTACT_mm, abs=2 * STEP_mm)


def test_without_an_electrical_column_the_points_are_unknown(tmp_path: Path) -> None:
    model = fit_file(write_columns(tmp_path / "p.csv", {"force_cN": known_cN(bench_mm())})).model
    assert (model.actuation_mm, model.reset_mm) == (None, None)


def test_several_velocities_become_several_curves(tmp_path: Path) -> None:
    x = bench_mm()
    columns = {
        "force_cN_100mm_s": known_cN(x, added_cN=10),
        "force_cN_50mm_s": known_cN(x, added_cN=4),
        "force_cN_0.5mm_s": known_cN(x),
    }
    found = fit_file(write_columns(tmp_path / "fast.csv", columns))
    assert found.model.velocities_mm_s(Stroke.PRESS) == (0.5, 50.0, 100.0)
    assert [f.curve.velocity_mm_s for f in found.fits] == [0.5, 50.0, 100.0]
    at = np.array([0.8, 2.0, 3.2])
    slow = found.model.force_cN(at, 0.5, "press")
    assert np.allclose(found.model.force_cN(at, 50.0, "press") - slow, 4, atol=0.3)
    assert np.allclose(found.model.force_cN(at, 100.0, "press") - slow, 10, atol=0.3)
    report = found.to_dict()
    assert report["strokes"]["press"] == {
        k: v for k, v in report["curves"][0].items() if k not in {"stroke", "velocity_mm_s"}
    }


def test_press_and_release_of_one_velocity_share_it(tmp_path: Path) -> None:
    x = bench_mm()
    columns = {"press_force_cN_50mm_s": known_cN(x), "release_force_cN_50mm_s": known_cN(x, "release")}
    model = fit_file(write_columns(tmp_path / "pair.csv", columns)).model
    assert [(c.stroke, c.velocity_mm_s) for c in model.curves] == [
        (Stroke.PRESS, 50.0),
        (Stroke.RELEASE, 50.0),
    ]


def test_the_settings_are_what_was_done_and_what_the_model_tells(cycle: Path) -> None:
    settings = FitSettings(FitMethod.UNIFORM, 22, 3, 0.05)
    found = fit_file(cycle, settings)
    assert {c.control_points_cN.size for c in found.model.curves} == {22}
    assert {c.degree for c in found.model.curves} == {3}
    method = found.model.provenance.method
    assert all(word in method for word in ("uniform", "22 control points", "sigma 0.05 mm"))
    assert "cycle.csv" in found.model.provenance.source


def test_a_release_alone_makes_a_model_without_landmarks(tmp_path: Path) -> None:
    path = write_columns(tmp_path / "r.csv", {"release_force_cN": known_cN(bench_mm(), "release")})
    found = fit_file(path)
    assert found.landmarks is None
    assert found.to_dict()["landmarks"] == {"travel_mm": found.model.travel_mm}


def test_a_stroke_that_stops_short_is_reported(tmp_path: Path) -> None:
    lines = write_columns(tmp_path / "s.csv", {"force_cN": known_cN(bench_mm())}).read_text().splitlines()
    (tmp_path / "s.csv").write_text("\n".join(lines[:600]) + "\n")
    found = fit_file(tmp_path / "s.csv")
    assert any("no stop found" in warning for warning in found.warnings)
    assert found.model.travel_mm == pytest.approx(598 * STEP_mm - CONTACT_mm, abs=STEP_mm)


def test_too_few_samples_for_the_points_are_refused_by_name(tmp_path: Path) -> None:
    path = tmp_path / "few.csv"
    rows = "\n".join(f"{x / 5},{10 * x}" for x in range(10))
    path.write_text("displacement_mm,force_cN\n" + rows + "\n")
    with pytest.raises(InputError, match=r"few\.csv: curve: .*16 distinct displacements.* got 10"):
        fit_file(path)


def test_a_file_that_fdvv_wrote_is_refused_as_a_measurement(tmp_path: Path) -> None:
    path = tmp_path / "mx-red.fdvv.json"
    save_model(load_builtin("mx-red"), path)
    with pytest.raises(InputError, match="holds an FDVV model, not a measurement"):
        fit_file(path)


def test_a_name_of_several_lines_becomes_one(tmp_path: Path) -> None:
    model = fit_file(write_cycle(tmp_path / "two\nlines.csv")).model
    assert model.name == "two lines"
    assert "\n" not in model.provenance.source
