"""What a study of thresholds or staircases measured, as a file: against its own answers and known people."""

from __future__ import annotations

import dataclasses
from pathlib import Path

import msgspec
import numpy as np
import pytest
from scipy.optimize import brentq

from fdvv.errors import InputError
from fdvv.model.file import load_builtin
from fdvv.model.jnd_file import JndRecord, jnds_of
from fdvv.model.magnify import magnify
from fdvv.model.noticeable import LITERATURE
from fdvv_people.study.admin.study import Study
from fdvv_people.study.analysis.analyse import analyse
from fdvv_people.study.analysis.code_book import write_answers
from fdvv_people.study.analysis.jnd_record import jnd_record
from fdvv_people.study.analysis.jnds import standard_sizes
from fdvv_people.study.analysis.read_answers import UNSEALED, read_answers
from fdvv_people.study.plan.plan_file import template_text
from fdvv_people.study.simulation.perception import haptic_features, perceived_difference
from fdvv_people.study.simulation.sessions import Simulation, simulate_study
from tests.support.jnds import measured, record_of
from tests.support.study_people import CHEAP, PASSPHRASE


def played(folder: Path, kind: str, **changes: str) -> Study:
    """Return an unsealed study of two simulated people, both of whom count."""
    text = template_text(kind).replace("people = 8", "people = 2")
    for old, new in {"same_choice": "1.0", **changes}.items():
        text = text.replace(f"{old} = ", f"{old} = {new} # ")
    study = Study.declare_text(folder / "study", text, folder)
    study.freeze(PASSPHRASE, CHEAP)
    simulate_study(study, simulation=Simulation(pressed=False))
    study.unseal(PASSPHRASE, who="me", why="a test")
    return study


def test_thresholds_are_kept_with_their_reference_people_trials_and_study(tmp_path: Path) -> None:
    study = played(tmp_path, "thresholds", trials="8")
    record = jnd_record(study)
    assert (record.study, record.kind, record.fingerprint) == ("thresholds", "thresholds", study.fingerprint)
    assert (record.simulated, record.people, record.trials) == (True, 2, 16)
    assert (record.task, record.share_correct) == ("Which one feels stronger?", 0.75)
    sizes = standard_sizes(load_builtin("mx-clear"))
    assert {one.dimension: one.standard for one in record.jnds} == sizes
    found = analyse(read_answers(study.folder), study.plan)
    for one in record.jnds:
        spread = found.jnd[one.dimension]
        assert (one.ratio, one.low, one.high) == pytest.approx((spread.mean, spread.low, spread.high))
        assert (one.button, one.condition, one.people) == ("MX Clear", "standard", 2)
        assert (one.above is not None) == (one.dimension == "vibration")
    assert sum(one.trials for one in record.jnds) == 16
    # what was written can be read
    assert msgspec.convert(msgspec.to_builtins(record), JndRecord) == record


def test_staircases_are_of_force_at_the_share_to_which_they_converge(tmp_path: Path) -> None:
    record = jnd_record(played(tmp_path, "staircase", reversals="4", rounds="1"))
    assert record.share_correct == pytest.approx(0.5**0.5)
    assert [(one.dimension, one.button) for one in record.jnds] == [
        ("force", "MX Red"),
        ("force", "MX Clear"),
    ]
    assert jnds_of(record).origin == "JNDs of force of 2 people of study staircase (simulated)"
    assert jnds_of(record).snap_cN == LITERATURE.snap_cN


def test_one_person_has_the_interval_of_their_own_trials(tmp_path: Path) -> None:
    study = played(tmp_path, "thresholds", trials="8")
    answers = read_answers(study.folder)
    alone = dataclasses.replace(answers, excluded=np.where(answers.person == "P01", "", "left"))
    write_answers(study.folder / UNSEALED, alone, study.plan)
    record = jnd_record(study)
    (own,) = analyse(alone, study.plan).jnds
    for one in record.jnds:
        jnd = own.jnds[one.dimension]
        assert (one.people, one.low, one.high) == (1, jnd.low, jnd.high)
    assert "of 1 person of study" in record.origin


def test_a_staircase_of_one_right_answer_down_is_refused(tmp_path: Path) -> None:
    text = template_text("staircase").replace("down = 2", "down = 1")
    with pytest.raises(InputError, match="2 or 3 down"):
        jnd_record(Study.declare_text(tmp_path / "chance", text, tmp_path))


def test_people_who_notice_a_whole_button_are_taken_for_a_little_duller_than_they_are() -> None:
    """A JND is read at the peak, where forces are largest, and people may notice by the whole stroke."""
    standard = load_builtin("mx-clear")
    felt = haptic_features(standard)

    def away(change: float) -> float:
        return perceived_difference(felt, haptic_features(magnify(standard, 1 + change))).total_JND - 1

    ratio = brentq(away, 0.01, 1.0)
    found = jnds_of(record_of(measured("force", ratio, standard_sizes(standard)["force"])))
    assert 1.0 < found.force_ratio / LITERATURE.force_ratio < 1.25
