"""Paths between frames follow from the force, on motions whose truth is integrated finely.

The force sensor's filter and play are undone.
"""

from __future__ import annotations

import itertools
import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.interpolate import BSpline

from fdvv.errors import ModelError
from fdvv.preprocess.fuse import (
    EvenBasis,
    Fusion,
    Seen,
    fuse,
    rough,
    table_curve,
    undo_filter,
    undo_play,
    zero_curve,
)
from fdvv.units import FloatArray

MOVING_g = 5.0
PLACES_mm = np.linspace(0.0, 4.0, 81)


def button_cN(x_mm: FloatArray) -> FloatArray:
    """Return the force of a spring with a bump: 30 cN, 12 cN/mm, 20 cN of bump at 1.5 mm."""
    return np.asarray(30 + 12 * x_mm + 20 * np.exp(-(((x_mm - 1.5) / 0.35) ** 2)))


def press(random: np.random.Generator, speed: float = 1.0) -> tuple[Seen, FloatArray]:
    """Press the spring with a force that pulls like a finger; frames at 256 Hz with 28 um, force each ms."""
    step = 1e-5
    x, v, t = 0.0, 40.0 * speed, 0.0
    times, places, forces = [], [], []
    while x < 3.9:
        wanted = 40.0 * speed + 150 * speed * np.sin(np.pi * min(x / 4.0, 1.0))
        force_cN = float(button_cN(np.array([x]))[0]) + 0.6 * (wanted - v)
        acceleration_mm_s2 = (force_cN - float(button_cN(np.array([x]))[0])) * 1e-2 / (MOVING_g * 1e-3) * 1e3
        times.append(t)
        places.append(x)
        forces.append(force_cN)
        v += step * acceleration_mm_s2
        x += step * v
        t += step
    truth_t, truth_x, truth_f = np.array(times), np.array(places), np.array(forces)
    t_s = np.arange(0.0, truth_t[-1], 1e-3)
    frame_s = np.arange(random.uniform(0, 1 / 256), t_s[-1], 1 / 256)
    frame_mm = np.interp(frame_s, truth_t, truth_x) + 0.028 * random.standard_normal(frame_s.size)
    force_cN = np.interp(t_s, truth_t, truth_f)
    seen = Seen(t_s, np.asarray(force_cN), frame_s, frame_mm, np.interp(t_s, frame_s, frame_mm))
    return seen, np.interp(t_s, truth_t, truth_x)


def presses(seed: int) -> list[tuple[Seen, FloatArray]]:
    random = np.random.default_rng(seed)
    return [press(random, random.uniform(0.9, 1.1)) for _ in range(15)]


KNOWN, UNKNOWN = Fusion(MOVING_g), Fusion(MOVING_g, pieces=25, unknown_N=1e3)


def error_mm(settings: Fusion) -> float:
    """Return the error of paths by a button that is known, or found with the paths."""
    made = presses(1)
    curve = zero_curve if settings is UNKNOWN else table_curve(PLACES_mm, button_cN(PLACES_mm))
    paths, _ = fuse([seen for seen, _ in made], curve, settings)
    misses = [p.displacement_mm - x for p, (_, x) in zip(paths, made, strict=True)]
    return float(np.sqrt(np.mean(np.concatenate(misses) ** 2)))


def line_error_mm() -> float:
    return float(np.sqrt(np.mean(np.concatenate([seen.guess_mm - x for seen, x in presses(1)]) ** 2)))


def test_a_known_button_halves_the_error_of_lines_between_frames() -> None:
    assert error_mm(KNOWN) < min(0.025, 0.5 * line_error_mm())


def test_an_unknown_button_is_found_with_the_paths() -> None:
    assert error_mm(UNKNOWN) < line_error_mm()


def test_the_button_comes_back_as_a_curve() -> None:
    _, curve = fuse([seen for seen, _ in presses(2)], zero_curve, UNKNOWN)

    x = np.linspace(0.3, 3.5, 60)
    force_cN, stiffness_cN_mm = curve(x)
    assert np.sqrt(np.mean((force_cN - button_cN(x)) ** 2)) < 2.5
    assert stiffness_cN_mm == pytest.approx(np.gradient(force_cN, x), abs=8)


def test_a_wrong_mass_costs_little() -> None:
    assert error_mm(Fusion(1.4 * MOVING_g)) < 0.03


def test_a_stroke_without_frames_is_refused() -> None:
    with pytest.raises(ModelError, match="needs 4 samples and 2 frames, got 5 and 0"):
        Seen(np.arange(5.0) * 1e-3, np.zeros(5), np.zeros(0), np.zeros(0), np.zeros(5))


@pytest.mark.parametrize("derivative", [0, 1, 2])
def test_rows_of_even_splines_are_those_of_scipy(derivative: int) -> None:
    basis = EvenBasis(2.0, 0.25, 9)
    knots = 2.0 + 0.25 * np.arange(-3, 13)
    at = np.linspace(2.0, 4.2499, 101)

    expected = BSpline(knots, np.eye(12), 3)(at, nu=derivative)

    assert basis.rows(at, derivative) == pytest.approx(expected, abs=1e-9)


def test_rows_of_even_splines_sum_to_one_and_hold_beyond_the_ends() -> None:
    basis = EvenBasis(0.0, 1.0, 4)

    assert basis.rows(np.linspace(-2, 7, 50)).sum(axis=1) == pytest.approx(1.0)
    assert basis.rows(np.array([-5.0])) == pytest.approx(basis.rows(np.array([0.0])))


def test_a_parabola_is_not_rough() -> None:
    assert rough(8) @ np.arange(8.0) ** 2 == pytest.approx(0.0)


def filtered(values: FloatArray, step_s: float, filter_s: float) -> FloatArray:
    """Slow oracle: integrate the filter over lines between the samples in small steps."""
    out, state, fine = [values[0]], values[0], 400
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
