"""A study of thresholds from its file to its report, with simulated participants."""

from __future__ import annotations

import csv
import dataclasses
from pathlib import Path

import numpy as np
import pytest
from msgspec.structs import replace

from fdvv.model.file import load_builtin
from fdvv_people.study.admin.preview import preview_sections
from fdvv_people.study.admin.review import device_problems, review_plan, twin_problems
from fdvv_people.study.analysis.analyse import analyse
from fdvv_people.study.analysis.code_book import write_answers
from fdvv_people.study.analysis.export import JNDS_FILE, analysis_dict, write_analysis
from fdvv_people.study.analysis.jnds import standard_sizes, standards_of
from fdvv_people.study.analysis.read_answers import read_answers
from fdvv_people.study.analysis.report import study_html, study_summary
from fdvv_people.study.plan.answers import Answers
from fdvv_people.study.plan.plan import OfDimensions, Thresholds
from fdvv_people.study.plan.plan_check import plan_problems
from fdvv_people.study.plan.plan_file import read_plan_text, template_text
from fdvv_people.study.plan.schedule import draw_schedule
from fdvv_people.study.plan.threshold_trials import largest_change, practice_change
from tests.study.test_jnd_record import played
from tests.support.study_people import PASSPHRASE

PLAN = read_plan_text(template_text("thresholds"), "thresholds")
RULE = PLAN.thresholds or Thresholds()


LAPSE_ratio = 0.03


def answered(people: int = 2, trials: int = 40, jnd_ratio: float = 0.1) -> Answers:
    """Return answers about force alone, of people with one JND, who lapse now and then."""
    from scipy.special import ndtr

    random = np.random.default_rng(people)
    change = np.zeros((people * trials, 3))
    change[:, 0] = random.choice([0.5, 1.0, 2.0, 3.0], len(change)) * jnd_ratio
    share = 0.5 * LAPSE_ratio + (1 - LAPSE_ratio) * ndtr(0.6745 * change[:, 0] / jnd_ratio)
    right = random.random(len(change)) < share
    return Answers(
        "thresholds",
        ("standard", "comparison"),
        person=np.repeat([f"P{n + 1:02d}" for n in range(people)], trials),
        item=np.full(len(change), "MX Clear"),
        round=np.zeros(len(change), int),
        choice=np.where(right, "comparison", "standard"),
        correct=right.astype(float),
        change=change,
    )


def test_the_template_can_be_run_on_the_twin_and_on_a_device(tmp_path: Path) -> None:
    assert plan_problems(PLAN) == ()
    look = review_plan(PLAN, tmp_path)
    assert look.problems == ()
    assert twin_problems(PLAN, tmp_path) == device_problems(PLAN, tmp_path) == ()
    text = " ".join(line for section in preview_sections(look) for line in section.paragraphs)
    assert "54 trials" in text
    assert "75.0 % correct" in text


@pytest.mark.parametrize(
    ("change", "problem"),
    [
        ({"thresholds": None}, "thresholds: there is none"),
        ({"rounds": 2}, "rounds: thresholds have one"),
        ({"kind": "2afc"}, "thresholds: 2afc has none"),
        ({"thresholds": replace(RULE, dimensions=())}, "dimensions: there is none"),
        ({"thresholds": replace(RULE, dimensions=("snap", "snap"))}, "the same name"),
        (
            {"thresholds": replace(RULE, largest_ratio=OfDimensions(force=0.1, snap=1, vibration=1))},
            "force 0.1 is below the expected JND of 0.12",
        ),
    ],
)
def test_what_cannot_be_measured_is_named(change: dict[str, object], problem: str) -> None:
    assert any(problem in one for one in plan_problems(replace(PLAN, **change)))


def test_a_button_without_a_snap_or_a_vibration_is_refused(tmp_path: Path) -> None:
    (item,) = PLAN.items
    stimuli = tuple(replace(one, button="mx-brown") for one in item.stimuli)
    plan = replace(PLAN, items=(replace(item, stimuli=stimuli),))
    assert any("no vibration" in one for one in review_plan(plan, tmp_path).problems)
    without = replace(plan, thresholds=replace(RULE, dimensions=("force", "snap")))
    assert review_plan(without, tmp_path).problems == ()


