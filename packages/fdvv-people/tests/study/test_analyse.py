from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.stats import norm, wilcoxon

from fdvv.errors import InputError
from fdvv.io.documents import finite
from fdvv_people.stats.rank_tests import signed_rank
from fdvv_people.study.analysis.analyse import analyse
from fdvv_people.study.analysis.code_book import write_answers
from fdvv_people.study.analysis.export import analysis_dict
from fdvv_people.study.analysis.read_answers import read_answers
from fdvv_people.study.analysis.sentences import scale_sentence
from fdvv_people.study.plan.answers import Answers
from fdvv_people.study.plan.claim import claim_scores
from fdvv_people.study.plan.plan import StudyPlan
from fdvv_people.study.plan.plan_file import read_plan_text, template_text
from tests.support.study_answers import (
    BROKEN,
    BUTTONS,
    EVERY_KIND,
    all_ties,
    choices_only,
    mushra,
    paper_like,
    realism,
    right_or_wrong,
    staircase,
    timing,
    with_missing,
)


def plan() -> StudyPlan:
    return read_plan_text(template_text("realism"), "realism.toml")


def test_the_papers_statistics_come_out() -> None:
    found = analyse(paper_like())
    assert [one.button for one in found.tests] == list(BUTTONS)
    for one in found.tests:
        assert_allclose(one.test.z, -3.0594, atol=5e-5)
        assert_allclose(one.test.p_asymptotic, 0.0022, atol=5e-5)
        assert one.test.p_exact == 2 / 2**12
    assert found.preference is not None
    assert_allclose(100 * found.preference.share.share, 77.31, atol=0.005)
    assert found.preference.interval.low < 334 / 432 < found.preference.interval.high


def _harder_rounds() -> Answers:
    """Return six people of two rounds, the second rated higher, who all feel FDVV a step above FD."""
    answers = realism(6, 2, ("Clear",))
    ratings = np.where(answers.round[:, np.newaxis] == 0, [1.0, 2.0], [6.0, 7.0])
    return replace(answers, choice=np.full(12, ""), ratings={"realism": ratings})


def test_a_rating_that_is_missing_unpairs_nothing_and_is_counted() -> None:
    answers = _harder_rounds()
    ratings = answers.ratings["realism"].copy()
    ratings[1, 1] = np.nan
    found = analyse(replace(answers, ratings={"realism": ratings}))
    (test,) = found.tests
    assert found.claim is not None
    assert test.test.p_exact == found.claim.test.p_exact == 2 / 2**6
    assert (test.unpaired, test.test.n) == (1, 6)
    assert any("1 rating stands alone in a trial" in note for note in found.notes)


def test_ratings_that_never_meet_in_a_trial_are_refused() -> None:
    answers = _harder_rounds()
    ratings = np.where(answers.round[:, np.newaxis] == [0, 1], answers.ratings["realism"], np.nan)
    found = analyse(replace(answers, ratings={"realism": ratings}))
    assert found.tests == ()
    assert any("FDVV and FD were never rated in one trial" in note for note in found.notes)


def test_who_lacks_a_pair_at_one_button_is_named_by_number() -> None:
    answers = realism(8, 2, ("Clear", "Red"))
    ratings = answers.ratings["realism"].copy()
    ratings[(answers.person == "P02") & (answers.item == "Red"), 0] = np.nan
    found = analyse(replace(answers, ratings={"realism": ratings}))
    assert [one.test.n for one in found.tests] == [8, 7]
    assert any("for want of a pair, people: 1 at Red" in note for note in found.notes)


def test_pairs_of_many_renderings_are_of_trials_in_which_both_were_rated() -> None:
    answers = mushra(9, ("Clear",))
    ratings = answers.ratings["quality"].copy()
    ratings[(answers.person == "P03") & (answers.round == 1), 2] = np.nan
    (found,) = analyse(replace(answers, ratings={"quality": ratings})).rated
    off = ratings[:, 1] - ratings[:, 2]
    means = [np.nanmean(off[answers.person == person]) for person in dict.fromkeys(answers.person)]
    (pair,) = [one for one in found.pairs if (one.first, one.second) == ("FDVV", "FD")]
    assert_allclose(pair.test.p_exact, signed_rank(means).p_exact)
    assert_allclose(pair.test.shift, signed_rank(means).shift)
    assert found.unpaired == 3


def test_a_singular_ordinal_fit_says_so_and_has_no_correlation() -> None:
    found = analyse(realism(6, 2, ("Clear",)))
    model = found.scales[0].model
    assert model.correlation is None
    assert "the fit is singular" in model.singular
    assert any(model.singular in note for note in found.notes)
    assert model.singular.split(":")[0] in scale_sentence(found.scales[0]).replace("\u00a0", " ")


def test_the_plan_decides_what_the_main_claim_is() -> None:
    # two buttons and few people tell what the claim is as well
    answers, declared = realism(6, 2, ("Clear", "Dome")), plan()
    assert declared.claim is not None
    found = analyse(answers, declared)
    assert found.claim is not None
    assert found.claim.registered
    assert found.claim.claim == declared.claim
    assert not analyse(answers).claim.registered  # type: ignore[union-attr]


