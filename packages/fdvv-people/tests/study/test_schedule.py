"""Schedules: balance of orders over a whole study, and what labels tell."""

from __future__ import annotations

from collections import Counter
from itertools import pairwise, product

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fdvv_people.stats.orders import williams_orders
from fdvv_people.study.plan.plan import Item, Rating, Staircase, Stimulus, StudyPlan
from fdvv_people.study.plan.schedule import draw_schedule, item_orders
from fdvv_people.study.plan.trial import StudyTrial


def plan_of(items: int, rounds: int, kind: str = "realism", stimuli: int = 2, practice: int = 0) -> StudyPlan:
    names = ["FD", "FDVV", "low", "mid"][:stimuli]
    made = tuple(
        Item(name=f"button {i}", stimuli=tuple(Stimulus(name=n, button="mx-clear") for n in names))
        for i in range(items)
    )
    return StudyPlan(
        name="study",
        title={"en": "Study"},
        kind=kind,
        items=made,
        rounds=rounds,
        practice=practice,
        ratings=(Rating(name="close", question={"en": "?"}),) if kind == "mushra" else (),
        staircase=Staircase(trials=10) if kind == "staircase" else None,
    )


def schedules(plan: StudyPlan, people: int, seed: int = 0) -> list[tuple[StudyTrial, ...]]:
    return [draw_schedule(plan, i, np.random.default_rng([seed, i])) for i in range(people)]


def orders_of(trials: tuple[StudyTrial, ...], rounds: int) -> list[list[str]]:
    return [[t.item for t in trials if t.round == r and not t.practice] for r in range(rounds)]


def places(orders: list[list[str]]) -> Counter[tuple[int, str]]:
    return Counter((place, item) for order in orders for place, item in enumerate(order))


def follows(orders: list[list[str]]) -> Counter[tuple[str, str]]:
    return Counter(pair for order in orders for pair in pairwise(order))


@settings(max_examples=60, deadline=None)
@given(st.integers(2, 9), st.integers(1, 8), st.integers(1, 5))
def test_every_button_is_in_every_place_and_after_every_other_equally_often_where_a_study_allows(
    items: int, rounds: int, times: int
) -> None:
    rows = items if items % 2 == 0 else 2 * items
    # the fewest people whose rounds fill whole Williams designs, some times over
    people = times * rows // int(np.gcd(rows, rounds))
    orders = [o for one in schedules(plan_of(items, rounds), people) for o in orders_of(one, rounds)]
    stood, followed = places(orders), follows(orders)
    assert len(stood) == items**2
    assert len(set(stood.values())) == 1
    assert len(followed) == items * (items - 1)
    assert len(set(followed.values())) == 1


@settings(max_examples=60, deadline=None)
@given(st.integers(2, 9), st.integers(1, 14), st.integers(1, 30))
def test_at_any_time_no_row_was_used_more_than_once_more_often_than_another(
    items: int, rounds: int, people: int
) -> None:
    plan, rows = plan_of(items, rounds), williams_orders(items)
    used = Counter(order for person in range(people) for order in item_orders(plan, person))
    counts = [used[row] for row in rows]
    assert max(counts) - min(counts) <= 1


@settings(max_examples=60, deadline=None)
@given(st.integers(2, 9), st.integers(1, 14))
def test_as_many_people_as_rows_meet_every_row_in_every_round(items: int, rounds: int) -> None:
    plan, rows = plan_of(items, rounds), williams_orders(items)
    for round_ in range(rounds):
        assert {item_orders(plan, person)[round_] for person in range(len(rows))} == set(rows)


def test_in_the_papers_study_every_person_meets_every_order_once() -> None:
    plan = plan_of(6, 6)
    for person in range(12):
        assert set(item_orders(plan, person)) == set(williams_orders(6))


def test_one_button_has_one_order_and_random_orders_hold_every_button() -> None:
    from msgspec.structs import replace

    assert item_orders(plan_of(1, 3), 5) == ((0,), (0,), (0,))
    orders = item_orders(replace(plan_of(5, 40), order="random"), 0, np.random.default_rng(1))
    assert all(sorted(order) == [0, 1, 2, 3, 4] for order in orders)
    assert len(set(orders)) > 20


