"""Chained logs: whatever is done to their files is noticed, and whatever a kill leaves is not."""

from __future__ import annotations

import contextlib
import json
import zlib
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fdvv.errors import InputError
from fdvv.eventlog import line_of
from fdvv_people.study.files.chained_log import ChainedLog, next_chain, read_chained
from fdvv_people.study.files.log_head import LogHead, head_path
from tests.support.campaign import campaign
from tests.support.kill import Killed, kill_at

KEY = bytes(range(32))
RECORDS = [{"shown": {"number": i}, "x": [0.1 * i, "ä\n", None]} for i in range(4)]
KEYS = pytest.mark.parametrize("key", [b"", KEY], ids=["plain", "marked"])


def written(folder: Path, key: bytes = KEY, name: str = "session.jsonl") -> Path:
    folder.mkdir(exist_ok=True)
    with ChainedLog.create(folder / name, {"person": "P01"}, key) as log:
        for record in RECORDS:
            log.write(record)
    return folder / name


def problems(path: Path, key: bytes = b"") -> tuple[str, ...]:
    return read_chained(path, key).problems


@KEYS
def test_what_was_written_is_read_back(tmp_path: Path, key: bytes) -> None:
    path = written(tmp_path, key)
    found = read_chained(path, key)
    assert found.problems == ()
    assert list(found.records) == RECORDS
    assert found.about == {"person": "P01"}
    with ChainedLog(path, key) as log:
        assert log.records == RECORDS
        log.write({"last": 1})
    assert read_chained(path, key).records[-1] == {"last": 1}


@KEYS
@campaign("start", range(61), part=1)
def test_a_changed_byte_anywhere_is_noticed(tmp_path: Path, key: bytes, start: int) -> None:
    path = written(tmp_path, key)
    for file in (path, head_path(path)):
        whole = file.read_bytes()
        for place in range(start, len(whole), 61):
            for by in (1, 128):
                changed = bytearray(whole)
                changed[place] ^= by
                file.write_bytes(changed)
                assert problems(path), (file.name, place)
        file.write_bytes(whole)
    assert problems(path, key) == ()


LINES = st.lists(st.integers(0, 6), max_size=8)


@pytest.fixture(scope="module")
def whole(tmp_path_factory: pytest.TempPathFactory) -> dict[bytes, Path]:
    """Return a log of either kind; it is put right after every change."""
    return {key: written(tmp_path_factory.mktemp("log"), key) for key in (b"", KEY)}


@pytest.mark.parametrize("key", [b"", KEY], ids=["plain", "marked"])
@settings(max_examples=25, deadline=None)
@given(order=LINES | st.permutations(range(5)) | st.just([0, 1, 2, 3, 4]))
def test_lines_cut_moved_repeated_or_added_are_noticed(
    whole: dict[bytes, Path], key: bytes, order: list[int]
) -> None:
    path = whole[key]
    before = path.read_bytes()
    lines = before.splitlines(keepends=True)
    lines += [line_of({"entry": {"record": {}, "chain": "", "mark": ""}}), b"nonsense\n"]
    path.write_bytes(b"".join(lines[i] for i in order))
    found = problems(path)
    path.write_bytes(before)
    assert bool(found) == (order != [0, 1, 2, 3, 4])


@KEYS
@pytest.mark.parametrize("kept", [0, 1, 40])
def test_bytes_added_to_the_end_are_noticed(tmp_path: Path, key: bytes, kept: int) -> None:
    path = written(tmp_path, key)
    with path.open("ab") as stream:
        stream.write(b"\n" * kept if kept else b"x\n")
    assert problems(path) != ()


def test_a_line_forged_with_its_checksum_breaks_the_chain(tmp_path: Path) -> None:
    path = written(tmp_path)
    lines = path.read_bytes().splitlines(keepends=True)
    lines[2] = forged(lines[2], lambda entry: entry["record"].update(shown={"number": 9}))
    path.write_bytes(b"".join(lines))
    assert problems(path) == ("line 3 was changed, moved or added",)


