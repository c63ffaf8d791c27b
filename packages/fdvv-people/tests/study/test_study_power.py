"""The power of a plan's claim, from its file."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from fdvv.errors import InputError
from fdvv_people.study.plan.plan import Stimulus, StudyPlan
from fdvv_people.study.plan.plan_file import write_template
from fdvv_people.study.simulation.perception import Senses, haptic_features, perceived_difference
from fdvv_people.study.simulation.study_power import open_plan, power_design, reference_of, study_power
from fdvv_people.study.stimulus.renderer import stimulus_model


@pytest.fixture
def study(tmp_path: Path) -> Path:
    """Return the shipped study as a file."""
    return write_template("realism", tmp_path)


def kind(tmp_path: Path, name: str) -> tuple[StudyPlan, Path]:
    return open_plan(write_template(name, tmp_path / name))


def test_the_papers_study_is_planned_from_its_file_and_says_that_it_is_simulated(study: Path) -> None:
    found = study_power(study, [6, 12], studies=100)
    parsed = json.loads(json.dumps(found.to_dict()))
    assert parsed["simulated"] is True
    assert [row["people"] for row in parsed["rows"]] == [6, 12]
    assert parsed["items"][0]["item"] == "MX Clear"
    for one in parsed["items"]:
        assert one["for"] + one["equal"] + one["against"] == pytest.approx(1)
    power = parsed["rows"][1]["power"]
    assert power["low"] <= power["value"] <= power["high"]


def test_what_is_compared_is_what_would_be_rendered(study: Path) -> None:
    plan, folder = open_plan(study)
    effect = power_design(plan, folder).effects[1]
    fd, fdvv = (haptic_features(stimulus_model(one, folder)) for one in plan.items[1].stimuli)
    assert effect.between == perceived_difference(fdvv, fd)
    assert effect.more.total_JND == 0  # X is taken to be the button as its whole model has it
    assert effect.less == perceived_difference(fd, fdvv)


def test_duller_senses_find_smaller_differences(study: Path) -> None:
    plan, folder = open_plan(study)
    sharp, dull = (power_design(plan, folder, Senses(weber_ratio=one)) for one in (0.05, 0.2))
    for one, other in zip(sharp.effects, dull.effects, strict=True):
        assert one.between.force_JND == pytest.approx(4 * other.between.force_JND)


def test_one_difference_for_all_may_be_assumed(study: Path) -> None:
    found = study_power(study, [8], studies=8, given_JND=1.0)
    assert {effect.between.total_JND for effect in found.table.design.effects} == {1.0}
    assert found.to_dict()["given_JND"] == 1.0


def test_a_rating_is_planned_on_its_own_scale(tmp_path: Path) -> None:
    plan, folder = kind(tmp_path, "mushra")
    design = power_design(plan, folder)
    assert design.points == 101
    assert (
        reference_of(plan, plan.items[0], Stimulus(name="any", button="mx-red")) == plan.items[0].stimuli[0]
    )


def test_abx_claims_that_both_can_be_distinguished(tmp_path: Path) -> None:
    design = power_design(*kind(tmp_path, "abx"))
    assert design.alpha == 0.05
    assert all(effect.between.total_JND > 0 for effect in design.effects)


def test_what_2afc_asks_for_must_be_what_is_claimed(tmp_path: Path) -> None:
    path = write_template("2afc", tmp_path)
    text = (
        path.read_text()
        .replace('more = "heavier"', 'more = "as made"')
        .replace('less = "as made"', 'less = "heavier"')
    )
    path.write_text(text)
    with pytest.raises(InputError, match="the second stimulus"):
        power_design(*open_plan(path))
