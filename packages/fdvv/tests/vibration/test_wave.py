"""WAV files."""

import io
import wave
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings

from fdvv.errors import InputError, ModelError
from fdvv.model.curve import Stroke
from fdvv.model.vibration import Mode, Vibration
from fdvv.program.synth import RATE_HZ, Slot, render
from fdvv.vibration.wave import board_wav, read_wav, to_wav, vibration_samples
from tests.support.program.slot_strategies import SLOTS

SNAP = Vibration(Stroke.PRESS, None, 2.0, 0.016, (Mode(239.0, 4.6, 100.0),))


@given(SLOTS)
@settings(max_examples=30, deadline=None)
def test_the_boards_samples_come_back_bit_for_bit(slot: Slot) -> None:
    counts = render(slot, min(slot.duration_samples, 4000))
    sound = read_wav(board_wav(counts, RATE_HZ).data)
    assert sound.rate_Hz == RATE_HZ
    assert np.array_equal(sound.samples // 16 + 2048, counts)


def test_a_vibration_is_as_loud_as_16_bits_allow_and_its_scale_is_returned() -> None:
    samples = vibration_samples(SNAP)
    made = to_wav(samples)
    sound = read_wav(made.data)
    assert np.abs(sound.samples).max() == 32_767
    assert (
        np.abs(sound.samples / 32_767 * made.full_scale - samples).max() <= made.full_scale / 65_534 * 1.001
    )


def test_a_common_scale_keeps_two_sounds_comparable() -> None:
    samples = vibration_samples(SNAP)
    half = read_wav(to_wav(samples / 2, full_scale=float(np.abs(samples).max())).data)
    assert np.abs(half.samples).max() == pytest.approx(32_767 / 2, abs=1)


def test_silence_surrounds_the_vibration() -> None:
    samples = vibration_samples(SNAP, 48_000, quiet_s=0.01)
    assert not samples[:480].any()
    assert not samples[-400:].any()
    assert samples.size == round((0.016 + 0.02) * 48_000)


def test_a_written_file_is_read_again(tmp_path: Path) -> None:
    made = to_wav(vibration_samples(SNAP))
    made.save(tmp_path / "snap.wav")
    assert np.array_equal(read_wav(tmp_path / "snap.wav").samples, read_wav(made.data).samples)


def test_samples_that_are_none_are_refused() -> None:
    with pytest.raises(ModelError, match="finite samples"):
        to_wav(np.array([1.0, np.nan]))
    with pytest.raises(ModelError, match="full_scale must be"):
        to_wav(np.array([2.0]), full_scale=1.0)


def stereo() -> bytes:
    held = io.BytesIO()
    with wave.open(held, "wb") as sound:
        sound.setnchannels(2)
        sound.setsampwidth(2)
        sound.setframerate(8000)
        sound.writeframes(bytes(8))
    return held.getvalue()


@pytest.mark.parametrize(
    ("data", "message"),
    [(b"not a sound at all", "not a WAV file"), (b"", "not a WAV file"), (stereo(), "2 channels of 16 bits")],
)
def test_other_files_are_refused_in_one_line(tmp_path: Path, data: bytes, message: str) -> None:
    (tmp_path / "x.wav").write_bytes(data)
    with pytest.raises(InputError, match=message) as caught:
        read_wav(tmp_path / "x.wav")
    assert "\n" not in str(caught.value)
