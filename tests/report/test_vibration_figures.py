"""Figure of a press as a vibration sensor heard it."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.testing import assert_allclose

from fdvv.errors import ModelError
from fdvv.rendering.figures import plot_heard

T_s = np.arange(2000) / 10_000
MODE = (239.0, 150.0, 2.0, 0.5)


def signal_V() -> np.ndarray:
    after = np.maximum(T_s - 0.05, 0)
    return np.asarray((T_s >= 0.05) * 2 * np.exp(-150 * after) * np.sin(2 * np.pi * 239 * after + 0.5))


def test_the_fitted_ring_lies_on_the_signal_that_it_was_made_from() -> None:
    ax = plot_heard(T_s, signal_V(), {"snap": 0.05, "bottom": 0.12}, (0.05, [MODE]), simulated=True)
    signal, envelope, ring, snap, bottom = ax.get_lines()
    assert_allclose(np.asarray(signal.get_ydata()), signal_V())
    at_ms, shown = np.asarray(ring.get_xdata()), np.asarray(ring.get_ydata())
    assert at_ms[0] == pytest.approx(50.0)
    assert at_ms[-1] == pytest.approx(50 + 1e3 * np.log(10) / 150)
    assert_allclose(shown, np.interp(at_ms, 1e3 * T_s, signal_V()), atol=0.02)
    assert np.max(np.asarray(envelope.get_ydata())) <= 2.0
    assert [np.asarray(line.get_xdata())[0] for line in (snap, bottom)] == [50.0, 120.0]
    assert ax.get_title(loc="right") == "simulated"


def test_columns_of_different_length_are_refused() -> None:
    with pytest.raises(ModelError, match="time for each sample"):
        plot_heard(T_s, T_s[1:], {})
