"""A recording on file: exact to the bit, only growing, refused where anything is wrong."""

from __future__ import annotations

import time
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from fdvv.errors import InputError, ModelError
from fdvv.eventlog import line_of
from fdvv.recording.file import RECORDING_SUFFIX, Correction, load_recording, save_recording
from fdvv.recording.log import RecordingLog
from fdvv.recording.types import Bench, Quantity, Recording, Stream
from tests.recording.strategies import contents, recordings
from tests.recording.takes import ABOUT, TAKE, head, take

SMALL = settings(suppress_health_check=[HealthCheck.function_scoped_fixture], max_examples=25, deadline=None)


def written(path: Path, takes: int = 3) -> Path:
    with RecordingLog(path, ABOUT) as log:
        for number in range(1, takes + 1):
            log.add(take(number))
    return path


@SMALL
@given(recording=recordings())
def test_a_recording_comes_back_to_the_bit(tmp_path: Path, recording: Recording) -> None:
    path = tmp_path / f"a{RECORDING_SUFFIX}"
    path.unlink(missing_ok=True)
    save_recording(recording, path)
    assert contents(load_recording(path)) == contents(recording)


@SMALL
@given(recording=recordings())
def test_adding_take_by_take_writes_the_same_bytes_as_saving_at_once(
    tmp_path: Path, recording: Recording
) -> None:
    one, other = tmp_path / "one", tmp_path / "other"
    one.unlink(missing_ok=True)
    other.unlink(missing_ok=True)
    save_recording(recording, one)
    for take_ in recording.takes:
        with RecordingLog(other, recording) as log:
            log.add(take_)
    RecordingLog(other, recording).close()
    assert other.read_bytes() == one.read_bytes()


def test_sixty_presses_of_four_streams_load_in_well_under_a_second(tmp_path: Path) -> None:
    path = tmp_path / "a"
    save_recording(replace(ABOUT, takes=tuple(take(n, samples=2000) for n in range(1, 61))), path)
    start_s = time.process_time()
    assert len(load_recording(path).takes) == 60
    assert time.process_time() - start_s < 0.5


def test_what_is_there_is_never_written_over(tmp_path: Path) -> None:
    path = written(tmp_path / "a")
    before = path.read_bytes()
    with pytest.raises(InputError, match="there is a file already"):
        save_recording(ABOUT, path)
    assert path.read_bytes() == before


OTHERS = [
    replace(ABOUT, name="mx-blue"),
    replace(ABOUT, bench=Bench()),
    replace(ABOUT, person="B"),
    replace(ABOUT, licence=""),
    replace(ABOUT, simulated=True),
]


@pytest.mark.parametrize("about", OTHERS, ids=["button", "bench", "person", "licence", "simulated"])
def test_takes_of_something_else_are_not_added(tmp_path: Path, about: Recording) -> None:
    path = written(tmp_path / "a")
    before = path.read_bytes()
    with pytest.raises(InputError, match=r"is another recording: .* there and .* now; name another file"):
        RecordingLog(path, about)
    assert path.read_bytes() == before


def test_takes_are_counted(tmp_path: Path) -> None:
    with RecordingLog(tmp_path / "a", ABOUT) as log:
        with pytest.raises(ModelError, match="the next take bears the number 1, got 2"):
            log.add(take(2))
        log.add(take(1))
        assert log.next_number == 2
    with RecordingLog(tmp_path / "a", ABOUT) as log:
        assert log.next_number == 2


def test_a_second_process_is_refused_while_the_first_is_at_work(tmp_path: Path) -> None:
    with RecordingLog(tmp_path / "a", ABOUT):
        with pytest.raises(InputError, match="another process is at work on this recording"):
            RecordingLog(tmp_path / "a", ABOUT)
        assert load_recording(tmp_path / "a").name == "mx-clear"


@SMALL
@given(part=st.floats(0, 1, exclude_max=True))
def test_wherever_it_is_cut_the_whole_takes_before_are_there_and_it_goes_on(
    tmp_path: Path, part: float
) -> None:
    path = tmp_path / "a"
    path.unlink(missing_ok=True)
    data = written(path).read_bytes()
    data = data[: int(part * len(data))]
    path.write_bytes(data)
    whole = max(0, data.count(b"\n") - 1)
    with RecordingLog(path, ABOUT) as log:
        assert len(log.recording.takes) == whole
        assert bool(log.warnings) == bool(data and not data.endswith(b"\n"))
        log.add(take(whole + 1))
    found = load_recording(path)
    assert contents(found.takes) == contents(tuple(take(n) for n in range(1, whole + 2)))
    assert found.warnings == ()


