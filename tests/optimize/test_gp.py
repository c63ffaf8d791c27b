"""The Gaussian process and the engine on it."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from benchmarks.optimize_baselines import compared_engine
from msgspec import UNSET
from scipy.stats import norm

from fdvv.errors import InputError
from fdvv_botorch.models import torch_there
from fdvv_people.optimize.engines.gp import ChangeCost
from fdvv_people.optimize.engines.gp_model import Basis, Observed, believe, believed_best, prior_basis
from fdvv_people.optimize.engines.gp_model import observed as scores_of
from fdvv_people.optimize.engines.registry import engine_of
from fdvv_people.optimize.engines.search import log_expected_improvement
from fdvv_people.optimize.paper_space import paper_space
from fdvv_people.optimize.problem import Problem, Trial, TrialState
from tests.optimize.problems import BOWL, bowl_ms, problem, run, scored

NO_TORCH = pytest.mark.skipif(not torch_there(), reason="botorch is not installed")


def observed(count: int, errors: float = 0.5, seed: int = 0) -> Observed:
    rng = np.random.default_rng(seed)
    places = rng.random((count, 3))
    values = np.array([bowl_ms(d) for d in BOWL.of_unit(places)]) + errors * rng.normal(size=count)
    return Observed(places, values, np.full(count, errors))


def test_the_log_of_expected_improvement_is_that_of_the_closed_form_and_finite_far_out() -> None:
    z = np.linspace(-6.0, 6.0, 49)
    plain = np.log(norm.pdf(z) + z * norm.cdf(z))
    np.testing.assert_allclose(log_expected_improvement(-z, np.ones_like(z), 0.0), plain, rtol=1e-6)
    far = log_expected_improvement(np.array([1e2, 9e2, 1.1e3, 1e5]), np.ones(4), 0.0)
    assert np.all(np.isfinite(far))
    assert np.all(np.diff(far) < 0)
    np.testing.assert_allclose(far[:1], -0.5 * 1e4 - 0.5 * np.log(2 * np.pi) - 2 * np.log(1e2), rtol=1e-4)


def test_the_posterior_is_that_of_the_normal_equations_with_the_weights_as_unknowns() -> None:
    scores = observed(12)
    basis = Basis(lambda places: places[:, :1] - 0.5, np.array([0.3]), np.array([0.5]))
    belief = believe(scores, basis)
    new = np.random.default_rng(5).random((6, 3))
    both = np.vstack([scores.places, new])
    # one Gaussian over scores and new places, the weight drawn along with f
    H = basis.about(scores.places).of(both) / belief.scale
    K = belief.kernel(both) + H @ np.diag(basis.spread**2) @ H.T
    K[:12, :12] += np.diag(belief.noise)
    mean = (H @ basis.weight) * belief.scale + belief.centre
    gain = K[12:, :12] @ np.linalg.inv(K[:12, :12])
    wanted = mean[12:] + gain @ (scores.values - mean[:12])
    spread = np.sqrt(np.diag(K[12:, 12:] - gain @ K[:12, 12:])) * belief.scale
    found, sd = belief.predict(new)
    np.testing.assert_allclose(found, wanted, rtol=1e-6)
    np.testing.assert_allclose(sd, spread, rtol=1e-5)


def test_a_fantasy_leaves_the_mean_where_it_is_and_takes_the_spread() -> None:
    belief = believe(observed(10))
    place = np.array([0.9, 0.1, 0.9])
    more = belief.with_fantasy(place)
    (before, sd), (after, less) = belief.predict(place[None]), more.predict(place[None])
    assert after[0] == pytest.approx(before[0], abs=1e-6)
    assert less[0] < sd[0]


def test_the_luckiest_score_is_not_what_is_recommended() -> None:
    places = np.random.default_rng(2).random((20, 3))
    trials = [scored(i, d, bowl_ms(d)) for i, d in enumerate(BOWL.of_unit(places))]
    worst = int(np.argmax([bowl_ms(trial.design) for trial in trials]))
    least = min(bowl_ms(trial.design) for trial in trials)
    trials[worst] = scored(worst, trials[worst].design, least - 1.0, 40.0)
    assert compared_engine("gp-ei").best(problem(), trials) == trials[worst].design
    for best in (believed_best(problem(), trials), engine_of("gp").best(problem(), trials)):
        assert best != trials[worst].design


def test_a_place_that_failed_again_and_again_is_left_alone() -> None:
    ideal = dict.fromkeys(BOWL.names, 1.0)
    started = run(engine_of("sobol"), problem(), 15, noise_ms=0.5)
    near = BOWL.of_unit(0.5 + 0.03 * np.random.default_rng(0).normal(size=(6, 3)))
    failed = [Trial(15 + i, design, TrialState.FAILED) for i, design in enumerate(near)]
    (free,) = engine_of("gp").suggest(problem(), started)
    (wary,) = engine_of("gp").suggest(problem(), [*started, *failed])

    def away(design: dict[str, float]) -> float:
        return float(np.abs(BOWL.to_unit([design]) - BOWL.to_unit([ideal])).max())

    assert away(free) < 0.15 < away(wary)


@pytest.mark.parametrize("name", ["gp", pytest.param("botorch", marks=NO_TORCH), "tpe", "cmaes"])
def test_trials_of_others_lead_to_the_place_at_once(name: str) -> None:
    others = tuple(run(engine_of("sobol"), problem(seed=9), 40))
    began = run(engine_of("sobol"), problem(), 0 if name == "cmaes" else 2)
    (first,) = compared_engine(name).suggest(problem(prior=others), began)
    assert bowl_ms(first) < 85.0


def test_what_others_did_counts_in_the_scores_own_unit_however_near_the_best_one_looks() -> None:
    others = tuple(run(engine_of("sobol"), problem(seed=9), 60))
    near = BOWL.of_unit(0.5 + 0.04 * np.random.default_rng(0).normal(size=(6, 3)))
    noise_ms = 8.0 * np.random.default_rng(1).normal(size=len(near))
    tried = [
        scored(i, one, bowl_ms(one) + more, 8.0)
        for i, (one, more) in enumerate(zip(near, noise_ms, strict=True))
    ]
    case = problem(prior=others)
    belief = believe(scores_of(BOWL, case.objectives[0], tried), prior_basis(case))
    far = BOWL.of_unit([[0.1, 0.1, 0.9]])
    # six scores that differ by their noise alone do not make the bowl shallow
    predicted_ms = belief.predict(BOWL.to_unit(far))[0][0] - belief.predict(BOWL.to_unit(near[:1]))[0][0]
    assert predicted_ms == pytest.approx(bowl_ms(far[0]) - bowl_ms(near[0]), rel=0.4)


def test_people_who_differ_in_one_way_are_known_after_few_trials() -> None:
    """Everybody's best depth differs: the mean over people says nothing of it, how they differ does."""
    rng = np.random.default_rng(4)
    places = rng.random((60, 3))

    def score_ms(depth: float, at: np.ndarray) -> np.ndarray:
        return 60.0 + 80.0 * (at[:, 0] - depth) ** 2

    everybody = np.array([score_ms(depth, places) for depth in rng.random(30)])
    differences = everybody - everybody.mean(axis=1, keepdims=True)
    left, size, _ = np.linalg.svd((differences - differences.mean(axis=0)).T, full_matrices=False)
    components = left[:, :2] * size[:2] / np.sqrt(len(everybody) - 1)
    others = tuple(
        replace(scored(i, design, float(mean)), components=tuple(more.tolist()))
        for i, (design, mean, more) in enumerate(
            zip(BOWL.of_unit(places), everybody.mean(axis=0), components, strict=True)
        )
    )
    at, fresh = rng.random((3, 3)), rng.random((200, 3))
    missed = []
    for prior in (others, tuple(replace(trial, components=UNSET) for trial in others)):
        case = problem(prior=prior)
        tried = [
            scored(i, d, float(y))
            for i, (d, y) in enumerate(zip(BOWL.of_unit(at), score_ms(0.9, at), strict=True))
        ]
        belief = believe(scores_of(BOWL, case.objectives[0], tried), prior_basis(case))
        error = belief.mean(fresh) - score_ms(0.9, fresh)
        missed.append(float(np.std(error)))
    assert missed[0] < 0.25 * missed[1]


