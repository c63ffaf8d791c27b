"""Noise and shape are parted by how successive samples differ."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from fdvv.button.fit import measured_parts
from fdvv.formats.force.read import read_force_file
from fdvv.model.fit import fit_curve
from fdvv.model.residual import holds_shape, noise_cN

X = np.linspace(0, 4, 801)
NOISE = np.random.default_rng(0).normal(0, 0.1, X.size)


def test_noise_is_estimated_beside_a_curve_and_its_steps() -> None:
    assert abs(noise_cN(30 + 10 * X + 20.0 * (X > 2) + NOISE) - 0.1) < 0.01
    assert noise_cN(np.array([1.0, 9.0])) == 0.0


def test_white_residuals_hold_no_shape_and_waves_do() -> None:
    curve = 30 + 10 * X
    assert not holds_shape(curve + NOISE, curve)
    assert holds_shape(curve + NOISE + 0.5 * np.sin(20 * X), curve)
    # alike, but no louder than the noise
    assert not holds_shape(curve + NOISE + 0.05 * np.sin(20 * X), curve)


@pytest.mark.shared
def test_auto_takes_more_points_of_a_real_curve_where_bic_star_leaves_shape(shared_data: Path) -> None:
    """BIC* alone asks for 27, whose error is 0.218 cN."""
    press = measured_parts(read_force_file(shared_data / "haata" / "Cherry MX Clear.csv")).strokes[0]
    fit, papers = fit_curve(press), fit_curve(press, control_points=15)
    assert fit.curve.control_points_cN.size > 30
    assert fit.rmse_cN < 0.17
    assert fit.bic_star <= papers.bic_star
