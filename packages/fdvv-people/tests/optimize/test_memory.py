"""A run that is opened again is spared the fits of the last time, and none that its trials have changed."""

from __future__ import annotations

from functools import partial
from pathlib import Path

import pytest

from fdvv_people.optimize.run.memory import LastResult, RunMemory
from fdvv_people.optimize.run.session import Optimization
from fdvv_people.optimize.run.setup import OptimizeSetup
from fdvv_people.task.score import Objective, Score

TWO = (Objective("asynchrony_ms"), Objective("effort_N_s"))


def play(session: Optimization, count: int) -> None:
    for _ in range(count):
        (trial,) = session.ask()
        slow, effort = trial.design["actuation_mm"], trial.design["y1_cN"]
        scores = {"asynchrony_ms": Score(60.0 + 8.0 * slow, 1.0), "effort_N_s": Score(effort / 50.0, 1.0)}
        session.answer(trial.number, scores)


def test_a_result_is_computed_anew_for_other_inputs_and_after_an_error_only() -> None:
    asked: list[int] = []

    def squared(number: int) -> int:
        asked.append(number)
        if number < 0:
            raise ValueError("negative")
        return number**2

    last = LastResult[int]()
    assert [last.of(one, partial(squared, one)) for one in (3, 3, 4, 3)] == [9, 9, 16, 9]
    assert asked == [3, 4, 3]
    for _ in range(2):
        with pytest.raises(ValueError, match="negative"):
            last.of(-1, partial(squared, -1))
    assert asked == [3, 4, 3, -1, -1]


def test_a_run_opened_with_its_memory_has_the_same_front_until_a_trial_is_done(tmp_path: Path) -> None:
    memory, folder = RunMemory(), tmp_path / "run"
    Optimization.create(folder, OptimizeSetup(engine="sobol", objectives=TWO, budget=7)).close()
    with Optimization.open(folder, memory) as session:
        play(session, 6)
        front = session.front()
        session.ask()
    with Optimization.open(folder, memory) as session:
        assert session.front() is front
        play(session, 1)
        longer, found = session.front(), session.recommended()
        assert longer is not front
    with Optimization.open(folder) as session:
        assert (session.front(), session.recommended()) == (longer, found)


def test_a_memory_of_another_run_changes_nothing(tmp_path: Path) -> None:
    memory = RunMemory()
    for seed in (0, 1):
        folder = tmp_path / str(seed)
        Optimization.create(folder, OptimizeSetup(engine="sobol", seed=seed, budget=3)).close()
        with Optimization.open(folder, memory) as session:
            play(session, 3)
            best = session.best()
            assert session.best() is best
        with Optimization.open(folder) as session:
            assert session.best() == best
