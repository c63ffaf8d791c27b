"""Simulated participants go through a whole frozen study; everything says that they are simulated."""

from __future__ import annotations

import json
from functools import partialmethod
from pathlib import Path

import numpy as np
import pytest

from fdvv.errors import InputError, ModelError
from fdvv_people.study.admin.study import Study
from fdvv_people.study.simulation.people import ProxySettings
from fdvv_people.study.simulation.sessions import Simulation, simulate_study
from tests.support.study_people import CHEAP, CONSENT, PASSPHRASE, frozen_study

FAST = Simulation(pressed=False)


@pytest.fixture(autouse=True)
def cheap_codes(monkeypatch: pytest.MonkeyPatch) -> None:
    """Stretch codes cheaply."""
    monkeypatch.setattr(Study, "enrol", partialmethod(Study.enrol, cost=CHEAP))


def simulated(folder: Path, people: int = 2, **about: object) -> Study:
    study = frozen_study(folder, tables=CONSENT)
    simulate_study(study, people, Simulation(pressed=False, **about))  # type: ignore[arg-type]
    return study


def test_a_whole_study_is_answered_and_marked_in_every_file(tmp_path: Path) -> None:
    study = simulated(tmp_path / "s")
    assert [(one.name, one.state, one.simulated) for one in study.people()] == [
        ("P01", "finished", True),
        ("P02", "finished", True),
    ]
    assert study.verify() == ()
    for person in ("P01", "P02"):
        first = (study.folder / "people" / person / "session.jsonl").read_text()
        assert '"simulated":true' in first.replace(" ", "")
    answers = study.unseal(PASSPHRASE, "a test", "to test")
    assert answers.simulated
    assert len(answers.person) == 8
    assert set(answers.choice) <= {"FD", "FDVV", "equal"}
    assert np.isfinite(answers.ratings["realism"]).all()
    book = json.loads((study.folder / "unsealed" / "codebook.json").read_text())
    assert "simulated" in json.dumps(book)


def test_the_finger_really_presses_what_is_rendered(tmp_path: Path) -> None:
    study = frozen_study(tmp_path / "s", rounds=1, practice=0)
    simulate_study(study, 1)
    study.unseal(PASSPHRASE, "a test", "to test")
    rows = (study.folder / "unsealed" / "rendered.csv").read_text().splitlines()
    heads = rows[0].split(",")
    for row in rows[1:]:
        cells = dict(zip(heads, row.split(","), strict=True))
        assert int(cells["presses"]) >= 1
        assert 0 <= float(cells["largest_error_cN"]) < 10
        assert all(50 < float(one) < 250 for one in cells["velocities_mm_s"].split())


def test_those_who_are_done_count_and_the_same_command_adds_the_rest(tmp_path: Path) -> None:
    study = simulated(tmp_path / "s", people=1)
    assert len(simulate_study(study, 3, FAST).sessions) == 2
    assert simulate_study(study, 3, FAST).sessions == ()
    assert simulate_study(study, simulation=FAST).finished == ("P01", "P02", "P03", "P04")  # as planned


def test_breaks_take_no_real_time(tmp_path: Path) -> None:
    study = frozen_study(tmp_path / "s", break_every_min=2, break_min=30)
    (session,) = simulate_study(study, 1, FAST).sessions
    assert session.breaks >= 1
    assert session.time_s > 30 * 60 * session.breaks


@pytest.mark.slow
def test_people_who_feel_much_choose_what_is_close(tmp_path: Path) -> None:
    sharp = ProxySettings().changed("weber_ratio", 0.005).changed("lapse_ratio", 0.0)
    study = simulated(tmp_path / "s", settings=sharp.changed("taste_ratio", 0.0))
    answers = study.unseal(PASSPHRASE, "a test", "to test")
    assert set(answers.choice) == {"FDVV"}


def test_what_is_felt_and_answered_follows_from_the_seed(tmp_path: Path) -> None:
    ratings = []
    for name, seed in (("a", 5), ("b", 5), ("c", 6)):
        study = simulated(tmp_path / name, people=1, seed=seed)
        ratings.append(study.unseal(PASSPHRASE, "a test", "to test").ratings["realism"].tolist())
    assert ratings[0] == ratings[1]
    assert ratings[0] != ratings[2]


def test_a_study_of_people_takes_no_simulated_ones(tmp_path: Path) -> None:
    study = frozen_study(tmp_path / "s")
    study.enrol("en")
    with pytest.raises(InputError, match="cannot have simulated ones"):
        simulate_study(study, 1)


def test_a_study_that_is_not_frozen_is_refused(tmp_path: Path) -> None:
    from fdvv_people.study.plan.plan_file import template_text

    text = template_text("abx")
    study = Study.declare_text(tmp_path / "s", text, tmp_path)
    with pytest.raises(InputError, match="not frozen"):
        simulate_study(study, 1)
    with pytest.raises(ModelError):
        simulate_study(study, 0)


def test_ctrl_c_leaves_whole_people_only_and_the_same_command_goes_on(tmp_path: Path) -> None:
    study = frozen_study(tmp_path / "s")

    def stop(done: int, _total: int) -> None:
        if done >= 150:  # hundredths of a person
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        simulate_study(study, 2, FAST, progress=stop)
    assert [one.state for one in study.people()] == ["finished", "deleted"]
    assert study.verify() == ()
    assert simulate_study(study, 2, FAST).finished == ("P01", "P03")
