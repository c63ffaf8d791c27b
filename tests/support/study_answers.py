"""Answers of made-up people, for all tests that look at an analysis: whoever is asked leans a known way."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from fdvv.units import FloatArray
from fdvv_people.study.plan.answers import Answers
from fdvv_people.study.plan.plan import Staircase
from fdvv_people.study.plan.staircase import staircase_state
from fdvv_people.study.plan.trial import EQUAL

BUTTONS = ("Clear", "Brown", "Black", "Red", "HP keyboard", "MacBook Pro keyboard")
CHOSEN, ASKED = 334, 432


def rows_of(people: int, buttons: tuple[str, ...], rounds: int) -> list[tuple[str, str, int]]:
    return [(f"P{p + 1:02d}", button, k) for p in range(people) for button in buttons for k in range(rounds)]


def answers_of(
    kind: str,
    stimuli: tuple[str, ...],
    rows: list[tuple[str, str, int]],
    choice: np.ndarray | None = None,
    correct: FloatArray | None = None,
    ratings: dict[str, FloatArray] | None = None,
) -> Answers:
    n = len(rows)
    return Answers(
        kind,
        stimuli,
        person=np.array([one[0] for one in rows]),
        item=np.array([one[1] for one in rows]),
        round=np.array([one[2] for one in rows]),
        choice=np.full(n, "") if choice is None else choice,
        correct=np.full(n, np.nan) if correct is None else correct,
        ratings=ratings or {},
        time_s=np.linspace(10.0, 30.0, n),
    )


def realism(
    people: int = 12, rounds: int = 2, buttons: tuple[str, ...] = BUTTONS, lean: float = 1.0, seed: int = 1
) -> Answers:
    """Return choices with ties and ratings from 1 to 7; lean : how far FDVV is felt above FD."""
    random = np.random.default_rng(seed)
    rows = rows_of(people, buttons, rounds)
    felt = lean + random.normal(0, 1, len(rows))
    choice = np.select([felt > 0.3, felt < -0.3], ["FDVV", "FD"], EQUAL)
    sides = np.array([-0.5, 0.5])
    scale = np.round(4 + felt[:, np.newaxis] * sides + random.normal(0, 0.7, (len(rows), 2)))
    return answers_of("realism", ("FD", "FDVV"), rows, choice, ratings={"realism": np.clip(scale, 1, 7)})


def paper_like() -> Answers:
    """Return 12 people of 36 trials who all rate FDVV higher for every button, and choose it 334 times."""
    rows = rows_of(12, BUTTONS, 6)
    choice = np.full(ASKED, "FD", "<U8")
    choice[np.random.default_rng(0).permutation(ASKED)[:CHOSEN]] = "FDVV"
    above = np.repeat(np.linspace(0.5, 2.0, 12), 36)
    ratings = {"realism": np.column_stack([np.full(ASKED, 3.0), 3.0 + above])}
    return answers_of("realism", ("FD", "FDVV"), rows, choice, ratings=ratings)


def all_ties(people: int = 8) -> Answers:
    found = realism(people, 2, ("Clear", "Red"))
    n = len(found.person)
    return replace(found, choice=np.full(n, EQUAL), ratings={"realism": np.full((n, 2), 4.0)})


def with_missing(share: float = 0.2, seed: int = 3) -> Answers:
    found = realism(6, 4, ("Clear", "Red"))
    gone = np.random.default_rng(seed).random(len(found.person)) < share
    ratings = np.where(gone[:, np.newaxis], np.nan, found.ratings["realism"])
    return replace(found, choice=np.where(gone, "", found.choice), ratings={"realism": ratings})


def right_or_wrong(kind: str = "abx", people: int = 10, share: float = 0.7, seed: int = 2) -> Answers:
    rows = rows_of(people, ("Clear", "Red"), 8)
    correct = (np.random.default_rng(seed).random(len(rows)) < share).astype(np.float64)
    choice = np.where(correct == 1, "FDVV", "FD")
    return answers_of(kind, ("FD", "FDVV"), rows, choice, correct)


def choices_only(kind: str, people: int = 10, ties: bool = True) -> Answers:
    found = realism(people, 4, ("Clear", "Red"))
    choice = found.choice if ties else np.where(found.choice == EQUAL, "FD", found.choice)
    return replace(found, kind=kind, ratings={}, choice=choice)


def mushra(people: int = 9, buttons: tuple[str, ...] = ("Clear", "Red")) -> Answers:
    rows = rows_of(people, buttons, 2)
    random = np.random.default_rng(4)
    means = np.array([97.0, 78.0, 60.0, 22.0])
    scores = np.clip(random.normal(means, (1.5, 10, 12, 9), (len(rows), 4)).round(), 0, 100)
    return answers_of("mushra", ("reference", "FDVV", "FD", "anchor"), rows, ratings={"quality": scores})


def staircase(people: int = 4, threshold: float = 0.08) -> Answers:
    """Return staircases of people who are right below the threshold by chance and above it always."""
    random = np.random.default_rng(5)
    rows, ratios, correct = [], [], []
    for person in range(people):
        history: list[tuple[float, bool]] = []
        while (ratio := staircase_state(Staircase(), history).ratio) is not None:
            history.append((ratio, bool(ratio > threshold or random.random() < 0.5)))
        rows += [(f"P{person + 1:02d}", "Clear", k) for k in range(len(history))]
        ratios += [ratio for ratio, _ in history]
        correct += [float(right) for _, right in history]
    found = answers_of("staircase", ("standard", "comparison"), rows, correct=np.array(correct))
    return replace(found, ratio=np.array(ratios))


def timing(people: int = 8) -> Answers:
    rows = rows_of(people, ("optimal", "clear", "random"), 2)
    random = np.random.default_rng(6)
    base = np.array([{"optimal": 70.0, "clear": 88.0, "random": 100.0}[one[1]] for one in rows])
    scores = np.column_stack([base, 1.1 * base]) + random.normal(0, 5, (len(rows), 2))
    return answers_of("timing", ("easy", "hard"), rows, ratings={"asynchrony_ms": scores})


EVERY_KIND = {
    "realism": realism(7, 2, ("Clear", "Red")),
    "abx": right_or_wrong("abx"),
    "2afc": right_or_wrong("2afc"),
    "2ac": choices_only("2ac"),
    "preference": choices_only("preference", ties=False),
    "mushra": mushra(),
    "staircase": staircase(),
    "timing": timing(),
}
BROKEN = {
    "one person": realism(1, 2),
    "one person, one trial": realism(1, 1, ("Clear",)),
    "two people": realism(people=2, buttons=("Clear",)),
    "all ties": all_ties(),
    "missing trials": with_missing(),
    "nearly nothing left": with_missing(0.7),
    "one item": realism(7, 2, ("Clear",)),
    "one abx person": right_or_wrong(people=1),
    "all right": right_or_wrong("2afc", share=1.1),
    "one mushra person": mushra(1, ("Clear",)),
    "two mushra people": mushra(2),
    "one staircase": staircase(1),
    "one timing person": timing(1),
}