@settings(max_examples=40, deadline=None)
@given(
    st.sampled_from(["realism", "abx", "2afc", "2ac", "preference", "staircase"]),
    st.integers(1, 4),
    st.integers(1, 9),
    st.integers(0, 2**32 - 1),
)
def test_labels_are_balanced_within_a_person_and_button(
    kind: str, items: int, rounds: int, seed: int
) -> None:
    plan = plan_of(items, rounds, kind, practice=2)
    (trials,) = schedules(plan, 1, seed)
    assert [t.number for t in trials] == list(range(len(trials)))
    for item in plan.items:
        own = [t for t in trials if t.item == item.name and not t.practice]
        hidden = [
            "AB"[list(t.labels.values()).index(t.labels["X"])] if kind == "abx" else t.correct for t in own
        ]
        sides = [t.labels["A"] for t in own] if kind != "abx" else hidden
        for counted in (sides, [t.labels.get("X", "") for t in own] if kind == "abx" else sides):
            count = Counter(counted)
            assert abs(2 * max(count.values()) - len(own)) <= 1
        assert all(set(t.labels.values()) == {"FD", "FDVV"} for t in own)
        if kind == "abx":
            assert all(t.labels[t.correct] == t.labels["X"] for t in own)
        elif kind in ("2afc", "2ac", "staircase"):
            assert all(t.labels[t.correct] == "FDVV" for t in own)
        else:
            assert all(t.correct == "" for t in own)


def test_all_balanced_sequences_of_labels_are_equally_likely() -> None:
    plan, random = plan_of(1, 4), np.random.default_rng(3)
    drawn = Counter(
        "".join((t.labels["A"] == "FD" and "a") or "b" for t in draw_schedule(plan, 0, random))
        for _ in range(6000)
    )
    assert len(drawn) == 6
    # chi square of 5 degrees of freedom, far in its tail
    assert sum((count - 1000) ** 2 / 1000 for count in drawn.values()) < 25


def test_an_odd_round_goes_to_either_side_and_practice_is_a_coin() -> None:
    random = np.random.default_rng(4)
    more = Counter[str]()
    for _ in range(800):
        trials = draw_schedule(plan_of(1, 3, practice=1), 0, random)
        more["odd"] += sum(t.labels["A"] == "FD" for t in trials[1:]) > 1
        more["practice"] += trials[0].labels["A"] == "FD"
    assert all(320 < count < 480 for count in more.values())


def test_buttons_of_a_person_are_independent_of_each_other() -> None:
    random, same = np.random.default_rng(5), 0
    for _ in range(800):
        trials = draw_schedule(plan_of(2, 2), 0, random)
        first = {t.item: t.labels["A"] for t in reversed(trials)}
        same += first["button 0"] == first["button 1"]
    assert 320 < same < 480


def test_orders_that_all_may_see_are_drawn_from_another_stream_than_labels() -> None:
    from msgspec.structs import replace

    plan = plan_of(1, 6)
    random = replace(plan_of(4, 6), order="random")
    one, other = (draw_schedule(p, 0, np.random.default_rng(7)) for p in (plan, random))
    first = [t.labels for t in other if t.item == "button 0"]
    assert [t.labels for t in one] == first
    assert len({tuple(t.item for t in other if t.round == r) for r in range(6)}) > 1


def test_many_stimuli_are_permuted_anew_in_every_trial() -> None:
    random = np.random.default_rng(6)
    trials = [t for _ in range(300) for t in draw_schedule(plan_of(1, 4, "mushra", 4), 0, random)]
    assert all(list(t.labels) == ["A", "B", "C", "D"] for t in trials)
    drawn = Counter(tuple(t.labels.values()) for t in trials)
    assert len(drawn) == 24
    again = Counter(a.labels["A"] == b.labels["A"] for a, b in pairwise(trials))
    assert 240 < again[True] < 360


def guessed(rounds: int, share: float) -> list[float]:
    """Return the part of assignments that the best guess hits beforehand, by trial."""
    sequences = [s for s in product((0, 1), repeat=rounds) if 2 * sum(s) == rounds]
    hit = []
    for trial in range(rounds):
        likely = 0.0
        for answers in product((0, 1), repeat=trial):
            weight = [0.0, 0.0]
            for one in sequences:
                right = sum(a == b for a, b in zip(answers, one, strict=False))
                weight[one[trial]] += share**right * (1 - share) ** (trial - right) / len(sequences)
            likely += max(weight)
        hit.append(likely)
    return hit


@pytest.mark.parametrize(
    ("rounds", "share", "mean", "last"),
    [(6, 1.0, 0.68, 1.0), (6, 0.7731, 0.57, 0.63), (2, 0.7731, 0.64, 0.77)],
)
def test_what_earlier_answers_tell_of_a_label_is_what_the_docstring_says(
    rounds: int, share: float, mean: float, last: float
) -> None:
    hit = guessed(rounds, share)
    assert round(float(np.mean(hit)), 2) == mean
    assert round(hit[-1], 2) == last
    assert draw_schedule.__doc__
    assert all(f"{round(100 * value)} " in draw_schedule.__doc__ for value in (mean, last) if value < 1)


def test_a_staircase_has_a_block_of_trials_for_every_item_and_round() -> None:
    (trials,) = schedules(plan_of(2, 3, "staircase", practice=1), 1)
    assert trials[0].ratio == 0.3
    blocks = [(t.item, t.round) for t in trials if not t.practice]
    assert len(blocks) == 60
    assert sum(a != b for a, b in pairwise(blocks)) == 5