def test_a_calibration_is_mended_without_touching_a_sample(tmp_path: Path) -> None:
    path = written(tmp_path / "a")
    before = path.read_bytes()
    with RecordingLog(path, ABOUT) as log:
        log.mend(
            Correction({"scale": 0.06, "zero": 11.0}, stream="force", why="weighed again"), made="2026-02-01"
        )
        log.mend(Correction({"remark": "slipped", "stage": "probe"}, take=2))
        log.mend(Correction({"tip_mass_g": 3.0, "licence": "CC BY 4.0"}))
        log.add(take(4))
        mended = log.recording
    found = load_recording(path)
    assert path.read_bytes().startswith(before)
    assert contents(found) == contents(mended)
    assert [t.streams[0].scale for t in found.takes] == [0.06, 0.06, 0.06, 0.05]
    assert (found.takes[1].remark, found.takes[1].stage, found.takes[0].remark) == ("slipped", "probe", "")
    assert (found.bench.tip_mass_g, found.bench.force_filter_ms, found.licence) == (3.0, 1.0, "CC BY 4.0")
    assert contents(found.takes[0].streams[0].raw) == contents(take().streams[0].raw)


WRONG = [
    ({"raw": 1}, None, "force"),
    ({"scale": 0.0}, None, "force"),
    ({"scale": "2"}, None, "force"),
    ({"scale": 2.0}, 1, None),
    ({"scale": 2.0}, 9, "force"),
    ({"scale": 2.0}, None, "no such"),
    ({"name": "other"}, None, None),
    ({"tip_mass_g": -1.0}, None, None),
    ({"clocks_go_on": 1}, None, None),
    ({"stage": "no stage"}, 1, None),
    ({}, 1, None),
]


@pytest.mark.parametrize(("values", "number", "stream"), WRONG)
def test_what_may_not_be_mended_is_refused_before_it_is_written(
    tmp_path: Path, values: dict[str, object], number: int | None, stream: str | None
) -> None:
    path = written(tmp_path / "a", 1)
    before = path.read_bytes()
    with RecordingLog(path, ABOUT) as log, pytest.raises((ModelError, ValueError)):
        log.mend(Correction(values, number, stream))
    assert path.read_bytes() == before


STREAM = {"name": "f", "quantity": "force", "clock": "b", "scale": 1.0, "zero": 0.0}
EMPTY = "<f8:eJwDAAAAAAE="
NO_QUANTITY = {**STREAM, "quantity": "x", "t_s": EMPTY, "raw": EMPTY}
BAD: dict[str, tuple[list[dict[str, object]], str]] = {
    "no head": ([{"take": {**TAKE, "streams": []}}], "line 1: begins with no head"),
    "two heads": ([{"head": head()}, {"head": head()}], "line 2: holds a second head"),
    "another format": ([{"head": head(format="x")}], '"format" must be "fdvv-recording"'),
    "a newer one": ([{"head": head(version=2)}], "file version 2, this fdvv reads version 1"),
    "a field too many": ([{"head": head(more=1)}], "unknown field `more`"),
    "a bad bench": ([{"head": head(bench={})}], r"line 1, \$.bench: .*missing required field"),
    "a name with spaces": ([{"head": head(name=" a ")}], "name must be text without spaces"),
    "a number left out": (
        [{"head": head()}, {"take": {**TAKE, "number": 2, "streams": []}}],
        "line 2: take 1 bears the number 2",
    ),
    "no column": (
        [{"head": head()}, {"take": {**TAKE, "streams": [{**STREAM, "t_s": "<f8:!", "raw": EMPTY}]}}],
        r"line 2, \$.streams\[0\]: ",
    ),
    "an unknown quantity": (
        [{"head": head()}, {"take": {**TAKE, "streams": [NO_QUANTITY]}}],
        "line 2, .*quantity: Invalid enum value 'x'",
    ),
    "a head that is a list": ([{"head": []}], '"format" must be'),
    "a mend of nothing": ([{"head": head()}, {"mend": 5}], "line 2: Expected `object`"),
}  # fmt: skip


@pytest.mark.parametrize("name", BAD)
def test_a_file_with_a_wrong_record_is_refused_with_its_line(tmp_path: Path, name: str) -> None:
    records, reason = BAD[name]
    path = tmp_path / "a"
    path.write_bytes(b"".join(line_of(record) for record in records))
    with pytest.raises(InputError, match=reason) as caught:
        load_recording(path)
    assert "\n" not in str(caught.value)
    with pytest.raises(InputError, match=reason):
        RecordingLog(path, ABOUT)


@pytest.mark.parametrize("content", [b"", b"a", b"\x00\xff", b'{"crc32": 1}'])
def test_a_file_without_a_whole_record_is_refused(tmp_path: Path, content: bytes) -> None:
    (tmp_path / "a").write_bytes(content)
    with pytest.raises(InputError, match="holds no whole record"):
        load_recording(tmp_path / "a")


def test_text_that_no_file_can_hold_is_refused_before_it_is_written(tmp_path: Path) -> None:
    with RecordingLog(tmp_path / "a", ABOUT) as log:
        before = (tmp_path / "a").read_bytes()
        with pytest.raises(ModelError, match="take 1"):
            log.add(replace(take(), remark="\ud800"))
        half = Stream("a", Quantity.COUNTS, "b", np.zeros(1), np.zeros(1, np.float16))
        with pytest.raises(ModelError, match="take 1: a column cannot hold float16"):
            log.add(replace(take(), streams=(half,)))
        assert (tmp_path / "a").read_bytes() == before
