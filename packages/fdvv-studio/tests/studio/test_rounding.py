"""Numbers on their way to a screen."""

from __future__ import annotations

import numpy as np

from fdvv_studio.studio.rounding import finite_or_none, finite_row, rounded


def test_what_is_not_known_is_none_and_the_rest_is_rounded() -> None:
    row = np.array([1.23456, np.nan, np.inf, -0.0004])
    assert finite_row(row) == (1.235, None, None, -0.0)
    assert [finite_or_none(value) for value in row.tolist()] == [1.235, None, None, -0.0]
    assert rounded(row[[0, 3]]) == (1.235, -0.0)
