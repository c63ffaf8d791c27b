"""Sound files: every width, one microphone distinguished from two, and no volts that nobody stated."""

from __future__ import annotations

import io
import sys
from pathlib import Path

import numpy as np
import numpy.typing as npt
import pytest

from fdvv.errors import BuildError, InputError
from fdvv.recording.read import read_log
from fdvv.recording.types import Quantity, Recording
from tests.recording.files import wav

RNG = np.random.default_rng(1)


def noise(width: int) -> npt.NDArray[np.int64]:
    """Return 400 samples from end to end."""
    top = 2 ** (8 * width - 1)
    return np.concatenate([[-top, top - 1, 0], RNG.integers(-top, top, 397)])


def read(folder: Path, content: bytes, full_scale_V: float | None = None) -> Recording:
    (folder / "a.wav").write_bytes(content)
    return read_log(folder / "a.wav", full_scale_V=full_scale_V)


@pytest.mark.parametrize("width", [1, 2, 3, 4])
def test_whole_numbers_of_every_width_come_back_as_they_are(tmp_path: Path, width: int) -> None:
    samples = noise(width)
    found = read(tmp_path, wav(samples, width))
    (stream,) = found.takes[0].streams
    assert (stream.name, stream.quantity, stream.clock) == ("sound", Quantity.COUNTS, "sound card")
    np.testing.assert_array_equal(stream.values, samples)
    np.testing.assert_array_equal(stream.t_s, np.arange(400) / 44100)
    assert "no volts; give full_scale_V" in found.warnings[0]


@pytest.mark.parametrize("width", [1, 2, 3, 4])
def test_volts_come_of_a_full_scale_that_is_stated(tmp_path: Path, width: int) -> None:
    found = read(tmp_path, wav(noise(width), width), full_scale_V=1.5)
    (stream,) = found.takes[0].streams
    assert (stream.quantity, found.warnings) == (Quantity.SOUND, ())
    assert stream.values[0] == pytest.approx(-1.5)


def test_two_channels_that_are_one_are_read_once(tmp_path: Path) -> None:
    found = read(tmp_path, wav(np.repeat(noise(2), 2), channels=2))
    assert [s.name for s in found.takes[0].streams] == ["sound"]
    assert found.warnings[0] == "both channels are the same; the left one is read"


@pytest.mark.parametrize("what", ["another", "silent", "louder", "turned"])
def test_two_channels_that_differ_are_two_streams(tmp_path: Path, what: str) -> None:
    left = noise(2) // 4
    right = {"another": noise(2), "silent": 0 * left, "louder": 3 * left, "turned": -left}[what]
    found = read(tmp_path, wav(np.column_stack([left, right]).ravel(), channels=2))
    assert [s.name for s in found.takes[0].streams] == ["sound 1", "sound 2"]
    np.testing.assert_array_equal(found.takes[0].streams[1].raw, right)


def coded(form: str, subtype: str, samples: npt.NDArray[np.float64]) -> bytes:
    import soundfile

    stream = io.BytesIO()
    soundfile.write(stream, samples, 44100, format=form, subtype=subtype)
    return stream.getvalue()


@pytest.mark.parametrize(
    ("form", "subtype", "name"),
    [
        ("WAV", "FLOAT", "wav"),
        ("FLAC", "PCM_16", "flac"),
        ("OGG", "VORBIS", "ogg"),
        ("MP3", "MPEG_LAYER_III", "mp3"),
    ],
)
def test_other_codings_are_read_as_parts_of_full_scale(
    tmp_path: Path, form: str, subtype: str, name: str
) -> None:
    pytest.importorskip("soundfile")
    tone = 0.5 * np.sin(2 * np.pi * 440 * np.arange(8820) / 44100)
    found = read(tmp_path, coded(form, subtype, np.column_stack([tone, tone])), full_scale_V=2.0)
    (stream,) = found.takes[0].streams
    assert (found.sources[0].format, stream.raw.dtype.str) == (name, "<f4")
    assert np.abs(stream.values[2000:6000]).max() == pytest.approx(1.0, rel=0.02)
    assert stream.rate_Hz == pytest.approx(44100)


def test_without_soundfile_it_is_asked_for(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "soundfile", None)
    with pytest.raises(BuildError, match=r"needs soundfile; pip install 'fdvv\[audio\]'"):
        read(tmp_path, b"OggS" + bytes(100))


BROKEN = {
    "a head alone": wav(noise(2))[:20],
    "no sample": wav(noise(2))[:44],
    "nonsense": b"RIFF1234WAVE" + bytes(50),
    "an Ogg of nothing": b"OggS" + bytes(100),
    "an MP3 of nothing": b"ID3" + bytes(100),
}


@pytest.mark.parametrize("what", BROKEN)
def test_a_broken_sound_is_refused_in_one_line(tmp_path: Path, what: str) -> None:
    pytest.importorskip("soundfile")
    with pytest.raises(InputError) as caught:
        read(tmp_path, BROKEN[what])
    assert "\n" not in str(caught.value)


def test_a_sound_that_was_cut_short_keeps_what_is_there(tmp_path: Path) -> None:
    found = read(tmp_path, wav(noise(2))[:-101])
    assert found.takes[0].streams[0].raw.size == 349
