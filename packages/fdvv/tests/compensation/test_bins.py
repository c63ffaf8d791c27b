"""Bins, smoothing and bumps."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from fdvv.compensation.tables import bin_force, bump_kept_ratio, grid_mm, smooth
from fdvv.model.curve import Stroke
from fdvv.model.file import load_builtin
from fdvv.units import FloatArray

GRID = grid_mm(4.0, 0.05)


def naive_bins(x: FloatArray, force: FloatArray, grid: FloatArray) -> FloatArray:
    """Average bin by bin, then draw straight lines between visited bins."""
    half = (grid[1] - grid[0]) / 2
    known: dict[int, float] = {}
    for i, centre in enumerate(grid):
        inside = [f for a, f in zip(x, force, strict=True) if centre - half <= a < centre + half]
        if inside:
            known[i] = sum(inside) / len(inside)
    out = np.full(grid.size, np.nan)
    for i in range(grid.size):
        below, above = [k for k in known if k <= i], [k for k in known if k >= i]
        if below and above:
            a, b = max(below), min(above)
            part = 0.0 if a == b else (i - a) / (b - a)
            out[i] = known[a] + part * (known[b] - known[a])
    return out


def test_the_grid_holds_both_ends_of_the_travel() -> None:
    assert GRID.size == 81
    assert GRID[0] == 0.0
    assert GRID[-1] == pytest.approx(4.0)


@given(
    st.lists(st.tuples(st.integers(-20, 470), st.floats(-100, 100)), min_size=1, max_size=40),
)
def test_bins_agree_with_a_slow_average(samples: list[tuple[int, float]]) -> None:
    # displacements on hundredths, moved off the borders of the bins
    x = np.array([n / 100 + 0.002 for n, _ in samples])
    force = np.array([f for _, f in samples])
    np.testing.assert_allclose(bin_force(x, force, GRID), naive_bins(x, force, GRID), atol=1e-9)


@given(st.floats(-50, 50), st.lists(st.floats(0.0, 4.0), min_size=1, max_size=30))
def test_a_constant_force_stays_itself_wherever_it_was_visited(level: float, places: list[float]) -> None:
    found = bin_force(np.array(places), np.full(len(places), level), GRID)
    np.testing.assert_allclose(found[np.isfinite(found)], level)


@given(st.floats(-30, 30), st.floats(-100, 100), st.floats(0.0, 0.5))
def test_smoothing_leaves_a_straight_line_alone(slope: float, level: float, sigma_mm: float) -> None:
    line = level + slope * GRID
    np.testing.assert_allclose(smooth(line, sigma_mm, 0.05), line, atol=1e-9)


def test_smoothing_damps_a_wave_as_a_gaussian_does() -> None:
    grid = grid_mm(40.0, 0.05)
    wave = np.sin(2 * np.pi * grid / 1.0)
    middle = slice(300, 500)
    gain = np.exp(-2 * np.pi**2 * 0.15**2)
    np.testing.assert_allclose(smooth(wave, 0.15, 0.05)[middle], gain * wave[middle], atol=1e-3)


def test_the_printed_smoothing_erases_the_bump_and_the_default_keeps_it() -> None:
    model = load_builtin("mx-clear")
    clear = model.force_cN(GRID, 50.0, Stroke.PRESS)
    # the contact flank of the press is steeper than any bump and lies before it
    erased, kept = bump_kept_ratio(GRID, clear, 1.2), bump_kept_ratio(GRID, clear, 0.06)
    assert erased == pytest.approx(0.0, abs=0.02)
    assert kept is not None
    assert 0.9 < kept < 1.0


def test_a_curve_without_a_bump_has_nothing_to_keep() -> None:
    assert bump_kept_ratio(GRID, GRID * 20.0, 0.06) is None
