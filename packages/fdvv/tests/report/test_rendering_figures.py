from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

from fdvv.errors import ModelError
from fdvv.model.curve import Stroke
from fdvv.rendering.figures import PAPER_ERROR_cN, plot_convergence, plot_rendering
from fdvv.report.records import ErrorHistory, RenderedBand, RenderedCurve
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
