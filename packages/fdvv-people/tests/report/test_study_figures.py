from __future__ import annotations

import numpy as np
import pytest
from numpy.testing import assert_allclose

from fdvv.errors import ModelError
from fdvv.model.file import load_builtin
from fdvv.report.svg import figure_of
from fdvv.units import FloatArray
from fdvv_people.optimize.run.report import DesignPanel, plot_designs
from fdvv_people.report.score_figures import ScoreBars, TrainingScores, plot_score_bars, plot_training
from tests.support.gallery import FigureRules, Gallery

MODEL = load_builtin("mx-clear")
NAMES = ("optimal", "clear", "random")


def bars(level: str, scores: FloatArray, marks: tuple[str, ...] = ()) -> ScoreBars:
    return ScoreBars(level, NAMES, scores, scores.std(axis=0, ddof=1), marks)


def scores(shape: tuple[int, int] = (10, 3)) -> FloatArray:
    return np.random.default_rng(1).normal(80.0, 9.0, shape)


def test_bars_are_the_means_and_every_person_is_a_dot() -> None:
    found = scores()
    (ax,) = plot_score_bars([bars("easy", found)], "asynchrony (ms)")
    assert_allclose([bar.get_height() for bar in ax.patches], found.mean(axis=0))
    dots = [line.get_ydata() for line in ax.get_lines() if line.get_marker() == "."]
    assert_allclose(dots, found.T)


def test_levels_share_one_scale_that_begins_at_zero() -> None:
    easy, hard = plot_score_bars([bars("easy", scores()), bars("hard", 2 * scores())], "asynchrony (ms)")
    assert easy.get_ylim() == hard.get_ylim()
    assert easy.get_ylim()[0] == 0.0
    assert easy.get_ylim()[1] > 2 * scores().max()


def test_marks_and_means_are_written_above_the_bars() -> None:
    (ax,) = plot_score_bars([bars("easy", scores(), ("", "*", "***"))], "asynchrony (ms)")
    labels = [text.get_text() for text in ax.texts]
    assert [text.partition("\n")[2] for text in labels] == ["", "*", "***"]
    assert labels[0] == f"{scores()[:, 0].mean():.1f}"


def test_bars_of_other_counts_than_their_names_and_figures_of_nothing_are_refused() -> None:
    with pytest.raises(ModelError, match="3 conditions need columns"):
        bars("easy", scores((10, 4)))
    with pytest.raises(ModelError, match="as many marks"):
        bars("easy", scores(), ("*",))
    with pytest.raises(ModelError, match="at least one level"):
        plot_score_bars([], "asynchrony (ms)")
    with pytest.raises(ModelError, match="at least one"):
        plot_designs([])


def test_the_best_so_far_never_rises_and_passes_over_a_trial_without_a_score() -> None:
    found = np.array([[9.0, 7, np.nan, 8, 5], [8, 9, 6, 7, 7]])
    (ax,) = plot_training([TrainingScores("easy", found)], "asynchrony (ms)")
    best = next(line for line in ax.get_lines() if str(line.get_label()).startswith("best so far"))
    assert_allclose(best.get_ydata(), [8.5, 7.5, 6.5, 6.5, 5.5])


def test_designs_show_their_points_and_marks_in_a_grid() -> None:
    points = np.array([[0.5, 40.0], [2.0, 60.0], [3.5, 50.0]])
    axes = plot_designs([DesignPanel(f"person {i}", MODEL, points) for i in range(3)])
    assert [[ax.get_visible() for ax in row] for row in axes] == [[True, True], [True, False]]
    drawn = next(line for line in axes[0, 0].get_lines() if line.get_marker() == "o")
    assert_allclose(np.column_stack([drawn.get_xdata(), drawn.get_ydata()]), points)
    (legend,) = figure_of(axes).legends
    assert [text.get_text() for text in legend.get_texts()] == [
        "force of the press", "control point", "activation", "vibration"
    ]  # fmt: skip


def test_of_one_person_failed_trials_leave_gaps_and_no_median_is_drawn() -> None:
    found = np.array([[np.nan, 9.0, np.nan, 7, 8]])
    (ax,) = plot_training([TrainingScores("easy", found)], "asynchrony (ms)")
    labels = ax.get_legend_handles_labels()[1]
    assert labels == ["a person's trial", "best so far"]
    best = next(line for line in ax.get_lines() if line.get_label() == "best so far")
    assert_allclose([best.get_xdata(), best.get_ydata()], [[2, 3, 4, 5], [9, 9, 7, 7]])


def test_a_score_beyond_the_scale_is_marked_at_its_edge() -> None:
    found = scores((10, 3))
    found[0, 2] = 900.0
    panel = ScoreBars("easy", NAMES, found, np.array([5.0, 5, 5]))
    (ax,) = plot_score_bars([panel], "asynchrony (ms)")
    (mark,) = [line for line in ax.get_lines() if line.get_marker() == "^"]
    assert_allclose([mark.get_xdata(), mark.get_ydata()], [[2], [ax.get_ylim()[1]]])
    assert ax.get_ylim()[1] < 900.0


@pytest.fixture(scope="module")
def gallery() -> Gallery:
    panels = [DesignPanel(f"person {i}", MODEL) for i in range(3)]
    levels = [bars(level, scores(), ("", "*", "***")) for level in ("easy", "hard")]
    trainings = [TrainingScores(level, scores((4, 9))) for level in ("easy", "hard")]
    return Gallery(
        {
            "score bars": lambda said: plot_score_bars(levels, "score (ms)", simulated=said),
            "training": lambda said: plot_training(trainings, "score (ms)", simulated=said),
            "designs": lambda said: plot_designs(panels, simulated=said),
        }
    )


@pytest.fixture(params=["score bars", "training", "designs"])
def name(request: pytest.FixtureRequest) -> str:
    return str(request.param)


class TestEveryFigureOfPeople(FigureRules):
    """The figures of scores and designs."""
