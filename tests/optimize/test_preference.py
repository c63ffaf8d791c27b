"""Comparisons of two designs."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.optimize import minimize
from scipy.stats import norm

from fdvv.errors import ModelError
from fdvv_botorch.models import torch_there
from fdvv_people.optimize.engines.preference import NOISE, believe_choices
from fdvv_people.optimize.engines.registry import engine_of, pair_engine_names
from fdvv_people.optimize.problem import Answer, Engine, Problem, Trial, TrialState
from fdvv_people.optimize.space import Design
from tests.optimize.problems import BOWL, HELD, bowl_ms, problem

NO_TORCH = pytest.mark.skipif(not torch_there(), reason="botorch is not installed")
NAMES = [pytest.param(n, marks=NO_TORCH if n.endswith("botorch") else ()) for n in pair_engine_names()]


@pytest.fixture(params=NAMES)
def engine(request: pytest.FixtureRequest) -> Engine:
    return engine_of(request.param)


def pair(number: int, first: Design, second: Design, answer: Answer | None = None) -> Trial:
    if answer is None:
        return Trial(number, dict(first), beside=(dict(second),))
    return Trial(number, dict(first), TrialState.DONE, beside=(dict(second),), best=answer.best)


def compared(case: Problem, engine: Engine, count: int) -> list[Trial]:
    """Let somebody answer who likes a low bowl, and sees no difference below 1 ms."""
    found: list[Trial] = []
    for number in range(count):
        first, second = engine.suggest(case, found)
        gap = bowl_ms(second) - bowl_ms(first)
        answer = Answer.EQUAL if abs(gap) < 1.0 else Answer.FIRST if gap > 0 else Answer.SECOND
        found.append(pair(number, first, second, answer))
    return found


def test_pairs_replay_differ_and_hold_the_constraints(engine: Engine) -> None:
    case = problem(HELD, seed=3)
    found = compared(case, engine, 5)
    assert found == compared(case, engine_of(engine.name), 5)
    for one in found:
        first, second = one.designs
        assert first != second
        assert HELD.broken(first) == HELD.broken(second) == ()
    asked = {frozenset(tuple(design.values()) for design in one.designs) for one in found}
    assert len(asked) == 5


def test_a_favourite_is_found_in_ten_comparisons(engine: Engine) -> None:
    everywhere = np.array([bowl_ms(d) for d in BOWL.of_unit(np.random.default_rng(4).random((2000, 3)))])
    ranks = []
    for seed in range(7 if engine.name == "preference" else 3):
        case = problem(seed=seed)
        best = engine.best(case, compared(case, engine, 10))
        ranks.append(float((everywhere < bowl_ms(best)).mean()))
    assert np.median(ranks) < 0.1


def test_nothing_is_recommended_before_an_answer(engine: Engine) -> None:
    first, second = BOWL.of_unit([[0.1] * 3, [0.9] * 3])
    unanswered = pair(0, first, second)
    with pytest.raises(ModelError):
        engine.best(problem(), [unanswered])
    assert engine.suggest(problem(), [unanswered])[0] not in unanswered.designs


def test_equal_answers_alone_prefer_nobody(engine: Engine) -> None:
    a, b, c = BOWL.of_unit([[0.1] * 3, [0.9] * 3, [0.5, 0.1, 0.9]])
    same = [pair(0, a, b, Answer.EQUAL), pair(1, b, c, Answer.EQUAL)]
    assert engine.best(problem(), same) in (a, b, c)
    first, second = engine.suggest(problem(), same)
    assert first != second


def test_the_worths_are_the_most_probable_ones() -> None:
    a, b, c = BOWL.of_unit([[0.1] * 3, [0.9] * 3, [0.5, 0.1, 0.9]])
    answers = [(a, b, Answer.FIRST), (b, c, Answer.EQUAL), (c, a, Answer.SECOND), (a, b, Answer.SECOND)]
    belief = believe_choices(BOWL, [pair(i, x, y, z) for i, (x, y, z) in enumerate(answers)])
    assert belief is not None
    K = belief._kernel(belief.places)

    def cost(worth: np.ndarray[tuple[int], np.dtype[np.float64]]) -> float:
        fa, fb, fc = worth
        gaps = [(fa - fb, 1.0), (fb - fc, 0.5), (fc - fb, 0.5), (fa - fc, 1.0), (fb - fa, 1.0)]
        likely = sum(w * norm.logcdf(g / (np.sqrt(2) * NOISE)) for g, w in gaps)
        return float(0.5 * worth @ np.linalg.solve(K, worth) - likely)

    wanted = minimize(cost, np.zeros(3), tol=1e-12).x
    np.testing.assert_allclose(belief.mean(belief.places), wanted, atol=1e-4)
