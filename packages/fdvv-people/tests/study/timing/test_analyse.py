"""The statistics of a validation beside known effects, and what is said of them."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import msgspec
import pytest

from fdvv.errors import ModelError
from fdvv_people.study.admin.study import Study
from fdvv_people.study.plan.plan_file import write_template
from fdvv_people.study.timing import paper
from fdvv_people.study.timing.analyse import analyse_timing, people_needed
from fdvv_people.study.timing.kind import KIND
from fdvv_people.study.timing.plan import TimingClaim, TimingPlan
from fdvv_people.study.timing.report import timing_dict, timing_html
from fdvv_people.study.timing.scores import TimingScores, read_scores, scores_text
from fdvv_people.study.timing.sentences import next_sentence, strokes_sentence, verdict_sentence
from tests.support.timing import SMALL
from tests.support.timing_scores import made_scores

PLAN = msgspec.structs.replace(KIND.read_plan(SMALL, "small"), rounds=2, people=10)


def test_an_effect_that_is_there_is_found_with_its_size() -> None:
    found = analyse_timing(made_scores(PLAN, 10, 15.0))
    assert found.holds
    for one in found.rivals:
        assert one.mixed.value.low is not None
        assert one.mixed.value.high is not None
        assert one.mixed.value.low < -15.0 < one.mixed.value.high
        assert one.flip_p == pytest.approx(2 / 1024)
    assert found.anova is not None
    assert found.anova.people == 10
    assert found.rounds_anova is not None
    # as the paper counts: 10 people of 2 rounds are 20
    assert found.rounds_anova.of("button").error_df == 3 * 19
    assert verdict_sentence(found).startswith("the claim holds: optimised has a smaller mean asynchrony than")


def test_no_effect_is_not_called_one() -> None:
    wrong = sum(bool(analyse_timing(made_scores(PLAN, 8, 0.0, seed)).holds) for seed in range(3))
    assert wrong == 0


def test_a_button_that_is_worse_does_not_hold_the_claim() -> None:
    found = analyse_timing(made_scores(PLAN, 10, -15.0))
    assert found.holds is False
    assert "a worse score than" in verdict_sentence(found)


def test_who_is_not_complete_counts_in_the_mixed_model_only() -> None:
    scores = made_scores(PLAN, 10, 15.0)
    rows = (replace(scores.rows[0], excluded="its button could not be rendered"), *scores.rows[1:])
    found = analyse_timing(TimingScores(PLAN, rows))
    assert found.anova is not None
    assert found.anova.people == 9
    assert found.model is not None
    assert found.model.people == 10
    assert any("P01" in note for note in found.notes)


def test_of_two_people_nothing_is_claimed() -> None:
    found = analyse_timing(made_scores(PLAN, 2, 15.0))
    assert found.holds is None
    assert found.notes
    assert "could not be tested" in verdict_sentence(found)


def test_without_a_score_there_is_nothing_to_analyse() -> None:
    with pytest.raises(ModelError):
        analyse_timing(TimingScores(PLAN, ()))


def test_the_next_step_is_to_go_on_to_plan_or_to_report() -> None:
    assert "a look in between" in next_sentence(analyse_timing(made_scores(PLAN, 6, 15.0)))
    assert next_sentence(analyse_timing(made_scores(PLAN, 10, 15.0))).startswith("Report the contrasts")
    assert "evidence" in next_sentence(analyse_timing(made_scores(PLAN, 10, 15.0, simulated=True)))
    assert "plan that as a new study" in next_sentence(analyse_timing(made_scores(PLAN, 10, 2.0)))


def test_more_people_are_needed_for_less_of_a_difference() -> None:
    large, small = (analyse_timing(made_scores(PLAN, 10, gain)).rivals[0] for gain in (15.0, 5.0))
    assert (people_needed(large, 10) or 0) < (people_needed(small, 10) or 0)


def test_scores_come_back_from_their_table(tmp_path: Path) -> None:
    scores = made_scores(PLAN, 3, 5.0)
    (tmp_path / "scores.csv").write_text(scores_text(scores.rows))
    again = read_scores(tmp_path / "scores.csv", PLAN)
    assert [row.score for row in again.rows] == pytest.approx([row.score for row in scores.rows], rel=1e-5)
    assert [replace(row, score=0.0) for row in again.rows] == [replace(row, score=0.0) for row in scores.rows]


def test_the_report_has_the_papers_figures_beside_its_own_and_marks_what_is_simulated(tmp_path: Path) -> None:
    plan = Study.open(write_template("timing", tmp_path / "s").parent).plan
    found = analyse_timing(made_scores(plan, 10, 15.0, simulated=True))
    html = timing_html(found, tmp_path, "a test")
    for words in ("Simulated:", "Simulated. Mean asynchrony beside", "65.8", "108.22", "F(5, 95) = 10.724"):
        assert words in html
    assert "Simulated. Contrasts of the mixed model." in html
    measured = timing_html(analyse_timing(made_scores(plan, 10, 15.0)), tmp_path, "a test")
    assert "imulated" not in measured
    assert timing_dict(found)["simulated"] is True


def test_what_is_cited_of_the_paper_is_its_text_where_that_is_at_hand(tmp_path: Path) -> None:
    plan = Study.open(write_template("timing", tmp_path / "s").parent).plan
    cited = [paper.cited(one, level) for level in plan.levels for one in plan.conditions]
    assert all(cited)
    path = Path(__file__).resolve().parents[5].parent / "shared/paper/button-simulation-fdvv-chi2020.tex"
    if not path.is_file():
        pytest.skip("the paper's text is not at hand")
    text = path.read_text(errors="replace")
    for mean, std in filter(None, cited):
        assert f"{mean:g}" in text
        assert f"{std:g}" in text


def tapping(at_least_Hz: float) -> TimingPlan:
    plan = msgspec.structs.replace(PLAN, task="tapping", levels=(), training=None, rounds=3)
    return msgspec.structs.replace(
        plan, conditions=plan.conditions[1:3], claim=TimingClaim(better="MX Red", at_least_Hz=at_least_Hz)
    )


def test_a_claimed_rate_is_reached_missed_or_open() -> None:
    scores = made_scores(tapping(8.0), 10, -20.0)
    rate = analyse_timing(scores).rate
    assert rate is not None
    assert rate.rate_Hz.value > 100
    assert rate.reached
    assert analyse_timing(scores).holds
    for at_least, word in ((rate.rate_Hz.value, "may or may not reach"), (200.0, "does not reach")):
        found = analyse_timing(TimingScores(tapping(at_least), scores.rows))
        assert found.holds is False
        assert word in verdict_sentence(found)


def test_keys_that_the_button_pressed_are_no_strokes(tmp_path: Path) -> None:
    scores = made_scores(tapping(8.0), 5, -20.0)
    assert strokes_sentence(analyse_timing(scores)) == ""
    rows = tuple(
        replace(row, strokes_Hz=row.score * (0.5 if row.condition == "MX Red" else 0.99))
        for row in scores.rows
    )
    found = analyse_timing(TimingScores(scores.plan, rows))
    mean = found.means[0].mean
    assert strokes_sentence(found).endswith(f"The finger made {mean / 2:.2f} on MX Red a second.")
    assert f"by {mean / 2:.2f} strokes of the finger, reaches the claimed 8" in verdict_sentence(found)
    assert strokes_sentence(found) in timing_html(found, tmp_path, "a test")
