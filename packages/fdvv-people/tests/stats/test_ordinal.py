from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

from fdvv.errors import ModelError
from fdvv.units import FloatArray
from fdvv_people.stats.ordinal import ordinal_model
from fdvv_people.stats.ordinal_fit import OrdinalPoint, gathered, log_likelihood
from tests.stats.golden import golden
from tests.support.campaign import campaign


def some_ratings(
    seed: int, people: int = 10, rounds: int = 6, effect: float = 0.8, sd: float = 0.7
) -> tuple[FloatArray, Any, FloatArray]:
    """Return ratings, who gave them, and 0 or 1 for what was rated."""
    random = np.random.default_rng(seed)
    person = np.repeat(np.arange(people), 2 * rounds)
    x = np.tile(np.repeat([0.0, 1.0], rounds), people)
    felt = random.normal(0, sd, people)[person] + effect * x + random.normal(size=x.size)
    return np.asarray(np.digitize(felt, [-1.4, -0.6, 0.1, 0.7, 1.4]) + 1.0, dtype=np.float64), person, x


def of_golden(one: Any) -> tuple[FloatArray, Any, FloatArray]:
    ratings = np.array([float(digit) if digit != "0" else math.nan for digit in one["r"]])
    rounds = ratings.size // one["people"] // 2
    person = np.repeat(np.arange(one["people"]), 2 * rounds)
    return ratings, person, np.tile(np.repeat([0.0, 1.0], rounds), one["people"])


@campaign("start", range(50), part=1)
def test_it_agrees_with_ordinals_clmm(start: int) -> None:
    for one in golden("ordinal")[start::50]:
        found = ordinal_model(*of_golden(one), ["x"], nodes=7)
        effect = found.of("x")
        assert found.problem == ""
        assert found.log_likelihood == pytest.approx(one["log_likelihood"], abs=1e-4)
        assert [effect.value, effect.error] == pytest.approx([one["value"], one["error"]], abs=2e-3)
        assert found.thresholds == pytest.approx(one["thresholds"], abs=4e-3)
        assert found.person_sd == pytest.approx([one["sd"]], abs=4e-3)
        assert found.missing == one["r"].count("0")


@campaign("start", range(12), part=1)
def test_with_a_slope_it_agrees_with_ordinals_clmm(start: int) -> None:
    for one in golden("ordinal_slope", least=25)[start::12]:
        ratings, person, x = of_golden(one)
        there = ~np.isnan(ratings)
        _, category = np.unique(ratings[there], return_inverse=True)
        data = gathered(category, person[there], x[there, np.newaxis], 0)
        (first, second), way = one["sd"], max(-1.0, min(1.0, one["correlation"] or 0.0))
        factor = np.array([[first, 0.0], [way * second, second * math.sqrt(1 - way**2)]])
        point = OrdinalPoint(np.array(one["thresholds"]), np.array([one["value"]]), factor)
        # clmm has Laplace's approximation for two parts of a person, which is one node
        assert log_likelihood(data, point, 1)[0] == pytest.approx(one["log_likelihood"], abs=1e-4)
        found = ordinal_model(ratings, person, x, ["x"], "x")
        assert found.problem == ""
        # ours is the higher by the same measure, and not far away
        assert found.log_likelihood >= log_likelihood(data, point, 9)[0] - 1e-6
        assert found.of("x").value == pytest.approx(one["value"], abs=0.05 * one["error"])


def a_point(random: np.random.Generator, size: int) -> OrdinalPoint:
    factor = np.tril(random.normal(0, 0.6, (size, size)))
    return OrdinalPoint(np.sort(random.normal(0, 1.2, 5)), random.normal(0, 1, 1), factor)


def integrated(ratings: FloatArray, person: Any, x: FloatArray, point: OrdinalPoint) -> float:
    """Integrate each person's own parts over a plain fine grid, with SciPy's normal distribution."""
    from scipy.stats import norm

    edges = np.concatenate([[-np.inf], point.thresholds, [np.inf]])
    at = np.linspace(-7, 7, 71)
    size = len(point.factor)
    own = np.stack(np.meshgrid(*[at] * size, indexing="ij"), axis=-1).reshape(-1, size)
    weight = np.prod(norm.pdf(own), axis=1) * (at[1] - at[0]) ** size
    total = 0.0
    for one in np.unique(person):
        chance = weight.copy()
        for rating, value in zip(ratings[person == one], x[person == one], strict=True):
            mean = value * point.effects[0] + own @ point.factor.T @ np.array([1.0, value])[:size]
            low, high = edges[int(rating) - 1] - mean, edges[int(rating)] - mean
            chance *= norm.cdf(high) - norm.cdf(low)
        total += math.log(chance.sum())
    return total


@pytest.mark.parametrize("size", [1, 2])
@campaign("seed", range(200), part=2)
def test_the_likelihood_is_that_of_a_plain_integral(seed: int, size: int) -> None:
    ratings, person, x = some_ratings(seed, people=3, rounds=3)
    data = gathered(ratings.astype(int) - 1, person, x[:, np.newaxis], 0 if size == 2 else None)
    point = a_point(np.random.default_rng(6 + seed), size)
    value, _ = log_likelihood(data, point, 21)
    assert value == pytest.approx(integrated(ratings, person, x, point), abs=2e-4)


