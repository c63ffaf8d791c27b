"""What the clocks were joined by."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from fdvv.preprocess.clock import ClockFit
from fdvv.preprocess.takes import edge_bounds
from tests.support.captures import capture, recorded


def test_every_edge_is_bounded_about_the_line_that_was_fitted() -> None:
    clock = recorded().processed.clock
    bounds = edge_bounds(capture(), clock)
    assert bounds is not None
    assert bounds.board_s.size == clock.edges
    assert np.all(np.diff(bounds.board_s) > 0)
    slack_s = 2e-4
    assert np.all(bounds.low_s <= slack_s)
    assert np.all(bounds.high_s >= -slack_s)
    # two exposures bound an edge, at 256 a second; a lost frame makes it two steps
    assert np.median(bounds.high_s - bounds.low_s) < 1 / 256


def test_a_line_that_is_shifted_leaves_the_bounds_shifted_the_other_way() -> None:
    clock = recorded().processed.clock
    here, there = (edge_bounds(capture(), c) for c in (clock, replace(clock, offset_s=clock.offset_s + 5e-4)))
    assert here is not None
    assert there is not None
    np.testing.assert_allclose(there.low_s, here.low_s - 5e-4, atol=1e-9)


def test_one_clock_has_no_edges_to_show() -> None:
    assert edge_bounds(capture(), ClockFit(0.0)) is None