def test_blanks_that_mean_nothing_are_noticed_too(tmp_path: Path) -> None:
    path = written(tmp_path)
    path.write_bytes(path.read_bytes().replace(b'{"crc32": ', b'{"crc32":  ', 1))
    assert problems(path)


def forged(line: bytes, change: Callable[[dict[str, Any]], None]) -> bytes:
    record = json.loads(line)["record"]
    change(record["entry"])
    body = json.dumps(record).encode()
    return b'{"crc32": %d, "record": %b}\n' % (zlib.crc32(body), body)


def test_who_forges_a_whole_chain_lacks_the_key(tmp_path: Path) -> None:
    """Everything that can be computed without the key is right; the marks are not."""
    path = written(tmp_path)
    lines = path.read_bytes().splitlines(keepends=True)
    chain = json.loads(lines[3])["record"]["entry"]["chain"]
    record = {"answered": {"number": 3}}

    def change(entry: dict[str, Any]) -> None:
        entry.update(record=record, chain=next_chain(chain, record))

    lines[4] = forged(lines[4], change)
    path.write_bytes(b"".join(lines))
    last = json.loads(lines[4])["record"]["entry"]["chain"]
    head_path(path).write_text(LogHead(5, last).marked(bytes(32)).text)
    assert problems(path) == ()
    assert problems(path, KEY) == ("line 5 was changed, moved or added",)
    with pytest.raises(InputError, match="line 5 was changed"):
        ChainedLog(path, KEY)


def test_a_log_in_the_place_of_another_says_so(tmp_path: Path) -> None:
    path = written(tmp_path)
    other = written(tmp_path, bytes(32), "other.jsonl")
    path.write_bytes(other.read_bytes())
    head_path(path).write_bytes(head_path(other).read_bytes())
    assert problems(path, KEY) != ()


@KEYS
@pytest.mark.parametrize("missing", [".jsonl", ".head"])
def test_a_missing_file_is_noticed(tmp_path: Path, key: bytes, missing: str) -> None:
    path = written(tmp_path, key)
    path.with_suffix(missing).unlink()
    assert problems(path)
    with pytest.raises(InputError):
        ChainedLog(path, key)


@KEYS
@pytest.mark.parametrize("step", range(5))
def test_whatever_a_kill_leaves_is_whole_and_is_gone_on_with(
    tmp_path: Path, key: bytes, step: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    path = written(tmp_path, key)
    log = ChainedLog(path, key)
    with contextlib.suppress(Killed), kill_at(step, monkeypatch):
        log.write({"last": 1})
    log.close()
    assert problems(path) == ()
    with ChainedLog(path, key) as again:
        assert again.records in (RECORDS, [*RECORDS, {"last": 1}])
        again.write({"more": 2})
    assert problems(path, key) == ()


@KEYS
def test_a_line_that_a_kill_cut_short_is_left_out(tmp_path: Path, key: bytes) -> None:
    path = written(tmp_path, key)
    before, head = path.read_bytes(), head_path(path).read_bytes()
    with ChainedLog(path, key) as log:
        log.write({"last": 1})
    whole = path.read_bytes()
    next_ = json.loads(head_path(path).read_text())["chain"]
    announced = {**json.loads(head), "next": "" if key else next_}
    for end in (*range(len(before), len(whole), 47), len(whole) - 1):
        path.write_bytes(whole[:end])
        head_path(path).write_text(json.dumps(announced) + "\n")
        assert problems(path, key) == ()
        assert len(read_chained(path, key).records) == 4
    with ChainedLog(path, key) as log:
        assert log.records == RECORDS
    assert path.read_bytes() == before


def test_a_log_at_work_elsewhere_is_refused(tmp_path: Path) -> None:
    path = written(tmp_path)
    with ChainedLog(path, KEY), pytest.raises(InputError, match="another process is at work"):
        ChainedLog(path, KEY)


def test_what_json_cannot_hold_is_not_written(tmp_path: Path) -> None:
    path = written(tmp_path)
    with ChainedLog(path, KEY) as log:
        with pytest.raises(ValueError, match="JSON compliant"):
            log.write({"x": float("nan")})
        log.write({"x": 1})
    assert problems(path, KEY) == ()
