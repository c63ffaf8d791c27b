"""What several people share, and how each departs from it."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from fdvv.errors import ModelError
from fdvv.units import FloatArray
from fdvv_people.optimize.group.belief import GroupBelief, GroupScores, believe_group

PEOPLE, EACH = 4, 30
ERROR_ms = 1.0


def scores(apart: float, seed: int = 0) -> GroupScores:
    """Make bowls over two parameters: the lowest point of person p is apart from that of the others."""
    random = np.random.default_rng(seed)
    people = np.repeat(np.arange(PEOPLE), EACH)
    places = random.random((people.size, 2))
    low = 0.5 + apart * (people / (PEOPLE - 1) - 0.5)
    values = 20.0 + 60.0 * ((places[:, 0] - low) ** 2 + (places[:, 1] - 0.5) ** 2)
    values = values + ERROR_ms * random.standard_normal(people.size)
    return GroupScores(people, places, values, np.full(people.size, ERROR_ms))


def along(count: int = 41) -> FloatArray:
    return np.column_stack([np.linspace(0, 1, count), np.full(count, 0.5)])


def test_the_posterior_is_that_of_one_gaussian_over_scores_and_new_places() -> None:
    belief = believe_group(scores(0.6))
    new = np.random.default_rng(3).random((5, 2))
    found = belief.means(new)
    places = np.vstack([belief.scores.places, new])
    for person in range(PEOPLE):
        people = np.append(belief.scores.people, [person] * 5)
        same = people[:, None] == people[None]
        f = belief.kernel(places) * (belief.shared + belief.own * same) + belief.level * same
        n = belief.scores.people.size
        K = f[:n, :n] + np.diag(belief.noise)
        y = (np.log(belief.scores.values) - belief.centre) / belief.scale
        wanted = np.exp(belief.centre + belief.scale * f[n:, :n] @ np.linalg.solve(K, y))
        np.testing.assert_allclose(found[person], wanted, rtol=1e-7)


def test_differences_are_those_of_the_means_and_none_of_a_design_with_itself() -> None:
    belief = believe_group(scores(0.6))
    first, second = np.random.default_rng(4).random((2, PEOPLE, 2))
    drawn = belief.differences(first, second)
    everybody = np.arange(PEOPLE)
    wanted = belief.means(first)[everybody, everybody] - belief.means(second)[everybody, everybody]
    np.testing.assert_allclose(np.median(drawn, axis=0), wanted, atol=0.1 * drawn.std(axis=0).max())
    np.testing.assert_array_equal(drawn, belief.differences(first, second))
    np.testing.assert_allclose(belief.differences(first, first), 0.0, atol=1e-5)


def test_scores_above_0_are_learned_by_their_logarithms_and_others_as_they_are() -> None:
    plain = scores(0.6)
    below = replace(plain, values=plain.values - 30.0)
    assert believe_group(plain).logarithmic
    assert not believe_group(below).logarithmic
    np.testing.assert_allclose(lowest(believe_group(below)), lowest(believe_group(plain)), atol=0.1)


def lowest(belief: GroupBelief) -> FloatArray:
    """Return where along the first parameter each person's scores are lowest."""
    return np.asarray(along()[np.argmin(belief.means(along()), axis=1), 0])


def test_people_who_differ_have_a_lowest_place_each_and_those_who_are_alike_one() -> None:
    apart, alike = believe_group(scores(0.6)), believe_group(scores(0.0))
    np.testing.assert_allclose(lowest(apart), [0.2, 0.4, 0.6, 0.8], atol=0.1)
    np.testing.assert_allclose(lowest(alike), 0.5, atol=0.08)
    assert alike.own < 0.1 * alike.shared < apart.own


def test_whoever_scores_twice_as_much_has_the_same_best_design_and_gains_twice_as_much_with_it() -> None:
    plain, times = scores(0.6), np.array([1.0, 2.0, 0.5, 1.3])
    each = times[plain.people]
    moved = believe_group(replace(plain, values=each * plain.values, errors=each * plain.errors))
    belief = believe_group(plain)
    np.testing.assert_allclose(lowest(moved), lowest(belief), atol=0.05)
    middle, own = np.full((PEOPLE, 2), 0.5), np.column_stack([lowest(belief), np.full(PEOPLE, 0.5)])
    gains, wanted = (np.median(one.differences(middle, own), axis=0) for one in (moved, belief))
    np.testing.assert_allclose(gains[[0, 3]], (times * wanted)[[0, 3]], rtol=0.2)


def test_differences_lie_within_their_intervals_as_often_as_stated() -> None:
    hit = []
    for seed in range(15):
        belief = believe_group(scores(0.5, seed))
        first, second = np.random.default_rng([seed, 1]).random((2, PEOPLE, 2))
        low = np.column_stack([0.5 + 0.5 * (np.arange(PEOPLE) / (PEOPLE - 1) - 0.5), np.full(PEOPLE, 0.5)])
        truth = 60.0 * (((first - low) ** 2).sum(axis=1) - ((second - low) ** 2).sum(axis=1))
        least, most = np.percentile(belief.differences(first, second), [2.5, 97.5], axis=0)
        hit += ((least < truth) & (truth < most)).tolist()
    assert 0.88 <= np.mean(hit) <= 1.0


def test_scores_without_errors_are_learned_from_too() -> None:
    unknown = replace(scores(0.6), errors=np.full(PEOPLE * EACH, np.nan))
    np.testing.assert_allclose(lowest(believe_group(unknown)), [0.2, 0.4, 0.6, 0.8], atol=0.1)


def test_one_person_is_no_group() -> None:
    with pytest.raises(ModelError, match="two people"):
        replace(scores(0.6), people=np.zeros(PEOPLE * EACH, dtype=np.int64))
