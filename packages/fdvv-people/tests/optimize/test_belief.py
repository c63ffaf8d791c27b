"""The interval of a recommended design: from numbers of another program, by scores and by comparisons."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from fdvv.errors import InputError, ModelError
from fdvv_people.optimize.run.belief import best_design
from fdvv_people.optimize.run.report import optimize_html
from fdvv_people.optimize.run.session import Optimization
from fdvv_people.optimize.run.setup import OptimizeSetup, SpaceSetup
from fdvv_people.optimize.space import Parameter
from fdvv_people.task.score import Objective, Score

pytest.importorskip("sklearn")
pytestmark = pytest.mark.usefixtures("hasty_disk")
SIZE = Parameter("size_px", 10.0, 1000.0, "log")


def run_of(folder: Path, larger: bool = False, task: str = "external", engine: str = "sobol") -> Optimization:
    space = SpaceSetup("own", parameters=(SIZE,))
    objectives = (Objective("score", larger),)
    setup = OptimizeSetup(space=space, engine=engine, task=task, objectives=objectives, budget=40)
    return Optimization.create(folder, setup)


def test_of_one_design_the_interval_is_that_of_the_mean_of_its_scores(tmp_path: Path) -> None:
    rng, truth, noise, count = np.random.default_rng(1), 300.0, 20.0, 25
    with run_of(tmp_path / "run") as run:
        scores = rng.normal(truth, noise, count)
        for value in scores:
            trial = run._ledger.suggest([{"size_px": 100.0}], "test")
            run.answer(trial.number, {"score": Score(float(value))})
        best = best_design(run)
    error = scores.std(ddof=1) / np.sqrt(count)
    assert best.mean == pytest.approx(scores.mean(), abs=0.25 * error)
    assert best.high - best.low == pytest.approx(2 * 1.96 * error, rel=0.3)
    assert best.count == count


@pytest.mark.parametrize("larger", [False, True])
def test_the_interval_covers_the_true_score_of_the_best_design(tmp_path: Path, larger: bool) -> None:
    sign, held = -1.0 if larger else 1.0, []

    def truth(design: dict[str, float]) -> float:
        return float(sign * (500.0 + 200.0 * np.log10(design["size_px"] / 100.0) ** 2))

    for seed in range(12):
        rng = np.random.default_rng(seed)
        with run_of(tmp_path / str(seed), larger) as run:
            for trial in run.ask(20):
                run.answer(
                    trial.number, {"score": Score(truth(trial.design) + float(rng.normal(0, 20.0)), 20.0)}
                )
            best = best_design(run)
        assert best.low < best.mean < best.high
        held.append(best.low <= truth(best.design) <= best.high)
    assert np.mean(held) >= 0.75  # 95 % meant; fewer than 9 of 12 has a chance of 1 in 5000


def test_of_comparisons_the_favourite_is_worth_more_than_the_first(tmp_path: Path) -> None:
    with run_of(tmp_path / "run", task="preference", engine="preference") as run:
        with pytest.raises(ModelError):
            best_design(run)
        for _ in range(12):
            (pair,) = run.ask()
            off = [abs(np.log(one["size_px"] / 200.0)) for one in pair.designs]
            run.answer(pair.number, [off.index(min(off))])
        best = best_design(run)
    assert best.chance is not None
    assert best.chance > 0.5
    assert best.low < best.mean < best.high


def test_a_log_scale_puts_the_middle_at_the_geometric_mean(tmp_path: Path) -> None:
    with run_of(tmp_path / "run") as run:
        (middle,) = run.space.of_unit([[0.5]])
        assert middle["size_px"] == pytest.approx(100.0)
        assert run.space.to_unit([{"size_px": 1000.0}])[0, 0] == 1.0
        with pytest.raises(InputError, match="numbers of another program"):
            run.model({"size_px": 100.0})
    with pytest.raises(ModelError, match="above 0"):
        Parameter("size_px", 0.0, 1.0, "log")


def test_a_run_of_own_numbers_has_a_report(tmp_path: Path) -> None:
    pytest.importorskip("matplotlib")
    with run_of(tmp_path / "run") as run:
        for trial in run.ask(3):
            run.answer(trial.number, {"score": Score(trial.design["size_px"])})
        page = optimize_html(run)
    assert "size (px)" in page
    assert "recommended" in page


def test_a_run_of_own_numbers_is_the_same_when_it_is_opened_again(tmp_path: Path) -> None:
    with run_of(tmp_path / "run") as run:
        (trial,) = run.ask()
    with Optimization.open(tmp_path / "run") as again:
        assert again.space.parameters == (SIZE,)
        assert again.ask() == (trial,)


def test_of_lines_the_favourite_is_worth_more_than_where_one_began(tmp_path: Path) -> None:
    with run_of(tmp_path / "run", task="preference", engine="preference-line") as run:
        with pytest.raises(ModelError):
            best_design(run)
        for _ in range(4):
            (line,) = run.ask()
            sizes = [design["size_px"] for design in line.designs]
            run.answer(line.number, [sizes.index(max(sizes))])
        best = best_design(run)
    assert best.design["size_px"] == pytest.approx(1000.0)
    assert best.count == 4
    assert best.chance is not None
    assert 0.5 < best.chance < 1.0
    assert best.low < best.mean < best.high
