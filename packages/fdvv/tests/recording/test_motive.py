"""Exports of Motive: versions, units, rates, gaps, and what is refused."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from fdvv.errors import InputError
from fdvv.recording.read import read_log
from fdvv.recording.types import Recording
from tests.recording.files import motive


def read(folder: Path, text: str | bytes) -> Recording:
    path = folder / "take.csv"
    path.write_bytes(text.encode() if isinstance(text, str) else text)
    return read_log(path)


@pytest.mark.parametrize("version", ["1.21", "1.22", "1.23", "1.24", "1.25"])
@pytest.mark.parametrize("end", ["\n", "\r\n"])
@pytest.mark.parametrize("rigid_body", [False, True])
def test_every_version_gives_the_same_places(
    tmp_path: Path, version: str, end: str, rigid_body: bool
) -> None:
    found = read(tmp_path, motive(version, end=end, rigid_body=rigid_body))
    assert found.sources[0].format == f"motive-{version}"
    left, right = found.takes[0].streams[-2:]
    assert (left.name, right.name, left.clock, left.quantity) == ("left", "right", "camera", "marker")
    frame = np.arange(40)
    np.testing.assert_allclose((right.values - left.values)[frame != 3], 100)
    np.testing.assert_allclose(np.diff(left.values[4:, 1]), 0.5)
    assert np.flatnonzero(np.isnan(left.raw).all(axis=1)).tolist() == [3]
    np.testing.assert_array_equal(left.t_s, frame / 256)


@pytest.mark.parametrize(
    ("unit", "scale"), [("Meters", 1000.0), ("Centimeters", 10.0), ("Millimeters", 1.0), ("Inches", 25.4)]
)
def test_lengths_come_out_in_mm_and_stay_on_file_as_they_were(
    tmp_path: Path, unit: str, scale: float
) -> None:
    left = read(tmp_path, motive(unit=unit)).takes[0].streams[0]
    assert left.raw[0].tolist() == [0, 1, 2]
    assert left.values[0].tolist() == [0, scale, 2 * scale]


def test_what_motive_computed_has_another_name_and_the_rest_is_reported(tmp_path: Path) -> None:
    blocks = [("Rigid Body Marker", "cap:Marker1"), ("Marker", "cap:Marker1"), ("Marker", "Unlabeled 7")]
    found = read(tmp_path, motive(blocks=blocks, rigid_body=True))
    names = [stream.name for stream in found.takes[0].streams]
    assert names == [
        "cap (rigid body)",
        "cap:Marker1 (rigid body marker)",
        "cap:Marker1",
        "Unlabeled 7",
    ]
    assert found.warnings == ("columns left out: 4 of rotation, 1 of mean marker error, 1 of marker quality",)


def test_two_places_of_one_name_are_both_kept(tmp_path: Path) -> None:
    found = read(tmp_path, motive(blocks=[("Marker", "a"), ("Labeled Marker", "a")]))
    assert [stream.name for stream in found.takes[0].streams] == ["a", "a 2"]


@pytest.mark.parametrize("rate", [120.0, 240.0, 256.0, 360.0, 1000.0])
@pytest.mark.parametrize("digits", [3, 6])
def test_times_are_those_of_the_frame_counter_however_they_are_rounded(
    tmp_path: Path, rate: float, digits: int
) -> None:
    stream = read(tmp_path, motive(rate=rate, digits=digits)).takes[0].streams[0]
    np.testing.assert_array_equal(stream.t_s, np.arange(40) / rate)


def test_times_that_are_not_those_of_the_head_are_kept_as_printed(tmp_path: Path) -> None:
    text = motive(rate=256.0).replace("Frame Rate,256.000000", "Frame Rate,120.000000")
    found = read(tmp_path, text)
    assert found.takes[0].streams[0].rate_Hz == pytest.approx(256.0, rel=1e-3)
    assert "the head tells 120 frames a second, the times 256" in found.warnings[0]


def test_an_export_that_begins_later_keeps_its_times(tmp_path: Path) -> None:
    lines = motive().split("\n")
    found = read(tmp_path, "\n".join([*lines[:7], *lines[17:]]))
    stream = found.takes[0].streams[0]
    np.testing.assert_array_equal(stream.t_s, np.arange(10, 40) / 256)
    assert found.warnings == ("the head tells of 40 frames, 30 are there",)


def test_missing_frames_are_reported(tmp_path: Path) -> None:
    lines = motive().split("\n")
    found = read(tmp_path, "\n".join([*lines[:20], *lines[25:]]))
    assert found.warnings[0] == "5 frames missing in between"
    steps = np.diff(found.takes[0].streams[0].t_s)
    assert steps.max() == pytest.approx(6 / 256)


def test_a_file_cut_in_a_row_loses_that_row_and_says_so(tmp_path: Path) -> None:
    found = read(tmp_path, motive()[:-30])
    assert found.takes[0].streams[0].t_s.size == 39
    assert "1 row cut short left out" in found.warnings


def test_a_cell_that_is_no_number_is_a_gap_and_is_counted(tmp_path: Path) -> None:
    found = read(tmp_path, motive().replace("100.000000,106.000000", "#REF!,1_0", 1))
    assert found.warnings == ("2 cells of no usable number read as gaps",)
    assert np.isnan(found.takes[0].streams[1].raw[10, :2]).all()


STARTS = {
    "2023-11-28 10.27.58.765 DU.": "2023-11-28T22:27:58.765",
    "2023-11-28 10.27.58.765 DE.": "2023-11-28T10:27:58.765",
    "2016-01-05 03.49.50.755 PM": "2016-01-05T15:49:50.755",
    "2018-10-05 12.05.03.445 P.M.": "2018-10-05T12:05:03.445",
    "2018-10-05 12.05.03.445 AM": "2018-10-05T00:05:03.445",
    "2018-10-05 17.05.03.445 ": "2018-10-05T17:05:03.445",
}
NO_STARTS = ["2020-01-16 07.07.59.330 ", "", "2020-99-16 17.07.59.330", "yesterday"]


@pytest.mark.parametrize("start", STARTS)
def test_the_start_is_read_in_english_and_hungarian(tmp_path: Path, start: str) -> None:
    found = read(tmp_path, motive(start=start))
    assert (found.takes[0].made, found.takes[0].remark, found.warnings) == (STARTS[start], "made up", ())


@pytest.mark.parametrize("start", NO_STARTS)
def test_a_start_without_a_time_is_reported_and_left_open(tmp_path: Path, start: str) -> None:
    found = read(tmp_path, motive(start=start))
    assert found.takes[0].made == ""
    assert "tells no certain moment" in found.warnings[0]


REFUSED = {
    "no marker": (motive(blocks=[]), "line 7: it holds frames and times but no marker; export it again"),
    "no frame": (motive(frames=0), "line 8: it holds no frame"),
    "no unit": (motive(unit="Furlongs"), "Length Units is 'Furlongs', one of meters"),
    "an old version": (motive("1.1"), r"format version '1\.1', versions 1\.21 to 1\.25 are read"),
    "no axes": (motive().replace("Frame,", "Rame,"), "no line begins with Frame,Time"),
}


@pytest.mark.parametrize("what", REFUSED)
def test_what_cannot_be_used_is_refused_with_a_reason(tmp_path: Path, what: str) -> None:
    text, reason = REFUSED[what]
    with pytest.raises(InputError, match=reason):
        read(tmp_path, text)


def test_a_version_to_come_is_read_like_the_newest_with_a_warning(tmp_path: Path) -> None:
    found = read(tmp_path, motive("1.26"))
    assert found.warnings == ("format version 1.26 is not known; read like 1.25",)
