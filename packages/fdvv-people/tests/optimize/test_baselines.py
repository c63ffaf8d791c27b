"""Runs of engines that are baselines of the benchmarks now: read and reported, not continued."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from benchmarks.optimize_baselines import BASELINES

from fdvv.errors import InputError
from fdvv_people.optimize.engines.gp_model import believed_best
from fdvv_people.optimize.engines.registry import RETIRED, engine_names, engine_of
from fdvv_people.optimize.run.replay import replay_differences
from fdvv_people.optimize.run.report import optimize_html, optimize_report
from fdvv_people.optimize.run.session import Optimization
from fdvv_people.optimize.run.setup import OptimizeSetup
from fdvv_people.task.score import Score
from tests.optimize.problems import problem, scored


def test_every_retired_engine_is_a_baseline_and_no_engine_of_a_new_run(tmp_path: Path) -> None:
    assert set(RETIRED) == set(BASELINES)
    assert not set(RETIRED) & set(engine_names())
    with pytest.raises(InputError, match=r"tpe: is a baseline of the benchmarks now.*use one of random"):
        Optimization.create(tmp_path / "run", OptimizeSetup(engine="tpe"))
    assert not (tmp_path / "run").exists()


@pytest.mark.parametrize("name", RETIRED)
def test_an_earlier_run_of_a_retired_engine_is_reported_and_not_continued(tmp_path: Path, name: str) -> None:
    folder = tmp_path / "run"
    with Optimization.create(folder, OptimizeSetup(engine="random", budget=4)) as session:
        for late_ms in (70.0, 60.0, 80.0):
            (trial,) = session.ask()
            session.answer(trial.number, {"asynchrony_ms": Score(late_ms, 5.0)})
    for file in ("optimize.json", "trials.jsonl"):
        path = folder / file
        _rename(path, name)
    with Optimization.open(folder) as session:
        assert optimize_report(session)["best"] == session.trials[1].design
        assert f"engine {name}" in optimize_html(session)
        with pytest.raises(InputError, match=f"{name}: suggests no more designs.*begin another run with gp"):
            session.ask()
    with pytest.raises(InputError, match="suggests no more"):
        replay_differences(folder)


def _rename(path: Path, name: str) -> None:
    """Write a file as an earlier fdvv did, with an engine of that time."""
    from fdvv.eventlog import line_of

    text = path.read_text().replace('"random"', f'"{name}"')
    if path.suffix == ".json":
        path.write_text(text)
        return
    records = [json.loads(line)["record"] for line in text.splitlines()]
    path.write_bytes(b"".join(map(line_of, records)))


def test_gp_ei_recommends_the_best_score_as_it_did_and_the_others_what_is_believed() -> None:
    designs = problem().space.of_unit([[0.1] * 3, [0.5] * 3, [0.52] * 3, [0.9] * 3])
    trials = [
        scored(i, one, value, 9.0)
        for i, (one, value) in enumerate(zip(designs, (90, 70, 99, 66), strict=True))
    ]
    assert engine_of("gp-ei").best(problem(), trials) == designs[3]
    expected = believed_best(problem(), trials)
    for name, options in (("tpe", {}), ("gp-ei", {"smoothed": True})):
        assert engine_of(name, options).best(problem(), trials) == expected
