"""What does each error of a capture bench do to the captured curve? Lines of button_validation. Simulated."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from typing import Any

import numpy as np

from benchmarks.button_lines import Line, rms
from fdvv.recording.types import Quantity, Stage
from fdvv.testing.captured import PERFECT_RIG, PERFECT_SENSOR
from fdvv.twin.capture.bench import CaptureBench, SimulatedTake
from fdvv.twin.capture.participant import PARTICIPANTS
from fdvv.twin.capture.rig import CaptureRig
from fdvv.twin.files import load_button
from fdvv.twin.finger import Finger
from fdvv.twin.rig import ForceSensor


def curve_error_cN(made: SimulatedTake, synced: bool) -> float:
    """Align, join and compare one captured press with the true force at the true displacement; rms.

    synced: use the true relation of the clocks, else the frame in which the light was first seen.
    """
    take, truth, trace = made.take, made.truth, made.truth.trace
    assert trace is not None
    (force,), (light,), markers = (take.of(q) for q in (Quantity.FORCE, Quantity.LIGHT, Quantity.MARKER))
    lit_s = light.t_s[int(np.argmax(light.values > 0.5))]
    light_s = take.times_s("light on")
    offset_s = (truth.setup.camera_s(light_s)[0] if synced else lit_s) - light_s[0]
    places = np.stack([marker.values for marker in markers])
    seen = ~np.isnan(places).any(axis=(0, 2))
    cap_mm = (truth.setup.places_mm[:, None] - places)[:, seen].mean(axis=0) @ truth.setup.turn[:, 2]
    sampled_mm = np.interp(force.t_s, light.t_s[seen] - offset_s, cap_mm)
    end = int(np.argmax(sampled_mm))
    x_mm = np.linspace(0.3, 0.95 * float(trace.displacement_mm.max()), 200)
    captured = np.interp(x_mm, np.maximum.accumulate(sampled_mm[:end]), force.values[:end])
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
        "cameras: play of the cap": {"sideways_m": rig.sideways_m},
        "force: zero off by 2 cN rms": {"force_zero_N": rig.force_zero_N},
        "clocks: 50 ppm": {"clock_ppm": rig.clock_ppm},
    }  # fmt: skip
    for what, changes in sensors.items():
        yield _budget_line(what, replace(PERFECT_SENSOR, **changes), PERFECT_RIG, True, velocity_mm_s)
    for what, changes in rigs.items():
        yield _budget_line(what, PERFECT_SENSOR, replace(PERFECT_RIG, **changes), True, velocity_mm_s)
    slow = replace(PERFECT_RIG, frame_Hz=rig.frame_Hz)
    yield _budget_line("clocks: light seen at 256 frames/s", PERFECT_SENSOR, slow, False, velocity_mm_s)
    yield _budget_line("all of it", sensor, rig, False, velocity_mm_s)


def _budget_line(what: str, sensor: ForceSensor, rig: CaptureRig, synced: bool, velocity_mm_s: float) -> Line:
    button, finger = load_button("mx-clear"), Finger()
    finger = replace(finger, habit=finger.habit.still())
    found = []
    for seed in range(20):
        bench = CaptureBench(button, rig, finger, sensor, PARTICIPANTS["steady"], np.random.default_rng(seed))
        found.append(curve_error_cN(bench.take(1, Stage.PRESS, velocity_mm_s), synced))
    got = f"{np.median(found):.2f} cN rms, median of 20 ({min(found):.2f} to {max(found):.2f})"
    perfect = what.startswith("nothing")
    met = float(np.median(found)) < 0.5 if perfect else True
    return Line(f"V10 {velocity_mm_s:g} mm/s: {what}", got, "< 0.5 cN" if perfect else "budget", met)
