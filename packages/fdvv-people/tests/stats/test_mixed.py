"""The mixed model beside closed forms, statsmodels and what was put in; flipped signs beside counting."""

from __future__ import annotations

import warnings
from itertools import product

import numpy as np
import pytest

from fdvv.errors import ModelError
from fdvv.units import FloatArray
from fdvv_people.stats.mixed import MixedFit, fit_mixed, sign_flip_p
from fdvv_people.stats.post_hoc import post_hoc


def one_way(scores: FloatArray) -> MixedFit:
    """Fit (people, rounds) with one mean."""
    people = np.repeat(np.arange(len(scores)), scores.shape[1])
    return fit_mixed(scores.ravel(), np.ones((scores.size, 1)), people.tolist(), {})


def test_balanced_one_way_variances_are_those_of_the_analysis_of_variance() -> None:
    random = np.random.default_rng(1)
    scores = 80 + 9 * random.standard_normal((12, 1)) + 5 * random.standard_normal((12, 4))
    within = scores.var(axis=1, ddof=1).mean()
    between = scores.mean(axis=1).var(ddof=1) - within / 4
    fit = one_way(scores)
    assert fit.variances["residual"] == pytest.approx(within, rel=1e-4)
    assert fit.variances["person"] == pytest.approx(between, rel=1e-4)
    assert fit.means[0] == pytest.approx(scores.mean())
    error = np.sqrt(scores.mean(axis=1).var(ddof=1) / 12)
    assert fit.contrast([1.0]).error == pytest.approx(error, rel=1e-4)


def test_balanced_nested_variances_are_those_of_the_mean_squares_however_small_they_are() -> None:
    compared = 0
    for seed in range(60):
        random = np.random.default_rng(seed)
        people, kinds, rounds = shape = (12, 6, 3)
        scores = 8 * random.standard_normal((people, 1, 1)) + 2.5 * random.standard_normal((people, kinds, 1))
        scores = scores + 10 * random.standard_normal(shape)
        cells, means = scores.mean(axis=2), scores.mean(axis=(1, 2))
        apart = cells - means[:, None] - cells.mean(axis=0) + scores.mean()
        within = scores.var(axis=2, ddof=1).mean()
        between_kinds = rounds * (apart**2).sum() / ((people - 1) * (kinds - 1))
        between_people = kinds * rounds * means.var(ddof=1)
        kind = (between_kinds - within) / rounds
        if kind <= 0 or between_people <= between_kinds:
            continue  # there the likelihood ends at 0
        compared += 1
        person, column = (index.ravel().tolist() for index in np.indices(shape)[:2])
        fit = fit_mixed(scores.ravel(), np.eye(kinds)[column], person, {"kind": column})
        expected = [(between_people - between_kinds) / (kinds * rounds), kind, within]
        assert list(fit.variances.values()) == pytest.approx(expected, rel=1e-3, abs=1e-2), seed
    assert compared > 40


def test_people_who_are_all_alike_have_no_variance_between_them() -> None:
    scores = np.tile([1.0, 5.0, 3.0], (6, 1))
    assert one_way(scores).variances["person"] == pytest.approx(0.0, abs=1e-6)


def crossed(seed: int, people: int = 12) -> tuple[FloatArray, list[tuple[int, int, int, int]]]:
    """Draw scores of people, 3 conditions, 2 levels and 2 rounds; return them with their places."""
    random = np.random.default_rng(seed)
    person, level = 10 * random.standard_normal(people), 4 * random.standard_normal((people, 2))
    places = list(product(range(people), range(3), range(2), range(2)))
    slope = 6 * random.standard_normal((people, 3))
    scores = [
        80 - 5 * (c == 0) + 8 * j + person[p] + level[p, j] + slope[p, c] + 3 * random.standard_normal()
        for p, c, j, _ in places
    ]
    return np.array(scores), places


def design_of(places: list[tuple[int, int, int, int]]) -> FloatArray:
    """Return a column a condition and one of the level, centred."""
    return np.array([[c == 0, c == 1, c == 2, j - 0.5] for _, c, j, _ in places], float)