def test_the_mean_alone_is_that_of_the_whole_belief() -> None:
    case = problem(prior=tuple(run(engine_of("sobol"), problem(seed=9), 20)))
    scores = scores_of(BOWL, case.objectives[0], run(engine_of("sobol"), problem(), 6))
    belief = believe(scores, prior_basis(case))
    places = np.random.default_rng(0).random((50, 3))
    assert belief.mean(places) == pytest.approx(belief.predict(places)[0])


@pytest.mark.parametrize("name", ["gp", pytest.param("botorch", marks=NO_TORCH)])
def test_trials_of_others_are_given_up_where_they_mislead(name: str) -> None:
    others = run(engine_of("sobol"), problem(seed=9), 40)

    def turned(design: dict[str, float]) -> float:
        return 130.0 - bowl_ms(design)

    wrong = tuple(scored(i, t.design, turned(t.design)) for i, t in enumerate(others))
    case = problem(prior=wrong)
    engine = engine_of(name)
    assert bowl_ms(engine.best(case, run(engine, case, 25))) < 75.0


def test_a_trend_is_taken_off_and_the_better_design_found_beneath_it() -> None:
    places = np.random.default_rng(1).random((24, 3))
    # the person grows 60 ms faster, so that what came last looks best
    learning = 60.0 * (1.0 - np.log1p(np.arange(24)) / np.log1p(24))
    designs = sorted(BOWL.of_unit(places), key=bowl_ms)
    trials = [scored(i, d, bowl_ms(d) + learning[i], 1.0) for i, d in enumerate(designs)]
    gaps = {}
    for trend in (False, True):
        gaps[trend] = bowl_ms(engine_of("gp", {"trend": trend}).best(problem(), trials)) - bowl_ms(designs[0])
    assert gaps[True] < gaps[False]


