"""Simulated participants answer as the psychophysics they are made of says."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from scipy.special import ndtr

from fdvv.errors import ModelError
from fdvv_people.stats.two_ac import shares_2ac
from fdvv_people.study.simulation.judgement import EQUAL_INDEX, proxy_trials
from fdvv_people.study.simulation.people import NOISE_JND, ProxySettings, SimulatedPeople, draw_people
from fdvv_people.study.simulation.power import ItemEffect

ALIKE = ProxySettings(
    weber_spread_ratio=0, threshold_spread_dB=0, criterion_spread_ratio=0, lapse_ratio=0, taste_ratio=0
)
TRIALS = 100_000


def one_person(settings: ProxySettings = ALIKE, seed: int = 0) -> SimulatedPeople:
    return draw_people(np.random.default_rng(seed), (1,), settings)


def shares(
    kind: str, difference_JND: float, settings: ProxySettings = ALIKE, ties: bool = True
) -> np.ndarray:
    """Return the shares of first, equal and second of one person in many trials."""
    between = np.full((1, TRIALS), difference_JND)
    distances = np.stack([np.zeros_like(between), between], axis=-1)
    random = np.random.default_rng(1)
    found = proxy_trials(kind, one_person(settings), between, distances, random, ties)
    return np.array([np.mean(found.chosen == one) for one in (0, EQUAL_INDEX, 1)])


def test_one_just_noticeable_difference_is_noticed_in_three_choices_of_four() -> None:
    assert shares("2afc", 1.0)[0] == pytest.approx(0.75, abs=0.006)
    assert shares("2afc", 0.0)[0] == pytest.approx(0.5, abs=0.006)


@pytest.mark.parametrize("difference_JND", [0.0, 0.7, 2.0])
def test_choices_with_ties_are_those_of_the_2ac_model(difference_JND: float) -> None:
    expected = shares_2ac(difference_JND / NOISE_JND, ALIKE.criterion_JND / NOISE_JND)
    found = shares("2ac", difference_JND)
    assert sorted(found) == pytest.approx(sorted(np.ravel(expected).tolist()), abs=0.006)


@pytest.mark.parametrize("difference_JND", [0.5, 1.5, 3.0])
def test_abx_follows_the_differencing_rule(difference_JND: float) -> None:
    d = difference_JND / NOISE_JND
    close, far = d / math.sqrt(2), d / math.sqrt(6)
    expected = ndtr(close) * ndtr(far) + ndtr(-close) * ndtr(-far)
    assert shares("abx", difference_JND)[0] == pytest.approx(expected, abs=0.006)
    # the paper's task without ties is the same where one of both is the reference itself
    assert shares("realism", difference_JND, ties=False)[0] == pytest.approx(expected, abs=0.006)


@pytest.mark.parametrize("kind", ["realism", "abx", "2afc", "2ac", "preference", "mushra", "staircase"])
def test_nothing_to_tell_gives_no_side(kind: str) -> None:
    first, _, second = shares(kind, 0.0, ProxySettings())
    assert first == pytest.approx(second, abs=0.008)


def test_equal_is_said_only_where_it_is_offered() -> None:
    assert shares("realism", 0.3)[1] > 0.2
    assert shares("realism", 0.3, ties=False)[1] == 0
    assert shares("abx", 0.3)[1] == shares("2afc", 0.3)[1] == shares("staircase", 0.3)[1] == 0


def test_lapses_are_answered_by_chance() -> None:
    blind = replace(ALIKE, lapse_ratio=0.5)
    lapse = float(one_person(blind).lapse_ratio[0])
    assert shares("2afc", 20.0, blind)[0] == pytest.approx(1 - lapse / 2, abs=0.006)


def test_a_taste_leans_where_something_differs_and_nowhere_else() -> None:
    leaning = replace(ALIKE, taste_ratio=2.0)
    fond = next(one for seed in range(50) if (one := one_person(leaning, seed)).taste[0] > 1.0)
    for difference_JND, expected in ((0.0, False), (1.0, True)):
        between = np.full((1, 20_000), difference_JND)
        even = np.stack([between, between], axis=-1)
        found = proxy_trials("realism", fond, between, even, np.random.default_rng(2))
        assert (np.mean(found.chosen == 0) - np.mean(found.chosen == 1) > 0.1) == expected


def test_ratings_fall_with_distance_and_stay_on_their_scale() -> None:
    between = np.full((1, 5_000), 3.0)
    distances = np.stack([np.zeros_like(between), between], axis=-1)
    found = proxy_trials(
        "realism", one_person(), between, distances, np.random.default_rng(3), points=(7, 101)
    )
    for rated, (low, high) in zip(found.ratings, ((1, 7), (0, 100)), strict=True):
        assert rated.min() >= low
        assert rated.max() <= high
        np.testing.assert_array_equal(rated, np.rint(rated))
        near, far = rated.mean(axis=(0, 1))
        assert near > far + 0.1 * (high - low)


def test_in_mushra_what_seems_closest_is_given_the_top() -> None:
    distances = np.tile([0.0, 2.0, 5.0], (1, 2_000, 1))
    found = proxy_trials(
        "mushra", one_person(), distances[..., 1], distances, np.random.default_rng(4), points=(101,)
    )
    (rated,) = found.ratings
    assert (rated.max(axis=-1) == 100).all()
    assert np.mean(rated[..., 0] == 100) > 0.7


def test_people_differ_as_the_settings_say_and_the_same_seed_draws_the_same() -> None:
    many = draw_people(np.random.default_rng(5), (20_000,))
    assert np.log(many.sharpness).std() == pytest.approx(0.3 * 0.96, rel=0.03)  # cut at two spreads
    assert many.lapse_ratio.mean() == pytest.approx(0.02, rel=0.05)
    again = draw_people(np.random.default_rng(5), (20_000,))
    np.testing.assert_array_equal(many.criterion_JND, again.criterion_JND)


def test_sharper_people_feel_more_of_the_same() -> None:
    effect = ItemEffect.of_size("any", 2.0)
    many = draw_people(np.random.default_rng(6), (100,))
    np.testing.assert_allclose(many.felt_JND(effect.between), 2.0 * many.sharpness)


def test_a_constant_is_changed_by_its_name() -> None:
    assert ProxySettings().changed("weber_ratio", 0.2).senses.weber_ratio == 0.2
    assert ProxySettings().changed("lapse_ratio", 0.0).lapse_ratio == 0
    for name, value in (("senses", 1.0), ("patience", 1.0), ("lapse_ratio", 0.9), ("noise_JND", -1.0)):
        with pytest.raises(ModelError):
            ProxySettings().changed(name, value)
