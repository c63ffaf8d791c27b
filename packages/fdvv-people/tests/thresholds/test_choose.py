"""The next change is the one that says most of the JNDs, and the same for the same trials."""

from __future__ import annotations

import time

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.special import ndtr

from fdvv.model.noticeable import AT_JND, DIMENSIONS
from fdvv_people.thresholds import belief, choose
from fdvv_people.thresholds.belief import Belief, Trial, belief_after
from fdvv_people.thresholds.choose import candidates, directions, information, next_change
from fdvv_people.thresholds.observer import LAPSE, share_correct
from fdvv_people.thresholds.prior import ThresholdPrior

PRIOR = ThresholdPrior()
MOST = (1.0, 2.0, 3.0)


def test_directions_are_the_dimensions_or_all_that_combine_them() -> None:
    np.testing.assert_array_equal(directions(DIMENSIONS, several=False), np.eye(3))
    assert len(directions(DIMENSIONS, several=True)) == 4
    np.testing.assert_array_equal(directions(("snap",), several=False), [[0, 1, 0]])
    np.testing.assert_array_equal(directions(("force", "vibration"), several=True), [[1, 0, 1]])


def two_observers(apart: float) -> Belief:
    """Return a belief that an observer is one of two, whose JNDs of force differ and who are else alike."""
    middle = np.tile(PRIOR.mean, (2, 1))
    middle[:, LAPSE] = -40.0
    middle[:, 0] += [-apart, apart]
    return Belief(middle, np.array([0.5, 0.5]))


def test_between_two_observers_information_is_what_the_answer_shares_with_who_it_is() -> None:
    either = two_observers(0.7)
    change = np.array([[0.12, 0.0, 0.0]])
    right = 0.5 * ndtr(AT_JND * 0.12 / np.exp(either.parameters[:, 0]))
    joint = np.array([right, 0.5 - right])  # answers by observers
    apart = joint.sum(axis=0) * joint.sum(axis=1)[:, None]
    assert information(either, change)[0] == pytest.approx(np.sum(joint * np.log(joint / apart)))


def test_where_all_observers_answer_alike_nothing_is_said() -> None:
    changes = np.array([[0.06, 0.0, 0.0], [0.24, 0.0, 0.0]])
    np.testing.assert_allclose(information(two_observers(0.0), changes), 0.0, atol=1e-12)
    # they differ in force, and are alike in snap
    other = np.array([[0.0, 0.5, 0.0]])
    np.testing.assert_allclose(information(two_observers(0.7), other), 0.0, atol=1e-12)


def test_information_is_how_much_the_entropy_of_the_belief_is_expected_to_fall() -> None:
    before = belief_after([((0.12, 0.0, 0.0), True)], PRIOR, 512)
    change = np.array([[0.2, 0.0, 0.0]])
    share = share_correct(before.parameters, change)[:, 0]
    fall = 0.0
    for likely in (share, 1 - share):
        probability = float(before.weights @ likely)
        after = before.weights * likely / probability
        fall += probability * float(np.sum(after * np.log(after / before.weights)))
    assert information(before, change)[0] == pytest.approx(fall)


def test_information_is_never_negative_and_never_above_one_bit() -> None:
    after = belief_after([((0.12, 0.0, 0.0), True), ((0.0, 0.5, 0.0), False)], PRIOR, 512)
    found = information(after, candidates(after, directions(DIMENSIONS, several=True), MOST))
    assert np.all(found >= -1e-12)
    assert np.all(found <= np.log(2))


@given(st.lists(st.booleans(), max_size=8), st.booleans())
@settings(max_examples=6, deadline=None)
def test_changes_stay_within_bounds_and_follow_from_the_trials(answers: list[bool], combined: bool) -> None:
    trials: list[Trial] = []
    for right in answers:
        change = next_change(trials, PRIOR, largest=(0.2, 0.5, 0.3), combined=combined)
        assert all(0 <= one <= most for one, most in zip(change, (0.2, 0.5, 0.3), strict=True))
        assert any(change)
        trials.append((change, right))
    once = next_change(trials, PRIOR, largest=(0.2, 0.5, 0.3), combined=combined)
    belief._belief.cache_clear()
    choose._next_change.cache_clear()
    assert next_change(list(trials), PRIOR, largest=(0.2, 0.5, 0.3), combined=combined) == once


def test_only_the_dimensions_that_are_asked_for_change() -> None:
    trials: list[Trial] = []
    for right in (True, False, True, True):
        change = next_change(trials, PRIOR, ("snap",), MOST)
        assert change[0] == change[2] == 0.0
        trials.append((change, right))


def test_every_third_trial_changes_several_where_that_is_asked_for() -> None:
    trials: list[Trial] = []
    for right in (True, False, True, True, True, False):
        trials.append((next_change(trials, PRIOR, largest=MOST, combined=True), right))
    assert [np.count_nonzero(change) > 1 for change, _ in trials] == [False, False, True] * 2
    alone = [((0.2, 0.0, 0.0), True)] * 2
    assert np.count_nonzero(next_change(alone, PRIOR, ("force",), MOST, combined=True)) == 1


def test_what_is_known_well_is_asked_less() -> None:
    trials: list[Trial] = [((0.2, 0.0, 0.0), bool(n % 5)) for n in range(60)]
    assert next_change(trials, PRIOR, largest=MOST)[0] == 0.0


def test_a_choice_after_sixty_trials_takes_less_than_50_ms_of_a_core() -> None:
    trials: list[Trial] = [((0.0, 0.0, 0.4 * 1.2 ** (n % 12 - 6)), n % 4 > 0) for n in range(60)]
    next_change(trials, PRIOR, largest=MOST, combined=True)
    took_s = []
    for n in range(5):
        began_s = time.process_time()
        next_change([*trials, ((0.12, 0.0, 0.0), n % 2 > 0)] * (1 + n), PRIOR, largest=MOST, combined=True)
        took_s.append(time.process_time() - began_s)
    assert min(took_s) < 0.05
