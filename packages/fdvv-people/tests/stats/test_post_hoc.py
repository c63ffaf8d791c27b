from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from fdvv.errors import ModelError
from fdvv_people.stats.post_hoc import bonferroni, holm, post_hoc

GOLDEN: Any = json.loads((Path(__file__).parent / "files" / "pingouin.json").read_text())
BUTTONS = ("optimal", "clear", "brown", "black", "red", "random")
CHANCES = st.lists(st.floats(0, 1), min_size=1, max_size=15)


def test_every_pair_agrees_with_pingouin() -> None:
    tests = post_hoc(np.mean(GOLDEN["scores"], axis=2), BUTTONS)
    expected = GOLDEN["pairs"]
    assert [one.t for one in tests] == pytest.approx(expected["T"], rel=1e-6)
    for ours, theirs in (("p", "p_unc"), ("holm_p", "holm"), ("bonferroni_p", "bonferroni")):
        assert [getattr(one, ours) for one in tests] == pytest.approx(expected[theirs], rel=1e-5, abs=2e-9)


def test_against_one_button_counts_only_its_pairs() -> None:
    averaged = np.mean(GOLDEN["scores"], axis=2)
    tests = post_hoc(averaged, BUTTONS, against="optimal")
    assert [one.second for one in tests] == list(BUTTONS[1:])
    assert all(one.bonferroni_p == pytest.approx(min(1.0, 5 * one.p)) for one in tests)


def test_the_interval_of_a_difference_touches_zero_where_p_is_five_per_cent() -> None:
    base = np.random.default_rng(0).normal(size=(9, 2)) + np.array([0.0, 1.0])
    test = post_hoc(base, ("a", "b"))[0]
    shift = test.difference.high
    assert shift is not None
    moved = post_hoc(base - np.array([shift, 0.0]), ("a", "b"))[0]
    assert moved.p == pytest.approx(0.05)


def test_holm_on_an_example_done_by_hand() -> None:
    assert holm([0.01, 0.04, 0.03, 0.005]) == pytest.approx((0.03, 0.06, 0.06, 0.02))
    assert bonferroni([0.01, 0.4]) == pytest.approx((0.02, 0.8))


@given(CHANCES)
def test_holm_lies_between_p_and_bonferroni_and_keeps_the_order(p: list[float]) -> None:
    corrected = holm(p)
    assert all(a <= b <= c for a, b, c in zip(p, corrected, bonferroni(p), strict=True))
    ranked = [corrected[i] for i in np.argsort(p, kind="stable")]
    assert ranked == sorted(ranked)


def test_pairs_without_spread_and_unknown_buttons_are_refused() -> None:
    with pytest.raises(ModelError, match="a and b differ alike"):
        post_hoc(np.array([[1.0, 2], [2, 3], [3, 4]]), ("a", "b"))
    with pytest.raises(ModelError, match="no condition 'c' among a, b"):
        post_hoc(np.eye(3)[:, :2], ("a", "b"), against="c")
    with pytest.raises(ModelError, match="different names"):
        post_hoc(np.eye(3)[:, :2], ("a", "a"))
