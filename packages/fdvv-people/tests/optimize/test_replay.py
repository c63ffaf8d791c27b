"""What a replay of a run notices; that it agrees with whole runs is tested where these are made."""

from __future__ import annotations

from pathlib import Path

from fdvv_people.optimize.run.replay import replay_differences
from fdvv_people.optimize.run.session import Optimization
from fdvv_people.optimize.run.setup import OptimizeSetup


def test_a_run_whose_seed_was_changed_is_seen_by_its_replay(tmp_path: Path) -> None:
    with Optimization.create(tmp_path / "run", OptimizeSetup(engine="sobol")) as session:
        session.ask(2)
    path = tmp_path / "run" / "optimize.json"
    path.write_text(path.read_text().replace('"seed": 0', '"seed": 1'))
    assert [one.number for one in replay_differences(tmp_path / "run")] == [0, 1]


def test_a_replay_writes_nothing_and_needs_no_lock(tmp_path: Path) -> None:
    with Optimization.create(tmp_path / "run", OptimizeSetup(engine="sobol")) as session:
        session.ask(2)
        before = {path: path.read_bytes() for path in (tmp_path / "run").iterdir()}
        assert replay_differences(tmp_path / "run") == ()
        assert {path: path.read_bytes() for path in (tmp_path / "run").iterdir()} == before
