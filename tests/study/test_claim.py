"""The main claim is one number a person, and one test."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fdvv.errors import ModelError
from fdvv.study import Answers, Claim, claim_holds, claim_p, claim_scores, signed_rank

CLAIM = Claim(more="FDVV", less="FD")


def answers(choices: dict[str, list[str]], kind: str = "realism") -> Answers:
    """Give answers of people, one row a choice, in turns as they came."""
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


def test_in_abx_what_is_right_counts_whichever_it_is() -> None:
    given = answers({"P01": ["FDVV", "FD"], "P02": ["FDVV", "FDVV"]}, "abx")
    _, scores = claim_scores(replace(given, correct=np.array([1.0, 1.0, 1.0, 0.0])), CLAIM)
    np.testing.assert_array_equal(scores, [1.0, 0.0])


def test_a_claim_that_the_answers_know_nothing_of_is_refused() -> None:
    for claim in (
        Claim(more="FDVV", less="FD", measure="beauty"),
        Claim(more="X", less="FD", measure="realism"),
    ):
        with pytest.raises(ModelError):
            claim_scores(answers({"P01": ["FD"]}), claim)


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
