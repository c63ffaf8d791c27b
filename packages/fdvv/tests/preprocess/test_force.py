"""The force sensor's filter and play are undone."""

from __future__ import annotations

import itertools
import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fdvv.errors import ModelError
from fdvv.preprocess.fuse import undo_filter, undo_play
from fdvv.units import FloatArray


def filtered(values: FloatArray, step_s: float, filter_s: float, fine: int = 400) -> FloatArray:
    """Slow oracle: integrate the filter over lines between the samples in small steps."""
    out = [values[0]]
    state = values[0]
    keep = math.exp(-step_s / fine / filter_s)
    for before, after in itertools.pairwise(values):
        for k in range(fine):
            state = keep * state + (1 - keep) * (before + (after - before) * (k + 0.5) / fine)
        out.append(state)
    return np.array(out)


@settings(max_examples=30, deadline=None)
@given(st.lists(st.floats(-200, 200), min_size=3, max_size=30), st.floats(0.05, 0.8))
def test_a_filter_over_lines_is_undone(values: list[float], ratio: float) -> None:
    felt = np.array(values)

    undone = undo_filter(filtered(felt, 1e-3, ratio * 1e-3), 1e-3, ratio * 1e-3)

    assert undone == pytest.approx(felt, abs=0.05)


def test_a_step_is_back_in_one_sample() -> None:
    step = np.where(np.arange(20) < 10, 0.0, 50.0)

    undone = undo_filter(filtered(step, 1e-3, 3.33e-4), 1e-3, 3.33e-4)

    assert undone == pytest.approx(step, abs=0.02)


def test_noise_grows_by_less_than_two_at_the_papers_filter() -> None:
    noise = np.random.default_rng(1).standard_normal(20_000)

    assert 1.0 < undo_filter(noise, 1e-3, 3.33e-4).std() < 2.0


def test_without_a_filter_nothing_changes() -> None:
    values = np.array([1.0, 2.0, 3.0])

    assert undo_filter(values, 1e-3, 0.0) is values


def test_a_filter_too_slow_to_undo_is_refused() -> None:
    with pytest.raises(ModelError, match=r"filter of 2 ms cannot be undone at steps of 1 ms"):
        undo_filter(np.zeros(5), 1e-3, 2e-3)


def test_play_is_undone_on_the_way_up_and_down() -> None:
    force = np.concatenate([np.linspace(0, 90, 100), np.linspace(90, 0, 100)])
    read = np.concatenate([force[:100] - 0.5, force[100:] + 0.5])

    undone = undo_play(read, 1.0)

    inner = np.r_[5:95, 105:195]
    assert undone[inner] == pytest.approx(force[inner], abs=0.1)


def test_play_adds_nothing_at_rest() -> None:
    still = np.full(30, 12.0)

    assert undo_play(still, 1.0) == pytest.approx(still)
