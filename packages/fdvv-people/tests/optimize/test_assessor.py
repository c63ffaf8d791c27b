"""Simulated people who compare: by their own taste, the same after a kill, to a design they like better."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from fdvv.errors import InputError
from fdvv_people.optimize.people.taste import draw_taste, expected_liking
from fdvv_people.optimize.problem import Answer
from fdvv_people.optimize.run.assessor import SimulatedAssessor, assessor_of
from fdvv_people.optimize.run.begin import RunRequest, begin_run
from fdvv_people.optimize.run.report import optimize_html, optimize_report
from fdvv_people.optimize.run.session import Optimization
from fdvv_people.optimize.run.verdict import verdict_sentence
from fdvv_people.task.pointing import ASYNCHRONY

COMPARED: dict[str, Any] = {"task": "preference", "space": "paper"}
ENGINES = ("preference-line", "preference")


def begun(folder: Path, person: int = 3, engine: str | None = None, budget: int = 5) -> Optimization:
    return begin_run(folder, RunRequest(engine=engine, budget=budget, person=person, retest=4, **COMPARED))


def assessed(folder: Path, person: int = 3, engine: str | None = None) -> Optimization:
    session = begun(folder, person, engine)
    assessor_of(session.setup).play(session)
    return session


def test_what_is_found_suits_the_taste_of_most_people_better_than_the_start(tmp_path: Path) -> None:
    gains = []
    for person in range(12):
        with assessed(tmp_path / str(person), person) as session:
            found, start, taste = session.recommended(), session.start, draw_taste(0, person)
            assert found is not None
            assert start is not None
            gains.append(
                expected_liking(session.model(found), taste) - expected_liking(session.model(start), taste)
            )
    assert np.mean(gains) > 0.2
    assert np.mean(np.array(gains) > 0) > 0.7


@pytest.mark.parametrize("engine", ENGINES)
def test_a_run_in_pieces_has_the_answers_of_one_at_a_time(tmp_path: Path, engine: str) -> None:
    with assessed(tmp_path / "whole", engine=engine) as session:
        whole = session.trials, session.retests
        assert session.finished
    begun(tmp_path / "pieces", engine=engine).close()
    going = True
    while going:
        with Optimization.open(tmp_path / "pieces") as session:
            going = assessor_of(session.setup).answer_next(session)
    with Optimization.open(tmp_path / "pieces") as session:
        assert (session.trials, session.retests) == whole


def test_buttons_that_feel_alike_are_equal_or_either_is_preferred(tmp_path: Path) -> None:
    with begun(tmp_path / "run", engine="preference", budget=1) as session:
        (pair,) = session.ask()
        people = [SimulatedAssessor(draw_taste(0, 3), seed) for seed in range(400)]
        said = [one.compare(session, [pair.design, pair.design], 0) for one in people]
    counts = [said.count(answer) for answer in (Answer.FIRST, Answer.SECOND, Answer.EQUAL)]
    # a difference of two normal numbers of 0.3 points is within 0.15 in 28 %
    assert counts == pytest.approx([145, 145, 110], abs=35)


@pytest.mark.parametrize("engine", ENGINES)
def test_the_end_counts_answers_and_says_simulated(tmp_path: Path, engine: str) -> None:
    with assessed(tmp_path / "run", engine=engine) as session:
        document, page = optimize_report(session), optimize_html(session)
        sentence = verdict_sentence(session)
    assert document["verdict"] == sentence
    assert "simulated" in str(sentence)
    assert document["answers"].count(Answer.EQUAL) < 4
    assert len(document["lines"]) + len(document["comparisons"]) == 5
    assert f"5 of 5 {'lines' if engine == 'preference-line' else 'comparisons'} answered" in page
    assert "compared 4 times, blind" in page
    assert "Trials" not in page


@pytest.mark.parametrize(
    ("request_", "message"),
    [
        (RunRequest(task="preference", engine="gp"), "reads scores, but designs are compared"),
        (RunRequest(engine="preference-line"), "temporal-pointing is scored; play preference"),
        (RunRequest(task="preference", also=("liking",)), "--also: preference: designs are compared"),
        (RunRequest(task="preference", weights={ASYNCHRONY.name: 1.0}), "--weight: preference"),
        (RunRequest(task="preference", switches=("mx-red",)), "--switch: preference"),
        (RunRequest(task="preference", rig="light"), "compares designs as they are"),
    ],
)
def test_what_comparing_has_no_use_for_is_refused(tmp_path: Path, request_: RunRequest, message: str) -> None:
    with pytest.raises(InputError, match=message):
        begin_run(tmp_path / "run", request_)
    assert not (tmp_path / "run").exists()


def test_a_run_of_a_person_waits_for_that_person(tmp_path: Path) -> None:
    request = RunRequest(task="preference", budget=2, person=None)
    with begin_run(tmp_path / "run", request) as session, pytest.raises(InputError, match="no simulated"):
        assessor_of(session.setup)
