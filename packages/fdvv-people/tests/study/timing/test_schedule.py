"""Orders of conditions: balanced over the study, and secret."""

from __future__ import annotations

from collections import Counter
from itertools import pairwise
from pathlib import Path

import msgspec

from fdvv_people.study.admin.study import Study
from fdvv_people.study.plan.plan_file import write_template
from fdvv_people.study.timing.kind import KIND
from fdvv_people.study.timing.schedule import draw_validation, faces_of, level_order
from tests.support.timing import SMALL

PLAN = KIND.read_plan(SMALL, "small")


def blocks(people: int, secret: str) -> list[list[str]]:
    """Return the conditions of every round of a level, in the order they are pressed in."""
    found = []
    for place in range(people):
        names = [name for one in draw_validation(PLAN, place, secret) for name in one.labels.values()]
        size = len(PLAN.conditions)
        found += [names[i : i + size] for i in range(0, len(names), size)]
    return found


def test_every_round_has_every_condition_once() -> None:
    names = sorted(one.name for one in PLAN.conditions)
    assert all(sorted(block) == names for block in blocks(4, "s"))


def test_in_whole_passes_each_has_each_place_and_follows_each_other_one_equally_often() -> None:
    # four conditions have a design of four rows; four people have eight rounds: two passes
    found = blocks(4, "s")
    places = Counter((i, name) for block in found for i, name in enumerate(block))
    follows = Counter(pair for block in found for pair in pairwise(block))
    assert set(places.values()) == {2}
    assert len(places) == 16
    assert set(follows.values()) == {2}
    assert len(follows) == 12


def test_without_the_secret_the_place_does_not_tell_the_order() -> None:
    first = Counter(blocks(1, f"secret {i}")[0][0] for i in range(400))
    # each of four comes first in about 100 of 400 studies
    assert all(60 < count < 140 for count in first.values())
    assert len(first) == 4


def test_the_shipped_study_is_balanced_exactly_with_the_people_it_plans(tmp_path: Path) -> None:
    plan = Study.open(write_template("timing", tmp_path / "s").parent).plan
    trials = [draw_validation(plan, place, "s") for place in range(plan.people)]
    names = [[name for one in found for name in one.labels.values()] for found in trials]
    places = Counter((i % 6, name) for found in names for i, name in enumerate(found))
    assert set(places.values()) == {plan.people * 4 // 6}


def test_levels_are_met_the_other_way_round_by_every_second_person() -> None:
    assert level_order(PLAN, 0) == ("easy", "hard")
    assert level_order(PLAN, 1) == ("hard", "easy")


def test_a_code_is_never_met_twice_and_hides_what_is_rendered() -> None:
    trials = draw_validation(PLAN, 0, "s")
    codes = [code for one in trials for code in one.labels]
    assert len(set(codes)) == len(codes) == 8
    faces = faces_of(PLAN, 0, trials)
    assert [one.phase for one in faces] == ["training"] * 4 + ["validation"] * 8
    assert [one.number for one in faces] == list(range(12))
    public = msgspec.json.encode([one for one in faces if one.hand == "button"]).decode()
    assert not any(name in public for name in ("optimised", "MX Red", "random"))
    assert {one.switch for one in faces if one.hand == "switch"} == {"table"}
