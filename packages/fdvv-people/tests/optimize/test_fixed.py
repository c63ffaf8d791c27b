"""The best fixed designs that are shipped: made by the benchmark, and what they say they are."""

from __future__ import annotations

import json

import numpy as np
import pytest
from benchmarks.fixed_design import CHOOSE, FILE, JUDGE, SEED, Score, people_of
from benchmarks.optimize_people import FIRST_SEED
from benchmarks.people_who_differ import SEED as JUDGING_SEED

from fdvv_people.optimize.button_constraints import button_constraints
from fdvv_people.optimize.paper_space import paper_space
from fdvv_people.optimize.people.fixed import fixed_design
from fdvv_people.optimize.people.groups import GROUPS
from fdvv_people.task.pointing import LEVELS_px_s

CASES = [(group, level) for group in GROUPS for level in LEVELS_px_s]


@pytest.mark.parametrize(("group", "level"), CASES)
def test_a_fixed_design_is_a_button_and_scores_what_its_file_says(group: str, level: str) -> None:
    found = fixed_design(group, level)
    assert found is not None
    space = paper_space(button_constraints())
    assert space.broken(space.nearest(found.design)) == ()
    assert space.nearest(found.design) == pytest.approx(found.design, abs=1e-3)
    judges = people_of(group, judging=True)
    assert len(found.judged_ms) == len(judges)
    again = Score(level, judges[:2])(found.design)
    assert again == pytest.approx(found.judged_ms[:2], abs=0.02)
    assert found.mean_ms == pytest.approx(float(np.mean(found.judged_ms)))


def test_nobody_who_judges_an_engine_has_a_part_in_it() -> None:
    assert SEED != JUDGING_SEED
    assert SEED < FIRST_SEED
    chose, judged = ({one.number for one in people_of("paper", judging=judging)} for judging in (False, True))
    assert (len(chose), len(judged)) == (CHOOSE, JUDGE)
    assert not chose & judged


def test_the_file_says_that_it_is_simulated_and_how_it_was_made() -> None:
    record = json.loads(FILE.read_text())
    assert record["simulated"] is True
    assert record["command"] == "python -m benchmarks.fixed_design"


def test_what_is_not_known_is_none() -> None:
    assert fixed_design("paper", None) is None
    assert fixed_design("nobody", "easy") is None
