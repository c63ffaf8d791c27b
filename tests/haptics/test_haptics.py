"""AHAP, .haptic and HJIF: written as the formats ask, and read back as far as they hold it."""

import json
from collections.abc import Callable
from itertools import pairwise
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fdvv.errors import InputError, ModelError
from fdvv.formats.exchange.exported import Exported
from fdvv.model.curve import Stroke
from fdvv.model.vibration import Mode, Vibration
from fdvv_haptics.ahap import ahap, read_ahap
from fdvv_haptics.hjif import hjif, read_hjif
from fdvv_haptics.meta_haptic import meta_haptic, read_meta_haptic
from fdvv_haptics.pulse import Pulse, frequency_Hz, mode_of, pulse_of, sharpness

DATE = "2026-01-01"
SNAP = Vibration(Stroke.PRESS, None, 1.0, 0.03, (Mode(239.0, 4.6, 131.0),))
TWO = Vibration(Stroke.PRESS, 100.0, 1.0, 0.05, (Mode(180.0, 5.0, 60.0, 0.3), Mode(260.0, -3.0, 120.0, 1.0)))
modes = st.builds(Mode, st.floats(70, 295), st.floats(0.01, 100), st.floats(0, 800), st.floats(-3, 3))
WRITERS: list[Callable[[Vibration], Exported]] = [ahap, meta_haptic, lambda v: hjif(v, DATE)]


def _pulse_of_file(made: Exported) -> Pulse:
    return (read_ahap if made.format == "ahap" else read_meta_haptic)(made.data)


@settings(max_examples=25, deadline=None)
@given(mode=modes, duration_s=st.floats(0.005, 0.5))
def test_one_mode_comes_back_from_every_format_but_for_its_phase(mode: Mode, duration_s: float) -> None:
    vibration = Vibration(Stroke.PRESS, None, 1.0, duration_s, (mode,))
    for write in (ahap, meta_haptic):
        found = mode_of(_pulse_of_file(write(vibration)))
        assert found.frequency_Hz == pytest.approx(mode.frequency_Hz, rel=1e-9)
        assert found.phase_rad == 0
        t = np.linspace(0, duration_s, 200)
        fall, wanted = (m.amplitude_m_s2 * np.exp(-m.decay_1_s * t) for m in (found, mode))
        assert np.abs(fall - wanted).max() < 0.02 * mode.amplitude_m_s2


@settings(max_examples=25, deadline=None)
@given(found=st.lists(modes, min_size=1, max_size=4), duration_s=st.floats(0.005, 0.5))
def test_hjif_keeps_every_mode_to_a_whole_hertz(found: list[Mode], duration_s: float) -> None:
    vibration = Vibration(Stroke.RELEASE, None, 1.0, duration_s, tuple(found))
    read, length_s = read_hjif(hjif(vibration, DATE).data)
    assert length_s == pytest.approx(duration_s, abs=1.1e-5)
    loudest = max(m.amplitude_m_s2 for m in found)
    t = np.linspace(0, duration_s, 100)
    for mode, wanted in zip(read, found, strict=True):
        assert mode.frequency_Hz == pytest.approx(round(wanted.frequency_Hz))
        turn = (mode.phase_rad - wanted.phase_rad) % (2 * np.pi)
        assert min(turn, 2 * np.pi - turn) < 1e-9
        a, b = (m.amplitude_m_s2 * np.exp(-m.decay_1_s * t) for m in (mode, wanted))
        assert np.abs(a - b).max() < 0.02 * len(found) * loudest


def test_a_negative_amplitude_is_half_a_turn_in_hjif() -> None:
    read, duration_s = read_hjif(hjif(TWO, DATE).data)
    back = Vibration(Stroke.PRESS, None, 1.0, duration_s, read)
    t = np.linspace(0, 0.049, 300)
    np.testing.assert_allclose(back.acceleration_m_s2(t), TWO.acceleration_m_s2(t), atol=0.02)


