"""A person's presses are on the disk before the next one, whatever ends the process."""

from __future__ import annotations

from pathlib import Path

import pytest

from fdvv.errors import InputError
from fdvv_people.task.rounds import ClockSource, RoundTiming, TaskRounds, read_rounds

TIMING = RoundTiming(ClockSource.PAGE, 30.0, 17.0, 10.0, 10.0, 5e6, 0.6, 4.0, 16.7, "key")


def written_rounds(folder: Path, trial: int, times_s: tuple[float, ...]) -> TaskRounds:
    rounds = TaskRounds(folder)
    rounds.begin(trial)
    for at_s in times_s:
        rounds.add(trial, at_s, (at_s + 0.05,), TIMING)
    return rounds


def test_rounds_are_read_again_as_they_were(tmp_path: Path) -> None:
    rounds = written_rounds(tmp_path, 3, (1.0, 2.0))
    before = rounds.counting(3)
    assert [one.number for one in before] == [1, 2]
    rounds.close()
    again = TaskRounds(tmp_path)
    assert again.counting(3) == before
    assert [one.press.activations_s for one in before] == [(1.05,), (2.05,)]
    again.close()


def test_a_trial_that_is_begun_again_counts_anew_and_keeps_what_was(tmp_path: Path) -> None:
    written_rounds(tmp_path, 0, (1.0, 2.0, 3.0)).close()
    rounds = TaskRounds(tmp_path)
    assert rounds.begin(0) == 2
    assert rounds.counting(0) == ()
    rounds.add(0, 9.0, (), TIMING)
    assert [(one.attempt, one.number, one.target_s) for one in rounds.counting(0)] == [(2, 1, 9.0)]
    assert len(rounds.all) == 4
    rounds.close()


def test_a_reader_counts_as_the_writer_does_while_that_is_at_work(tmp_path: Path) -> None:
    assert read_rounds(tmp_path).all == ()
    assert list(tmp_path.iterdir()) == []
    written_rounds(tmp_path, 0, (1.0, 2.0)).close()
    writer = written_rounds(tmp_path, 1, (3.0,))
    writer.begin(0)
    writer.add(0, 4.0, (), TIMING)
    reader = read_rounds(tmp_path)
    assert reader.all == writer.all
    assert [reader.counting(trial) for trial in (0, 1, 2)] == [writer.counting(trial) for trial in (0, 1, 2)]
    assert [one.target_s for one in reader.counting(0)] == [4.0]
    writer.close()


@pytest.mark.parametrize("lost_bytes", [1, 20, 60])
def test_a_round_that_was_cut_short_is_the_only_one_lost(tmp_path: Path, lost_bytes: int) -> None:
    rounds = written_rounds(tmp_path, 0, (1.0, 2.0, 3.0))
    rounds.close()
    whole = rounds.path.read_bytes()
    rounds.path.write_bytes(whole[:-lost_bytes])
    again = TaskRounds(tmp_path)
    assert [one.target_s for one in again.counting(0)] == [1.0, 2.0]
    again.add(0, 3.0, (3.05,), TIMING)
    again.close()
    assert [one.target_s for one in TaskRounds(tmp_path).counting(0)] == [1.0, 2.0, 3.0]


def test_a_damaged_file_and_one_at_work_elsewhere_are_refused(tmp_path: Path) -> None:
    rounds = written_rounds(tmp_path, 0, (1.0, 2.0))
    with pytest.raises(InputError, match="another fdvv works on it"):
        TaskRounds(tmp_path)
    rounds.close()
    rounds.path.write_text(rounds.path.read_text().replace("1.0", "1.5", 1))
    with pytest.raises(InputError, match="damaged"):
        TaskRounds(tmp_path)