def test_practice_shows_each_dimension_in_turn_and_trials_are_as_many_as_planned() -> None:
    trials = draw_schedule(PLAN, 0, np.random.default_rng(0))
    assert [int(np.flatnonzero(one.change)[0]) for one in trials if one.practice] == [0, 1, 2]
    assert sum(not one.practice for one in trials) == RULE.trials
    both = Thresholds(dimensions=("snap", "force"))
    assert np.flatnonzero(practice_change(both, 0)).tolist() == [1]
    assert largest_change(both) == (1.0, 2.0, 0.0)


def test_answers_find_the_jnd_that_they_were_made_with() -> None:
    found = analyse(answered(8, 60))
    assert list(found.jnd) == ["force"]
    assert found.jnd["force"].mean == pytest.approx(0.1, rel=0.3)
    held = [one.jnds["force"].low <= 0.1 <= one.jnds["force"].high for one in found.jnds]
    assert np.mean(held) > 0.7
    assert found.jnds[0].trials == 60
    assert found.claim is None
    assert found.preference is None
    assert "Three of four comparisons notice force" in study_summary(found)
    assert "Next: let a project judge by these figures (fdvv study jnds); " in study_summary(found)


def test_trials_that_do_not_count_change_nothing() -> None:
    whole = answered(1)
    excluded = np.where(np.arange(40) < 10, "device fault", "")
    part = dataclasses.replace(whole, excluded=excluded)
    shorter = Answers(
        whole.kind, whole.stimuli, whole.person[10:], whole.item[10:], whole.round[10:], whole.choice[10:],
        whole.correct[10:], change=whole.change[10:] if whole.change is not None else None,
    )  # fmt: skip
    assert analyse(part).jnds[0].jnds == analyse(shorter).jnds[0].jnds


def test_answers_are_read_as_they_were_written(tmp_path: Path) -> None:
    once = answered()
    write_answers(tmp_path, once)
    again = read_answers(tmp_path)
    assert again.kind == "thresholds"
    assert again.change is not None
    np.testing.assert_array_equal(again.change, once.change)
    assert analyse(again).jnds[0].jnds == analyse(once).jnds[0].jnds
    # without the code book the columns tell
    assert read_answers(tmp_path.rename(tmp_path.with_name("x")) / "answers.csv").kind == "thresholds"


def test_jnds_are_in_the_units_of_the_button() -> None:
    sizes = standard_sizes(load_builtin("mx-clear"))
    assert sizes["force"] > sizes["snap"] > 0
    assert sizes["vibration"] == pytest.approx(4.6, rel=0.5)
    assert list(standard_sizes(load_builtin("mx-red"))) == ["force"]
    assert standards_of(PLAN, Path()) == {"MX Clear": sizes}


def test_simulated_participants_play_it_to_a_report_that_says_so(tmp_path: Path) -> None:
    study = played(tmp_path, "thresholds", trials="8")
    standards = standards_of(study.plan, study.folder)
    found = analyse(read_answers(study.folder), study.plan, standards=standards)
    assert [one.trials for one in found.jnds] == [8, 8]
    assert len(found.jnds[0].surfaces) == 3
    assert study.verify(passphrase=PASSPHRASE) == ()
    html = study_html(found, study.plan)
    assert "Simulated." in html
    assert "Just noticeable differences" in html
    assert html.count("<svg") >= 4
    (tmp_path / "out").mkdir()
    files = write_analysis(tmp_path / "out", found)
    assert [path.name for path in files][-1] == JNDS_FILE
    rows = list(csv.DictReader((tmp_path / "out" / JNDS_FILE).read_text().splitlines()))
    assert len(rows) == 6
    assert {row["unit"] for row in rows} == {"cN", "m/s²"}
    assert {row["simulated"] for row in rows} == {"1"}
    for row in rows:
        size = found.standards["MX Clear"][row["dimension"]]  # type: ignore[index]
        assert float(row["jnd"]) == pytest.approx(float(row["jnd_ratio"]) * size)
    assert len(analysis_dict(found)["jnds"]) == 2