def test_old_scores_fade_where_they_are_to_be_forgotten() -> None:
    place, other = BOWL.of_unit([[0.2, 0.2, 0.2], [0.8, 0.8, 0.8]])
    old = [scored(i, place, 60.0) for i in range(4)] + [scored(i + 4, other, 70.0) for i in range(4)]
    new = [scored(i + 40, place, 80.0) for i in range(3)]
    assert engine_of("gp", {"forget": 5.0}).best(problem(), [*old, *new]) == other
    assert engine_of("gp", {"forget": 1e6}).best(problem(), [*old, *new]) == place
    with pytest.raises(InputError, match="forget"):
        engine_of("gp", {"forget": 0.0})


SPACE = paper_space()
COST = ChangeCost(60.0, {"y1_cN": 180.0, "y2_cN": 90.0})


def test_what_is_built_costs_nothing_and_the_dearest_new_value_counts() -> None:
    built = np.full((2, 8), 0.5)
    built[1, 3] = 0.1
    places = np.tile(built[0], (4, 1))
    places[1, 6] = 0.9
    places[2, 4] = 0.9
    places[3, [3, 4]] = 0.9
    assert COST.seconds(SPACE, places, built).tolist() == [60.0, 60.0, 150.0, 240.0]
    assert COST.seconds(SPACE, places, built[:0]).tolist() == [240.0] * 4
    with pytest.raises(InputError, match="colour"):
        ChangeCost(60.0, {"colour": 1.0}).dear(SPACE)
    with pytest.raises(InputError, match="trial_s"):
        ChangeCost(0.0, {})


@pytest.mark.slow
def test_a_dear_change_is_made_less_often_where_its_cost_is_known() -> None:
    cost = {name: 600.0 for name in SPACE.names if name.startswith(("x", "y"))}

    def truth(design: dict[str, float]) -> float:
        return 60.0 + 8.0 * abs(design["actuation_mm"] - 1.0) + 0.05 * design["y1_cN"]

    built = {}
    for name, given in (("free", {}), ("dear", {"build_s": cost})):
        case = Problem(SPACE, problem().objectives, 1)
        trials = run(engine_of("gp", given), case, 16, truth)  # type: ignore[arg-type]
        built[name] = len({trial.design["y1_cN"] for trial in trials})
    # a force at the end of its range may come twice where it costs nothing
    assert 2 * built["dear"] < built["free"]


def test_the_length_of_the_space_is_what_the_kernel_expects_unless_the_engine_has_its_own() -> None:
    designs = [{"p0_mm": at, "p1_mm": 1.0, "p2_mm": 1.0} for at in (-2.0, 0.0, 1.0, 4.0)]
    tried = [scored(i, design, bowl_ms(design)) for i, design in enumerate(designs)]
    found = {
        length: believe(scores_of(BOWL, problem().objectives[0], tried), length=length).kernel.k2.length_scale
        for length in (0.2, 0.45)
    }
    # nothing was varied along these, so that the prior alone speaks
    np.testing.assert_allclose(found[0.2][1:], 0.2 * np.sqrt(3), rtol=0.05)
    np.testing.assert_allclose(found[0.45][1:], 0.45 * np.sqrt(3), rtol=0.05)
    smooth, space = engine_of("gp"), replace(BOWL, length=0.45)
    same = engine_of("gp", {"length": 0.45}).suggest(problem(), tried)
    assert smooth.suggest(problem(space), tried) == same != smooth.suggest(problem(), tried)
    with pytest.raises(InputError, match="length"):
        engine_of("gp", {"length": 0.0})


def test_the_process_begins_after_as_many_designs_as_it_is_asked_to() -> None:
    three = run(engine_of("sobol"), problem(), 3)
    net = engine_of("sobol").suggest(problem(), three)
    assert engine_of("gp", {"startup": 4}).suggest(problem(), three) == net
    assert engine_of("gp").suggest(problem(), three) != net
    with pytest.raises(InputError, match="startup"):
        engine_of("gp", {"startup": 0})
