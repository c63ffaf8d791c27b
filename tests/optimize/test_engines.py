"""What every engine keeps, whatever it believes."""

from __future__ import annotations

import time
from dataclasses import replace

import numpy as np
import pytest
from benchmarks.optimize_baselines import BASELINES, compared_engine

from fdvv.errors import InputError, ModelError
from fdvv_botorch.models import torch_there
from fdvv_people.optimize.engines.registry import engine_names, engine_of
from fdvv_people.optimize.paper_space import paper_space
from fdvv_people.optimize.problem import Engine, Problem, Trial, TrialState
from fdvv_people.optimize.space import Constraint, DesignSpace
from fdvv_people.task.score import Objective, Score
from tests.optimize.problems import BOWL, HELD, bowl_ms, problem, run, scored

NO_TORCH = pytest.mark.skipif(not torch_there(), reason="botorch is not installed")
NAMES = [
    *(pytest.param(name, marks=NO_TORCH if name == "botorch" else ()) for name in engine_names()),
    *BASELINES,
]
STARTED = [
    scored(i, d, bowl_ms(d)) for i, d in enumerate(BOWL.of_unit(np.random.default_rng(3).random((12, 3))))
]


@pytest.fixture(params=NAMES)
def engine(request: pytest.FixtureRequest) -> Engine:
    return compared_engine(request.param)


def test_the_same_problem_and_trials_give_the_same_suggestion(engine: Engine) -> None:
    for trials in ([], STARTED):
        first, again = (compared_engine(engine.name).suggest(problem(), trials, 2) for _ in range(2))
        assert first == again


def test_another_seed_suggests_otherwise(engine: Engine) -> None:
    assert engine.suggest(problem(seed=0), []) != engine.suggest(problem(seed=1), [])


def test_a_batch_differs_in_itself_and_from_what_was_tried(engine: Engine) -> None:
    designs = engine.suggest(problem(), STARTED, 4)
    places = BOWL.to_unit([*designs, *(trial.design for trial in STARTED)])
    apart = np.abs(places[:, None] - places[None]).max(axis=2) + np.eye(len(places))
    assert apart.min() > 1e-6


def test_a_trial_under_way_is_not_suggested_again(engine: Engine) -> None:
    (first,) = engine.suggest(problem(), STARTED)
    (second,) = engine.suggest(problem(), [*STARTED, Trial(len(STARTED), first)])
    assert first != second


@pytest.mark.parametrize("count", [0, 12])
def test_every_suggestion_holds_the_constraints(engine: Engine, count: int) -> None:
    started = [trial for trial in STARTED[:count] if not HELD.broken(trial.design)]
    for design in engine.suggest(problem(HELD), started, 5):
        assert HELD.checked(design) == design
        assert HELD.broken(design) == ()


def test_a_space_of_a_thin_slice_is_still_found(engine: Engine) -> None:
    thin = Constraint("thin", "p0 and p1 agree to 0.01 mm", lambda d: 0.01 - abs(d["p0_mm"] - d["p1_mm"]))
    space = DesignSpace("slice", BOWL.parameters, (thin,))
    designs = engine.suggest(problem(space), [], 3)
    assert all(not space.broken(design) for design in designs)
    assert len({tuple(design.values()) for design in designs}) == 3


def test_a_space_where_nothing_holds_is_refused_with_what_was_asked(engine: Engine) -> None:
    never = Constraint("never", "the moon is cheese", lambda _: -1.0)
    with pytest.raises(InputError, match="the moon is cheese"):
        engine.suggest(problem(DesignSpace("none", BOWL.parameters, (never,))), [])


def test_a_failed_trial_without_scores_does_no_harm(engine: Engine) -> None:
    failed = Trial(12, STARTED[0].design, TrialState.FAILED, reason="the rig stopped")
    (design,) = engine.suggest(problem(), [*STARTED, failed])
    assert BOWL.checked(design)
    (design,) = engine.suggest(problem(), [failed])
    assert BOWL.checked(design)


def test_the_recommended_design_is_one_of_those_done(engine: Engine) -> None:
    open_one = Trial(12, dict.fromkeys(BOWL.names, 1.0), TrialState.SHOWN)
    best = engine.best(problem(), [*STARTED, open_one])
    assert best in [trial.design for trial in STARTED]


def test_nothing_is_recommended_before_anything_is_done(engine: Engine) -> None:
    with pytest.raises(ModelError):
        engine.best(problem(), [Trial(0, STARTED[0].design)])
    two = Problem(BOWL, (Objective("a_ms"), Objective("b_ms")))
    with pytest.raises(ModelError, match="front"):
        engine.best(two, STARTED)


def test_scores_may_come_without_errors_and_all_alike(engine: Engine) -> None:
    same = [replace(trial, scores={"asynchrony_ms": Score(70.0)}) for trial in STARTED]
    assert BOWL.checked(engine.suggest(problem(), same)[0])
    assert engine.best(problem(), same)


def test_larger_may_be_better(engine: Engine) -> None:
    case = Problem(BOWL, (Objective("hits", larger_is_better=True),))
    turned = [replace(t, scores={"hits": Score(-t.scores["asynchrony_ms"].value, 3.0)}) for t in STARTED]
    assert engine.best(case, turned) == engine.best(problem(), STARTED)


@pytest.mark.parametrize("name", ["tpe"])
def test_an_engine_that_learns_ends_nearer_than_an_even_net(name: str) -> None:
    gaps = {}
    for which in (name, "sobol"):
        engine = compared_engine(which)
        cases = [problem(seed=seed) for seed in range(5)]
        gaps[which] = np.median([bowl_ms(engine.best(case, run(engine, case, 30))) - 60.0 for case in cases])
    assert gaps[name] < gaps["sobol"]


def test_an_unknown_engine_or_option_is_refused_by_name() -> None:
    with pytest.raises(InputError, match="sobol"):
        engine_of("annealing")
    with pytest.raises(InputError, match="heat"):
        engine_of("random", {"heat": 3})


@pytest.mark.parametrize("seed", range(20))
def test_what_is_left_of_places_is_new_and_comes_once(seed: int) -> None:
    from fdvv_people.optimize.engines.search import SAME, fresh

    rng = np.random.default_rng(seed)
    places = rng.integers(0, 3, (30, 2)) / 2 + rng.choice([0.0, 0.1 * SAME], (30, 2))
    tried = places[:3]
    kept: list[np.ndarray[tuple[int], np.dtype[np.float64]]] = []
    for place in places:
        if all(np.abs(place - other).max() >= SAME for other in [*tried, *kept]):
            kept.append(place)
    np.testing.assert_array_equal(fresh(places, tried), np.reshape(kept, (-1, 2)))


@pytest.mark.slow
@pytest.mark.parametrize(
    ("name", "most_s"), [("tpe", 0.5), ("gp", 0.5), pytest.param("botorch", 2.0, marks=NO_TORCH)]
)
def test_a_suggestion_at_thirty_trials_comes_in_time(name: str, most_s: float) -> None:
    space = paper_space()
    case = Problem(space, (Objective("asynchrony_ms"),), 1)
    trials = run(engine_of("sobol"), case, 34, lambda design: 60.0 + 8.0 * design["actuation_mm"], 7.0)
    taken = []
    for count in range(28, 35):
        start_s = time.process_time()
        compared_engine(name).suggest(case, trials[:count])
        taken.append(time.process_time() - start_s)
    # the first one imports what the engine needs
    assert np.median(taken[1:]) < most_s
