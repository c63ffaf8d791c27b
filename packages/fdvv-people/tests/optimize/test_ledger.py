"""The ledger: what is kept, what may follow what."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import pytest
from msgspec import UNSET

from fdvv.errors import InputError
from fdvv.eventlog import line_of
from fdvv_people.optimize.problem import Answer, TrialState
from fdvv_people.optimize.run.ledger import Ledger, read_ledger, steps_before
from fdvv_people.optimize.run.session import Optimization
from fdvv_people.optimize.run.setup import OptimizeSetup
from fdvv_people.task.score import Score

A, B = {"p_mm": 1.0}, {"p_mm": 2.0}


def filled(path: Path | None) -> Ledger:
    ledger = Ledger(path)
    ledger.suggest([A], "sobol")
    ledger.edit(0, B)
    ledger.become(0, TrialState.SHOWN)
    ledger.become(0, TrialState.DONE, {"asynchrony_ms": Score(81.5, 7.25)})
    ledger.suggest([A], "gp")
    ledger.become(1, TrialState.FAILED, reason="no signal")
    ledger.suggest([A], "gp")
    ledger.become(2, TrialState.ABANDONED)
    ledger.suggest([B], "person")
    ledger.suggest([A, B, A], "preference-line")
    ledger.become(4, TrialState.DONE, best=[1])
    ledger.suggest([A, B], "retest")
    ledger.become(5, TrialState.DONE, best=[0, 1])
    ledger.suggest([B, A], "retest")
    return ledger


def test_what_is_written_is_read_back_whole(tmp_path: Path) -> None:
    written = filled(tmp_path / "trials.jsonl")
    written.close()
    read = Ledger(tmp_path / "trials.jsonl")
    assert read.trials == written.trials
    assert [one.best for one in read.trials[4:]] == [(1,), (0, 1), UNSET]
    assert [one.answer for one in read.trials[5:]] == [Answer.EQUAL, None]
    assert read.trials[4].designs == (A, B, A)
    read.close()


@pytest.mark.parametrize("state", [TrialState.SHOWN, TrialState.DONE, TrialState.ABANDONED])
@pytest.mark.parametrize("number", [0, 1, 2])
def test_a_trial_at_its_end_stays_as_it_is(number: int, state: TrialState) -> None:
    ledger = filled(None)
    before = ledger.trials
    with pytest.raises(InputError, match=f"trial {number}"):
        ledger.become(number, state)
    with pytest.raises(InputError, match="edited"):
        ledger.edit(number, A)
    assert ledger.trials == before


def test_what_is_not_there_is_refused(tmp_path: Path) -> None:
    ledger = filled(tmp_path / "trials.jsonl")
    size = (tmp_path / "trials.jsonl").stat().st_size
    for number in (-1, 7):
        with pytest.raises(InputError, match="no such"):
            ledger.become(number, TrialState.SHOWN)
    with pytest.raises(InputError, match="was answered"):
        ledger.become(5, TrialState.DONE, best=[0])
    with pytest.raises(InputError, match="several designs"):
        ledger.edit(6, B)
    assert (tmp_path / "trials.jsonl").stat().st_size == size
    ledger.close()


def test_a_cut_last_line_is_left_out_and_reported(tmp_path: Path) -> None:
    path = tmp_path / "trials.jsonl"
    whole = filled(path)
    whole.close()
    data = path.read_bytes()
    path.write_bytes(data[:-9])
    ledger = Ledger(path)
    assert ledger.trials == whole.trials[:6]
    assert "not whole" in ledger.warnings[0]
    ledger.suggest([B, A], "retest")
    ledger.close()
    assert path.read_bytes() == data


def test_a_damaged_line_is_refused_by_its_number(tmp_path: Path) -> None:
    path = tmp_path / "trials.jsonl"
    filled(path).close()
    path.write_bytes(path.read_bytes().replace(b"81.5", b"18.5", 1))
    with pytest.raises(InputError, match="line 4"):
        Ledger(path)


def test_a_record_that_cannot_follow_is_refused_by_its_number(tmp_path: Path) -> None:
    path = tmp_path / "trials.jsonl"
    filled(path).close()
    with path.open("ab") as stream:
        stream.write(line_of({"state": {"number": 0, "state": "shown"}}))
    with pytest.raises(InputError, match="line 15"):
        Ledger(path)


def test_every_suggestion_is_found_with_what_was_known_then(tmp_path: Path) -> None:
    path = tmp_path / "trials.jsonl"
    filled(path).close()
    found = list(steps_before(path))
    assert [one.number for _, one in found] == list(range(7))
    assert [len(before) for before, _ in found] == list(range(7))
    assert found[0][1].design == A
    assert found[1][0][0].state is TrialState.DONE
    assert found[5][0][4].best == (1,)


EARLIER: tuple[dict[str, Any], ...] = (
    {"line": {"number": 0, "stops": [A, B, A], "best": None}},
    {"choice": {"number": 0, "best": 2}},
    {"line": {"number": 1, "stops": [B, A], "best": None}},
    {"choice": {"number": 1, "best": 0}},
    {"pair": {"number": 0, "first": A, "second": B, "answer": None}},
    {"answer": {"number": 0, "answer": "equal"}},
    {"pair": {"number": 1, "first": B, "second": A, "answer": None}},
)


def written_earlier(path: Path, records: Sequence[dict[str, Any]]) -> Path:
    path.write_bytes(b"".join(map(line_of, records)))
    return path


def test_lines_and_pairs_of_an_earlier_fdvv_are_one_list_of_trials(tmp_path: Path) -> None:
    path = written_earlier(tmp_path / "trials.jsonl", EARLIER)
    ledger = Ledger(path)
    assert [one.designs for one in ledger.trials] == [(A, B, A), (B, A), (A, B), (B, A)]
    assert [one.best for one in ledger.trials] == [(2,), (0,), (0, 1), UNSET]
    assert [one.origin for one in ledger.trials] == ["preference-line", "preference-line", "", ""]
    assert [one.number for _, one in steps_before(path)] == [0, 1, 2, 3]
    # what was open is answered in today's words
    ledger.become(3, TrialState.DONE, best=[1])
    ledger.close()
    assert read_ledger(path).trials == ledger.trials


@pytest.mark.parametrize(
    ("record", "line"),
    [
        ({"pair": {"number": 3, "first": A, "second": B}}, 8),
        ({"answer": {"number": 2, "answer": "first"}}, 8),
        ({"answer": {"number": 0, "answer": "first"}}, 8),
        ({"choice": {"number": 1, "best": 0}}, 8),
    ],
)
def test_earlier_records_that_cannot_follow_are_refused_too(
    tmp_path: Path, record: dict[str, Any], line: int
) -> None:
    with pytest.raises(InputError, match=f"line {line}"):
        Ledger(written_earlier(tmp_path / "trials.jsonl", (*EARLIER, record)))


def test_comparisons_beyond_the_budget_are_the_retest_of_an_earlier_run(tmp_path: Path) -> None:
    setup = OptimizeSetup(task="preference", engine="preference-line", budget=2)
    Optimization.create(tmp_path / "run", setup).close()
    written_earlier(tmp_path / "run" / "trials.jsonl", EARLIER)
    with Optimization.open(tmp_path / "run") as session:
        assert [one.number for one in session.trials] == [0, 1]
        assert [one.number for one in session.retests] == [2, 3]
        assert session.retest_answers == (Answer.EQUAL,)