@pytest.mark.parametrize("size", [1, 2])
def test_the_slope_is_that_of_the_likelihood(size: int) -> None:
    random = np.random.default_rng(7)
    ratings, person, x = some_ratings(1, people=5)
    data = gathered(ratings.astype(int) - 1, person, x[:, np.newaxis], 0 if size == 2 else None)
    point = a_point(random, size)
    flat = point.flat()
    _, slope = log_likelihood(data, point, 25)
    for moved, expected in zip(1e-5 * np.eye(flat.size), slope, strict=True):
        up, down = (log_likelihood(data, point.moved(flat + way * moved), 25)[0] for way in (1, -1))
        assert (up - down) / 2e-5 == pytest.approx(expected, abs=1e-3)


def test_where_people_do_not_differ_it_agrees_with_statsmodels() -> None:
    from statsmodels.miscmodels.ordinal_model import OrderedModel  # type: ignore[import-untyped]

    ratings, _, x = some_ratings(2, people=1, rounds=30)
    theirs = OrderedModel(ratings, x[:, np.newaxis], distr="probit").fit(method="bfgs", disp=False)
    cuts = theirs.model.transform_threshold_params(theirs.params)[1:-1]
    # three people who answer all alike
    found = ordinal_model(np.tile(ratings, 3), np.repeat([0, 1, 2], ratings.size), np.tile(x, 3), ["x"])
    assert found.person_sd == pytest.approx([0.0], abs=1e-3)
    assert found.of("x").value == pytest.approx(theirs.params[0], abs=1e-4)
    assert found.thresholds == pytest.approx(cuts.tolist(), abs=1e-4)
    assert found.log_likelihood == pytest.approx(3 * theirs.llf, abs=1e-4)
    assert found.of("x").error == pytest.approx(theirs.bse[0] / math.sqrt(3), rel=1e-3)


def test_nobody_minds_in_which_order_answers_and_people_come() -> None:
    ratings, person, x = some_ratings(3)
    order = np.random.default_rng(1).permutation(ratings.size)
    here = ordinal_model(ratings, person, x, ["x"])
    names = np.array([f"P{one}" for one in person])
    there = ordinal_model(ratings[order], names[order], x[order], ["x"])
    assert here.of("x").value == pytest.approx(there.of("x").value, abs=1e-5)
    assert here.log_likelihood == pytest.approx(there.log_likelihood, abs=1e-8)


def test_a_slope_tells_who_feels_it_more() -> None:
    random = np.random.default_rng(8)
    own = np.array([-0.5, 0.0, 0.5, 1.0, 1.5, 2.5])
    person, x = np.repeat(np.arange(6), 80), np.tile(np.repeat([0.0, 1.0], 40), 6)
    ratings = np.digitize(own[person] * x + random.normal(size=x.size), [-0.8, 0, 0.8, 1.6]) + 1.0
    found = ordinal_model(ratings, person, x, ["x"], slope="x")
    assert np.corrcoef(found.person_effects, own)[0, 1] > 0.97
    assert found.person_sd[1] == pytest.approx(own.std(), abs=0.35)
    assert found.of("x").error > ordinal_model(ratings, person, x, ["x"]).of("x").error


def test_scales_of_other_steps_give_the_same_model() -> None:
    ratings, person, x = some_ratings(4)
    here, there = (ordinal_model(one, person, x, ["x"]) for one in (ratings, 10 * ratings**2))
    assert here.of("x") == there.of("x")
    assert there.categories == tuple(10 * one**2 for one in here.categories)


def test_an_effect_that_all_answers_agree_on_is_called_unbounded() -> None:
    x = np.tile([0.0, 1.0], 20)
    found = ordinal_model(1 + x, np.repeat(np.arange(5), 8), x, ["x"])
    assert "do not bound x" in found.problem


@pytest.mark.parametrize(
    ("ratings", "person", "predictors", "reason"),
    [
        ([3, 3, 3, 3], "aabb", [0, 1, 0, 1], "2 categories and 2 people, got 1 and 2"),
        ([1, 2, 3, 4], "aaaa", [0, 1, 0, 1], "got 4 and 1"),
        ([1, 2, 3, 4], "aabb", [1, 1, 1, 1], "never changes"),
        ([1, 2, 3, 4], "aabb", [1, math.nan, 1, 0], "missing"),
        ([1, 2, 3, 4], "aabb", [[1, 1], [0, 0], [1, 1], [0, 0]], "need as many different names"),
    ],
)
def test_ratings_without_a_model_are_refused(ratings: Any, person: str, predictors: Any, reason: str) -> None:
    with pytest.raises(ModelError, match=reason):
        ordinal_model(ratings, list(person), predictors, ["x"])


def test_a_slope_of_no_predictor_is_refused() -> None:
    with pytest.raises(ModelError, match="no predictor 'y'"):
        ordinal_model([1, 2, 1, 2], list("aabb"), [0, 1, 0, 1], ["x"], slope="y")
