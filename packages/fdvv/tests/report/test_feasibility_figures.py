from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_array_equal

from fdvv.errors import ModelError
from fdvv.model.curve import Stroke
from fdvv.rendering.figures import plot_feasibility
from fdvv.report.records import FeasibleCurve, RenderedBand
from fdvv.report.svg import figure_of

X_mm = np.linspace(0.0, 4.0, 81)
CURVE = FeasibleCurve(
    Stroke.PRESS, 50.0, X_mm, 40 + X_mm, 39 + X_mm, (X_mm > 1.0) & (X_mm < 1.5), "follows in part: why not"
)
BAND_mm = np.linspace(0.3, 3.9, 10)
BAND = RenderedBand("measured", 41 + BAND_mm, 40 + BAND_mm, 43 + BAND_mm)
MEASURED = replace(CURVE, velocity_mm_s=200.0, band_mm=BAND_mm, band=BAND, simulated=True)


def test_a_cell_draws_what_was_measured_achievable_and_intended() -> None:
    ax = plot_feasibility([CURVE, MEASURED])[1, 0]
    drawn = [line.get_ydata() for line in ax.get_lines()]
    for got, wanted in zip(drawn, (BAND.mean_cN, CURVE.achievable_cN, CURVE.intended_cN), strict=True):
        assert_array_equal(got, wanted)


def test_the_grid_names_strokes_speeds_and_what_is_simulated() -> None:
    axes = plot_feasibility([MEASURED, CURVE, replace(CURVE, stroke=Stroke.RELEASE)])
    assert [ax.get_title(loc="left") for ax in axes[:, 0]] == ["press, 50 mm/s", "press, 200 mm/s"]
    assert [ax.get_title(loc="right") for ax in axes[:, 0]] == ["", "simulated"]
    assert [ax.get_visible() for ax in axes[:, 1]] == [True, False]


def test_the_verdict_stands_above_the_curve_and_a_long_one_is_cut() -> None:
    text = plot_feasibility([replace(CURVE, verdict="word " * 200)])[0, 0].texts[0].get_text()
    assert text.count("\n") == 2
    assert text.endswith("…")
    assert plot_feasibility([CURVE])[0, 0].texts[0].get_text() == CURVE.verdict


def test_the_legend_names_only_what_is_drawn() -> None:
    def names(*curves: FeasibleCurve) -> list[str]:
        (legend,) = figure_of(plot_feasibility(curves)).legends
        return [text.get_text() for text in legend.get_texts()]

    plain = replace(CURVE, cut=np.zeros(81, dtype=bool))
    assert names(plain) == ["intended", "achievable"]
    assert names(CURVE, MEASURED) == ["intended", "achievable", "measured", "a limit cuts"]


def test_the_cut_range_is_shaded_where_it_is() -> None:
    (shade,) = plot_feasibility([CURVE])[0, 0].collections
    places = shade.get_paths()[0].vertices[:, 0]
    assert (places.min(), places.max()) == pytest.approx((1.05, 1.45))


def test_a_grid_of_nothing_or_of_two_for_one_cell_is_refused() -> None:
    for curves in ([], [CURVE, CURVE]):
        with pytest.raises(ModelError, match="one curve per velocity and stroke"):
            plot_feasibility(curves)


def test_columns_that_do_not_match_are_refused() -> None:
    with pytest.raises(ModelError, match="achievable_cN must match"):
        replace(CURVE, achievable_cN=np.zeros(3))
    with pytest.raises(ModelError, match="needs its places"):
        replace(CURVE, band=BAND)