def test_the_claim_is_tested_on_the_numbers_that_power_was_planned_with() -> None:
    answers = with_missing()
    found = analyse(answers)
    assert found.claim is not None
    _, scores = claim_scores(found.screening.answers, found.claim.claim)
    scores = scores[np.isfinite(scores)]
    assert found.claim.test.n == scores.size
    assert_allclose(found.claim.test.p_exact, wilcoxon(scores[scores != 0], method="exact").pvalue)


def test_shares_count_people_as_people_and_say_what_they_would_be_otherwise() -> None:
    found = analyse(choices_only("2ac")).preference
    assert found is not None
    assert found.more_count + found.equal_count + found.less_count == found.share.n == 80
    assert found.people_share is not None
    assert found.interval.people == 10
    assert_allclose(found.split, found.share.share + found.equal_count / 160)
    assert found.d[0].people == 10
    assert found.d[-1].people is None


def test_abx_is_analysed_by_both_rules_and_2afc_by_the_normal_quantile() -> None:
    abx = analyse(right_or_wrong("abx")).preference
    assert abx is not None
    assert (abx.more, abx.less) == ("right", "wrong")
    assert [one.method.split(",")[:2] for one in abx.d[1:]] == [
        ["abx", " differencing"], ["abx", " independent"]
    ]  # fmt: skip
    forced = analyse(right_or_wrong("2afc")).preference
    assert forced is not None
    assert_allclose(forced.d[-1].d, np.sqrt(2) * norm.ppf(forced.share.share))


def test_mushra_ranks_all_renderings_and_tests_every_pair() -> None:
    found = analyse(mushra())
    assert [one.button for one in found.rated] == ["", "Clear", "Red"]
    whole = found.rated[0]
    assert list(whole.spreads) == ["reference", "FDVV", "FD", "anchor"]
    assert whole.friedman is not None
    assert whole.friedman.mean_ranks[0] > whole.friedman.mean_ranks[3]
    assert len(whole.pairs) == 6


def test_staircases_find_about_what_they_were_made_with() -> None:
    found = analyse(staircase(threshold=0.08))
    assert len(found.thresholds) == 4
    assert found.threshold is not None
    assert 0.06 < found.threshold.mean < 0.11
    assert found.preference is None


def test_a_round_of_many_trials_is_a_staircase_of_its_own(tmp_path: Path) -> None:
    once = staircase(2)
    names = ("person", "item", "choice", "correct", "ratio")
    doubled: dict[str, Any] = {name: np.concatenate([getattr(once, name)] * 2) for name in names}
    twice = Answers("staircase", once.stimuli, round=np.repeat([0, 1], len(once.person)), **doubled)
    write_answers(tmp_path, twice)
    found, single = analyse(read_answers(tmp_path)).thresholds, analyse(once).thresholds
    assert [one.person for one in found] == ["P01", "P02"] * 2
    assert [one.threshold for one in found] == [one.threshold for one in single] * 2


def test_timing_is_tested_by_button_and_level() -> None:
    found = analyse(timing()).timing
    assert found is not None
    assert found.anova is not None
    assert found.measure_text == "asynchrony (ms)"
    assert [one.name for one in found.anova.effects] == ["button", "level", "button × level"]
    assert set(found.pairs) == {"all levels", "easy", "hard"}


def test_ordered_categories_agree_with_the_lean_that_ratings_have() -> None:
    (found,) = analyse(realism(6, 4, ("Clear",))).scales
    assert not found.model.problem
    assert found.model.of("FDVV").low > 0


@pytest.mark.parametrize(
    "answers",
    [
        *(pytest.param(one, id=name, marks=pytest.mark.slow) for name, one in EVERY_KIND.items()),
        *(pytest.param(one, id=name) for name, one in BROKEN.items()),
    ],
)
def test_every_kind_and_every_problem_is_written_as_json(answers: Answers) -> None:
    document = analysis_dict(analyse(answers))
    parsed = json.loads(json.dumps(finite(document), allow_nan=False))
    assert {"tests", "preference", "screening", "claim"} <= set(parsed)
    if parsed["preference"]:
        assert parsed["preference"]["low"] <= parsed["preference"]["share"] <= parsed["preference"]["high"]
    for test in parsed["tests"]:
        assert {"button", "statistic", "z", "p_asymptotic", "p_exact", "effect"} <= set(test)


def test_for_few_people_a_warning_says_that_nothing_can_be_significant() -> None:
    assert "One person is left" in analyse(realism(1, 2)).notes[0]
    assert "With 5 people no exact" in analyse(realism(5, 2, ("Clear",))).notes[0]
    assert not any("no exact" in note for note in analyse(realism(6, 2, ("Clear",))).notes)


def test_all_ties_speak_neither_for_nor_against() -> None:
    found = analyse(all_ties())
    assert found.claim is not None
    assert not found.claim.supported
    assert not found.claim.opposed
    assert found.preference is not None
    assert found.preference.split == 0.5
    assert found.preference.dropped is None


def test_nothing_answered_is_refused() -> None:
    answers = replace(realism(), choice=np.full(144, ""), ratings={})
    with pytest.raises(InputError, match="holds no answer"):
        analyse(answers)


def test_simulated_answers_say_so_in_the_json() -> None:
    document = analysis_dict(analyse(replace(right_or_wrong(), simulated=True)))
    assert document["simulated"]
    assert document["proxy"] == "simulated participants: a proxy, no evidence"