def test_the_envelope_of_two_modes_beats() -> None:
    pulse = pulse_of(TWO)
    t = np.linspace(0, 0.05, 2000)
    wave = np.abs(TWO.acceleration_m_s2(t))
    envelope = np.interp(t, pulse.t_s, pulse.amplitude_m_s2)
    assert (wave <= envelope + 0.02 * envelope.max()).all()
    assert 180 <= pulse.frequency_Hz.min() <= pulse.frequency_Hz.max() <= 260


def test_ahap_has_the_keys_and_ranges_that_apple_documents_in_short_curves() -> None:
    record = json.loads(ahap(TWO, "a").text)
    assert record["Version"] == 1.0
    assert record["Pattern"][0]["Event"]["EventType"] == "HapticContinuous"
    for part in record["Pattern"][1:]:
        curve = part["ParameterCurve"]
        points = curve["ParameterCurveControlPoints"]
        assert curve["ParameterID"] in ("HapticIntensityControl", "HapticSharpnessControl")
        assert 2 <= len(points) <= 16
        assert points[0]["Time"] == 0
        if curve["ParameterID"] == "HapticIntensityControl":
            assert all(0 <= p["ParameterValue"] <= 1 for p in points)
        else:
            assert all(-1 <= p["ParameterValue"] <= 1 for p in points)


def test_ahap_pieces_of_a_curve_meet() -> None:
    record = json.loads(ahap(TWO).text)
    pieces = [p["ParameterCurve"] for p in record["Pattern"][1:]]
    loud = [c for c in pieces if c["ParameterID"] == "HapticIntensityControl"]
    assert len(loud) > 1
    for one, following in pairwise(loud):
        last = one["ParameterCurveControlPoints"][-1]
        assert one["Time"] + last["Time"] == pytest.approx(following["Time"])
        first = following["ParameterCurveControlPoints"][0]
        assert last["ParameterValue"] == first["ParameterValue"]


def test_a_haptic_file_keeps_the_rules_of_its_data_model() -> None:
    record = json.loads(meta_haptic(TWO).text)
    assert record["version"] == {"major": 1, "minor": 0, "patch": 0}
    envelopes = record["signals"]["continuous"]["envelopes"]
    for name in ("amplitude", "frequency"):
        times = [p["time"] for p in envelopes[name]]
        assert times == sorted(times)
        assert times[0] == 0
        assert all(0 <= p[name] <= 1 for p in envelopes[name])


def test_an_hjif_file_has_what_the_reference_reader_requires() -> None:
    record = json.loads(hjif(TWO, DATE, "a").text)
    assert {"version", "profile", "level", "date", "description", "timescale"} <= set(record)
    assert record["avatars"] == record["syncs"] == []
    (perception,) = record["perceptions"]
    assert perception["avatar_id"] == 0
    (channel,) = perception["channels"]
    assert len(channel["bands"]) == 2
    for band in channel["bands"]:
        (effect,) = band["effects"]
        assert isinstance(effect["position"], int)
        for frame in effect["keyframes"]:
            assert isinstance(frame["relative_position"], int)
            assert isinstance(frame["frequency_modulation"], int)
            assert -1 <= frame["amplitude_modulation"] <= 1
            assert frame["frequency_modulation"] <= band["upper_frequency_limit"]
    many = Vibration(Stroke.PRESS, None, 1.0, 0.1, tuple(Mode(100.0 + i, 1.0, 50.0) for i in range(8)))
    assert (record["level"], json.loads(hjif(many, DATE).text)["level"]) == (1, 2)


def test_sharpness_and_frequency_are_each_others_inverse_within_their_range() -> None:
    f = np.linspace(65, 300, 20)
    np.testing.assert_allclose(frequency_Hz(sharpness(f)), f)
    assert sharpness(np.array([10.0, 1000.0])).tolist() == [0, 1]


