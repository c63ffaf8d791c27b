"""The rig that any board may drive."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from fdvv.errors import ModelError
from fdvv.firmware.core import Core
from fdvv.model.surface import ForceSurface
from fdvv.twin.finger import Finger
from fdvv.twin.gesture import plan
from fdvv.twin.image import image_of
from fdvv.twin.noise import settle_ticks, silence
from fdvv.twin.plant import RigPlant
from fdvv.twin.rig import Rig
from fdvv.twin.settings import settings_of
from tests.support.table_press import simulate


def test_a_board_that_runs_the_core_beside_the_plant_gives_the_same_press_to_the_bit(
    tactile: ForceSurface,
) -> None:
    rig, finger = Rig(), Finger()
    gesture = plan(finger, 0.004, 0.08)
    alone = simulate(rig, finger, gesture, tactile, 4.0, silence(rig, gesture), 100.0)
    core = Core(settings_of(rig), image_of(tactile, 4.0).image)
    core.announce(1600)
    core.arm()
    plant = RigPlant(rig, finger, seed=None, stop_us=1600)
    wait = settle_ticks(rig)
    plant.press(replace(gesture, onset_s=gesture.onset_s + wait * rig.controller.tick_s))
    for _ in range(wait + int(alone.tick.sum())):
        out = core.tick(plant.inputs)
        plant.step(out["duty_q15"], out["enable"], out["stop_us"], out["slot"])
    beside = plant.record()
    first = wait * 10
    assert np.array_equal(beside.sensed_mm[first:], alone.sensed_mm)
    assert beside.displacement_mm[first:] == pytest.approx(alone.displacement_mm, abs=1e-12)
    assert beside.force_cN[first:] == pytest.approx(alone.force_cN, abs=1e-9)
    assert beside.commanded_cN[first:] == pytest.approx(alone.commanded_cN, abs=0.05)


def test_a_rig_left_alone_rests_with_its_cap_up_only_if_the_bridge_holds_its_weight() -> None:
    for duty, place_mm in ((1000, 0.0), (0, 4.0)):
        plant = RigPlant(seed=None, stop_us=1600)
        for _ in range(600):
            inputs = plant.step(duty, True, 1600)
        assert plant.record().displacement_mm[-1] == pytest.approx(place_mm, abs=0.03)
        assert inputs["lowest"] <= inputs["sum"] / 25 <= inputs["highest"]


def test_a_bridge_that_is_off_carries_no_current() -> None:
    plant = RigPlant(seed=None)
    for enable in (True, False):
        for _ in range(20):
            plant.step(8000, enable, 1600)
    assert abs(plant.record().current_A[-1]) < 1e-12


def test_the_supply_sags_under_the_current() -> None:
    plant = RigPlant(seed=None)
    for _ in range(50):
        inputs = plant.step(16384, True, 1600)
    amps = plant.record().current_A[-1]
    assert inputs["supply_mV"] == pytest.approx(12000 - 1000 * 0.1 * 0.5 * amps, abs=1)


def test_the_coil_warms_as_power_and_time_constant_say() -> None:
    plant = RigPlant(seed=None)
    for _ in range(3000):
        plant.step(8192, True, 1600)
    trace, coil = plant.record(), Rig().coil
    steady_K = coil.resistance_ohm * coil.heat_K_W * trace.current_A[-1] ** 2
    assert trace.warm_K[-1] == pytest.approx(steady_K * (1 - np.exp(-3.0 / coil.heat_s)), rel=0.03)


def test_the_servo_heeds_its_frame_its_dead_band_and_its_speed() -> None:
    plant = RigPlant(seed=None, stop_us=1600)
    for pulse in (1605, 1300):
        for _ in range(400):
            plant.step(1000, True, pulse)
    stop = plant.record().stop_mm
    ignored, moving, settled = stop[:4000], stop[4000:], stop[-1]
    assert np.all(ignored == pytest.approx(4.0, abs=1e-9))
    assert np.diff(moving[::10]).min() >= -45e-3 * 1.001  # mm per ms
    assert settled == pytest.approx(2.0 + 0.1, abs=0.01)  # the play lies above a stop that moved up


def test_a_sensor_in_the_cap_reads_the_force_of_the_finger() -> None:
    rig = replace(Rig(), keycap_sensor=replace(Rig().keycap_sensor, kind="force"))
    plant = RigPlant(rig, seed=None, stop_us=1600)
    plant.press(replace(plan(Finger(), 0.004, 0.1), dwell_s=1.0))
    for _ in range(500):
        inputs = plant.step(1500, True, 1600)
    settings, force_cN = settings_of(rig), plant.record().force_cN[-1]
    read_cN = (
        (int(inputs["force_counts"]) - settings.force_offset_counts) * settings.force_gain_q14 / 2**14 / 64
    )
    assert force_cN > 100
    assert read_cN == pytest.approx(force_cN, abs=0.6)


def test_noise_differs_between_seeds_and_repeats_with_one() -> None:
    def sums(seed: int) -> list[int]:
        plant = RigPlant(seed=seed)
        return [int(plant.step(1000, True, 1600)["sum"]) for _ in range(300)]

    assert sums(1) == sums(1)
    assert sums(1) != sums(2)


def test_a_record_before_the_first_tick_is_refused() -> None:
    with pytest.raises(ModelError, match="no tick has passed"):
        RigPlant().record()
