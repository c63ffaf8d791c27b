from typing import Any

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

from fdvv.button.figures import plot_fit, plot_scan
from fdvv.errors import ModelError
from fdvv.model.curve import MeasuredCurve
from fdvv.model.fit import CurveFit, fit_curve


def marked(ax: Any, marker: str) -> list[Any]:
    return [line for line in ax.get_lines() if line.get_marker() == marker]


def test_the_raw_samples_are_drawn_one_by_one(measured: MeasuredCurve, fits: list[CurveFit]) -> None:
    top, _ = plot_fit(measured, fits)
    (raw,) = marked(top, ".")
    assert_array_equal(raw.get_xdata(), measured.displacement_mm)
    assert_array_equal(raw.get_ydata(), measured.force_cN)


def test_control_points_and_knots_stand_where_the_fit_has_them(
    measured: MeasuredCurve, fits: list[CurveFit]
) -> None:
    top, _ = plot_fit(measured, fits)
    for points, ticks, fit in zip(marked(top, "o"), marked(top, "|"), fits, strict=True):
        assert_array_equal(points.get_xdata(), fit.curve.control_points_mm)
        assert_array_equal(points.get_ydata(), fit.curve.control_points_cN)
        assert_array_equal(ticks.get_xdata(), np.unique(fit.curve.knots_mm))


def test_the_residual_panel_shows_fit_minus_raw(measured: MeasuredCurve, fits: list[CurveFit]) -> None:
    _, residual = plot_fit(measured, fits)
    drawn = residual.get_lines()[1:]
    for line, fit in zip(drawn, fits, strict=True):
        error = np.asarray(line.get_ydata(), dtype=float)
        assert np.sqrt(np.mean(error**2)) == pytest.approx(fit.rmse_cN, rel=1e-12)
        assert np.abs(error).max() == pytest.approx(fit.max_cN, rel=1e-12)


def test_the_legend_tells_method_size_and_error(measured: MeasuredCurve, fits: list[CurveFit]) -> None:
    top, _ = plot_fit(measured, fits, title="raw switch")
    legend = top.get_legend()
    assert legend is not None
    entries = [text.get_text() for text in legend.get_texts()]
    assert entries[1] == f"uniform, 15 control points, RMSE {fits[0].rmse_cN:.2f} cN"
    assert entries[2].startswith("adaptive, 12 control points, RMSE ")
    assert top.get_title(loc="left") == "raw switch"


def test_a_method_keeps_its_colour_from_figure_to_figure(
    measured: MeasuredCurve, fits: list[CurveFit], scores: dict[str, dict[int, float]]
) -> None:
    both = [line.get_color() for line in marked(plot_fit(measured, fits)[0], "o")]
    (alone,) = (line.get_color() for line in marked(plot_fit(measured, fits[1:])[0], "o"))
    assert both[1] == alone
    scan = plot_scan(scores)
    assert [line.get_color() for line in marked(scan, ".")] == both


def test_three_fits_of_one_method_have_three_colours(measured: MeasuredCurve) -> None:
    fits = [fit_curve(measured, "uniform", size) for size in (8, 12, 15)]
    assert len({line.get_color() for line in marked(plot_fit(measured, fits)[0], "o")}) == 3


def test_a_figure_without_a_fit_is_refused(measured: MeasuredCurve) -> None:
    with pytest.raises(ModelError, match="at least one fit"):
        plot_fit(measured, [])


def test_a_scan_draws_its_scores_by_size_and_rings_the_least() -> None:
    ax = plot_scan({"uniform": {7: 30.0, 5: 40.0, 6: 20.0}, "adaptive": {}})
    drawn: Any = ax.get_lines()
    line, ring = drawn
    assert_allclose(line.get_xydata(), [[5, 40.0], [6, 20.0], [7, 30.0]])
    assert_allclose(ring.get_xydata(), [[6, 20.0]])
    assert line.get_label() == "uniform, least at 6"


def test_a_scan_without_scores_is_refused() -> None:
    with pytest.raises(ModelError, match="at least one score"):
        plot_scan({"uniform": {}})
