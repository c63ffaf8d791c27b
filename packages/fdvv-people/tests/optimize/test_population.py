"""A population on chunks: resumed, killed and shared out, its result stays the same to the bit."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import threading
from collections.abc import Iterator
from pathlib import Path

import msgspec
import numpy as np
import pytest

from fdvv.errors import InputError
from fdvv.parallel.open import open_executor
from fdvv_people.optimize.engines.registry import engine_of
from fdvv_people.optimize.paper_space import paper_space
from fdvv_people.optimize.population.plan import PopulationPlan
from fdvv_people.optimize.population.population import PopulationResult, read_population, run_population
from fdvv_people.optimize.problem import Problem
from fdvv_people.task.pointing import TemporalPointing

PEOPLE = PopulationPlan(people=5, seed=3, engine="random", budget=3, rounds=5, judged=1)
GRID = PopulationPlan(kind="grid", people=9, seed=3, designs=12, rounds=4)


def run(folder: Path, plan: PopulationPlan, processes: int = 1) -> PopulationResult:
    with open_executor(processes=processes) as executor:
        return run_population(folder, plan, executor)


def same(first: PopulationResult, second: PopulationResult) -> bool:
    assert first.columns.keys() == second.columns.keys()
    return all(np.array_equal(first.columns[name], second.columns[name]) for name in first.columns)


def children() -> set[int]:
    path = Path(f"/proc/{os.getpid()}/task/{threading.get_native_id()}/children")
    return {int(pid) for pid in path.read_text().split()}


@pytest.fixture(scope="module")
def people(tmp_path_factory: pytest.TempPathFactory) -> PopulationResult:
    return run(tmp_path_factory.mktemp("people") / "run", PEOPLE)


@pytest.fixture(scope="module")
def grid(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, PopulationResult]:
    folder = tmp_path_factory.mktemp("grid") / "run"
    return folder, run(folder, GRID)


def test_every_person_has_trials_of_their_own_and_is_judged_on_others(people: PopulationResult) -> None:
    columns = people.columns
    assert columns["designs"].shape == (5, 3, 8)
    assert columns["values"].shape == (5, 3)
    assert columns["best"].shape == (5, 8)
    assert len(np.unique(columns["designs"][:, 0], axis=0)) == 5
    # what is recommended was tried
    assert all(
        any(np.allclose(b, d) for d in tried)
        for b, tried in zip(columns["best"], columns["designs"], strict=True)
    )
    assert not np.isin(columns["judged"], columns["values"]).all()


@pytest.mark.slow
def test_the_first_people_of_a_large_population_are_those_of_a_small_one(
    people: PopulationResult, tmp_path: Path
) -> None:
    few = run(tmp_path / "few", msgspec.structs.replace(PEOPLE, people=2))
    assert all(np.array_equal(few.columns[name], people.columns[name][:2]) for name in few.columns)


@pytest.mark.parametrize(
    "options",
    [{"processes": 2}, pytest.param({"workers": 2}, marks=pytest.mark.slow)],
    ids=["processes", "dask"],
)
def test_who_works_on_it_changes_nothing(
    people: PopulationResult, tmp_path: Path, options: dict[str, int]
) -> None:
    with open_executor(options.get("processes"), options.get("workers")) as executor:
        assert same(run_population(tmp_path / "run", PEOPLE, executor), people)


@pytest.mark.slow
def test_a_worker_killed_from_outside_costs_only_its_chunk(people: PopulationResult, tmp_path: Path) -> None:
    killed: list[int] = []
    before = children()

    def kill(done: int, whole: int) -> None:
        if done == 2 and not killed:
            killed.append(max(children() - before))
            os.kill(killed[0], signal.SIGKILL)

    with open_executor(processes=2) as executor:
        found = run_population(tmp_path / "run", PEOPLE, executor, progress=kill)
    assert killed
    assert same(found, people)


RUN = """
import sys
from pathlib import Path
from fdvv_people.optimize.population.plan import PopulationPlan
from fdvv.parallel.open import open_executor
from fdvv_people.optimize.population.population import run_population
if __name__ == "__main__":
    plan = PopulationPlan(people=5, seed=3, engine="random", budget=3, rounds=5, judged=1)
    with open_executor(processes=2) as executor:
        run_population(Path(sys.argv[1]), plan, executor, progress=lambda done, _: print(done, flush=True))
