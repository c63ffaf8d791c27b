"""What the snapshot of the commands' output leaves out, and how it names a difference."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from tools.snapshot import Normaliser, differences, read_cases


@pytest.fixture
def normaliser(tmp_path: Path) -> Normaliser:
    return Normaliser({str(tmp_path): "<folder>"})


def test_paths_and_times_are_left_out(normaliser: Normaliser, tmp_path: Path) -> None:
    text = f"{tmp_path}/a.csv at 2026-11-24T02:43:16.123Z"
    assert normaliser.text(text) == "<folder>/a.csv at <time>"


def test_a_varying_field_is_kept_as_a_name_and_every_other_one_counts(normaliser: Normaliser) -> None:
    first, parts = normaliser.json('{"time_s": 1.0, "force_cN": [1, 2]}')
    again, later = normaliser.json('{"time_s": 2.0, "force_cN": [1, 2]}')
    other, moved = normaliser.json('{"time_s": 1.0, "force_cN": [1, 3]}')
    assert first == again
    assert parts == later
    assert other != first
    assert [key for key in parts if parts[key] != moved[key]] == ["force_cN"]


def test_the_order_of_fields_counts(normaliser: Normaliser) -> None:
    assert normaliser.json('{"a": 1, "b": 2}')[0] != normaliser.json('{"b": 2, "a": 1}')[0]


def test_a_journal_is_hashed_by_the_kind_of_its_lines(normaliser: Normaliser) -> None:
    lines = [{"crc32": i, "record": {"press": i}} for i in range(3)] + [{"crc32": 9, "record": {"run": 1}}]
    _, parts = normaliser.lines("\n".join(map(json.dumps, lines)))
    assert list(parts) == ["press x3", "run x1"]


def test_each_difference_is_a_line_that_says_where() -> None:
    before = {
        "a": {"sha256": "1", "parts": {"x": "1", "y": "1"}},
        "b": {"sha256": "1"},
        "c": {"sha256": "1", "status": 2},
    }
    after = {"a": {"sha256": "2", "parts": {"x": "1", "y": "2"}}, "c": {"sha256": "1"}, "d": {"sha256": "1"}}
    assert list(differences("case", before, after)) == [
        "case: b: gone",
        "case: a: y differs",
        "case: c: exit status 0, was 2",
        "case: d: new",
    ]


def test_every_case_has_a_name_of_its_own() -> None:
    names = [case.name for case in read_cases()]
    assert len(names) == len(set(names))
