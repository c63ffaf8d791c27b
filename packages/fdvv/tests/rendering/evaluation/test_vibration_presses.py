"""Vibrations in presses: synthetic ones whose vibration is known, and those of the twin."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fdvv.compensation.method import Trial, Tuning
from fdvv.device.twin import TwinDevice
from fdvv.errors import InputError
from fdvv.model.curve import Stroke
from fdvv.model.file import load_builtin
from fdvv.model.press import Press
from fdvv.model.surface import ForceSurface
from fdvv.model.vibration import Mode, Vibration
from fdvv.protocol.messages import head_of
from fdvv.rendering.evaluation.vibration_presses import (
    Playback,
    RenderedVibration,
    judge_vibration,
    vibrating_image,
)
from fdvv.rendering.probe import ProbeResult, probe
from fdvv.rendering.session import Session
from fdvv.testing.scripted import ScriptedDevice
from fdvv.twin.files import load_rig
from fdvv.twin.rig import Rig
from fdvv.units import FloatArray
from fdvv.vibration.exciter import KnownExciter

MODEL = load_builtin("mx-clear")
SURFACE = ForceSurface.of_model(MODEL, [50.0, 100.0])
SNAP = MODEL.vibrations[0]
RATE_Hz = 20_000.0


def moved_mm(mode: Mode, t_s: FloatArray) -> FloatArray:
    """Integrate one decaying sine twice from rest, in closed form; what drifts on is smooth."""
    pole = -mode.decay_1_s + 2j * np.pi * mode.frequency_Hz
    t = np.maximum(t_s, 0.0)
    inner = (np.exp(pole * t) - 1 - pole * t) / pole**2
    return np.asarray(1e3 * mode.amplitude_m_s2 * inner.imag)


def made(vibration: Vibration | None, seed: int, gain: float = 1.0, late_s: float = 0.0) -> Press:
    """Press and release at about 100 mm/s, with a vibration on the press that never ends."""
    speed = 100.0 * (1 + 0.05 * np.random.default_rng(seed).standard_normal())
    down_s = MODEL.travel_mm / speed
    t = np.arange(round((2 * down_s + 0.04) * RATE_Hz)) / RATE_Hz
    x = np.interp(
        t, [0.0, down_s, down_s + 0.02, 2 * down_s + 0.02], [0.0, MODEL.travel_mm, MODEL.travel_mm, 0.0]
    )
    if vibration is not None:
        x = x + gain * moved_mm(vibration.modes[0], t - vibration.onset_mm / speed - late_s)
    return Press(t, x, np.full(t.size, 50.0), 100.0)


def compared(gain: float = 1.0, late_s: float = 0.0) -> RenderedVibration:
    silent = [made(None, seed) for seed in range(5)]
    played = [made(SNAP, seed, gain, late_s) for seed in range(5)]
    return judge_vibration(MODEL, Stroke.PRESS, 100.0, silent, played)


@settings(max_examples=12, deadline=None)
@given(st.floats(0.3, 3.0), st.integers(-3, 6))
def test_a_press_with_a_known_shift_and_gain_comes_out_as_that(gain: float, late_ms: int) -> None:
    error = compared(gain, 1e-3 * late_ms).error
    assert error is not None
    assert error.onset_ms == pytest.approx(late_ms, abs=0.3)
    assert error.level_dB == pytest.approx(20 * np.log10(gain), abs=1.2)
    assert error.onset_mm == pytest.approx(0.1 * late_ms, abs=0.04)


def test_a_perfect_rendering_gives_nothing_to_notice() -> None:
    error = compared().error
    assert error is not None
    assert error.total_JND < 0.15
    assert error.likeness == pytest.approx(1.0, abs=0.03)


def test_a_record_of_the_rigs_own_sensor_or_a_coarse_one_measures_no_vibration() -> None:
    press = made(None, 1)
    sensed = replace(press, sensed_mm=press.displacement_mm)
    coarse = Press(press.t_s[::20], press.displacement_mm[::20], press.force_cN[::20], 100.0)
    for record in (sensed, coarse):
        found = judge_vibration(MODEL, Stroke.PRESS, 100.0, [record], [])
        assert "does not hold the cap's acceleration" in found.to_dict()["outcome"]
        assert found.error is None


def test_a_stroke_that_ends_too_soon_after_the_onset_is_not_measured() -> None:
    late = replace(SNAP, onset_mm=3.7)
    found = judge_vibration(replace(MODEL, vibrations=(late,)), Stroke.PRESS, 100.0, [made(None, 1)], [])
    assert "ends within one period" in found.reason


def uno() -> Rig:
    """Return the rig voltage with a synthesiser instead of a card."""
    return replace(Rig(), exciter=replace(Rig().exciter, latency_s=2e-4, jitter_s=0.0))


def test_on_the_twin_the_played_presses_are_the_silent_ones_again() -> None:
    result = probe(TwinDevice(uno(), seed=4), MODEL, SURFACE, [100.0], 3, playback=Playback(3))
    assert (result.presses, result.vibration_presses) == (3, 3)
    shown = result.curves[0].vibration.shown
    assert shown is not None
    assert shown.with_m_s2 is not None
    added = shown.with_m_s2 - shown.without_m_s2
    before = shown.since_ms < -1.0
    # the same press: before the vibration only what removing slow motion spreads
    assert np.abs(added[before]).max() < 0.05 * np.abs(added).max()
    error = result.curves[0].vibration.error
    assert error is not None
    assert error.played
    # played without knowing the exciter: late, because it rings first, and weaker than asked
    assert error.onset_ms == pytest.approx(1.3, abs=1.2)
    assert error.level_dB is not None
    assert -12 < error.level_dB < -3
    assert error.likeness is not None
    assert error.likeness > 0.7


def test_a_rig_without_an_exciter_says_what_its_cap_does_by_itself() -> None:
    device = TwinDevice(load_rig("recommended"), seed=4)
    result = probe(device, MODEL, SURFACE, [100.0], 2, playback=Playback(2))
    assert result.vibration_presses == 0
    found = result.curves[0].vibration.to_dict()
    assert found["outcome"] == "not played"
    assert found["level_dB"] is None
    assert found["own_dB"] > 0
    assert "is not played" in result.to_dict()["verdict"]


def test_a_device_of_tables_only_plays_nothing() -> None:
    result = probe(ScriptedDevice(), MODEL, SURFACE, [100.0], 2, playback=Playback(2))
    assert result.vibration_presses == 0
    assert not result.means.exciter


def test_nobody_presses_for_a_vibration_that_the_record_would_not_show() -> None:
    class Sensed(TwinDevice):
        """A rig that records only what its own sensor says."""

        def press(self, velocity_mm_s: float) -> Press:
            press = super().press(velocity_mm_s)
            assert press.sensed_mm is not None
            return replace(press, displacement_mm=press.sensed_mm)

    result = probe(Sensed(seed=4), MODEL, SURFACE, [50.0, 100.0], 2, playback=Playback(2))
    assert (result.presses, result.vibration_presses) == (4, 0)
    assert "not measured" in result.to_dict()["verdict"]


def test_a_vibration_that_the_board_cannot_play_is_refused() -> None:
    loud = replace(SNAP, modes=(Mode(239.0, 400.0, 130.0),))
    with pytest.raises(InputError, match="weaken or shorten"):
        probe(TwinDevice(), replace(MODEL, vibrations=(loud,)), SURFACE, [100.0], 1, playback=Playback(1))


def resumed(folder: Path, seed: int, playback: Playback | None = None) -> ProbeResult:
    session = Session(folder / "probe", seed=4)
    twin = TwinDevice(uno(), seed=seed)
    return probe(twin, MODEL, SURFACE, [100.0], 2, session=session, playback=playback)


def test_a_session_with_vibrating_presses_is_its_result_again_and_refuses_another_count(
    tmp_path: Path,
) -> None:
    first = resumed(tmp_path, 4, Playback(2))
    assert resumed(tmp_path, 5, Playback(2)).to_dict() == first.to_dict()
    with pytest.raises(InputError, match="another session"):
        resumed(tmp_path, 4)


def test_a_session_begun_without_vibrations_goes_on_without_them(tmp_path: Path) -> None:
    first = resumed(tmp_path, 4)
    assert resumed(tmp_path, 5, Playback(2)).to_dict() == first.to_dict()


@pytest.mark.parametrize("exciter", [None, KnownExciter(20.0, 600.0, 2.0)])
def test_the_image_holds_the_table_with_a_slot_and_an_event_for_each_vibration(
    exciter: KnownExciter | None,
) -> None:
    image = vibrating_image(MODEL, Trial(SURFACE, 100.0, Tuning(), vibrating=True), exciter)
    head = head_of(image)
    assert (head.states, head.surfaces, head.vibrations, head.slots) == (1, 2, 2, 1)
    device = TwinDevice(uno(), seed=1)
    device.upload_program(image)
    trace = device.press_trace(100.0)
    assert sorted(set(trace.slot[trace.slot != 255].tolist())) == [0]


def test_a_known_exciter_renders_the_vibration_more_alike_than_a_plain_one() -> None:
    found = {}
    for name, known in (("plain", None), ("inverse", KnownExciter(21.0, 700.0, 2.2))):
        result = probe(TwinDevice(uno(), seed=4), MODEL, SURFACE, [50.0], 3, playback=Playback(3, known))
        error = result.curves[0].vibration.error
        assert error is not None
        found[name] = error
    assert found["inverse"].likeness is not None
    assert found["plain"].likeness is not None
    assert found["inverse"].likeness > found["plain"].likeness
