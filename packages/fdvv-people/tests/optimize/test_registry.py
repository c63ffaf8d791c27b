"""Engines of other packages: found by one kind of entry point, whatever their trials are."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path
from types import MappingProxyType, SimpleNamespace
from typing import ClassVar

import pytest

from fdvv import extras
from fdvv.errors import InputError
from fdvv_people.optimize.engines.registry import engine_names, engine_of, pair_engine_names
from fdvv_people.optimize.engines.search import random_places
from fdvv_people.optimize.problem import Problem, Trial
from fdvv_people.optimize.run.replay import replay_differences
from fdvv_people.optimize.run.session import Optimization
from fdvv_people.optimize.run.setup import OptimizeSetup


@dataclass(frozen=True)
class Five:
    """Suggest five random designs and recommend the last that was chosen."""

    trial_size: ClassVar[int] = 5
    name: str = field(default="preference-five", init=False)

    def suggest(self, problem: Problem, trials: Sequence[Trial], count: int = 1) -> list[dict[str, float]]:
        return problem.space.of_unit(random_places(problem, trials, self.trial_size))

    def best(self, problem: Problem, trials: Sequence[Trial]) -> dict[str, float]:
        *_, last = (trial for trial in trials if trial.best)
        return last.designs[(last.best or (0,))[0]]


def install(monkeypatch: pytest.MonkeyPatch, name: str) -> None:
    entry = SimpleNamespace(load=lambda: Five)
    monkeypatch.setattr(extras, "installed", lambda _kind: MappingProxyType({name: entry}))


def test_an_engine_of_lines_of_another_package_plays_a_whole_run(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    install(monkeypatch, "preference-five")
    assert "preference-five" in engine_names(choices=True)
    assert "preference-five" not in (*engine_names(), *pair_engine_names())
    about = {OptimizeSetup.RETEST: 2}
    setup = OptimizeSetup(task="preference", engine="preference-five", budget=2, about=about)
    with Optimization.create(tmp_path / "run", setup) as session:
        assert session.asks_for == "line"
        while trial := session.next_trial():
            session.answer(trial.number, [0])
        assert [len(trial.designs) for trial in (*session.trials, *session.retests)] == [5, 5, 2, 2]
        assert session.finished
    assert replay_differences(tmp_path / "run") == ()


def test_an_engine_whose_name_does_not_say_what_it_reads_is_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    install(monkeypatch, "five")
    with pytest.raises(
        InputError, match="five: tries 5 designs at once; let the name begin with 'preference'"
    ):
        engine_of("five")
