"""fdvv vibration, and a known exciter on the command line."""

from pathlib import Path

import numpy as np
import pytest

from fdvv.cli.vibration import vibration
from fdvv.model.file import load_builtin
from fdvv.vibration.exciter import KnownExciter, load_exciter, save_exciter
from fdvv.vibration.sound import LEAST_CARRIED
from fdvv.vibration.wave import read_wav, to_wav
from tests.support.command_line import Run

EXCITER = KnownExciter(24.0, 670.0, 2.0, latency_s=0.007)


@pytest.fixture
def exciter(tmp_path: Path) -> str:
    save_exciter(EXCITER, tmp_path / "rig.exciter.json")
    return "rig.exciter.json"


def test_a_models_vibrations_are_listed(fdvv: Run) -> None:
    ran = fdvv("vibration", "mx-clear")
    assert ran.status == 0
    assert "press, any speed" in ran.out
    assert "239.00" in ran.out
    assert "likeness" not in ran.out


def test_with_an_exciter_the_similarity_is_printed(fdvv: Run, exciter: str) -> None:
    (press, release) = fdvv("vibration", "mx-clear", "--exciter", exciter, "--json").json["vibrations"]
    assert press["expected"]["way"] == "inverse"
    assert 0.9 < press["expected"]["likeness"] < 1
    assert release["stroke"] == "release"


def test_a_sound_is_written_and_its_scale_printed(fdvv: Run, tmp_path: Path) -> None:
    report = fdvv("vibration", "mx-clear", "--wav", "snap.wav", "--json").json["wav"]
    sound = read_wav(tmp_path / "snap.wav")
    wanted = load_builtin("mx-clear").vibration("press", 100.0)
    assert wanted is not None
    peak = np.abs(wanted.acceleration_m_s2(np.arange(0, 0.016, 1 / 48_000))).max()
    assert sound.rate_Hz == 48_000
    assert report["full_scale"] == pytest.approx(peak, rel=1e-6)
    assert report["unit"] == "m/s2"


def test_the_boards_samples_are_written_at_their_rate(fdvv: Run, tmp_path: Path, exciter: str) -> None:
    ran = fdvv("vibration", "mx-clear", "--wav", "b.wav", "--board", "--exciter", exciter)
    assert ran.out.endswith("written to b.wav; full scale is 2048 count\n")
    assert read_wav(tmp_path / "b.wav").rate_Hz == 16_000


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (("mx-red",), "it has none"),
        (("mx-clear", "--wav", "x.mp3"), "end it in .wav"),
        (("none",), "no such file or built-in button"),
    ],
)
def test_what_cannot_be_shown_is_refused_in_one_line(
    fdvv: Run, arguments: tuple[str, ...], message: str
) -> None:
    ran = fdvv("vibration", *arguments)
    assert ran.status == 2
    assert message in ran.err
    assert ran.err.count("\n") == 1


def keystroke(path: Path, noise: float) -> None:
    t = np.arange(8820) / 44_100
    after = np.maximum(t - 0.05, 0)
    ring = np.where(t >= 0.05, np.exp(-200 * after) * np.cos(2 * np.pi * 1500 * after), 0)
    random = np.random.default_rng(0).normal(0, 1, t.size)
    burst = np.where(t >= 0.05, np.exp(-200 * after), 0.001)
    to_wav(ring + noise * burst * random, 44_100).save(path)


def test_the_modes_of_a_key_press_are_shown_with_the_part_they_carry(fdvv: Run) -> None:
    keystroke(Path("key.wav"), 0.1)
    ran = fdvv("vibration", "key.wav")
    assert ran.out.startswith("key.wav: onset at 50.0")
    assert "of the ring's energy" in ran.out
    found = fdvv("vibration", "key.wav", "--json").json
    assert found["modes"][0]["frequency_Hz"] == pytest.approx(1500, rel=0.01)
    assert found["carried_ratio"] > 0.9


def test_a_sound_that_is_no_ring_is_refused_with_its_share(fdvv: Run) -> None:
    keystroke(Path("key.wav"), 2.0)
    ran = fdvv("vibration", "key.wav", "--json")
    assert ran.status == 2
    assert "of its energy is in damped modes, at least 50 % is needed" in ran.err
    assert 0 <= ran.json["error"]["carried_ratio"] < 0.5
    assert fdvv("vibration", "key.wav", "--least-carried", "0").status == 0
    assert "are of a button" in fdvv("vibration", "key.wav", "--board").err


def test_a_program_is_uploaded_through_the_inverse_of_a_known_exciter(fdvv: Run, exciter: str) -> None:
    plain = fdvv("device", "upload", "mx-clear", "--device", "host", "--json").json
    inverse = fdvv("device", "upload", "mx-clear", "--device", "host", "--exciter", exciter, "--json").json
    assert inverse["bytes"] > plain["bytes"]


def test_the_exciter_of_a_simulated_rig_is_known_and_written(fdvv: Run, tmp_path: Path) -> None:
    ran = fdvv("device", "exciter", "--device", "host", "--tone-s", "1", "-o", "e.exciter.json")
    assert ran.status == 0, ran.err
    assert ran.out.startswith("host (simulated), 14 tones")
    found = load_exciter(tmp_path / "e.exciter.json")
    assert found.simulated
    assert 500 < found.resonance_Hz < 900


def test_a_device_that_plays_in_presses_only_is_refused(fdvv: Run) -> None:
    ran = fdvv("device", "exciter", "--device", "twin")
    assert (ran.status, ran.err.count("\n")) == (2, 1)
    assert "use host or serial:PORT" in ran.err


def test_a_sound_is_refused_below_the_part_that_an_import_refuses() -> None:
    assert {option.name: option.default for option in vibration.params}["least_carried"] == LEAST_CARRIED
