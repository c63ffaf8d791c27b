"""Logs of converters, tables and the ForcePeaks experiment, and what none of the readers takes."""

from __future__ import annotations

import hashlib
from pathlib import Path

import numpy as np
import pytest

from fdvv.errors import InputError
from fdvv.recording.file import load_recording, save_recording
from fdvv.recording.read import read_log
from fdvv.recording.types import Quantity, Recording
from fdvv.units import GRAM_FORCE_cN
from tests.recording.files import NAMES, TEXTS, counts, forcepeaks, table


def read(folder: Path, text: str, name: str = "log.txt", rate_Hz: float | None = None) -> Recording:
    (folder / name).write_bytes(text.encode())
    return read_log(folder / name, rate_Hz=rate_Hz)


@pytest.mark.parametrize("form", TEXTS)
def test_a_format_is_found_by_looking_inside_whatever_the_name(tmp_path: Path, form: str) -> None:
    name = NAMES.get(form, "a.b")
    found = read(tmp_path, TEXTS[form], name)
    source = found.sources[0]
    assert (source.format, source.name) == (form, name)
    assert source.sha256 == hashlib.sha256(TEXTS[form].encode()).hexdigest()
    assert read(tmp_path, "\n \n" + TEXTS[form], name).takes[0].streams


@pytest.mark.parametrize("form", TEXTS)
def test_what_was_read_is_saved_and_read_again_as_the_same(tmp_path: Path, form: str) -> None:
    found = read(tmp_path, TEXTS[form], NAMES.get(form, "a.b"))
    path = tmp_path / "a.recording.jsonl"
    save_recording(found, path)
    for again in (load_recording(path), read_log(path)):
        for one, other in zip(found.takes[0].streams, again.takes[0].streams, strict=True):
            assert one.raw.tobytes() == other.raw.tobytes()
        assert (again.sources, again.warnings) == (found.sources, found.warnings)


RATES = {
    "hammer_2K_24b_fast.txt": 2000.0,
    "hammer_16K_24b.txt": 16000.0,
    "key_500Hz.txt": 500.0,
    "key 2.5kHz.txt": 2500.0,
    "key-8ksps.txt": 8000.0,
}


@pytest.mark.parametrize("name", RATES)
def test_a_converters_rate_is_that_of_its_name(tmp_path: Path, name: str) -> None:
    found = read(tmp_path, counts(), name)
    stream = found.takes[0].streams[0]
    assert (stream.quantity, stream.raw.dtype.str) == (Quantity.COUNTS, "<i4")
    np.testing.assert_array_equal(stream.t_s, np.arange(100) / RATES[name])
    assert any("that of the file's name" in warning for warning in found.warnings)


def test_a_converters_rate_may_be_given_and_must_be_known(tmp_path: Path) -> None:
    assert read(tmp_path, counts(), "a.txt", 100.0).takes[0].streams[0].rate_Hz == pytest.approx(100)
    with pytest.raises(InputError, match="numbers alone, and neither file nor name tells their rate"):
        read(tmp_path, counts(), "a24b.txt")
    for rate in (0.0, -1.0, float("nan"), float("inf")):
        with pytest.raises(InputError, match="rate_Hz: must be finite and above 0"):
            read(tmp_path, counts(), "a.txt", rate)


def test_a_lost_line_is_a_gap_so_that_time_goes_on(tmp_path: Path) -> None:
    found = read(tmp_path, counts().replace("3586068\n", "35x\n"), "a_1kHz.txt")
    raw = found.takes[0].streams[0].raw
    assert np.flatnonzero(np.isnan(raw)).tolist() == [7]
    assert "1 line of no number read as gaps" in found.warnings


def test_bits_that_the_name_tells_are_held_against_the_numbers(tmp_path: Path) -> None:
    found = read(tmp_path, counts(), "a_1kHz_12b.txt")
    assert "the name tells of 12 bits, but the numbers reach 3586712" in found.warnings


def test_several_converters_side_by_side_are_several_streams(tmp_path: Path) -> None:
    text = "".join(f"{i}\t{100 - i}\n" for i in range(30))
    streams = read(tmp_path, text, "a_1kHz.txt").takes[0].streams
    assert [(s.name, int(s.raw[1])) for s in streams] == [("counts 1", 1), ("counts 2", 99)]


@pytest.mark.parametrize("separator", [",", ";", "\t"])
def test_a_tables_columns_have_the_units_of_their_names(tmp_path: Path, separator: str) -> None:
    found = read(tmp_path, table(separator))
    force, left, light = found.takes[0].streams
    assert (force.name, force.quantity, light.quantity) == ("force", "force", "light")
    np.testing.assert_allclose(force.values[5], 50 * GRAM_FORCE_cN)
    assert np.flatnonzero(np.isnan(force.raw)).tolist() == [4]
    np.testing.assert_allclose(force.t_s, np.arange(20) / 1000)
    assert left.quantity is Quantity.MARKER
    np.testing.assert_allclose(left.values[7], [7.5, 2, 3])
    assert found.warnings == ("columns left out, for they name no quantity and unit: 'remark'",)


