"""What fits reach on 48 real switches."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from fdvv.button.fit import FitSettings, FolderFit, fit_files, measured_files, summarise
from fdvv.model.bump_kept import BUMP_KEPT_ratio
from fdvv.model.fit import FitMethod, fit_curve

pytestmark = pytest.mark.shared

PRESS_MEDIAN_cN, PRESS_P90_cN, RELEASE_P90_cN = 0.15, 0.35, 0.35
RELEASE_MEDIAN_cN = (0.145, 0.155)
"""The aim for the release is 0.15 cN; 0.151 is what 15 control points reach (docs/explanation/fitting.md:
the rest is texture of the raw curves). Both ends are bounds, so that a change of either kind is noticed."""


@pytest.fixture(scope="module")
def results(shared_data: Path) -> list[FolderFit]:
    return list(fit_files(measured_files(shared_data / "tg-tidy"), FitSettings(control_points=15)))


def test_every_switch_can_be_fitted(results: list[FolderFit]) -> None:
    assert [r.reason for r in results if not r.fit] == []
    assert len(results) == 48


def test_fifteen_control_points_come_close_to_the_raw_curves(results: list[FolderFit]) -> None:
    sizes = {f.curve.control_points_cN.size for r in results if r.fit for f in r.fit.fits}
    assert sizes == {15}
    found = {stroke: figures["rmse_cN"] for stroke, figures in summarise(results)["strokes"].items()}
    assert found["press"]["median"] <= PRESS_MEDIAN_cN
    assert found["press"]["p90"] <= PRESS_P90_cN
    assert found["release"]["p90"] <= RELEASE_P90_cN
    assert RELEASE_MEDIAN_cN[0] < found["release"]["median"] < RELEASE_MEDIAN_cN[1]


def test_every_bump_is_kept(results: list[FolderFit]) -> None:
    summary = summarise(results)
    assert summary["bumps"] >= 20
    assert summary["bumps_kept"] == summary["bumps"]


def sampled_ratios(results: list[FolderFit]) -> list[float]:
    fits = [fit for result in results if result.fit for fit in result.fit.fits]
    return [f.bump_kept_samples_ratio for f in fits if f.bump_kept_samples_ratio is not None]


def test_auto_comes_closer_keeps_every_bump_and_pulls_nowhere(
    shared_data: Path, results: list[FolderFit]
) -> None:
    by_fifteen = sampled_ratios(results)
    results = list(fit_files(measured_files(shared_data / "tg-tidy")))
    summary = summarise(results)
    for of_stroke in summary["strokes"].values():
        assert of_stroke["rmse_cN"]["median"] <= 0.12
        assert of_stroke["rmse_cN"]["p90"] <= 0.20
    assert summary["strokes"]["press"]["rmse_cN"]["median"] <= 0.10
    fits = [(f, m) for r in results if r.fit for f, m in zip(r.fit.fits, r.fit.measured, strict=True)]
    assert len(by_fifteen) > 20
    assert min(by_fifteen) < BUMP_KEPT_ratio
    assert min(sampled_ratios(results)) >= BUMP_KEPT_ratio
    for fit, measured in fits:
        x = np.linspace(fit.curve.start_mm, fit.curve.end_mm, 4000)
        assert fit.curve.force_cN(x).min() >= min(-0.5, measured.force_cN.min() - 0.5)


def test_uniform_knots_on_the_same_samples_are_ten_times_farther_off(results: list[FolderFit]) -> None:
    presses = [m for r in results if r.fit for m in r.fit.measured if m.stroke == "press"]
    uniform = np.median([fit_curve(m, FitMethod.UNIFORM, 15).rmse_cN for m in presses])
    assert uniform > 1.0
    assert uniform > 8 * summarise(results)["strokes"]["press"]["rmse_cN"]["median"]