def fitted(seed: int, missing: int = 0) -> MixedFit:
    scores, places = crossed(seed)
    scores, places = scores[missing:], places[missing:]
    effects = {
        "level": [f"{p} {j}" for p, _, j, _ in places],
        "condition": [f"{p} {c}" for p, c, _, _ in places],
    }
    return fit_mixed(scores, design_of(places), [p for p, *_ in places], effects)


def test_it_is_the_model_that_statsmodels_fits() -> None:
    statsmodels = pytest.importorskip("statsmodels.api")
    scores, places = crossed(3)
    groups = np.array([p for p, *_ in places])
    level = {f"l{j}": np.array([one[2] == j for one in places], float) for j in (0, 1)}
    kinds = {f"c{c}": np.array([one[1] == c for one in places], float) for c in (0, 1, 2)}
    names = [sorted(level), sorted(kinds)]
    columns = [np.column_stack([part[n] for n in sorted(part)]) for part in (level, kinds)]
    vc = statsmodels.regression.mixed_linear_model.VCSpec(
        ["condition", "level"],
        [[own] * 12 for own in (names[1], names[0])],
        [[columns[1][groups == p] for p in range(12)], [columns[0][groups == p] for p in range(12)]],
    )
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        theirs = statsmodels.MixedLM(
            scores, design_of(places), groups, exog_re=np.ones((len(scores), 1)), exog_vc=vc
        ).fit(reml=True)
    ours = fitted(3)
    assert ours.means == pytest.approx(np.asarray(theirs.fe_params), rel=1e-4)
    assert ours.variances["residual"] == pytest.approx(theirs.scale, rel=2e-2)
    assert np.sqrt(np.diag(ours.covariance)) == pytest.approx(np.asarray(theirs.bse_fe), rel=2e-2)


def test_with_slopes_a_complete_contrast_is_near_the_paired_t_test() -> None:
    scores, _ = crossed(5)
    cells = scores.reshape(12, 3, 4).mean(axis=2)
    paired = post_hoc(cells, ["a", "b", "c"], "a")[0]
    found = fitted(5).contrast([1, -1, 0, 0])
    assert found.value.value == pytest.approx(paired.difference.value, abs=1e-6)
    assert found.df == 11
    # the spread is pooled over conditions, so that t differs a little
    assert found.t == pytest.approx(paired.t, rel=0.35)


def test_the_interval_covers_what_was_put_in_as_often_as_it_says() -> None:
    covered = 0
    for seed in range(30):
        found = fitted(100 + seed).contrast([1, -0.5, -0.5, 0]).value
        assert found.low is not None
        assert found.high is not None
        covered += found.low <= -5.0 <= found.high
    # 28.5 are expected; fewer than 25 of 30 has a chance below 1 in 60
    assert covered >= 25


def test_a_missing_score_costs_its_row_and_no_person() -> None:
    assert fitted(3, missing=1).people == 12


def test_scores_that_cannot_be_fitted_are_refused() -> None:
    with pytest.raises(ModelError, match="3 people"):
        fit_mixed([1.0, 2.0], np.ones((2, 1)), ["a", "b"], {})
    with pytest.raises(ModelError, match="missing"):
        fit_mixed([1.0, np.nan], np.ones((2, 1)), ["a", "b"], {})
    with pytest.raises(ModelError, match="rows"):
        fit_mixed([1.0], np.ones((2, 1)), ["a"], {})


def test_flipped_signs_are_counted_exactly() -> None:
    # of eight flips only all signs alike reach the sum
    assert sign_flip_p([1.0, 2.0, 3.0]) == 2 / 8
    assert sign_flip_p([0.0, 0.0, 0.0]) == 1.0
    assert sign_flip_p([1.0, -1.0, 2.0]) == 1.0 - 2 / 8


def test_drawn_flips_agree_with_counted_ones() -> None:
    random = np.random.default_rng(2)
    differences = 0.6 + random.standard_normal(15)
    signs = 1 - 2 * ((np.arange(2**15)[:, None] >> np.arange(15)) & 1)
    exact = float(np.mean(np.abs(signs @ differences) >= abs(differences.sum()) * (1 - 1e-12)))
    assert sign_flip_p(differences) == pytest.approx(exact, abs=0.02)
