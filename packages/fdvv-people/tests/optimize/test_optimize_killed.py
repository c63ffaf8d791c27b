"""A run killed at any moment: every finished trial is there, and it goes on with the very same designs."""

from __future__ import annotations

import os
import random
import signal
import subprocess
import sys
from functools import cache
from pathlib import Path

import numpy as np
import pytest

from fdvv_people.optimize.engines.registry import engine_of
from fdvv_people.optimize.paper_space import paper_space
from fdvv_people.optimize.problem import Problem, Trial, TrialState
from fdvv_people.optimize.run.session import Optimization
from fdvv_people.optimize.run.setup import OptimizeSetup
from fdvv_people.optimize.space import Design
from fdvv_people.task.score import Objective, Score
from tests.hatchery import Hatchery, fork_and_kill
from tests.support.campaign import campaign

BUDGET = 100_000
"""More than a run makes in all its lives, on any machine: what it must read grows with what it made."""


def score(number: int, design: Design) -> Score:
    """Return a noisy score that depends on nothing but the trial."""
    noise = np.random.default_rng(number).normal()
    return Score(60.0 + 9.0 * abs(design["actuation_mm"] - 1.0) + 7.0 * noise, 7.0)


def go_on(session: Optimization):  # type: ignore[no-untyped-def]
    """Try what the session asks, now and then in a batch of two; yield each finished trial."""
    while asked := session.ask(2 if finished(session) % 5 == 0 else 1):
        for trial in asked:
            if trial.state is TrialState.SUGGESTED:
                session.show(trial.number)
            found = score(trial.number, trial.design)
            yield session.answer(trial.number, {"asynchrony_ms": found})


def finished(session: Optimization) -> int:
    return sum(trial.state is TrialState.DONE for trial in session.trials)


def setup_of(engine: str, seed: int) -> OptimizeSetup:
    return OptimizeSetup(engine=engine, seed=seed, budget=BUDGET, created="then", versions={})


@cache
def undisturbed(engine: str, seed: int, count: int) -> tuple[Trial, ...]:
    """Return the trials of a run that nobody killed."""
    import tempfile

    with (
        tempfile.TemporaryDirectory() as folder,
        Optimization.create(Path(folder) / "run", setup_of(engine, seed)) as session,
    ):
        steps = go_on(session)
        while len(session.trials) < count:
            next(steps)
        return session.trials


def hatch(engine: str) -> None:
    """Let an engine suggest once, then fork runs of it and kill them."""
    warm = engine_of(engine)
    case = Problem(paper_space(), (Objective("asynchrony_ms"),))
    designs = engine_of("sobol").suggest(case, [], 12)
    done = {"asynchrony_ms": score(0, designs[0])}
    warm.suggest(case, [Trial(i, design, TrialState.DONE, done) for i, design in enumerate(designs)])
    fork_and_kill(acknowledge)


def acknowledge(folder: str, into: int) -> None:
    """Go on with a run and tell every finished trial, until somebody kills this process."""
    with Optimization.open(Path(folder)) as session:
        for trial in go_on(session):
            os.write(into, f"{trial.number}:{trial.scores['asynchrony_ms'].value!r}\n".encode())
    signal.pause()


def check_kills(folder: Path, engine: str, seed: int, kills: int, longest_s: float) -> None:
    """Kill one run again and again; each time all that it acknowledged is there, and it is the same run."""
    rng = random.Random(seed)
    Optimization.create(folder, setup_of(engine, seed)).close()
    acknowledged: dict[int, float] = {}
    hatchery = Hatchery("tests.optimize.test_optimize_killed", engine)
    for _ in range(kills):
        pairs = (line.split(":") for line in hatchery.killed(folder, after_s=rng.uniform(0.0, longest_s)))
        acknowledged |= {int(number): float(value) for number, value in pairs}
        with Optimization.open(folder) as session:
            trials = session.trials
        for number, value in acknowledged.items():
            assert trials[number].state is TrialState.DONE
            assert trials[number].scores["asynchrony_ms"].value == value
        # what the killed runs had not finished is what the next one begins with
        assert sum(trial.state is not TrialState.DONE for trial in trials) <= 2
    hatchery.close()
    with Optimization.open(folder) as session:
        asked = session.ask(2 if finished(session) % 5 == 0 else 1)
        count = len(session.trials)
    wanted = undisturbed(engine, seed, count)
    assert [trial.design for trial in session.trials] == [trial.design for trial in wanted[:count]]
    assert asked[0].design == wanted[asked[0].number].design
    assert acknowledged


def test_a_killed_run_loses_no_finished_trial_and_asks_the_same_next_design(tmp_path: Path) -> None:
    check_kills(tmp_path / "run", "sobol", 1, 4, 0.2)


@pytest.mark.slow
@campaign(("engine", "seed", "kills"), [("random", 5, 90), ("sobol", 6, 70), ("gp", 8, 20)], part=1)
def test_no_finished_trial_is_lost_at_two_hundred_random_moments(
    tmp_path: Path, engine: str, seed: int, kills: int
) -> None:
    check_kills(tmp_path / "run", engine, seed, kills, 0.05 if engine in ("random", "sobol") else 0.2)


def test_a_second_process_on_a_folder_is_refused_in_one_line(tmp_path: Path) -> None:
    code = "import sys; from pathlib import Path; from fdvv_people.optimize.run.session import Optimization\n"
    code += "from fdvv.errors import InputError\n"
    code += "try: Optimization.open(Path(sys.argv[1]))\nexcept InputError as error: print(error)"
    with Optimization.create(tmp_path / "run", setup_of("sobol", 0)):
        command = [sys.executable, "-c", code, str(tmp_path / "run")]
        found = subprocess.run(command, capture_output=True, text=True, check=True)
    assert found.stdout.count("\n") == 1
    assert "another process is at work on this run" in found.stdout
