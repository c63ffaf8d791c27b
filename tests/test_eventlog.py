"""A journal loses no finished record and reads back nothing false."""

from __future__ import annotations

import errno
import json
import os
import zlib
from pathlib import Path
from typing import Any

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from fdvv.errors import InputError
from fdvv.eventlog import Journal, JournalKind, line_of, read_records

KIND = JournalKind({"a": Any, "b": Any}, "make another")
BUSY = InputError("x", "journal", "another process is at work", "wait")


def filled(path: Path, records: int = 3) -> Path:
    journal = Journal(path, BUSY)
    for number in range(records):
        journal.write({"a": {"number": number, "text": "x" * number}})
    journal.close()
    return path


def read(path: Path) -> list[int]:
    return [record["a"]["number"] for record, _ in read_records(path, KIND)]


def test_a_line_is_json_with_the_checksum_of_the_records_bytes() -> None:
    line = line_of({"a": [1, "ü"]})
    assert line == b'{"crc32": %d, "record": {"a": [1, "\\u00fc"]}}\n' % zlib.crc32(b'{"a": [1, "\\u00fc"]}')
    assert json.loads(line)["record"] == {"a": [1, "ü"]}


@settings(suppress_health_check=[HealthCheck.function_scoped_fixture], max_examples=25, deadline=None)
@given(part=st.floats(0, 1))
def test_wherever_it_is_cut_the_whole_lines_are_there_and_it_goes_on(tmp_path: Path, part: float) -> None:
    path = tmp_path / "j.jsonl"
    path.unlink(missing_ok=True)
    data = filled(path).read_bytes()
    data = data[: round(part * len(data))]
    path.write_bytes(data)
    whole = data.count(b"\n")
    assert read(path) == list(range(whole))
    end = max((end for _, end in read_records(path, KIND)), default=0)
    journal = Journal(path, BUSY)
    assert journal.cut(end) == (end < len(data))
    journal.write({"a": {"number": 9}})
    journal.close()
    assert read(path) == [*range(whole), 9]


@pytest.mark.parametrize(
    "record", [{"c": 1}, {"a": 1, "b": 2}, {}], ids=["another key", "two keys", "no key"]
)
def test_a_whole_line_with_another_record_is_no_record(tmp_path: Path, record: dict[str, int]) -> None:
    path = tmp_path / "j"
    path.write_bytes(line_of(record) + line_of({"a": {"number": 1}}))
    with pytest.raises(InputError, match="line 1: the record is damaged; make another"):
        read(path)


@pytest.mark.parametrize("line", [b"[" * 100_000, b"\xff", b'{"crc32": 0, "record": [1]}', b"\x00", b"{}"])
def test_a_line_that_is_no_record_is_refused_unless_it_is_the_last(tmp_path: Path, line: bytes) -> None:
    path = tmp_path / "j"
    good = line_of({"a": {"number": 1}})
    path.write_bytes(good + line + b"\n" + good)
    with pytest.raises(InputError, match="line 2: the record is damaged"):
        read(path)
    path.write_bytes(good + line)
    assert read(path) == [1]


def test_a_second_writer_is_refused_until_the_first_lets_go(tmp_path: Path) -> None:
    first = Journal(tmp_path / "j", BUSY)
    with pytest.raises(InputError, match="another process is at work"):
        Journal(tmp_path / "j", BUSY)
    first.close()
    first.close()
    Journal(tmp_path / "j", BUSY).close()


def test_a_full_disk_leaves_no_half_line_and_names_the_file(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    path = filled(tmp_path / "j")
    size, write = path.stat().st_size, os.write

    def full(file: int, data: bytes) -> int:
        if len(data) < 1000:
            raise OSError(errno.ENOSPC, "No space left on device")
        return write(file, data[: len(data) // 2])

    journal = Journal(path, BUSY)
    monkeypatch.setattr(os, "write", full)
    with pytest.raises(OSError, match="No space left") as caught:
        journal.write({"a": {"number": 3, "text": "x" * 5000}})
    monkeypatch.undo()
    journal.close()
    assert (caught.value.filename, path.stat().st_size) == (str(path), size)


def test_a_line_is_forced_to_the_disk_before_write_returns(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    journal = Journal(tmp_path / "j", BUSY)
    sizes: list[int] = []
    monkeypatch.setattr(os, "fsync", lambda file: sizes.append(os.fstat(file).st_size))
    journal.write({"a": 1})
    assert sizes == [len(line_of({"a": 1}))]
    journal.close()
