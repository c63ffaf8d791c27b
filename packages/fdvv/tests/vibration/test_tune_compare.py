"""Pairs: who is asked about, what the answers say."""

from collections import Counter

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.optimize import minimize

from fdvv.errors import ModelError
from fdvv.units import FloatArray
from fdvv.vibration.tune import Job, Preferred, SimulatedObserver, TuningState
from fdvv.vibration.tune_compare import PRIOR, Comparing, posterior, wins

JOB = Job((5,))


def run(method: Comparing, job: Job, observer: SimulatedObserver) -> TuningState:
    state = method.init(job)
    while (asked := method.ask(state)) is not None:
        state = method.tell(state, observer.answer(asked))
    return state


@given(st.lists(st.sampled_from(list(Preferred)), max_size=12), st.integers(0, 1000))
@settings(max_examples=30, deadline=None)
def test_the_same_answers_ask_the_same_so_that_a_session_can_go_on(
    answers: list[Preferred], seed: int
) -> None:
    method = Comparing(seed=seed)
    state = method.init(JOB)
    for answer in answers:
        if method.is_done(state):
            break
        assert method.ask(state) == Comparing(seed=seed).ask(TuningState(JOB, answers=state.answers))
        state = method.tell(state, answer)


@given(st.integers(0, 1000))
@settings(max_examples=20, deadline=None)
def test_two_different_templates_are_asked_about_and_each_as_often_first_as_second(seed: int) -> None:
    state = run(Comparing(seed=seed), JOB, SimulatedObserver([[0.0] * 5], seed=seed))
    lead: Counter[int] = Counter()
    for answered in state.answers:
        first, second = answered.templates
        assert first != second
        lead.update({first: 1, second: -1})
    assert all(abs(count) <= 2 for count in lead.values())


@pytest.mark.parametrize("seed", range(5))
def test_the_posterior_is_where_a_plain_search_finds_its_peak(seed: int) -> None:
    won = np.random.default_rng(seed).integers(0, 4, (4, 4)).astype(float)
    np.fill_diagonal(won, 0.0)

    def cost(logs: FloatArray) -> float:
        chance = 1 / (1 + np.exp(logs[None, :] - logs[:, None]))
        return float(-np.sum(won * np.log(chance)) + np.sum(logs**2) / 2 / PRIOR**2)

    slow = minimize(
        cost, np.zeros(4), method="Nelder-Mead", options={"xatol": 1e-7, "fatol": 1e-10, "maxiter": 9000}
    )
    assert posterior(won)[0] == pytest.approx(slow.x, abs=1e-3)


def test_without_answers_the_posterior_is_the_prior() -> None:
    mean, spread = posterior(np.zeros((3, 3)))
    assert mean.tolist() == [0.0, 0.0, 0.0]
    assert np.allclose(spread, PRIOR**2 * np.eye(3))


def test_a_draw_counts_half_for_both() -> None:
    method = Comparing()
    state = method.tell(method.init(JOB), Preferred.NEITHER)
    first, second = state.answers[0].templates
    assert wins(state, 0)[first, second] == wins(state, 0)[second, first] == 0.5
    assert wins(state, 0).sum() == 1


def test_an_observer_who_always_prefers_one_is_understood_in_fewer_answers_than_allowed() -> None:
    method = Comparing(comparisons=40)
    state = run(method, JOB, SimulatedObserver([[0, 0, 0, 9, 0]], noise=0.1))
    (found,) = method.best(state)
    assert found.best == 3
    assert found.distinct
    assert found.answers < 40


def test_an_observer_who_sees_no_difference_gets_no_claim_and_the_measured_one() -> None:
    method = Comparing()
    state = method.init(JOB)
    while method.ask(state) is not None:
        state = method.tell(state, Preferred.NEITHER)
    (found,) = method.best(state)
    assert not found.distinct
    assert found.best == 0
    assert found.answers == 15


@pytest.mark.parametrize("answer", [1, 0, "better"])
def test_what_is_no_preference_is_refused(answer: int) -> None:
    with pytest.raises(ModelError, match="an answer is one of first, second, neither"):
        Comparing().tell(Comparing().init(JOB), answer)


def test_each_velocity_has_answers_of_its_own() -> None:
    observer = SimulatedObserver([[5, 0, 0], [0, 0, 5, 0]], noise=0.1)
    method = Comparing()
    found = method.best(run(method, Job((3, 4)), observer))
    assert [standing.best for standing in found] == [0, 2]
    assert [len(standing.scores) for standing in found] == [3, 4]


@pytest.mark.slow
def test_chosen_pairs_find_the_best_more_often_than_pairs_by_chance() -> None:
    likes = [0.0, 0.4, 0.8, 1.2, 1.6, 2.0, 1.0, 0.2]
    chosen = drawn = 0
    for seed in range(120):
        observer = SimulatedObserver([likes], seed=seed)
        method = Comparing(comparisons=24, sure=1.0, seed=seed)
        state = run(method, Job((8,)), observer)
        chosen += int(np.argmax(posterior(wins(state, 0))[0])) == 5
        random = np.random.default_rng(seed)
        won = np.zeros((8, 8))
        for _ in range(24):
            a, b = random.choice(8, 2, replace=False)
            perceived = np.array([likes[a], likes[b]]) + random.normal(size=2)
            won[(a, b) if perceived[0] > perceived[1] else (b, a)] += 1
        drawn += int(np.argmax(posterior(won)[0])) == 5
    assert chosen > drawn


@pytest.mark.parametrize("bad", [{"comparisons": 0}, {"fewest": 0}, {"sure": 0.4}, {"seed": -1}])
def test_impossible_settings_are_refused(bad: dict[str, int]) -> None:
    with pytest.raises(ModelError):
        Comparing(**bad)


@pytest.mark.parametrize("templates", [(), (1,), (3, 1)])
def test_a_job_without_a_choice_is_refused(templates: tuple[int, ...]) -> None:
    with pytest.raises(ModelError, match="tuning needs 2 templates"):
        Job(templates)
