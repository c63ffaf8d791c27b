"""The bench that captures real presses: perfect, it returns its input; then one error at a time."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from fdvv.errors import ModelError
from fdvv.twin import (
    ButtonTrace,
    CaptureRig,
    Finger,
    ForceSensor,
    capture,
    load_button,
    no_button_noise,
    plan,
    simulate_button,
)

PERFECT = CaptureRig(
    exposure_s=0.0,
    marker_noise_m=0.0,
    marker_bias_m=0.0,
    rocking_rad=0.0,
    dropped_ratio=0.0,
    clock_ppm=0.0,
    sound_low_Hz=0.0,
    sound_filter_s=0.0,
    sound_noise_V=0.0,
    sound_range_V=100.0,
    sound_bits=0,
)


@pytest.fixture(scope="module")
def trace() -> ButtonTrace:
    button, finger = load_button("mx-clear"), Finger()
    gesture = plan(finger, button.curve.travel_m, 0.1)
    return simulate_button(button, finger, gesture, no_button_noise(gesture), ForceSensor())


def random() -> np.random.Generator:
    return np.random.default_rng(7)


def test_a_perfect_bench_returns_its_input(trace: ButtonTrace) -> None:
    raw = capture(trace, PERFECT, random())
    true_s = raw.frame_s - raw.offset_s
    for marker_mm in raw.marker_mm.T:
        assert np.allclose(marker_mm, np.interp(true_s, trace.t_s, trace.displacement_mm), atol=1e-12)
    assert trace.sensed_cN is not None
    assert np.array_equal(raw.force_cN, trace.sensed_cN[trace.tick])
    heard = 2e-3 * (trace.velocity_mm_s + trace.plate_velocity_mm_s)[trace.tick]
    assert np.allclose(raw.sound_V, heard, atol=1e-12)
    assert np.allclose(np.diff(raw.frame_s), 1 / 256)
    assert np.allclose(np.diff(raw.t_s), 1e-3)


def test_the_light_is_seen_at_most_one_frame_late(trace: ButtonTrace) -> None:
    for seed in range(30):
        raw = capture(trace, PERFECT, np.random.default_rng(seed))
        late_s = raw.frame_s[np.argmax(raw.light > 0)] - raw.offset_s - raw.light_s
        assert 0 <= late_s <= 1 / 256


def test_marker_noise_has_the_asked_size_and_bias_moves_a_take_as_a_whole(trace: ButtonTrace) -> None:
    clean = capture(trace, PERFECT, random())
    noisy = capture(trace, replace(PERFECT, marker_noise_m=5e-5), random())
    assert np.std(noisy.marker_mm - clean.marker_mm) == pytest.approx(0.05, rel=0.2)
    moved = capture(trace, replace(PERFECT, marker_bias_m=1e-4), random()).marker_mm - clean.marker_mm
    assert np.ptp(moved) < 1e-12
    assert abs(moved[0, 0]) > 0


def test_rocking_parts_the_markers_and_their_mean_keeps_little_of_it(trace: ButtonTrace) -> None:
    clean = capture(trace, PERFECT, random()).marker_mm
    rocked = capture(trace, replace(PERFECT, rocking_rad=0.03), random()).marker_mm
    apart = np.abs(rocked[:, 0] - rocked[:, 1]).max()
    mean = np.abs((rocked - clean).mean(axis=1)).max()
    assert 0.005 < apart < 0.5
    assert mean == pytest.approx(0.025 * apart, rel=0.01)


def test_lost_frames_are_marked_and_not_filled_in(trace: ButtonTrace) -> None:
    raw = capture(trace, replace(PERFECT, dropped_ratio=0.3), random())
    lost = np.isnan(raw.marker_mm)
    assert 0.1 < lost.mean() < 0.5
    assert np.array_equal(lost[:, 0], lost[:, 1])


def test_an_exposure_averages_the_motion(trace: ButtonTrace) -> None:
    raw = capture(trace, replace(PERFECT, exposure_s=0.004), random())
    true_s = raw.frame_s - raw.offset_s
    middle_mm = np.interp(true_s + 0.002, trace.t_s, trace.displacement_mm)
    start_mm = np.interp(true_s, trace.t_s, trace.displacement_mm)
    seen = raw.marker_mm[:, 0]
    assert np.abs(seen - middle_mm).max() < 0.3 * np.abs(seen - start_mm).max()


def test_a_microphone_with_a_high_pass_does_not_hear_a_cap_at_rest(trace: ButtonTrace) -> None:
    raw = capture(trace, replace(PERFECT, sound_low_Hz=90.0), random())
    assert np.abs(raw.sound_V[-20:]).max() < 0.05 * np.abs(raw.sound_V).max()


def test_a_converter_has_steps(trace: ButtonTrace) -> None:
    raw = capture(trace, replace(CaptureRig(), sound_noise_V=0.0), random())
    steps = raw.sound_V / (3.3 / 1024)
    assert np.allclose(steps, np.round(steps), atol=1e-9)


def test_a_bare_finger_cannot_be_captured() -> None:
    button, finger = load_button("mx-red"), Finger()
    gesture = plan(finger, button.curve.travel_m, 0.05)
    bare = simulate_button(button, finger, gesture, no_button_noise(gesture))
    with pytest.raises(ModelError, match="bare"):
        capture(bare, PERFECT, random())