"""


@pytest.mark.slow
def test_a_run_killed_as_a_whole_goes_on_where_it_was(people: PopulationResult, tmp_path: Path) -> None:
    script, folder = tmp_path / "run.py", tmp_path / "run"
    script.write_text(RUN)
    with subprocess.Popen(
        [sys.executable, str(script), str(folder)], stdout=subprocess.PIPE, text=True
    ) as process:
        assert process.stdout is not None
        while process.stdout.readline().strip() not in ("2", ""):
            pass
        process.kill()
    done_counts: list[int] = []
    with open_executor(processes=1) as executor:
        found = run_population(folder, PEOPLE, executor, progress=lambda done, _: done_counts.append(done))
    assert done_counts[0] >= 2
    assert same(found, people)
    assert same(read_population(folder), people)


def test_a_finished_run_is_read_without_any_work(grid: tuple[Path, PopulationResult]) -> None:
    folder, first = grid

    class Nobody:
        processes = 1

        def run(self, work: object, chunks: list[int]) -> Iterator[tuple[int, object]]:
            assert not chunks
            return iter(())

    assert same(run_population(folder, GRID, Nobody()), first)  # type: ignore[arg-type]


def test_a_grid_scores_every_design_by_everybody(grid: tuple[Path, PopulationResult]) -> None:
    result = grid[1]
    values, errors = result.table()
    assert values.shape == errors.shape == (12, 9)
    assert len(result.designs) == 12
    assert np.ptp(values, axis=0).min() > 0
    summary = result.summary()
    assert summary["simulated"]
    assert summary["best"]["mean_ms"] == pytest.approx(values.mean(axis=1).min())


def test_a_grid_becomes_what_others_begin_from(grid: tuple[Path, PopulationResult]) -> None:
    result = grid[1]
    prior = result.prior()
    values, _ = result.table()
    assert [t.scores["asynchrony_ms"].value for t in prior] == pytest.approx(values.mean(axis=1).tolist())
    # somebody who is late with every design says nothing of which is better
    apart = values - values.mean(axis=0)
    errors = apart.std(axis=1, ddof=1) / np.sqrt(values.shape[1])
    assert [t.scores["asynchrony_ms"].error for t in prior] == pytest.approx(errors.tolist())
    problem = Problem(paper_space(), TemporalPointing().objectives, 1, prior)
    design = engine_of("gp").suggest(problem, ())[0]
    assert not problem.space.broken(design)


def test_a_grid_passes_on_how_people_differ(grid: tuple[Path, PopulationResult]) -> None:
    components = np.array([trial.components for trial in grid[1].prior()])
    values, _ = grid[1].table()
    differences = values - values.mean(axis=0)
    covariance = np.cov(differences)
    # the best approximation of its rank: what is left is the rest of the spectrum
    left = np.linalg.eigvalsh(covariance)[::-1][components.shape[1] :]
    assert np.linalg.norm(covariance - components @ components.T) == pytest.approx(np.linalg.norm(left))


def test_few_people_do_not_show_how_people_differ(grid: tuple[Path, PopulationResult]) -> None:
    plan = msgspec.structs.replace(grid[1].plan, people=3)
    columns = {name: column[: 3 * plan.designs] for name, column in grid[1].columns.items()}
    assert all(trial.components is msgspec.UNSET for trial in PopulationResult(plan, columns).prior())


def test_another_plan_in_the_same_folder_is_refused(grid: tuple[Path, PopulationResult]) -> None:
    with pytest.raises(InputError, match="other people, seed"):
        run(grid[0], msgspec.structs.replace(GRID, seed=4, people=8))


def test_what_a_grid_does_not_use_makes_no_other_plan(grid: tuple[Path, PopulationResult]) -> None:
    folder, first = grid
    assert same(run(folder, msgspec.structs.replace(GRID, engine="sobol", budget=7, judged=2)), first)
    assert PEOPLE.differs(msgspec.structs.replace(PEOPLE, engine="sobol", designs=7)) == ["engine"]


def test_a_folder_with_other_things_is_left_alone(tmp_path: Path) -> None:
    (tmp_path / "letter.txt").write_text("mine")
    with pytest.raises(InputError, match="is not empty"):
        run(tmp_path, GRID)
    assert [path.name for path in tmp_path.iterdir()] == ["letter.txt"]


def test_people_may_be_shifted_but_only_in_what_they_have() -> None:
    usual, slow = PopulationPlan().user(4), PopulationPlan(shifts={"pace_mm_s": 0.5}).user(4)
    assert slow.pace_mm_s == pytest.approx(0.5 * usual.pace_mm_s)
    assert slow.push_cN == usual.push_cN
    with pytest.raises(InputError, match="people have no such number"):
        PopulationPlan(shifts={"charm": 2.0}).user(0)
