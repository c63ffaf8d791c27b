"""Folders: order, refusals, the same answer from any number of threads, summaries."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from fdvv.button.fit import FitSettings, FolderFit, fit_file, fit_files, measured_files, summarise
from fdvv.errors import InputError
from fdvv.model.curve import Stroke
from fdvv.model.file import MODEL_SUFFIX, load_builtin, save_model
from tests.support.buttons import write_cycle


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    below = tmp_path_factory.mktemp("switches")
    (below / "deep").mkdir()
    for i, name in enumerate(["d.csv", "a.csv", "deep/e.csv", "c.csv"]):
        write_cycle(below / name, added_cN=3 * i, seed=i)
    (below / "b.csv").write_text("text,of,no,kind\n1,2,3,4\n")
    save_model(load_builtin("mx-red"), below / f"fitted{MODEL_SUFFIX}")
    return below


@pytest.fixture(scope="module")
def results(folder: Path) -> list[FolderFit]:
    return list(fit_files(measured_files(folder), workers=1))


def test_files_come_in_the_order_of_their_paths_and_models_are_passed_over(
    folder: Path, results: list[FolderFit]
) -> None:
    names = [str(r.file.relative_to(folder)) for r in results]
    assert names == ["a.csv", "b.csv", "c.csv", "d.csv", "deep/e.csv"]
    assert measured_files(folder) == [r.file for r in results]


def test_a_refused_file_tells_why_and_stops_nothing(results: list[FolderFit]) -> None:
    assert [bool(r.fit) for r in results] == [True, False, True, True, True]
    assert "b.csv" in results[1].reason
    assert "\n" not in results[1].reason
    assert all(r.reason == "" for r in results if r.fit)


def test_threads_give_the_same_bits_as_one_worker(folder: Path, results: list[FolderFit]) -> None:
    for alone, shared in zip(results, fit_files(measured_files(folder), workers=4), strict=True):
        assert alone.file == shared.file
        assert (alone.fit is None) == (shared.fit is None)
        if alone.fit and shared.fit:
            # equality of models is of every number, exactly
            assert alone.fit.model == shared.fit.model
            assert [f.rmse_cN for f in alone.fit.fits] == [f.rmse_cN for f in shared.fit.fits]


def test_a_file_gives_in_a_folder_what_it_gives_alone(results: list[FolderFit]) -> None:
    fit = results[0].fit
    assert fit is not None
    assert fit.model == fit_file(results[0].file).model


def test_settings_reach_every_file(folder: Path) -> None:
    for result in fit_files(measured_files(folder), FitSettings(control_points=9)):
        if result.fit:
            assert {c.control_points_cN.size for c in result.fit.model.curves} == {9}


def test_a_summary_is_of_the_figures_it_sums_up(results: list[FolderFit]) -> None:
    summary = summarise(results)
    assert (summary["files"], summary["refused"]) == (5, 1)
    fits = [f for r in results if r.fit for f in r.fit.fits]
    for stroke in Stroke:
        errors = sorted(f.rmse_cN for f in fits if f.curve.stroke is stroke)
        assert summary["strokes"][stroke]["rmse_cN"] == pytest.approx(
            {"median": (errors[1] + errors[2]) / 2, "p90": errors[2] + 0.7 * (errors[3] - errors[2])}
        )
    kept = [f.bump_kept_ratio for f in fits if f.bump_kept_ratio is not None]
    assert (summary["bumps"], summary["bumps_kept"]) == (len(kept), int(np.sum(np.array(kept) >= 0.95)))


def test_a_summary_of_refusals_only_has_no_figures(folder: Path) -> None:
    summary = summarise([FolderFit(folder / "b.csv", None, "no curve")])
    assert summary == {"files": 1, "refused": 1, "bumps": 0, "bumps_kept": 0, "strokes": {}}


def test_a_folder_without_measurements_is_refused(tmp_path: Path) -> None:
    save_model(load_builtin("mx-red"), tmp_path / f"fitted{MODEL_SUFFIX}")
    with pytest.raises(InputError, match="of measurements in it"):
        measured_files(tmp_path)
    with pytest.raises(InputError, match="no such folder"):
        measured_files(tmp_path / "gone")
