"""Plans of timing studies: what is read, what is refused, and what ships."""

from __future__ import annotations

from pathlib import Path

import msgspec
import pytest

from fdvv.errors import InputError
from fdvv_people.study.admin.study import Study
from fdvv_people.study.plan.plan_file import write_template
from fdvv_people.study.timing.kind import KIND
from fdvv_people.study.timing.plan import Condition, TimingClaim, TimingPlan
from fdvv_people.study.timing.plan_check import plan_problems
from tests.support.timing import SMALL, declared

PLAN = KIND.read_plan(SMALL, "small")


def test_the_shipped_timing_study_is_the_papers(tmp_path: Path) -> None:
    plan = Study.open(write_template("timing", tmp_path / "s").parent).plan
    assert plan.training is not None
    assert (plan.training.trials, plan.presses, plan.rounds, plan.gap_days) == (27, 20, 2, 7.0)
    assert [one.kind for one in plan.conditions] == ["optimised", *["button"] * 4, "random"]
    # 10 people gave the paper's 240 observations of mean asynchrony
    assert 10 * (plan.trials - plan.training_trials) == 240


def changed(**changes: object) -> TimingPlan:
    return msgspec.structs.replace(PLAN, **changes)


def with_condition(**fields: object) -> TimingPlan:
    return changed(conditions=(*PLAN.conditions, Condition(name="more", **fields)))  # type: ignore[arg-type]


@pytest.mark.parametrize(
    ("plan", "place"),
    [
        (changed(conditions=PLAN.conditions[:1]), "conditions"),
        (changed(levels=()), "levels"),
        (changed(reminder={}), "reminder"),
        (changed(reminder={"en": "{when}"}), "reminder, en"),
        (changed(due_days=1.0), "due_days"),
        (changed(training=None), "conditions ('optimised')"),
        (changed(task="tapping"), "levels"),
        (changed(claim=TimingClaim(better="best")), "claim"),
        (changed(claim=TimingClaim(better="random", than=("random",))), "claim"),
        (changed(claim=TimingClaim(better="random", at_least_Hz=8.0)), "claim"),
        (with_condition(kind="button", button="mx-none"), "conditions ('more')"),
        (with_condition(kind="button", button="mx-red", key="Space"), "conditions ('more')"),
        (with_condition(kind="switch", button="mx-red"), "conditions ('more')"),
        (with_condition(kind="key", button="mx-red", latency_ms=3.0), "conditions ('more')"),
        (with_condition(kind="program", button="fast-tapping"), "conditions ('more')"),
        (with_condition(kind="random"), "conditions"),
        (with_condition(kind="optimised", button="mx-red"), "conditions ('more')"),
    ],
)
def test_a_plan_that_could_not_be_run_is_refused_by_place(plan: TimingPlan, place: str) -> None:
    assert plan_problems(PLAN) == ()
    assert any(problem.startswith(f"{place}: ") for problem in plan_problems(plan)), plan_problems(plan)


def test_a_file_that_is_not_there_is_refused_when_the_study_is_declared(tmp_path: Path) -> None:
    with pytest.raises(InputError, match=r"own\.fdvv\.json"):
        declared(tmp_path / "study", SMALL.replace('"mx-red"', '"own.fdvv.json"'))
    assert not (tmp_path / "study").exists()
