"""Opening buttons by id: what is there, and nothing else."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from tests.workflow.shelves import write_folder

from fdvv.errors import InputError
from fdvv.model import SUFFIX, Stroke, builtin_names, load_builtin, save_model
from fdvv.workflow import Shelf, fit_file, sample_strokes


@pytest.fixture
def shelf(tmp_path: Path) -> Shelf:
    write_folder(tmp_path / "bench", {"x.csv": 0, "y.csv": 10})
    save_model(load_builtin("mx-red"), tmp_path / "project" / "buttons" / f"mine{SUFFIX}")
    return Shelf(tmp_path / "project", [tmp_path / "bench"])


def test_every_origin_opens(shelf: Shelf) -> None:
    assert shelf.model("builtin:mx-clear") == load_builtin("mx-clear")
    assert shelf.model("own:mine") == load_builtin("mx-red")
    measured = next(file for file in shelf.scan() if file.id.startswith("measured:"))
    assert shelf.model(measured.id) == fit_file(measured.path).model


@pytest.mark.parametrize(
    "button_id",
    [
        *("own:../buttons/mine", f"own:mine{SUFFIX}", "own:", "", "mine", "builtin:", "builtin:../x"),
        *("measured:../x.csv", "measured:0000000000000000", "/etc/passwd", "own:mine\0"),
    ],
)
def test_what_is_no_id_opens_nothing(shelf: Shelf, button_id: str) -> None:
    with pytest.raises(InputError, match="no button is called"):
        shelf.model(button_id)


def test_a_changed_file_is_read_anew_and_one_that_came_is_found(shelf: Shelf, tmp_path: Path) -> None:
    path = tmp_path / "project" / "buttons" / f"mine{SUFFIX}"
    assert shelf.model("own:mine").name == "mx-red"
    save_model(load_builtin("mx-blue"), path)
    assert shelf.model("own:mine").name == "mx-blue"
    save_model(load_builtin("mx-black"), path.with_name(f"new{SUFFIX}"))
    assert shelf.model("own:new").name == "mx-black"
    path.unlink()
    with pytest.raises(InputError):
        shelf.model("own:mine")


def test_curves_are_the_means_themselves_not_a_fit(shelf: Shelf) -> None:
    measured = next(file for file in shelf.scan() if file.id.startswith("measured:"))
    raw, fitted = shelf.curves(measured.id), shelf.model(measured.id)
    x = np.linspace(0.3, 3.8, 200)
    gap = raw.force_cN(x, 1.0) - fitted.force_cN(x, 1.0)
    assert 0 < np.abs(gap).max() < 1.0
    assert raw.of(Stroke.PRESS)[0].degree == 1


def test_nothing_but_buttons_of_the_source_is_read(tmp_path: Path) -> None:
    secret = tmp_path / "secret.csv"
    secret.write_text("password")
    (tmp_path / "bench").mkdir()
    shelf = Shelf(tmp_path / "project", [tmp_path / "bench"])
    assert shelf.scan() == ()
    assert list((tmp_path / "bench").iterdir()) == []
    assert not (tmp_path / "project").exists()


@pytest.mark.parametrize("name", builtin_names())
def test_samples_lie_on_the_curves(name: str) -> None:
    model = load_builtin(name)
    for sampled, curve in zip(sample_strokes(model), model.curves, strict=True):
        x = sampled.start_mm + sampled.step_mm * np.arange(sampled.force_cN.size)
        np.testing.assert_allclose(sampled.force_cN, curve.force_cN(x), atol=1e-6)
        assert x[-1] == pytest.approx(curve.end_mm)
        assert sampled.step_mm <= 0.0101
