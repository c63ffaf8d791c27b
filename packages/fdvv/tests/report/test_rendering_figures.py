from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

from fdvv.errors import ModelError
from fdvv.model.curve import Stroke
from fdvv.rendering.figures import PAPER_ERROR_cN, plot_convergence, plot_feasibility, plot_rendering
from fdvv.report.records import ErrorHistory, FeasibleCurve, RenderedBand, RenderedCurve
from fdvv.report.svg import figure_of, figure_svg


def test_the_grid_has_velocities_down_and_strokes_across(rendered: list[RenderedCurve]) -> None:
    axes = plot_rendering(rendered)
    titles = [[ax.get_title(loc="left") for ax in row] for row in axes]
    assert titles == [["press, 50 mm/s", "release, 50 mm/s"], ["press, 200 mm/s", "release, 200 mm/s"]]


def test_a_cell_draws_the_means_the_target_and_the_spread(rendered: list[RenderedCurve]) -> None:
    curves = rendered
    ax = plot_rendering(curves)[1, 0]
    curve = next(c for c in curves if c.stroke is Stroke.PRESS and c.velocity_mm_s == 200.0)
    drawn = [line.get_ydata() for line in ax.get_lines()]
    for got, wanted in zip(drawn, [*(b.mean_cN for b in curve.bands), curve.target_cN], strict=True):
        assert_array_equal(got, wanted)
    for band, record in zip(ax.collections, curve.bands, strict=True):
        force = band.get_paths()[0].vertices[:, 1]
        assert force.min() == pytest.approx(record.low_cN.min())
        assert force.max() == pytest.approx(record.high_cN.max())


def test_the_legend_of_the_grid_names_target_and_methods_once(rendered: list[RenderedCurve]) -> None:
    (legend,) = figure_of(plot_rendering(rendered)).legends
    assert [text.get_text() for text in legend.get_texts()] == ["target", "FD only", "FDVV"]


def test_only_the_simulated_cells_say_simulated(rendered: list[RenderedCurve]) -> None:
    curves = [*rendered[:1], *(replace(c, simulated=True) for c in rendered[1:2])]
    axes = plot_rendering(curves)
    assert [ax.get_title(loc="right") for ax in axes[:, 0]] == ["simulated", ""]


def test_a_cell_without_a_curve_stays_blank(rendered: list[RenderedCurve]) -> None:
    axes = plot_rendering(rendered[:3])
    assert [[ax.get_visible() for ax in row] for row in axes] == [[True, False], [True, True]]


def test_a_grid_of_nothing_or_of_two_for_one_cell_is_refused(rendered: list[RenderedCurve]) -> None:
    with pytest.raises(ModelError, match="one curve per velocity and stroke"):
        plot_rendering([])
    with pytest.raises(ModelError, match="got 2 for 1"):
        plot_rendering(rendered[:1] * 2)


def test_displacements_that_no_press_reached_leave_a_gap() -> None:
    x = np.linspace(0.0, 4.0, 5)
    gap = np.array([1.0, 2.0, np.nan, 4.0, 5.0])
    curve = RenderedCurve(Stroke.PRESS, 50.0, x, x, (RenderedBand("FDVV", gap, gap - 1, gap + 1),))
    axes = plot_rendering([curve])
    assert np.isnan(axes[0, 0].get_lines()[0].get_ydata()[2])
    figure_svg(axes)


@pytest.mark.parametrize(
    ("x", "target", "mean", "message"),
    [
        ([0.0, 1.0], [1.0], [1.0, 2.0], "target_cN must match"),
        ([0.0, 1.0], [1.0, 2.0], [1.0], "FD mean_cN must match"),
        ([1.0, 0.0], [1.0, 2.0], [1.0, 2.0], "strictly rising"),
        ([1.0], [1.0], [1.0], "strictly rising"),
    ],
)
def test_a_rendered_curve_checks_its_columns(
    x: list[float], target: list[float], mean: list[float], message: str
) -> None:
    column = np.array(mean)
    band = RenderedBand("FD", column, column, column)
    with pytest.raises(ModelError, match=message):
        RenderedCurve(Stroke.PRESS, 50.0, np.array(x), np.array(target), (band,))


def curves_of(ax: Any) -> list[Any]:
    return [line for line in ax.get_lines() if line.get_marker() == "."]


def test_convergence_draws_each_error_at_its_press(histories: list[ErrorHistory]) -> None:
    ax = plot_convergence(histories)
    assert ax.get_yscale() == "log"
    for line, history in zip(curves_of(ax), histories, strict=True):
        assert_array_equal(line.get_xdata(), [1, 2, 3, 4])
        assert_allclose(line.get_ydata(), history.error_cN)
        assert line.get_linestyle() == ("-" if history.stroke is Stroke.PRESS else "--")


def test_the_papers_error_is_drawn_only_if_asked_for_and_is_named(
    gallery: Any, histories: list[ErrorHistory]
) -> None:
    assert len(plot_convergence(histories).get_lines()) == 4
    ax = plot_convergence(histories, paper=True)
    assert ax.get_lines()[-1].get_ydata() == [PAPER_ERROR_cN] * 2
    assert "2.93 cN, the paper's rig" in gallery.texts(ax)


def test_simulated_is_read_from_the_histories(gallery: Any, histories: list[ErrorHistory]) -> None:
    assert (
        "simulated"
        in gallery.texts(plot_convergence([replace(h, simulated=True) for h in histories])).splitlines()
    )


def test_an_error_of_zero_leaves_a_gap_on_the_logarithmic_axis() -> None:
    ax = plot_convergence([ErrorHistory(Stroke.PRESS, 50.0, np.array([2.0, 0.0, np.nan, 1.0]))])
    assert_allclose(curves_of(ax)[0].get_ydata(), [2.0, np.nan, np.nan, 1.0])
    figure_svg(ax)


def test_a_history_of_a_single_press_is_drawn() -> None:
    figure_svg(plot_convergence([ErrorHistory(Stroke.PRESS, 50.0, np.array([2.0]))]))


def test_a_history_needs_a_press_and_a_figure_a_history() -> None:
    with pytest.raises(ModelError, match="one column"):
        ErrorHistory(Stroke.PRESS, 50.0, np.array([]))
    with pytest.raises(ModelError, match="at least one history"):
        plot_convergence([])


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


def test_the_grid_of_feasibility_names_strokes_speeds_and_what_is_simulated() -> None:
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


def test_feasibility_of_nothing_or_of_two_for_one_cell_is_refused() -> None:
    for curves in ([], [CURVE, CURVE]):
        with pytest.raises(ModelError, match="one curve per velocity and stroke"):
            plot_feasibility(curves)


def test_columns_that_do_not_match_are_refused() -> None:
    with pytest.raises(ModelError, match="achievable_cN must match"):
        replace(CURVE, achievable_cN=np.zeros(3))
    with pytest.raises(ModelError, match="needs its places"):
        replace(CURVE, band=BAND)