TITLES = {
    "force_N": (Quantity.FORCE, 100.0),
    "Force (gf)": (Quantity.FORCE, GRAM_FORCE_cN),
    "force [mN]": (Quantity.FORCE, 0.1),
    "displacement_mm": (Quantity.DISPLACEMENT, 1.0),
    "lvdt_um": (Quantity.DISPLACEMENT, 1e-3),
    "sound_V": (Quantity.SOUND, 1.0),
    "cap_m_s2": (Quantity.ACCELERATION, 1.0),
    "adc_counts": (Quantity.COUNTS, 1.0),
    "contact": (Quantity.CONTACT, 1.0),
    "place_x_mm": (Quantity.MARKER, 1.0),
    "place_y_mm": (Quantity.DISPLACEMENT, 1.0),
}


@pytest.mark.parametrize("title", TITLES)
def test_a_title_tells_quantity_and_unit(tmp_path: Path, title: str) -> None:
    stream = read(tmp_path, f"time_s,{title}\n0,1\n1,2\n").takes[0].streams[0]
    quantity, scale = TITLES[title]
    assert stream.quantity is quantity
    assert stream.scale == pytest.approx(scale)


def test_a_force_without_a_unit_is_no_force(tmp_path: Path) -> None:
    found = read(tmp_path, "time_s,force\n0,1\n1,2\n")
    assert found.takes[0].streams[0].quantity is Quantity.COUNTS
    assert found.warnings == ("column 'force' has no unit; its numbers are kept as counts",)


def test_rows_whose_time_does_not_rise_are_left_out(tmp_path: Path) -> None:
    found = read(tmp_path, "time_s,force_N\n0,1\n1,2\n1,3\nx,3\n2,4\n900,5\n3,6\n")
    assert found.takes[0].streams[0].raw.tolist() == [1, 2, 4, 6]
    assert found.warnings == ("3 rows left out: no time, or one that does not rise",)


def test_samples_of_taps_get_the_times_of_their_taps(tmp_path: Path) -> None:
    found = read(tmp_path, forcepeaks())
    take = found.takes[0]
    (force,) = take.streams
    assert (force.quantity, force.clock, force.raw.dtype.str) == (Quantity.COUNTS, "board", "<i2")
    np.testing.assert_allclose(take.times_s("tap"), [10.9, 11.35, 12.18, 12.7, 13.1])
    begins = np.flatnonzero(np.diff(force.t_s, prepend=0) > 0.01)
    # the third tap is held while the sixth beat, at 12.22 s, lets sampling begin
    np.testing.assert_allclose(force.t_s[begins], [12.22, 12.7, 13.1])
    assert force.raw[begins].tolist() == [400] * 3
    assert np.diff(begins).tolist() == [59, 98]
    np.testing.assert_allclose(np.delete(np.diff(force.t_s), begins[1:] - 1), 1.024e-3)
    assert "one each 1.024 ms" in found.warnings[-1]


def test_a_log_without_samples_holds_its_taps(tmp_path: Path) -> None:
    found = read(tmp_path, forcepeaks(taps=()))
    assert (found.takes[0].streams, len(found.takes[0].marks)) == ((), 9)
    assert "the log holds no force" in found.warnings[0]
    found = read(tmp_path, forcepeaks(taps=(900,)))
    assert (found.takes[0].streams, len(found.takes[0].marks)) == ((), 10)
    assert "no tap came after the sixth beat" in found.warnings[-1]


def test_samples_that_do_not_fit_the_taps_keep_a_clock_of_their_own(tmp_path: Path) -> None:
    lines = [line for line in forcepeaks().split("\n") if not line.startswith("R 3 ")]
    found = read(tmp_path, "\n".join(lines))
    assert found.takes[0].streams[0].clock == "samples"
    assert "their clock knows no pauses" in found.warnings[-1]


NOTHING = {
    "empty": (b"", "it is empty"),
    "blanks": (b" \n\n", "it is empty"),
    "prose": (b"Dear Sir or Madam,\nhow are you\n", "none of the known formats of logs"),
    "a picture": (b"\x89PNG\r\n\x1a\n", "it is a PNG image"),
    "zeros": (bytes(5000), "a binary file of no kind known here"),
    "a curve": (b"displacement_mm,force_cN\n0,0\n1,2\n", "none of the known formats of logs"),
}


@pytest.mark.parametrize("what", NOTHING)
def test_what_is_no_log_is_refused_in_one_line(tmp_path: Path, what: str) -> None:
    content, reason = NOTHING[what]
    (tmp_path / "a.csv").write_bytes(content)
    with pytest.raises(InputError, match=reason) as caught:
        read_log(tmp_path / "a.csv")
    assert "\n" not in str(caught.value)


def test_a_file_that_is_not_there_is_refused(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="No such file"):
        read_log(tmp_path / "a.csv")