@pytest.mark.parametrize("write", WRITERS[:2])
def test_a_frequency_that_sharpness_cannot_hold_is_reported(write: Callable[[Vibration], Exported]) -> None:
    high = Vibration(Stroke.PRESS, None, 1.0, 0.02, (Mode(670.0, 1.0, 100.0),))
    assert any("670 Hz lies outside 65 to 300 Hz" in lost for lost in write(high).lost)


def _foreign() -> dict[str, Any]:
    """Return a pattern as Apple's own samples are: a transient, then a continuous event with curves."""
    return {
        "Version": 1.0,
        "Metadata": {"Project": "a", "Created": "5 June 2019"},
        "Pattern": [
            {
                "Event": {
                    "Time": 0.5,
                    "EventType": "HapticTransient",
                    "EventParameters": [{"ParameterID": "HapticIntensity", "ParameterValue": 0.8}],
                }
            },
            {"Event": {"Time": 0.5, "EventType": "AudioCustom", "EventWaveformPath": "a.wav"}},
            {
                "Event": {
                    "Time": 0.515,
                    "EventType": "HapticContinuous",
                    "EventDuration": 0.25,
                    "EventParameters": [{"ParameterID": "HapticIntensity", "ParameterValue": 5.0}],
                }
            },
            {
                "ParameterCurve": {
                    "ParameterID": "HapticIntensityControl",
                    "Time": 0.515,
                    "ParameterCurveControlPoints": [
                        {"Time": 0, "ParameterValue": 1},
                        {"Time": 0.25, "ParameterValue": 0.0},
                    ],
                }
            },
        ],
    }


def test_a_foreign_ahap_is_read_with_defaults_and_clamps() -> None:
    pulse = read_ahap(json.dumps(_foreign()).encode(), 10.0)
    assert pulse.t_s[-1] == pytest.approx(0.265)
    assert pulse.amplitude_m_s2[0] == pytest.approx(8.0)
    # intensity 5 is clamped to 1, and falls in a straight line to 0
    at = np.interp(0.015 + 0.125, pulse.t_s, pulse.amplitude_m_s2)
    assert at == pytest.approx(5.0, rel=0.01)
    assert pulse.frequency_Hz == pytest.approx(182.5)
    assert mode_of(pulse).decay_1_s > 0


def test_a_file_that_does_not_say_its_scale_asks_for_it() -> None:
    with pytest.raises(InputError, match="does not say what 1 stands for; give the full scale in m/s2"):
        read_ahap(json.dumps(_foreign()).encode())


def test_an_emphasis_lifts_its_breakpoint_and_a_step_takes_its_later_value() -> None:
    points: list[dict[str, Any]] = [
        {"time": 0.0, "amplitude": 0.2, "emphasis": {"amplitude": 0.9, "frequency": 0.5}},
        {"time": 0.1, "amplitude": 0.2},
        {"time": 0.1, "amplitude": 0.1},
        {"time": 0.2, "amplitude": 0.0},
    ]
    record = {"version": {"major": 1}, "signals": {"continuous": {"envelopes": {"amplitude": points}}}}
    pulse = read_meta_haptic(json.dumps(record).encode(), 2.0)
    assert pulse.amplitude_m_s2.tolist() == pytest.approx([1.8, 0.2, 0.0])
    assert pulse.frequency_Hz.tolist() == pytest.approx([182.5] * 3)


@pytest.mark.parametrize("write", WRITERS)
def test_a_silent_vibration_is_refused(write: Callable[[Vibration], Exported]) -> None:
    silent = Vibration(Stroke.PRESS, None, 1.0, 0.02, (Mode(200.0, 0.0, 100.0),))
    with pytest.raises(ModelError, match="silent"):
        write(silent)


@pytest.mark.parametrize("write", WRITERS)
def test_a_name_of_any_letters_is_kept(write: Callable[[Vibration], Exported]) -> None:
    assert json.loads(write(SNAP).text)
    assert "müßig" in ahap(SNAP, "müßig").text
