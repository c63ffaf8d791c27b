from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fdvv.errors import ModelError
from fdvv_people.stats.thurstone import d_prime_2afc
from fdvv_people.stats.two_ac import _most_likely, shares_2ac, two_ac, two_ac_people
from tests.stats.golden import TENTHS, golden
from tests.support.campaign import campaign


@TENTHS
def test_it_agrees_with_ordinal_on_200_tables(start: int) -> None:
    for one in golden("two_ac")[start::10]:
        found = two_ac(*one["counts"])
        assert found.d == pytest.approx(one["d"], abs=2e-5)
        assert found.tau == pytest.approx(one["tau"], abs=2e-5)
        # its bounds are read off a spline through a few points of the profile
        assert [found.low, found.high] == pytest.approx(one["interval"], abs=2e-3)


@settings(deadline=None, max_examples=60)
@given(st.floats(-3, 3), st.floats(0.01, 3))
def test_shares_turn_back_into_what_made_them(d: float, tau: float) -> None:
    shares = shares_2ac(d, tau)
    assert sum(shares) == pytest.approx(1.0)
    assert _most_likely(*shares) == pytest.approx((d, tau), abs=1e-9)


def test_what_people_do_who_feel_so_gives_the_shares() -> None:
    random = np.random.default_rng(3)
    felt = random.normal(0.8, 1.0, 400_000) - random.normal(0.0, 1.0, 400_000)
    seen = (np.mean(felt < -0.5), np.mean(np.abs(felt) <= 0.5), np.mean(felt > 0.5))
    assert shares_2ac(0.8, 0.5) == pytest.approx(seen, abs=4 * 0.5 / math.sqrt(400_000))


def test_each_bound_is_where_the_likelihood_has_fallen_by_half_of_chi_squared() -> None:
    from scipy.optimize import minimize_scalar
    from scipy.stats import chi2, multinomial

    def best(counts: tuple[int, int, int], d: float) -> float:
        def falling(tau: float) -> float:
            return -float(multinomial.logpmf(counts, sum(counts), np.array(shares_2ac(d, tau))))

        return -float(minimize_scalar(falling, bounds=(1e-6, abs(d) + 6), method="bounded").fun)

    for counts in ((2, 2, 6), (5, 9, 3), (0, 3, 7), (12, 1, 30)):
        found = two_ac(*counts)
        top = float(multinomial.logpmf(counts, sum(counts), np.array(counts) / sum(counts)))
        for bound in (found.low, found.high):
            if math.isfinite(bound):
                assert 2 * (top - best(counts, bound)) == pytest.approx(chi2.ppf(0.95, 1), abs=1e-4)


def test_without_any_equal_it_is_two_afc() -> None:
    found, forced = two_ac(6, 0, 14), d_prime_2afc(14, 20)
    assert found.tau == 0.0
    assert found.d == pytest.approx(forced.d)
    assert found.p == forced.p


@pytest.mark.parametrize(
    ("counts", "d", "bounded"),
    [
        ((0, 3, 7), math.inf, (True, False)),
        ((0, 0, 9), math.inf, (True, False)),
        ((7, 3, 0), -math.inf, (False, True)),
        ((9, 0, 0), -math.inf, (False, True)),
        ((3, 0, 7), 0.74, (True, True)),
    ],
)
def test_an_empty_cell_leaves_a_one_sided_interval(counts: Any, d: float, bounded: tuple[bool, bool]) -> None:
    found = two_ac(*counts)
    assert found.d == pytest.approx(d, abs=0.01)
    assert (math.isfinite(found.low), math.isfinite(found.high)) == bounded
    assert found.low <= found.d <= found.high


def test_all_equal_tells_nothing() -> None:
    found = two_ac(0, 9, 0)
    assert math.isnan(found.d)
    assert (found.low, found.high, found.p) == (-math.inf, math.inf, 1.0)


def test_turning_both_stimuli_around_turns_the_sign() -> None:
    here, there = two_ac(3, 4, 11), two_ac(11, 4, 3)
    assert (here.d, here.low, here.high) == pytest.approx((-there.d, -there.high, -there.low), abs=1e-7)


def test_intervals_hold_the_truth_about_as_often_as_they_say() -> None:
    random = np.random.default_rng(4)
    tables = random.multinomial(36, shares_2ac(0.9, 0.5), 40)
    hits = sum(one.low <= 0.9 <= one.high for one in (two_ac(*table) for table in tables.tolist()))
    assert 34 <= hits <= 40


@pytest.mark.parametrize("counts", [(0, 0, 0), (-1, 2, 3)])
def test_counts_that_cannot_be_are_refused(counts: Any) -> None:
    with pytest.raises(ModelError, match="at least one answer"):
        two_ac(*counts)


@campaign("start", range(50), part=1)
def test_over_people_it_agrees_with_ordinals_mixed_model(start: int, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("fdvv_people.stats.two_ac.NODES", 7)
    for one in golden("two_ac_people")[start::50]:
        found = two_ac_people(one["counts"])
        half = 1.959964 * one["error"]
        assert found.all.d == pytest.approx(one["d"], abs=2e-3)
        assert found.all.tau == pytest.approx(one["tau"], abs=1e-3)
        assert found.person_sd == pytest.approx(one["sd"], abs=2e-3)
        assert (found.all.high - found.all.low) / 2 == pytest.approx(half, rel=0.01)


def test_over_people_the_interval_is_wider_than_over_answers() -> None:
    counts = [[2, 6, 28], [10, 12, 14], [1, 3, 32], [14, 8, 14], [4, 20, 12], [0, 2, 34], [0, 0, 0]]
    found = two_ac_people(counts)
    plain = two_ac(*np.sum(counts, axis=0).tolist())
    assert found.all.people == 6
    assert found.all.high - found.all.low > plain.high - plain.low
    assert found.all.p == pytest.approx(2 * 0.5**5)
    assert [one.d for one in found.each] == [two_ac(*row).d for row in counts[:-1]]


def test_over_people_an_answer_never_given_leaves_a_one_sided_interval() -> None:
    found = two_ac_people([[0, 3, 5], [0, 2, 6], [0, 0, 8], [0, 7, 1]])
    assert (found.all.d, found.all.high) == (math.inf, math.inf)
    assert math.isnan(found.person_sd)
    assert found.all.low < two_ac(0, 12, 20).low


def test_one_person_makes_no_population() -> None:
    with pytest.raises(ModelError, match="at least 2 people"):
        two_ac_people([[1, 2, 3], [0, 0, 0]])
