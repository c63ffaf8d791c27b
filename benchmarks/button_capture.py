"""What does each error of a capture bench do to the captured curve? Lines of button_validation. Simulated."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from typing import Any

import numpy as np

from benchmarks.button_lines import Line, rms
from fdvv.twin import (
    ButtonTrace,
    CaptureRig,
    Finger,
    ForceSensor,
    RawCapture,
    capture,
    draw_button_noise,
    load_button,
    no_button_noise,
    plan,
    simulate_button,
    solve_button_pace,
)

PERFECT_SENSOR = ForceSensor(
    mass_kg=2e-4, filter_s=2e-5, noise_N=0.0, hysteresis_N=0.0, converter_bits=0, contact_stiffness_N_m=2e4,
    contact_loss_s_m=1.0,
)  # fmt: skip
PERFECT = CaptureRig(
    frame_Hz=2000.0, exposure_s=0.0, marker_noise_m=0.0, marker_bias_m=0.0, rocking_rad=0.0,
    dropped_ratio=0.0, clock_ppm=0.0, sound_low_Hz=0.0, sound_filter_s=0.0, sound_noise_V=0.0, sound_bits=0,
)  # fmt: skip


def curve_error_cN(trace: ButtonTrace, raw: RawCapture, synced: bool) -> float:
    """Align, join and compare one captured press with the true force at the true displacement; rms.

    synced: use the true offset of the clocks, else the frame in which the light was first seen.
    """
    lit = int(np.argmax(raw.light > 0.5))
    offset_s = raw.offset_s if synced else raw.frame_s[lit] - raw.light_s
    seen = ~np.isnan(raw.marker_mm[:, 0])
    cap_mm = raw.marker_mm[seen].mean(axis=1)
    sampled_mm = np.interp(raw.t_s, raw.frame_s[seen] - offset_s, cap_mm)
    end = int(np.argmax(sampled_mm))
    x_mm = np.linspace(0.3, 0.95 * float(trace.displacement_mm.max()), 200)
    captured = np.interp(x_mm, np.maximum.accumulate(sampled_mm[:end]), raw.force_cN[:end])
    turn = int(np.argmax(trace.displacement_mm))
    true = np.interp(x_mm, np.maximum.accumulate(trace.displacement_mm[:turn]), trace.force_cN[:turn])
    return rms(captured - true)


def budget(velocity_mm_s: float = 100.0) -> Iterator[Line]:
    sensor, rig = ForceSensor(), CaptureRig()
    sensors: dict[str, dict[str, Any]] = {
        "nothing (perfect bench)": {},
        "sensor: cone's mass and contact": {
            "mass_kg": sensor.mass_kg,
            "contact_stiffness_N_m": sensor.contact_stiffness_N_m,
            "contact_loss_s_m": sensor.contact_loss_s_m,
        },
        "sensor: RC filter": {"filter_s": sensor.filter_s},
        "sensor: 10 bit": {"converter_bits": 10},
        "sensor: noise": {"noise_N": sensor.noise_N},
        "sensor: play": {"hysteresis_N": sensor.hysteresis_N},
    }  # fmt: skip
    rigs: dict[str, dict[str, Any]] = {
        "cameras: 256 frames/s": {"frame_Hz": rig.frame_Hz},
        "cameras: exposure": {"exposure_s": rig.exposure_s},
        "cameras: noise": {"marker_noise_m": rig.marker_noise_m},
        "cameras: bias": {"marker_bias_m": rig.marker_bias_m},
        "cameras: rocking": {"rocking_rad": rig.rocking_rad, "lever_m": rig.lever_m,
                             "lever_mismatch_ratio": rig.lever_mismatch_ratio},
        "clocks: 50 ppm": {"clock_ppm": rig.clock_ppm},
    }  # fmt: skip
    for what, changes in sensors.items():
        yield _budget_line(what, replace(PERFECT_SENSOR, **changes), PERFECT, True, velocity_mm_s)
    for what, changes in rigs.items():
        yield _budget_line(what, PERFECT_SENSOR, replace(PERFECT, **changes), True, velocity_mm_s)
    slow = replace(PERFECT, frame_Hz=rig.frame_Hz)
    yield _budget_line("clocks: light seen at 256 frames/s", PERFECT_SENSOR, slow, False, velocity_mm_s)
    yield _budget_line("all of it", sensor, rig, False, velocity_mm_s)


def _budget_line(what: str, sensor: ForceSensor, rig: CaptureRig, synced: bool, velocity_mm_s: float) -> Line:
    button, finger = load_button("mx-clear"), Finger()
    gesture = plan(finger, button.curve.travel_m, solve_button_pace(button, finger, velocity_mm_s, sensor))
    found = []
    for seed in range(20):
        random = np.random.default_rng(seed)
        noise = replace(
            no_button_noise(gesture), force_N=draw_button_noise(finger, gesture, random, sensor).force_N
        )
        trace = simulate_button(button, finger, gesture, noise, sensor)
        found.append(curve_error_cN(trace, capture(trace, rig, random), synced))
    got = f"{np.median(found):.2f} cN rms, median of 20 ({min(found):.2f} to {max(found):.2f})"
    perfect = what.startswith("nothing")
    met = float(np.median(found)) < 0.5 if perfect else True
    return Line(f"V10 {velocity_mm_s:g} mm/s: {what}", got, "< 0.5 cN" if perfect else "budget", met)
