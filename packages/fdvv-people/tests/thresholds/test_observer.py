"""The observer discriminates as its formulas say, and its surface is where it notices three of four."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.special import expit

from fdvv.model.noticeable import DIMENSIONS
from fdvv_people.thresholds.observer import (
    EXPONENT,
    JND,
    LAPSE,
    PARAMETERS,
    SUMMATION,
    log_jnd_along,
    log_strength,
    share_correct,
)

RATIOS = st.floats(0.01, 1.0)
NEVER = -40.0
"""Logit of no lapses."""


def parameters(
    jnd: tuple[float, ...] = (0.1, 0.4, 0.3), exponent: float = 1.0, m: float = 2.0, lapse: float = NEVER
) -> np.ndarray:
    found = np.empty(PARAMETERS)
    found[JND], found[EXPONENT], found[SUMMATION], found[LAPSE] = (
        np.log(jnd),
        np.log(exponent),
        np.log(m - 1),
        lapse,
    )
    return found


def test_one_jnd_is_noticed_in_three_comparisons_of_four() -> None:
    np.testing.assert_allclose(share_correct(parameters(), np.diag([0.1, 0.4, 0.3])), 0.75)


def test_nothing_is_noticed_by_chance_and_much_always_but_for_lapses() -> None:
    changes = np.array([[1e-9, 0.0, 0.0], [50.0, 0.0, 0.0]])
    found = share_correct(parameters(lapse=np.log(0.1 / 0.9)), changes)
    np.testing.assert_allclose(found, [0.5, 0.95], atol=1e-6)


def test_with_an_exponent_of_two_squares_add_up() -> None:
    both = np.array([[0.3, 0.4 * 4.0, 0.0]])
    assert np.exp(log_strength(parameters(m=2.0), both))[0] == pytest.approx(5.0)


@given(st.floats(1.05, 8.0), st.floats(0.5, 2.0), RATIOS, RATIOS, RATIOS)
def test_several_changes_are_felt_at_least_as_the_strongest_and_at_most_as_their_sum(
    m: float, exponent: float, force: float, snap: float, vibration: float
) -> None:
    observer = parameters(exponent=exponent, m=m)
    alone = np.exp(log_strength(observer, np.diag([force, snap, vibration])))
    together = float(np.exp(log_strength(observer, np.array([[force, snap, vibration]])))[0])
    assert alone.max() <= together * (1 + 1e-9)
    assert together <= alone.sum() * (1 + 1e-9)


@given(
    st.lists(st.floats(-1.0, 1.0), min_size=PARAMETERS, max_size=PARAMETERS),
    st.lists(st.floats(0.05, 20.0), min_size=3, max_size=3),
)
def test_the_surface_is_crossed_where_a_change_is_one_jnd(drawn: list[float], direction: list[float]) -> None:
    observer = np.array(drawn)
    for used in ([1, 0, 0], [1, 1, 0], [0, 1, 1], [1, 1, 1]):
        along = np.array([direction]) * used
        size = np.exp(log_jnd_along(observer, along))
        assert log_strength(observer, along * size[:, None])[0] == pytest.approx(0.0, abs=1e-9)


def test_arrays_of_observers_are_judged_one_by_one() -> None:
    random = np.random.default_rng(0)
    many, changes = (
        random.normal(size=(2, 5, PARAMETERS)),
        random.uniform(0.1, 1.0, size=(4, len(DIMENSIONS))),
    )
    changes[0, 1:] = 0.0
    found = share_correct(many, changes)
    assert found.shape == (2, 5, 4)
    np.testing.assert_allclose(found[1, 3], share_correct(many[1, 3], changes))
    assert np.all(found >= 0.5 * expit(many[..., LAPSE, None]))
