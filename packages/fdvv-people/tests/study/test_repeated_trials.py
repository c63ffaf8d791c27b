"""A trial that stands twice in a table of answers is refused with both lines; what only looks so is not."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import product
from pathlib import Path

import numpy as np
import pytest

from fdvv.errors import InputError
from fdvv_people.study.analysis.columns import ColumnMap
from fdvv_people.study.analysis.read_answers import AnswersTable, read_table

PEOPLE, BUTTONS, TRIALS = ("P1", "P2", "P3"), ("Clear", "Red"), (1, 2, 3)
FREE, TIMED = ColumnMap(), ColumnMap(kind="timing")

# what a kind of table holds: its headings, the cells of a trial's rows, cells of another answer
CHOICES = ("preferred", ["FD", "FDVV"], "FDVV")
WIDE = ("realism_FD,realism_FDVV,preferred", ["3,6,FDVV", "4,4,equal"], "5,2,FD")
LONG = ("model,rating", ["FD,3", "FDVV,6"], "FDVV,1")
TIMES = ("condition,asynchrony_ms", ["easy,30.5", "hard,41"], "hard,12")
KINDS = [(CHOICES, FREE), (WIDE, FREE), (LONG, FREE), (TIMES, TIMED)]


def table(path: Path, head: str, rows: Sequence[str], asked: ColumnMap = FREE) -> AnswersTable:
    path.write_text("\n".join([head, *rows]) + "\n")
    return read_table(path, asked)


def trials(cells: Sequence[str], long: bool = False, before: str = "") -> list[str]:
    """Write a row of every person, button and trial, with the cells in turn; long : with all of them."""
    rows = []
    for number, (person, button, trial) in enumerate(product(PEOPLE, BUTTONS, TRIALS)):
        answers = cells if long else [cells[number % len(cells)]]
        rows += [f"{before}{person},{button},{trial},{answer}" for answer in answers]
    return rows


@pytest.mark.parametrize("trial", ["trial", "Trial_Number", "block", "repetition"])
@pytest.mark.parametrize(("kind", "asked"), KINDS, ids=["choices", "wide", "long", "timing"])
def test_a_trial_that_stands_twice_is_refused_with_both_lines(
    kind: tuple[str, list[str], str], asked: ColumnMap, trial: str, tmp_path: Path
) -> None:
    heads, cells, other = kind
    head, rows = f"participant,button,{trial},{heads}", trials(cells, long=kind in (LONG, TIMES))
    assert table(tmp_path / "a.csv", head, rows, asked).columns["round"] == trial
    for place, row in enumerate(rows):
        named = row.split(",")
        again = [*named[:3], *(other.split(",") if kind in (CHOICES, WIDE) else [named[3], "7"])]
        for repeat, how in ((row, "word for word"), (",".join(again), "with another")):
            if how == "with another" and repeat == row:
                continue
            with pytest.raises(InputError) as refused:
                table(tmp_path / "a.csv", head, [*rows, repeat], asked)
            said = str(refused.value)
            assert f"line {len(rows) + 2}: is the trial of line {place + 2} once more, {how}" in said
            assert f": {trial} {named[2]}, participant {named[0]}, button {named[1]}" in said


def test_a_column_that_is_mapped_as_the_round_is_refused_alike(tmp_path: Path) -> None:
    for (heads, cells, _), asked in KINDS:
        head, rows = f"participant,button,pass,{heads}", trials(cells, long="equal" not in cells[1])
        mapped = ColumnMap(kind=asked.kind, columns={"round": "pass"})
        if heads == CHOICES[0]:
            rows = trials(cells)
        table(tmp_path / "a.csv", head, rows, mapped)
        with pytest.raises(
            InputError, match=r"line \d+: P1 has a second row of Clear.*, round 1, after line 2;"
        ):
            table(tmp_path / "a.csv", head, [*rows, rows[0]], mapped)


def test_of_a_rendering_that_was_not_rated_a_second_row_is_seen_too(tmp_path: Path) -> None:
    rows = ["p1,Clear,1,FD,1", "p1,Clear,1,FDVV,0", "p1,Clear,1,FD,1"]
    with pytest.raises(InputError, match="line 4: p1 has a second row of Clear, FD, round 1, after line 2"):
        table(tmp_path / "a.csv", "person,item,round,stimulus,is_chosen", rows)


PART_HEADS = ["block", "Block Nr", "session_id", "day", "phase", "lighting"]


@pytest.mark.parametrize("part", PART_HEADS)
def test_trials_that_are_numbered_anew_in_each_part_are_no_repeats(part: str, tmp_path: Path) -> None:
    parts = ("1", "2") if part != "lighting" else ("dim", "bright")
    rows = [row for name in parts for row in trials(WIDE[1], before=f"{name},")]
    found = table(tmp_path / "a.csv", f"{part},participant,button,trial,{WIDE[0]}", rows)
    assert len(found.answers.person) == len(rows)
    with pytest.raises(InputError, match=f"line {len(rows) + 2}: is the trial of line 5 once more"):
        table(tmp_path / "a.csv", f"{part},participant,button,trial,{WIDE[0]}", [*rows, rows[3]])


def test_a_number_that_holds_several_rows_is_none_of_a_trial(tmp_path: Path) -> None:
    for head in ("block", "run", "repeat", "trial"):
        rows = [
            f"{p},{b},{k},{word}" for p, b, k in product(PEOPLE, BUTTONS, (0, 1)) for word in ("FD", "FDVV")
        ]
        found = table(tmp_path / "a.csv", f"participant,button,{head},preferred", rows)
        assert len(found.answers.person) == len(rows)
        assert "round" not in found.columns


@pytest.mark.shared
def test_a_log_of_taps_has_many_in_each_trial(shared_data: Path) -> None:
    taps = shared_data / "baath-sync-tapping" / "tapping_data_baath_madison_2012.subjects01-15.csv"
    asked = ColumnMap(kind="timing", columns={"stimulus": "isi", "asynchrony_ms": "asynch"})
    read = read_table(taps, asked)
    assert len(read.answers.person) > 1000
    assert read.unused == ("trial",)


def test_what_is_left_out_or_not_numbered_is_no_repeat(tmp_path: Path) -> None:
    head = "participant,button,trial,preferred,excluded"
    rows = [f"{row},no" for row in trials(["FD", "FDVV"])]
    redone = ["P1,Clear,2,FD,slipped", "P1,Red,,FD,practice", "P1,Red,,FD,practice"]
    found = table(tmp_path / "a.csv", head, [*rows, *redone])
    assert len(found.answers.person) == len(rows) + 3
    assert found.answers.excluded is not None
    assert np.count_nonzero(found.answers.excluded != "") == 3
