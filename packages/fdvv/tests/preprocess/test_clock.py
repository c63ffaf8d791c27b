"""Two clocks are joined by the edges of a light."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fdvv.errors import ModelError
from fdvv.preprocess.clock import _polygon, align_clocks
from fdvv.preprocess.edges import Edges
from fdvv.units import FloatArray

EXPOSURE_s = 3e-4
BLINKS_s = np.array([0.0, 0.009, 0.020, 0.035, 0.048, 0.057, 0.076, 0.088])


def session(
    takes: int, offset_s: float, rate: float, random: np.random.Generator, exposure_s: float = EXPOSURE_s
) -> tuple[Edges, FloatArray, FloatArray]:
    """Make edges on the board's clock and frames on the camera's, offset + rate * board."""
    starts = np.cumsum(random.uniform(1.0, 3.0, takes))
    times = (starts[:, None] + BLINKS_s).ravel()
    edges = Edges(times, np.arange(times.size) % 2 == 0)
    own = np.arange(offset_s, offset_s + rate * (starts[-1] + 1.0), 1 / 256) + random.uniform(0, 1 / 256)
    return edges, own, lit((own - offset_s) / rate, times, exposure_s / rate)


def lit(at_s: FloatArray, times: FloatArray, exposure_s: float) -> FloatArray:
    """Return the lit part of each exposure."""
    part = np.zeros(at_s.size)
    for on, off in zip(times[::2], times[1::2], strict=True):
        if exposure_s:
            part += np.clip((np.minimum(at_s + exposure_s, off) - np.maximum(at_s, on)) / exposure_s, 0, 1)
        else:
            part += (at_s >= on) & (at_s < off)
    return part


@settings(max_examples=10, deadline=None)
@given(
    st.integers(0, 2**32 - 1), st.floats(-50, 500), st.floats(-1e-2, 1e-2), st.sampled_from([0.0, EXPOSURE_s])
)
def test_offset_and_drift_are_found_within_the_reported_uncertainty(
    seed: int, offset_s: float, drift: float, exposure_s: float
) -> None:
    random = np.random.default_rng(seed)
    edges, frames, light = session(30, offset_s, 1 + drift, random, exposure_s)

    fit = align_clocks(edges, frames, light, exposure_s)

    error = fit.board_s(offset_s + (1 + drift) * edges.t_s) - edges.t_s
    assert np.abs(error).max() <= fit.doubt_s + 2e-5
    assert fit.doubt_s < 3e-4
    assert fit.edges >= 0.9 * edges.t_s.size


def test_lost_frames_widen_the_bounds_but_do_not_mislead() -> None:
    random = np.random.default_rng(3)
    edges, frames, light = session(30, 7.0, 1 + 5e-5, random)
    kept = random.random(frames.size) > 0.05

    fit = align_clocks(edges, frames[kept], light[kept], EXPOSURE_s)

    assert np.abs(fit.board_s(7.0 + (1 + 5e-5) * edges.t_s) - edges.t_s).max() < 3e-4


def test_an_edge_that_was_written_down_wrong_does_not_mislead() -> None:
    random = np.random.default_rng(4)
    edges, frames, light = session(10, 3.0, 1.0, random)
    moved = edges.t_s.copy()
    moved[20] += 4.5e-3
    wrong = Edges(moved, edges.on)

    fit = align_clocks(wrong, frames, light, EXPOSURE_s)

    assert fit.edges < edges.t_s.size
    assert abs(fit.offset_s - 3.0) < 3e-4


def test_brightness_may_be_in_any_measure() -> None:
    random = np.random.default_rng(5)
    edges, frames, light = session(10, 3.0, 1.0, random)

    fit = align_clocks(edges, frames, 17.0 + 230.0 * light, EXPOSURE_s)

    assert abs(fit.offset_s - 3.0) < 3e-4


def test_a_light_that_was_never_seen_is_reported() -> None:
    edges = Edges(np.array([1.0, 1.01, 1.05, 1.1]), np.array([True, False, True, False]))

    with pytest.raises(ModelError, match="no pattern in common"):
        align_clocks(edges, np.arange(0, 3, 1 / 256), np.zeros(768), EXPOSURE_s)


def test_a_camera_that_saw_only_the_second_half_is_aligned() -> None:
    random = np.random.default_rng(6)
    edges, frames, light = session(20, 3.0, 1 + 2e-4, random)
    late = frames > frames[frames.size // 2]

    fit = align_clocks(edges, frames[late], light[late], EXPOSURE_s)

    half = edges.t_s[edges.t_s.size // 2 :]
    assert np.abs(fit.board_s(3.0 + (1 + 2e-4) * half) - half).max() < 3e-4


def test_bounds_that_contradict_by_less_than_a_solver_tells_apart_are_joined_with_a_doubt() -> None:
    # of a recording: no line passes all three, but one that misses each by 0.03 us does
    edge_s = np.array([47.926792, 115.974631, 147.967624])
    low_s = np.array([89.972301738, 158.015270488, 190.011364238])
    high_s = np.array([89.975968334, 158.0189370838, 190.0150308338])

    fit = _polygon(edge_s, low_s, high_s, 0)

    line_s = fit.offset_s + fit.rate * edge_s
    assert np.all(line_s > low_s - 2e-7)
    assert np.all(line_s < high_s + 2e-7)
    assert fit.doubt_s > 2e-8
