"""Runs of several people: one button for all, everybody's own, and what that gains."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from fdvv.errors import InputError
from fdvv_people.optimize.group.group import Group, group_of, read_personal_runs
from fdvv_people.optimize.group.playoff import play_off
from fdvv_people.optimize.group.report import gain_sentence, group_html, group_report
from fdvv_people.optimize.run.player import about_player, player_of
from fdvv_people.optimize.run.session import Optimization
from fdvv_people.optimize.run.setup import OptimizeSetup, SpaceSetup
from fdvv_people.optimize.space import Parameter
from fdvv_people.task.score import Objective, Score

OWN = SpaceSetup(kind="own", parameters=(Parameter("first_mm", 0.0, 1.0), Parameter("second_mm", 0.0, 1.0)))


def run_of(folder: Path, person: int, low: float, **other: Any) -> Path:
    """Play a run whose scores are a bowl with its lowest point at low, in another program's numbers."""
    setup = OptimizeSetup(**{"space": OWN, "engine": "sobol", "budget": 16, "seed": person, **other})
    random = np.random.default_rng(person)
    with Optimization.create(folder, setup) as session:
        while trials := session.ask():
            trial = trials[0]
            session.show(trial.number)
            first, second = trial.design.values()
            value = 20.0 + 60.0 * ((first - low) ** 2 + (second - 0.5) ** 2) + random.standard_normal()
            session.answer(trial.number, {session.setup.objectives[0].name: Score(value, 1.0)})
    return folder


def group(folder: Path, lows: tuple[float, ...]) -> Group:
    folders = [run_of(folder / f"p{i}", i, low) for i, low in enumerate(lows)]
    return group_of(read_personal_runs(folders))


def test_the_groups_design_lies_between_people_who_differ_and_everybody_gains_with_their_own(
    tmp_path: Path,
) -> None:
    found = group(tmp_path, (0.2, 0.5, 0.8))
    assert found.design["first_mm"] == pytest.approx(0.5, abs=0.15)
    tried = [trial.design for run in found.runs for trial in run.trials]
    assert found.design in tried
    assert found.gain.kind == "better"
    assert found.expected[0] > 1.0 < found.expected[2]
    sentence = gain_sentence(found, None)
    assert sentence.startswith("Personalise: a button of one's own is ")
    assert "expected from the runs, not yet played" in sentence


def test_people_who_are_alike_need_no_button_of_their_own(tmp_path: Path) -> None:
    found = group(tmp_path, (0.5, 0.5, 0.5))
    # all scores together know more of the one best place than each person's do
    assert found.gain.kind in ("same", "worse")
    assert "Personalise" not in gain_sentence(found, None)
    assert "expected" in group_html(found, None).lower()


def test_runs_that_cannot_be_compared_are_refused_with_what_differs(tmp_path: Path) -> None:
    one = run_of(tmp_path / "one", 0, 0.5)
    hard = run_of(tmp_path / "task", 1, 0.5, level="hard")
    effort = run_of(tmp_path / "objective", 1, 0.5, objectives=(Objective("effort_N_s"),))
    paper = simulated(tmp_path / "space", 1)
    for other in (hard, effort, paper):
        with pytest.raises(InputError, match=f"differs from one in its {other.name}"):
            read_personal_runs([one, other])
    with pytest.raises(InputError, match="comes twice"):
        read_personal_runs([one, tmp_path / "." / "one"])


def test_a_run_that_is_not_over_is_refused(tmp_path: Path) -> None:
    with Optimization.create(tmp_path / "run", OptimizeSetup(space=OWN, engine="sobol")) as session:
        session.ask()
    with pytest.raises(InputError, match="is not over"):
        read_personal_runs([tmp_path / "run", tmp_path / "other"])


def simulated(folder: Path, person: int) -> Path:
    setup = OptimizeSetup(
        engine="sobol",
        budget=4,
        seed=person,
        level="easy",
        simulated=True,
        about=about_player(person, "ideal", 4, "diverse") | {OptimizeSetup.PRESSES: 4},
    )
    with Optimization.create(folder, setup) as session:
        player_of(session.setup).play(session)
    return folder


def test_simulated_people_press_again_and_the_same_presses_give_the_same_gain(tmp_path: Path) -> None:
    found = group_of(read_personal_runs([simulated(tmp_path / f"p{i}", i) for i in (1, 2)]))
    seen: list[tuple[int, int]] = []
    playoff = play_off(found, 3, lambda done, total: seen.append((done, total)))
    assert seen == [(0, 2), (1, 2), (2, 2)]
    assert playoff == play_off(found, 3)
    gains = [one.group - one.own for one in playoff.people]
    assert playoff.gain.difference == pytest.approx(np.mean(gains))
    for run, person in zip(found.runs, playoff.people, strict=True):
        assert (person.gain is None) == (run.own == found.design)
    document = group_report(found, playoff)
    assert document["simulated"]
    assert "simulated" in document["verdict"]
    assert [one["name"] for one in document["people"]] == ["p1", "p2"]


def test_the_same_simulated_person_does_not_count_twice(tmp_path: Path) -> None:
    folders = [simulated(tmp_path / name, 1) for name in ("a", "b")]
    with pytest.raises(InputError, match="same person as a"):
        read_personal_runs(folders)


def test_a_real_person_is_asked_in_a_study(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="in a study"):
        play_off(group(tmp_path, (0.2, 0.8)), 2)
