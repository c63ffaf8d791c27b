from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from matplotlib.container import ErrorbarContainer
from numpy.testing import assert_allclose

from fdvv.errors import ModelError
from fdvv.report.svg import figure_of
from fdvv.units import FloatArray
from fdvv_people.stats.effect_size import Estimate
from fdvv_people.stats.share import share, sign_test
from fdvv_people.study.analysis.answer_figures import ForestRow, plot_choices, plot_forest, plot_rating_bars
from fdvv_people.study.analysis.figures import plot_tracks
from fdvv_people.study.analysis.records import ChoiceResult, ThresholdResult

PROXY = "simulated participants: a proxy, no evidence"


MARKS = {"Clear": "***", "Red": "n.s."}


def ratings(people: int = 5) -> FloatArray:
    return np.random.default_rng(1).uniform(2, 6, (people, 2, 2))


def bars(people: FloatArray, marks: dict[str, str], simulated: bool = False) -> Any:
    names = ("Clear", "Red"), ("FD", "FDVV")
    return plot_rating_bars("realism", people, *names, (1.0, 7.0), marks, simulated)


def above(drawn: Any) -> str:
    """Return the title of a whole figure."""
    return str(figure_of(drawn).get_suptitle())


def choice(
    button: str, less: int, equal: int, more: int, names: tuple[str, str] = ("FD", "FDVV")
) -> ChoiceResult:
    n = less + equal + more
    counts = (names[1], names[0], more, equal, less, 0)
    return ChoiceResult(button, *counts, share(more, n), None, more / n, None, None, sign_test([]), None, ())


def track(person: str, ratios: list[float], correct: list[float], threshold: float) -> ThresholdResult:
    return ThresholdResult(person, "Red", np.array(ratios), np.array(correct), Estimate(threshold))


def test_rating_bars_reach_the_means_from_the_low_end_of_the_scale() -> None:
    given = ratings()
    ax = bars(given, MARKS)
    tops = [bar.get_y() + bar.get_height() for bar in ax.patches]
    assert_allclose(sorted(tops), np.sort(given.mean(axis=0).ravel()))
    assert {bar.get_y() for bar in ax.patches} == {1.0}
    assert [text.get_text() for text in ax.texts] == ["***", "n.s."]


def test_one_person_has_a_bar_and_no_spread() -> None:
    ax = bars(ratings(1), {})
    assert len(ax.patches) == 4
    spreads = [one for one in ax.containers if isinstance(one, ErrorbarContainer)]
    drawn = [segment for one in spreads for segment in one[2][0].get_segments() if len(segment)]
    assert not any(np.isfinite(segment).all() for segment in drawn)


def test_choices_are_parts_of_a_whole_and_the_share_lies_where_its_bar_ends() -> None:
    ax = plot_choices([choice("", 20, 20, 60), choice("Red", 0, 0, 5)])
    widths = np.array([bar.get_width() for bar in ax.patches]).reshape(3, 2)
    assert_allclose(widths.sum(axis=0), 1.0)
    assert_allclose(widths[0], [0.6, 1.0])
    marks = [line.get_xdata()[0] for line in ax.get_lines() if line.get_marker() == "D"]
    assert_allclose(marks, [0.6, 1.0])


def test_without_ties_nothing_is_called_equal() -> None:
    ax = plot_choices([choice("", 4, 0, 6, ("wrong", "right"))])
    texts = [text.get_text() for text in figure_of(ax).legends[0].get_texts()]
    assert "equal" not in texts
    assert {"right", "wrong"} <= set(texts)


def test_a_bound_without_end_is_an_arrow_and_a_value_that_is_none_says_so() -> None:
    rows = [
        ForestRow("P1", 1.0, 0.2, np.inf),
        ForestRow("P2", np.nan, np.nan, np.nan),
        ForestRow("P3", np.inf, 1.0, np.inf),
    ]
    ax = plot_forest(rows, "d′", "distance")
    assert sum(line.get_marker() == ">" for line in ax.get_lines()) == 2
    assert [text.get_text() for text in ax.texts] == ["no value"]


def test_staircases_have_a_panel_each_and_a_line_where_a_threshold_is() -> None:
    ratios, correct = [0.3, 0.3, 0.19], [1.0, 1.0, 0.0]
    tracks = [track("P1", ratios, correct, 0.2), track("P2", ratios, correct, np.nan)]
    axes = plot_tracks(tracks).ravel()
    dashed = [sum(line.get_linestyle() == "--" for line in ax.get_lines()) for ax in axes]
    assert dashed == [1, 0]


def test_every_figure_of_simulated_answers_says_that_they_are_no_evidence() -> None:
    drawn = [
        bars(ratings(), MARKS, True),
        plot_choices([choice("", 4, 1, 5)], True),
        plot_forest([ForestRow("P1", 1.0, 0.2, 2.0)], "d′", "distance", simulated=True),
        plot_tracks([track("P1", [0.3, 0.2], [1.0, 1.0], 0.2)], True),
    ]
    assert [above(one) for one in drawn] == [PROXY] * 4
    assert above(bars(ratings(), MARKS)) == ""


def test_what_does_not_fit_together_is_refused() -> None:
    with pytest.raises(ModelError, match="columns of as many"):
        bars(ratings()[:, :, :1], MARKS)
    with pytest.raises(ModelError, match="at least one row"):
        plot_choices([])
    with pytest.raises(ModelError, match="at least one row"):
        plot_forest([], "d′", "distance")
    with pytest.raises(ModelError, match="at least one"):
        plot_tracks([])
