from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose
from tests.study_answers import EVERY_KIND, mushra, realism, right_or_wrong, staircase, timing

from fdvv.errors import ModelError
from fdvv.study import (
    Claim,
    choice_claim,
    claim_scores,
    claim_values,
    is_answered,
    means_by,
    usual_claim,
)

CLAIM = Claim(more="FDVV", less="FD")


def test_a_choice_counts_for_against_or_neither() -> None:
    answers = realism()
    values = claim_values(answers, CLAIM)
    assert set(zip(answers.choice.tolist(), values.tolist(), strict=True)) == {
        ("FDVV", 1.0), ("FD", -1.0), ("equal", 0.0)
    }  # fmt: skip


def test_the_other_way_round_it_speaks_as_far_against() -> None:
    answers = realism()
    for measure in ("choice", "realism"):
        forth = claim_values(answers, Claim(more="FDVV", less="FD", measure=measure))
        back = claim_values(answers, Claim(more="FD", less="FDVV", measure=measure))
        assert_allclose(forth, -back)


def test_what_is_missing_is_nan_and_not_a_tie() -> None:
    answers = realism()
    answers = replace(answers, choice=np.where(answers.round == 0, "", answers.choice))
    assert np.array_equal(np.isnan(claim_values(answers, CLAIM)), answers.round == 0)


@pytest.mark.parametrize("measure", ["choice", "realism"])
def test_peoples_means_are_those_that_the_power_of_a_plan_is_told_of(measure: str) -> None:
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


def test_every_kind_holds_answers() -> None:
    assert all(is_answered(one).all() for one in EVERY_KIND.values())


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
