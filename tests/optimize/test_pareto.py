"""Fronts of several objectives, and how one of them is chosen."""

from __future__ import annotations

import numpy as np
import pytest
from benchmarks.optimize_baselines import compared_engine
from hypothesis import given
from hypothesis import strategies as st

from fdvv.errors import InputError, ModelError
from fdvv_botorch.models import torch_there
from fdvv_people.optimize.engines.multi_objective import ParetoFront, believed_front, pareto_front
from fdvv_people.optimize.problem import Problem, Trial, TrialState
from fdvv_people.optimize.space import DesignSpace, Parameter
from fdvv_people.task.score import Objective, Score
from tests.optimize.problems import BOWL

TWO = Problem(BOWL, (Objective("asynchrony_ms"), Objective("hits", larger_is_better=True)), 1)
DESIGN = dict.fromkeys(BOWL.names, 0.0)


def trial(number: int, asynchrony_ms: float, hits: float) -> Trial:
    scores = {"asynchrony_ms": Score(asynchrony_ms, 1.0), "hits": Score(hits)}
    return Trial(number, DESIGN, TrialState.DONE, scores)


@given(st.lists(st.tuples(st.integers(0, 5), st.integers(0, 5)), min_size=1, max_size=12))
def test_a_front_is_what_no_other_beats(rows: list[tuple[int, int]]) -> None:
    trials = [trial(i, a, b) for i, (a, b) in enumerate(rows)]
    wanted = {
        i for i, (a, b) in enumerate(rows) if not any(c <= a and d >= b and (c, d) != (a, b) for c, d in rows)
    }
    assert {one.number for one in pareto_front(TWO, trials).trials} == wanted


FRONT = pareto_front(TWO, [trial(0, 60, 10), trial(1, 62, 18), trial(2, 80, 20), trial(3, 81, 9)])


def test_pickers_choose_as_they_say() -> None:
    assert [one.number for one in FRONT.trials] == [0, 1, 2]
    assert FRONT.values().tolist() == [[60, 10], [62, 18], [80, 20]]
    assert FRONT.knee().number == 1
    assert FRONT.weighted({"asynchrony_ms": 1.0}).number == 0
    assert FRONT.weighted({"hits": 1.0}).number == 2
    assert FRONT.within({"hits": 15}).number == 1
    assert FRONT.within({"asynchrony_ms": 70}).number == 1


def test_what_cannot_be_chosen_is_said() -> None:
    with pytest.raises(InputError, match="loosen"):
        FRONT.within({"hits": 21})
    with pytest.raises(InputError, match="colour"):
        FRONT.weighted({"colour": 1.0})
    with pytest.raises(InputError, match="above 0"):
        FRONT.weighted({"hits": 0.0})


def test_trials_without_every_score_are_no_part_of_a_front() -> None:
    half = Trial(9, DESIGN, TrialState.DONE, {"hits": Score(99.0)})
    assert pareto_front(TWO, [half, Trial(1, DESIGN)]).trials == ()


def test_what_lies_within_the_doubt_is_no_reason_to_give_anything_up() -> None:
    """The same values: hits that are known to within 1 are worth 20 ms, hits that may be 8 off are not."""

    def front(hits_error: float) -> ParetoFront:
        rows = [(60.0, 10.0), (80.0, 14.0), (90.0, 15.0)]
        return pareto_front(
            TWO,
            [
                Trial(
                    i, DESIGN, TrialState.DONE, {"asynchrony_ms": Score(a, 1.0), "hits": Score(b, hits_error)}
                )
                for i, (a, b) in enumerate(rows)
            ],
        )

    assert front(0.1).knee().number == 1
    assert front(8.0).knee().number == 0


def test_a_front_of_nothing_recommends_nothing() -> None:
    with pytest.raises(ModelError, match="no trial is done"):
        believed_front(TWO, []).knee()


def test_a_lucky_score_is_on_the_front_as_measured_and_not_as_believed() -> None:
    """A line of designs, better and better in both; one in the middle was lucky in both."""
    space = DesignSpace("line", (Parameter("x_mm", 0.0, 1.0),))
    two = Problem(space, TWO.objectives)
    trials = []
    for i, x in enumerate(np.linspace(0.0, 1.0, 15).tolist()):
        lucky = i == 4
        scores = {
            "asynchrony_ms": Score(90.0 - 40.0 * x - 35.0 * lucky, 15.0),
            "hits": Score(20.0 * x + 18.0 * lucky, 8.0),
        }
        trials.append(Trial(i, {"x_mm": x}, TrialState.DONE, scores))
    assert 4 in [one.number for one in pareto_front(two, trials).trials]
    expected = believed_front(two, trials)
    assert 4 not in [one.number for one in expected.trials]
    assert expected.knee().number >= 12


def front_of(name: str, count: int) -> tuple[int, float]:
    """Return the number of trials on a front after count, and the part of a box that it dominates."""
    two = Problem(BOWL, (Objective("near_mm2"), Objective("far_mm2")), 2)
    trials: list[Trial] = []
    for i in range(count):
        (design,) = compared_engine(name).suggest(two, trials)
        near, far = (sum((value - ideal) ** 2 for value in design.values()) for ideal in (0.0, 2.0))
        scores = {"near_mm2": Score(near), "far_mm2": Score(far)}
        trials.append(Trial(i, design, TrialState.DONE, scores))
    values = pareto_front(two, trials).values()
    box = np.random.default_rng(0).random((4000, 2)) * 12.0
    return len(values), float(np.any(np.all(values[None] <= box[:, None], axis=2), axis=1).mean())


@pytest.mark.parametrize("name", ["gp", "botorch"])
def test_an_engine_of_several_objectives_covers_more_than_chance(name: str) -> None:
    if name == "botorch" and not torch_there():
        pytest.skip("botorch is not installed")
    assert front_of(name, 25)[1] > front_of("random", 25)[1]


@pytest.mark.parametrize("name", ["tpe", "nsga2"])
def test_samplers_take_several_objectives(name: str) -> None:
    assert front_of(name, 25)[0] > 2
