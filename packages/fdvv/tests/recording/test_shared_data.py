"""Real logs: each loads with its facts right, or is refused with its reason."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from fdvv.errors import InputError
from fdvv.recording.read import read_log
from fdvv.recording.types import Quantity, Recording

pytestmark = pytest.mark.shared

MOTIVE = "optitrack-motive/"
COUNTS = "the samples are counts of a converter, no volts; give full_scale_V where it is known"


def gaps_percent(recording: Recording) -> float:
    """Return the percentage of blank position cells."""
    raw = np.hstack([stream.raw for stream in recording.takes[0].streams])
    return 100 * float(np.isnan(raw).mean())


def test_eighteen_unlabeled_markers_at_360_frames_a_second_in_millimetres(shared_data: Path) -> None:
    found = read_log(shared_data / MOTIVE / "ha5dzs" / "test_markers_enabled.csv")
    streams = found.takes[0].streams
    assert (found.sources[0].format, len(streams), found.warnings) == ("motive-1.23", 18, ())
    assert [s.name for s in streams] == [f"Unlabeled {n}" for n in range(1036, 1054)]
    # the printed times are rounded to 3, 6, 8, 11 ms; the frames are not
    np.testing.assert_array_equal(streams[0].t_s, np.arange(1353) / 360)
    assert streams[0].values[0].tolist() == [2659.741943, -830.793884, -2862.191650]
    assert gaps_percent(found) == pytest.approx(8.41, abs=0.01)
    assert found.takes[0].made == "2023-11-28T22:27:58.765"  # "10.27.58.765 DU.", after noon


def test_a_rigid_body_and_its_markers_in_metres(shared_data: Path) -> None:
    found = read_log(shared_data / MOTIVE / "timeanddoctor" / "test.csv")
    streams = {stream.name: stream for stream in found.takes[0].streams}
    assert list(streams) == [
        "ernesto_body (rigid body)",
        *(f"ernesto_body:Marker{n} (rigid body marker)" for n in (1, 2, 3, 4)),
        *(f"ernesto_body:Marker{n}" for n in (1, 2, 3, 4)),
    ]
    first = streams["ernesto_body:Marker1"]
    np.testing.assert_array_equal(first.t_s, np.arange(499) / 120)
    np.testing.assert_allclose(first.values[0], [3833.445, 32.409, -2237.666])
    assert np.isfinite(first.raw).all()
    assert np.flatnonzero(np.isnan(streams["ernesto_body (rigid body)"].raw[:, 0])).tolist() == [4]
    assert found.warnings[0] == (
        "columns left out: 4 of rotation, 1 of mean marker error, 4 of marker quality"
    )


def test_piano_logs_are_counts_at_the_rate_of_their_name(shared_data: Path) -> None:
    files = sorted((shared_data / "piano-action-position").rglob("*.txt"))
    assert files
    for path in files:
        found = read_log(path)
        (stream,) = found.takes[0].streams
        assert (stream.quantity, stream.raw.dtype.str, stream.scale) == (Quantity.COUNTS, "<i4", 1.0)
        assert stream.rate_Hz == pytest.approx(
            2000.0 if "_2K_" in path.name else 8000.0 * path.name.count("K")
        )
        assert stream.t_s[-1] == pytest.approx(10.0, abs=0.001)
        assert 0 < stream.raw.min() < stream.raw.max() < 2**23
        assert "whose scale nobody stated" in found.warnings[0]


def test_every_sample_of_every_forcepeaks_log_finds_its_tap(shared_data: Path) -> None:
    files = sorted((shared_data / "forcepeaks-tapping").glob("*-raw.dat"))
    whole: list[int] = []
    bare = []
    for path in files:
        found = read_log(path)
        take = found.takes[0]
        assert take.times_s("beat").size == 25
        if not take.streams:
            bare.append(path.name)
            continue
        (force,) = take.streams
        assert (force.quantity, force.clock) == (Quantity.COUNTS, "board")
        begins = np.flatnonzero(np.diff(force.t_s, prepend=0) > 0.01)
        taps_s = take.times_s("tap")
        # all taps after the sixth beat have samples; one held while it comes has those behind it
        assert np.isin(np.round(force.t_s[begins[1:]], 6), np.round(taps_s, 6)).all()
        assert begins.size == np.sum(taps_s + 0.1 > take.times_s("beat")[5])
        whole += np.diff(begins)[1:].tolist()
    assert len(files) >= 72
    assert len(bare) == len(files) - 68
    # 100 ms of samples 1.024 ms apart are 97.66 on average, so that the board's rate is 976.6 Hz, not 1 kHz
    assert set(whole) == {97, 98}
    assert np.mean(whole) == pytest.approx(100 / 1.024, abs=0.05)


def test_the_experiments_lists_are_refused(shared_data: Path) -> None:
    for path in (shared_data / "forcepeaks-tapping").glob("*alltrials.csv"):
        with pytest.raises(InputError, match="none of the known formats of logs"):
            read_log(path)


def test_recordings_of_keys_are_mono_counts_at_their_rate(shared_data: Path) -> None:
    files = sorted((shared_data / "audio-bucklespring").rglob("*.wav"))
    assert files
    for path in files:
        found = read_log(path)
        (stream,) = found.takes[0].streams
        assert (stream.quantity, stream.raw.dtype.str, found.warnings) == (Quantity.COUNTS, "<i2", (COUNTS,))
        assert stream.rate_Hz == pytest.approx(44100)
        assert 0.05 < stream.t_s[-1] < 1


def test_key_sounds_as_mp3_are_short_mono_parts_of_full_scale(shared_data: Path) -> None:
    pytest.importorskip("soundfile")
    files = sorted((shared_data / "audio-kbsim").rglob("*.mp3"))
    assert files
    for path in files:
        found = read_log(path)
        (stream,) = found.takes[0].streams
        assert stream.raw.dtype.str == "<f4"
        assert stream.rate_Hz == pytest.approx(44100)
        assert 0 < np.abs(stream.raw).max() <= 1.5
        assert 0.01 < stream.t_s[-1] < 0.3


@pytest.mark.parametrize("name", ["cherrymx-black-abs", "cherrymx-blue-abs"])
def test_long_stereo_of_one_microphone_is_read_once(shared_data: Path, name: str) -> None:
    pytest.importorskip("soundfile")
    found = read_log(shared_data / "audio-mechvibes" / name / "sound.ogg")
    (stream,) = found.takes[0].streams
    assert "both channels are alike to 0.999" in found.warnings[0]
    assert 25 < stream.t_s[-1] < 98
