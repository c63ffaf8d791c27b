"""The ledger: what is kept, what may follow what."""

from __future__ import annotations

from pathlib import Path

import pytest

from fdvv.errors import InputError
from fdvv.optimize.problem import Answer, Trial, TrialState
from fdvv.optimize.run.ledger import Ledger, steps_before
from fdvv.task.score import Score

A, B = {"p_mm": 1.0}, {"p_mm": 2.0}


def filled(path: Path | None) -> Ledger:
    ledger = Ledger(path)
    ledger.suggest(A, "sobol")
    ledger.edit(0, B)
    ledger.become(0, TrialState.SHOWN)
    ledger.become(0, TrialState.DONE, {"asynchrony_ms": Score(81.5, 7.25)})
    ledger.suggest(A, "gp")
    ledger.become(1, TrialState.FAILED, reason="no signal")
    ledger.suggest(A, "gp")
    ledger.become(2, TrialState.ABANDONED)
    ledger.suggest(B, "person")
    ledger.line([A, B, A])
    ledger.choose(0, 1)
    ledger.line([B, A])
    ledger.pair(A, B)
    ledger.answer(0, Answer.EQUAL)
    ledger.pair(B, A)
    return ledger


def test_what_is_written_is_read_back_whole(tmp_path: Path) -> None:
    written = filled(tmp_path / "trials.jsonl")
    written.close()
    read = Ledger(tmp_path / "trials.jsonl")
    assert read.trials == written.trials
    assert read.comparisons == written.comparisons
    assert read.lines == written.lines
    assert [one.best for one in read.lines] == [1, None]
    read.close()


def test_an_edit_keeps_what_was_suggested() -> None:
    trial = filled(None).trials[0]
    assert (trial.design, trial.suggested) == (B, A)
    assert trial.scores == {"asynchrony_ms": Score(81.5, 7.25)}


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
    for number in (-1, 4):
        with pytest.raises(InputError, match="no such"):
            ledger.become(number, TrialState.SHOWN)
    with pytest.raises(InputError, match="equal"):
        ledger.answer(0, Answer.FIRST)
    assert (tmp_path / "trials.jsonl").stat().st_size == size
    ledger.close()


def test_a_cut_last_line_is_left_out_and_reported(tmp_path: Path) -> None:
    path = tmp_path / "trials.jsonl"
    whole = filled(path)
    whole.close()
    data = path.read_bytes()
    path.write_bytes(data[:-9])
    ledger = Ledger(path)
    assert ledger.trials == whole.trials
    assert ledger.comparisons == whole.comparisons[:1]
    assert "not whole" in ledger.warnings[0]
    ledger.pair(B, A)
    ledger.close()
    assert path.read_bytes() == data


def test_a_damaged_line_is_refused_by_its_number(tmp_path: Path) -> None:
    path = tmp_path / "trials.jsonl"
    filled(path).close()
    path.write_bytes(path.read_bytes().replace(b"81.5", b"18.5", 1))
    with pytest.raises(InputError, match="line 4"):
        Ledger(path)


def test_a_record_that_cannot_follow_is_refused_by_its_number(tmp_path: Path) -> None:
    from fdvv.eventlog import line_of

    path = tmp_path / "trials.jsonl"
    filled(path).close()
    with path.open("ab") as stream:
        stream.write(line_of({"state": {"number": 0, "state": "shown"}}))
    with pytest.raises(InputError, match="line 16"):
        Ledger(path)


def test_two_at_work_on_one_file_is_one_clear_line(tmp_path: Path) -> None:
    first = filled(tmp_path / "trials.jsonl")
    with pytest.raises(InputError, match="another process"):
        Ledger(tmp_path / "trials.jsonl")
    first.close()
    Ledger(tmp_path / "trials.jsonl").close()


def test_every_suggestion_is_found_with_what_was_known_then(tmp_path: Path) -> None:
    path = tmp_path / "trials.jsonl"
    filled(path).close()
    found = list(steps_before(path))
    assert [one.number for *_, one in found] == [0, 1, 2, 3, 0, 1, 0, 1]
    assert [len(trials) for trials, *_ in found] == [0, 1, 2, 3, 4, 4, 4, 4]
    assert isinstance(found[0][3], Trial)
    assert found[0][3].design == A
    assert found[1][0][0].state is TrialState.DONE
    assert [one.best for one in found[5][2]] == [1]
    assert found[7][1][0].answer is Answer.EQUAL


@pytest.mark.parametrize(
    ("number", "best", "said"),
    [
        (0, 0, "was answered: stop 1"),
        (1, 2, "has stops 0 to 1"),
        (1, -1, "has stops 0 to 1"),
        (2, 0, "no such"),
    ],
)
def test_a_line_is_answered_once_with_a_stop_of_its_own(number: int, best: int, said: str) -> None:
    ledger = filled(None)
    before = ledger.lines
    with pytest.raises(InputError, match=said):
        ledger.choose(number, best)
    assert ledger.lines == before
