"""The paper's recipe: what its filters leave of a bump, by the unit that their sigma is given."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from fdvv.errors import ModelError
from fdvv.model.bump import find_bump
from fdvv.model.curve import Stroke
from fdvv.preprocess.paper import (
    AS_PRINTED,
    EVEN_WIDTH,
    Gaussian,
    PaperRecipe,
    SigmaUnit,
    gaussian_smooth,
    paper_average,
    register,
)
from fdvv.preprocess.press import RawPress, Spans
from fdvv.preprocess.reject import Judged
from fdvv.units import FloatArray
from tests.support.captures import SHORT_STROKE, capture, recorded

NO_FILTER = PaperRecipe(Gaussian(0.0, SigmaUnit.SAMPLES), Gaussian(0.0, SigmaUnit.SAMPLES))


def drop_cN(x_mm: FloatArray, force_cN: FloatArray) -> float:
    found = find_bump(x_mm, force_cN, least_drop_cN=0.0)
    return 0.0 if found is None else found.drop_cN


@pytest.mark.shared
@pytest.mark.parametrize(
    ("sigma", "unit", "left_cN"),
    [
        (0.0, "samples", 18.8),
        (1.2, "samples", 17.8),
        (0.2, "mm", 11.1),
        (0.4, "mm", 2.0),
        (0.8, "mm", 0.0),
        (1.2, "mm", 0.0),
    ],
)
def test_a_real_clear_keeps_its_bump_or_loses_it_by_the_unit_of_sigma(
    shared_data: Path, sigma: float, unit: str, left_cN: float
) -> None:
    table = np.genfromtxt(shared_data / "cherry_down_up_cN.csv", delimiter=",", skip_header=1, names=True)
    x_mm, force_cN = table["x_mm"], table["Clear_stock_down_down"]
    whole = np.isfinite(force_cN) & (x_mm < 3.9)
    wide_mm = Gaussian(sigma, SigmaUnit(unit)).in_way_mm(0.05, 1.0)
    kept = gaussian_smooth(force_cN[whole], wide_mm / 0.05)
    assert drop_cN(x_mm[whole], kept) == pytest.approx(left_cN, abs=0.1)


@pytest.mark.parametrize("pace", [50.0, 150.0])
def test_the_printed_widths_erase_the_bump_of_presses(pace: float) -> None:
    found = recorded().processed
    printed = paper_average(found.judged, Stroke.PRESS, pace, AS_PRINTED, found.zero_mm)
    counted = paper_average(found.judged, Stroke.PRESS, pace, PaperRecipe(), found.zero_mm)
    assert drop_cN(printed.displacement_mm, printed.force_cN) < 0.5
    assert drop_cN(counted.displacement_mm, counted.force_cN) > 5.0


def test_the_method_keeps_more_of_a_fast_bump_than_the_recipe_does() -> None:
    found = recorded().processed
    (own,) = [c for c in found.curves if c.stroke is Stroke.PRESS and c.velocity_mm_s == 150.0]
    theirs = paper_average(found.judged, Stroke.PRESS, 150.0, PaperRecipe(), found.zero_mm)
    assert drop_cN(own.displacement_mm, own.force_cN) > 1.3 * drop_cN(theirs.displacement_mm, theirs.force_cN)


def even_press(speed_mm_s: float, force: float, take: int = 1) -> Judged:
    """A press and release at one speed with a force of 10 cN per mm, times force; a pause at the bottom."""
    t_s = np.arange(0.0, 8.4 / speed_mm_s + 0.3, 1e-3)
    way_s = 4.0 / speed_mm_s
    path_mm = np.interp(t_s, [0.1, 0.1 + way_s, 0.2 + way_s, 0.2 + 2 * way_s], [0.0, 4.0, 4.0, 0.0])
    frame_s, frame_mm = t_s[::4], path_mm[::4]
    apart_mm = np.full(frame_s.size, np.nan)
    press = RawPress(take, 1, speed_mm_s, t_s, force * 10 * path_mm, frame_s, frame_mm, apart_mm)
    spans = Spans(0.1, 0.1 + way_s, 0.2 + way_s, 0.2 + 2 * way_s, 4.0)
    return Judged(press, spans, speed_mm_s)


@pytest.mark.parametrize("stroke", list(Stroke))
def test_without_filters_a_straight_line_comes_back(stroke: Stroke) -> None:
    curve = paper_average([even_press(40.0, 1.0)] * 2, stroke, 40.0, NO_FILTER)
    inner = (curve.displacement_mm > 0.1) & (curve.displacement_mm < 3.85)
    np.testing.assert_allclose(curve.force_cN[inner], 10 * curve.displacement_mm[inner], atol=1e-6)
    np.testing.assert_allclose(np.diff(curve.displacement_mm), 0.05)
    assert curve.presses == 2
    assert curve.width_mm == 0.0


def test_the_mean_and_spread_are_those_of_the_presses() -> None:
    curve = paper_average(
        [even_press(40.0, f, i) for i, f in enumerate((0.9, 1.0, 1.1), 1)], Stroke.PRESS, 40.0, NO_FILTER
    )
    at = 40
    assert curve.displacement_mm[at] == pytest.approx(2.0)
    assert curve.force_cN[at] == pytest.approx(20.0, abs=1e-6)
    assert curve.spread_cN[at] == pytest.approx(2.0, abs=1e-6)
    assert (curve.achieved_mm_s, curve.achieved_spread_mm_s) == (40.0, 0.0)


def test_displacement_is_moved_by_the_zero() -> None:
    moved = paper_average([even_press(40.0, 1.0)], Stroke.PRESS, 40.0, NO_FILTER, zero_mm=0.5)
    at = int(np.argmin(np.abs(moved.displacement_mm - 2.5)))
    assert moved.force_cN[at] == pytest.approx(20.0, abs=1e-6)


@pytest.mark.parametrize(
    ("unit", "time_s", "way_mm"), [("samples", 2e-3, 0.1), ("ms", 2e-3, 0.1), ("mm", 0.04, 2.0)]
)
def test_a_sigma_of_two_is_as_wide_as_its_unit_says(unit: str, time_s: float, way_mm: float) -> None:
    two = Gaussian(2.0, SigmaUnit(unit))
    assert two.in_time_s(1e-3, 50.0) == pytest.approx(time_s)
    assert two.in_way_mm(0.05, 50.0) == pytest.approx(way_mm)


def test_a_filter_has_the_sigma_that_it_is_given() -> None:
    spike = np.zeros(401)
    spike[200] = 1.0
    spread = gaussian_smooth(spike, 12.0)
    place = np.arange(401) - 200.0
    assert float(spread.sum()) == pytest.approx(1.0)
    assert float(np.sqrt(np.sum(spread * place**2))) == pytest.approx(12.0, rel=0.01)
    # as much noise is left as of a mean over the even width
    assert 1 / float(np.sum(spread**2)) == pytest.approx(12.0 * EVEN_WIDTH, rel=0.01)


def test_samples_are_registered_on_lines_between_them_in_the_order_of_depth() -> None:
    x_mm, force_cN = np.array([0.0, 1.0, 1.0, 0.5, 2.0]), np.array([0.0, 10.0, 99.0, 4.0, 30.0])
    np.testing.assert_allclose(register(x_mm, force_cN, np.array([0.25, 0.75, 1.5])), [2.0, 7.0, 20.0])


def test_presses_that_are_left_out_are_not_averaged() -> None:
    found = recorded().processed
    assert paper_average(found.judged, Stroke.PRESS, 150.0, PaperRecipe()).presses == 6
    assert sum(t.velocity_mm_s == 150.0 for t in capture().takes) == 7
    assert [o.press.take for o in found.judged if o.reason] == [SHORT_STROKE]


def test_nothing_averages_to_nothing_and_a_filter_that_is_none_is_refused() -> None:
    with pytest.raises(ModelError, match="no press is left"):
        paper_average([even_press(40.0, 1.0)], Stroke.PRESS, 50.0, PaperRecipe())
    with pytest.raises(ModelError, match="sigma must be at least 0"):
        Gaussian(-1.0, SigmaUnit.MM)
    with pytest.raises(ValueError, match="inches"):
        Gaussian(1.0, "inches")  # type: ignore[arg-type]
