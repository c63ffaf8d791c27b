"""The main claim is one number a person, and one test."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.testing import assert_allclose

from fdvv.errors import ModelError
from fdvv_people.stats.rank_tests import signed_rank
from fdvv_people.study.plan.answers import Answers, means_by
from fdvv_people.study.plan.claim import (
    choice_claim,
    claim_holds,
    claim_p,
    claim_scores,
    claim_values,
    usual_claim,
)
from fdvv_people.study.plan.plan import Claim
from tests.support.study_answers import mushra, realism, right_or_wrong, staircase, timing

CLAIM = Claim(more="FDVV", less="FD")


def answers(choices: dict[str, list[str]], kind: str = "realism") -> Answers:
    """Return answers of people, one row a choice, in turns as they came."""
    rows = [(person, choice) for person, given in choices.items() for choice in given]
    n = len(rows)
    return Answers(
        kind=kind,
        stimuli=("FD", "FDVV"),
        person=np.array([person for person, _ in rows]),
        item=np.array(["MX Clear"] * n),
        round=np.arange(n),
        choice=np.array([choice for _, choice in rows]),
        correct=np.array([float(choice == "FDVV") if choice else np.nan for _, choice in rows]),
        ratings={"realism": np.array([[3.0, 5.0] if choice else [np.nan] * 2 for _, choice in rows])},
    )


def test_a_person_is_the_mean_of_what_was_chosen_and_equal_counts_for_nobody() -> None:
    given = answers({"P01": ["FDVV", "FDVV", "equal", "FD"], "P02": ["FD", "FD"], "P03": ["", ""]})
    people, scores = claim_scores(given, CLAIM)
    assert people == ("P01", "P02", "P03")
    np.testing.assert_array_equal(scores, [0.25, -1.0, np.nan])
    _, other_way = claim_scores(given, Claim(more="FD", less="FDVV"))
    np.testing.assert_array_equal(other_way, -scores)


def test_what_is_excluded_or_missing_does_not_count() -> None:
    given = answers({"P01": ["FDVV", "FD", ""]})
    given = replace(given, excluded=np.array(["", "a fault", ""]))
    _, scores = claim_scores(given, CLAIM)
    np.testing.assert_array_equal(scores, [1.0])


def test_a_rating_counts_as_its_difference() -> None:
    _, scores = claim_scores(answers({"P01": ["FD", ""]}), Claim(more="FDVV", less="FD", measure="realism"))
    np.testing.assert_array_equal(scores, [2.0])


def test_the_test_of_many_studies_is_that_of_each() -> None:
    scores = np.random.default_rng(0).integers(-3, 6, (50, 9)) / 6
    np.testing.assert_allclose(claim_p(scores), [signed_rank(row).p_exact for row in scores])
    assert claim_p(np.ones((1, 12)))[0] == 2 / 2**12


@settings(max_examples=30)
@given(st.integers(0, 2**32 - 1), st.integers(2, 24), st.sampled_from([0.001, 0.01, 0.05, 0.2]))
def test_whether_a_claim_holds_is_its_p_against_alpha(seed: int, people: int, alpha: float) -> None:
    random = np.random.default_rng(seed)
    # from no leaning to a strong one, coarse enough for ties and zeros
    scores = np.rint(3 * (random.standard_normal((40, people)) + random.uniform(0, 1.5, (40, 1)))) / 6
    np.testing.assert_array_equal(claim_holds(scores, alpha), claim_p(scores) <= alpha)


def test_what_is_missing_is_nan_and_not_a_tie() -> None:
    answers = realism()
    answers = replace(answers, choice=np.where(answers.round == 0, "", answers.choice))
    assert np.array_equal(np.isnan(claim_values(answers, CLAIM)), answers.round == 0)


@pytest.mark.parametrize("measure", ["choice", "realism"])
def test_peoples_means_are_those_that_the_power_of_a_plan_refers_to(measure: str) -> None:
    answers = realism()
    answers = replace(answers, excluded=np.where(answers.round == 1, "fault", ""))
    claim = Claim(more="FDVV", less="FD", measure=measure)
    _, planned = claim_scores(answers, claim)
    kept = answers.counts
    assert_allclose(means_by(claim_values(answers, claim)[kept], answers.person[kept]), planned)


def test_means_leave_out_what_is_missing_and_are_missing_where_all_of_it_is() -> None:
    values = np.array([1.0, np.nan, 3.0, np.nan])
    assert_allclose(means_by(values, np.array(["a", "a", "b", "c"])), [1.0, 3.0, np.nan])


def test_the_usual_claim_of_two_renderings_is_the_second_over_the_first() -> None:
    assert usual_claim(realism()) == CLAIM
    assert usual_claim(replace(realism(), choice=np.full(144, ""))) == Claim(
        more="FDVV", less="FD", measure="realism"
    )
    claim = usual_claim(right_or_wrong())
    assert claim is not None
    assert claim.measure == "correct"
    assert [usual_claim(one) for one in (mushra(), staircase(), timing())] == [None] * 3


def test_in_abx_a_choice_is_right_or_wrong_for_it_names_no_stimulus() -> None:
    answers = right_or_wrong("abx")
    assert choice_claim(answers, CLAIM).measure == "correct"
    assert_allclose(claim_values(answers, CLAIM), 2 * answers.correct - 1)


@pytest.mark.parametrize(
    ("claim", "said"),
    [
        (Claim(more="FDVV", less="anchor"), "the claim is about 'anchor'"),
        (Claim(more="FDVV", less="FD", measure="likeness"), "there are choice, realism"),
    ],
)
def test_a_claim_about_something_else_is_refused(claim: Claim, said: str) -> None:
    with pytest.raises(ModelError, match=said):
        claim_values(realism(), claim)
