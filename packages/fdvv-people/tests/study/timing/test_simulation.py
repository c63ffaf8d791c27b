"""A whole study played by simulated people: frozen, trained, a week, validated, unsealed, analysed."""

from __future__ import annotations

import csv
from pathlib import Path

import pytest

from fdvv.errors import InputError
from fdvv_people.study.simulation.sessions import Simulation, simulate_study
from fdvv_people.study.timing.analyse import analyse_timing
from fdvv_people.study.timing.people import seconds_of
from fdvv_people.study.timing.plan import DAY_s
from fdvv_people.study.timing.report import timing_html
from fdvv_people.study.timing.scores import read_scores
from fdvv_people.task.task import TaskPress
from tests.study.timing.test_participant import TAPPING
from tests.support.studies import PASSPHRASE
from tests.support.timing import SMALL, frozen


def test_a_whole_study_of_simulated_people_ends_in_a_report(tmp_path: Path) -> None:
    study = frozen(tmp_path / "study", SMALL.replace("rounds = 1", "rounds = 2"))
    found = simulate_study(study, 3)
    assert found.finished == ("P01", "P02", "P03")
    assert all(7.0 < one.time_s / DAY_s < 7.2 for one in found.sessions)
    assert study.verify(passphrase=PASSPHRASE) == ()
    scores = study.unseal(PASSPHRASE, "me", "a test")
    assert scores.simulated
    assert len(scores.rows) == 3 * 2 * 2 * 4
    # every press of every trial that was not given up is there
    rows = list(csv.DictReader((study.folder / "unsealed/rounds.csv").read_text().splitlines()))
    assert len(rows) == sum(one.count for one in found.sessions)
    assert {row["condition"] for row in rows if row["phase"] == "validation"} == set(scores.conditions)
    kept = read_scores(study.folder / "unsealed/scores.csv", study.plan)
    assert [row.condition for row in kept.rows] == [row.condition for row in scores.rows]
    html = timing_html(analyse_timing(kept), study.folder / "unsealed", "a test")
    assert "3 simulated people played temporal pointing" in html
    with pytest.raises(InputError, match="unsealed"):
        simulate_study(study, 4)


def test_simulated_people_tap_buttons_and_programs_at_rates_that_fingers_have(tmp_path: Path) -> None:
    study = frozen(tmp_path / "study", TAPPING)
    simulate_study(study, 2, Simulation(seed=4))
    scores = study.unseal(PASSPHRASE, "me", "a test")
    assert scores.simulated
    assert sorted({row.condition for row in scores.rows}) == ["fast", "red"]
    assert all(row.counts and 3 < row.score < 12 for row in scores.rows)
    assert study.verify(passphrase=PASSPHRASE) == ()


def test_taps_are_kept_by_seconds_from_the_first() -> None:
    found = seconds_of([TaskPress(None, (5.0, 5.4)), TaskPress(None, (6.1, 9.0))], 3)
    assert [len(one.activations_s) for one in found] == [2, 1, 0]
    assert found[1].activations_s == pytest.approx((1.1,))
