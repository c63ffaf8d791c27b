from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.stats import binomtest, ttest_1samp, wilcoxon

from fdvv.study.analysis.multiverse import multiverse
from fdvv.study.plan.answers import means_by, screen
from fdvv.study.plan.claim import claim_values
from fdvv.study.plan.plan import Claim
from tests.support.study_answers import all_ties, realism, right_or_wrong

CLAIM = Claim(more="FDVV", less="FD")


def test_the_registered_way_is_the_test_that_is_reported() -> None:
    answers = realism(lean=0.4)
    found = multiverse(answers, CLAIM)
    means = means_by(claim_values(answers, CLAIM), answers.person)
    main = found.reported
    assert (main.exclusions, main.measure, main.unit, main.ties) == (
        "by the rules", "choice", "person", "split"
    )  # fmt: skip
    assert_allclose(main.share, (means.mean() + 1) / 2)
    assert_allclose(main.p, wilcoxon(means[means != 0], method="exact").pvalue)
    assert main.n == 12


def test_every_way_is_what_a_plain_computation_gives() -> None:
    answers = realism(lean=0.4, seed=3)
    values = claim_values(answers, CLAIM)
    means = means_by(values, answers.person)
    ways = {(w.measure, w.unit, w.ties, w.test): w for w in multiverse(answers, CLAIM).specifications}
    assert_allclose(ways["choice", "person", "split", "t"].p, ttest_1samp(means, 0).pvalue)
    signs = binomtest(int(np.sum(values > 0)), int(np.sum(values != 0)))
    trial = ways["choice", "trial", "dropped", "sign"]
    assert_allclose(trial.p, signs.pvalue)
    interval = signs.proportion_ci(method="wilson")
    assert_allclose([trial.share, trial.low, trial.high], [signs.statistic, interval.low, interval.high])
    rated = claim_values(answers, Claim(more="FDVV", less="FD", measure="realism"))
    assert_allclose(ways["realism", "trial", "split", "t"].share, np.mean((np.sign(rated) + 1) / 2))


def test_ways_are_in_rising_order_and_differ() -> None:
    found = multiverse(realism(), CLAIM).specifications
    shares = [one.share for one in found]
    assert shares == sorted(shares)
    keys = [(w.exclusions, w.measure, w.unit, w.ties, w.test) for w in found]
    assert len(set(keys)) == len(keys)
    assert sum(one.reported for one in found) == 1


def test_a_clear_lean_is_found_in_every_way_and_none_in_few() -> None:
    clear = multiverse(realism(lean=1.5), CLAIM)
    assert clear.agreeing == clear.significant == len(clear.specifications)
    assert all(one.share > 0.5 for one in clear.specifications)
    opposite = multiverse(realism(lean=1.5), Claim(more="FD", less="FDVV"))
    assert opposite.significant == len(opposite.specifications)
    assert_allclose(
        sorted(1 - one.share for one in opposite.specifications),
        [one.share for one in clear.specifications],
    )


def test_what_rules_leave_out_is_put_back_in_one_part_of_the_ways() -> None:
    answers = realism(lean=0.3)
    out = np.where((answers.person == "P01") & (answers.round < 3), "fault", "")
    found = multiverse(screen(replace(answers, excluded=out)).answers, CLAIM)
    assert {one.exclusions for one in found.specifications} == {"by the rules", "nobody left out"}
    people = {(one.exclusions, one.n) for one in found.specifications if one.unit == "person"}
    assert people == {("by the rules", 11), ("nobody left out", 12)}


def test_people_who_lack_something_are_left_out_in_another_part() -> None:
    answers = realism(12, 6, ("Clear",), lean=0.3)
    out = np.where((answers.person == "P01") & (answers.round == 0), "fault", "")
    found = multiverse(screen(replace(answers, excluded=out)).answers, CLAIM)
    assert {one.exclusions for one in found.specifications} == {
        "by the rules", "nobody left out", "complete people only"
    }  # fmt: skip


def test_right_and_wrong_have_one_measure_and_no_ties() -> None:
    found = multiverse(right_or_wrong(), Claim(more="FDVV", less="FD"))
    assert {(one.measure, one.ties) for one in found.specifications} == {("correct", "split")}


def test_where_all_are_ties_nothing_is_found_either_way() -> None:
    found = multiverse(all_ties(), CLAIM)
    assert {one.share for one in found.specifications} == {0.5}
    assert found.significant == 0
    assert all(one.p == pytest.approx(1.0) for one in found.specifications)
