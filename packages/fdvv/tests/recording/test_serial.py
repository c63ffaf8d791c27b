"""The text of a capture microcontroller: units, events, roll-over, lines that did not come through."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from fdvv.errors import InputError
from fdvv.recording.file import load_recording
from fdvv.recording.log import RecordingLog
from fdvv.recording.read import read_log
from fdvv.recording.serial import SerialCapture
from fdvv.recording.types import Quantity, Recording, Stage
from tests.recording.files import serial


def read(folder: Path, text: str) -> Recording:
    (folder / "log.txt").write_bytes(text.encode())
    return read_log(folder / "log.txt")


@pytest.mark.parametrize("checked", [False, True])
def test_channels_have_their_units_and_events_their_moments(tmp_path: Path, checked: bool) -> None:
    found = read(tmp_path, serial(checked=checked))
    take = found.takes[0]
    force, sound = take.streams
    assert (force.name, force.quantity, force.clock) == ("force", Quantity.FORCE, "board")
    assert (sound.name, sound.quantity) == ("sound", Quantity.SOUND)
    np.testing.assert_allclose(force.values, 0.05 * np.arange(50))
    np.testing.assert_allclose(sound.values, -0.0008 * np.arange(50))
    np.testing.assert_allclose(force.t_s, np.arange(50) / 1000, atol=1e-12)
    assert force.raw.dtype == np.int32
    assert [(m.name, m.clock, round(m.t_s, 9)) for m in take.marks] == [("light on", "board", 0.02525)]
    assert (found.bench.force_filter_ms, found.bench.tip_mass_g, found.warnings) == (1.0, 2.5, ())


def test_the_counter_turns_over_without_a_gap(tmp_path: Path) -> None:
    take = read(tmp_path, serial(first_us=2**32 - 20_000)).takes[0]
    np.testing.assert_allclose(take.streams[0].t_s, np.arange(50) / 1000, atol=1e-12)
    assert take.marks[0].t_s == pytest.approx(0.02525)


@pytest.mark.parametrize("cut", [1, 3, 9])
def test_a_log_cut_at_both_ends_loses_those_lines_and_says_so(tmp_path: Path, cut: int) -> None:
    text = serial(head=False)
    found = read(tmp_path, text[cut : -cut - 2])
    assert found.takes[0].streams[0].t_s.size >= 48
    assert "garbled" in found.warnings[-1] or cut == 1


def test_a_log_whose_head_was_missed_holds_counts(tmp_path: Path) -> None:
    found = read(tmp_path, serial(head=False))
    assert [(s.name, s.quantity) for s in found.takes[0].streams] == [("F", "counts"), ("M", "counts")]
    assert found.warnings == ("the head was missed; channels without one are kept as counts",)


def test_a_head_that_comes_again_later_serves_the_whole_log(tmp_path: Path) -> None:
    lines = serial().split("\r\n")
    found = read(tmp_path, "\n".join([*lines[5:20], *lines[:5], *lines[20:]]))
    assert (found.takes[0].streams[0].quantity, found.warnings) == ("force", ())


GARBLED = [
    "FM 1003000 51",
    "FM 10\xff",
    "FM 1003000 1 2 3",
    "fm 1 2 3",
    "FF 1003000 1 2",
    "x",
    "FM 9999999999 1 2",
]


@pytest.mark.parametrize("line", GARBLED)
def test_a_garbled_line_is_left_out_and_counted(tmp_path: Path, line: str) -> None:
    lines = serial().split("\r\n")
    lines[8] = line
    found = read(tmp_path, "\n".join(lines))
    assert found.takes[0].streams[0].t_s.size == 49
    assert found.warnings == ("line 9 garbled and left out",)


def test_a_sum_that_does_not_fit_gives_a_changed_digit_away(tmp_path: Path) -> None:
    lines = serial(checked=True).split("\r\n")
    lines[8] = lines[8].replace(" 515 ", " 575 ")
    found = read(tmp_path, "\n".join(lines))
    assert found.takes[0].streams[0].raw.max() == 561
    assert found.warnings == ("line 9 garbled and left out",)


@pytest.mark.parametrize(
    "line", ["# fdvv-capture 7", "# fdvv-capture", "# fdvv-capture x", "# channel F g scale=nan"]
)
def test_a_repeated_head_that_differs_is_garbled(tmp_path: Path, line: str) -> None:
    found = read(tmp_path, serial() + line)
    assert found.takes[0].streams[0].quantity is Quantity.FORCE
    assert found.warnings == (("line 57 garbled and left out",) if line != "# fdvv-capture" else ())


def test_a_time_that_leaps_ahead_costs_one_sample(tmp_path: Path) -> None:
    text = serial().replace("FM 1003000 ", "FM 1903000 ")
    found = read(tmp_path, text)
    assert found.takes[0].streams[0].t_s.size == 49
    assert found.warnings[0] == "channel F: 1 sample left out: the times do not rise"


def test_a_channel_without_a_unit_is_kept_as_counts(tmp_path: Path) -> None:
    found = read(tmp_path, serial().replace("force_cN scale=0.05", "grip"))
    grip = found.takes[0].streams[0]
    assert (grip.name, grip.quantity, grip.scale, grip.zero) == ("grip", "counts", 1.0, 0.0)
    assert "channel F is called 'grip', which names no unit" in found.warnings[0]


REFUSED = {
    "a version to come": (serial().replace("capture 1", "capture 2"), "version 2 of fdvv-capture, this fdvv"),
    "no sample": (serial(samples=0), "it holds no sample"),
    "a bad bench": (serial().replace("mass_g=2.5", "mass_g=-1"), "head: tip_mass_g must be at least 0"),
}


@pytest.mark.parametrize("what", REFUSED)
def test_what_cannot_be_used_is_refused_with_a_reason(tmp_path: Path, what: str) -> None:
    text, reason = REFUSED[what]
    with pytest.raises(InputError, match=reason):
        read(tmp_path, text)


@pytest.mark.parametrize("first_us", [1_000_000, 2**32 - 20_000])
def test_takes_cut_out_of_a_board_that_goes_on_are_those_of_its_log(tmp_path: Path, first_us: int) -> None:
    text = serial(first_us=first_us)
    whole = read(tmp_path, text).takes[0]
    capture, path = SerialCapture(), tmp_path / "a.recording.jsonl"
    with RecordingLog(path, Recording("a")) as log:
        for count, line in enumerate(text.split("\r\n")):
            assert capture.feed(line)
            if count in (17, 40):
                log.add(capture.take(log.next_number, Stage.PRESS, 100.0))
        log.add(capture.take(log.next_number))
    takes = load_recording(path).takes
    assert [take.streams[0].t_s.size for take in takes] == [13, 22, 15]
    assert [take.velocity_mm_s for take in takes] == [100.0, 100.0, None]
    for at in (0, 1):
        joined = np.concatenate([take.streams[at].t_s for take in takes])
        np.testing.assert_allclose(joined, whole.streams[at].t_s, atol=1e-9)
        raw = np.concatenate([take.streams[at].raw for take in takes])
        np.testing.assert_array_equal(raw, whole.streams[at].raw)
    assert sum(len(take.marks) for take in takes) == 1
    assert (capture.bench.tip_mass_g, capture.warnings) == (2.5, [])


def test_a_take_in_which_nothing_came_is_empty() -> None:
    capture = SerialCapture()
    assert capture.take(1).streams == ()
    assert not capture.feed("FM 12")
    assert capture.take(2).marks == ()
    assert capture.warnings[-1] == "line 1 garbled and left out"
