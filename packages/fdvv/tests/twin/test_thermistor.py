"""The thermistor in the twin's bobbin, read by the firmware's own core."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from fdvv.firmware.core import Core
from fdvv.protocol.tables import Fault, Mode
from fdvv.twin.files import load_rig
from fdvv.twin.plant import RigPlant
from fdvv.twin.rig import Rig, Thermistor
from fdvv.twin.settings import limits_of, settings_of
from tests.safety.test_zero_force import constant_force

TICKS = 20_000


def rig_with(**changes: Any) -> Rig:
    rig = load_rig("recommended")
    return replace(rig, thermistor=replace(rig.thermistor, **changes))


def pushed(rig: Rig, ticks: int, force_cN64: int = 19_200) -> tuple[Core, RigPlant]:
    """Return core and plant after so many ticks of a held force, or less if it faults."""
    core = Core(settings_of(rig), constant_force(force_cN64), limits_of(rig))
    core.arm()
    plant = RigPlant(rig, seed=1, stop_us=1600)
    for _ in range(ticks):
        out = core.tick(plant.inputs)
        plant.step(out["duty_q15"], out["enable"], out["stop_us"], out["slot"])
        if core.mode is Mode.FAULT:
            break
    return core, plant


def counts_at(bead: Thermistor, rise_K: float) -> float:
    ohm = bead.resistance_ohm * math.exp(bead.beta_K * (1 / (bead.room_C + rise_K + 273.15) - 1 / 298.15))
    return 4096 * ohm / (ohm + bead.pull_up_ohm)


def test_the_bead_follows_the_coil_by_its_lag_and_share() -> None:
    rig = rig_with(noise_counts=0.0)
    core, plant = pushed(rig, TICKS)
    assert core.mode is Mode.ARMED
    warm_K = plant.record().warm_K
    bead_K, step = 0.0, 1e-4 / rig.thermistor.lag_s
    for coil_K in warm_K:
        bead_K += step * (rig.thermistor.share_ratio * coil_K - bead_K)
    assert warm_K[-1] > 0.5
    assert int(plant.inputs["thermistor_counts"]) == pytest.approx(counts_at(rig.thermistor, bead_K), abs=1)


@pytest.mark.parametrize(
    ("condition", "fault", "counts"),
    [("open", Fault.THERMISTOR_OPEN, 4095), ("short", Fault.THERMISTOR_SHORT, 0)],
)
def test_a_broken_wire_is_a_fault_after_one_sample(condition: str, fault: Fault, counts: int) -> None:
    core, _ = pushed(rig_with(condition=condition), 200)
    assert (core.mode, core.fault, core.evidence.value) == (Mode.FAULT, fault, counts)
    assert core.evidence.tick == 101


def test_a_rig_without_one_is_the_same_to_the_bit_whatever_its_input_reads() -> None:
    rig = rig_with(fitted="no")
    core, plant = pushed(rig, 500)
    assert core.mode is Mode.ARMED
    assert limits_of(rig).thermistor_lag_ms == 0
    assert int(plant.inputs["thermistor_counts"]) == 0


def test_the_noise_of_the_converter_is_as_large_as_the_rig_says() -> None:
    plant = RigPlant(rig_with(noise_counts=5.0), seed=1)
    counts = [int(plant.step(0, False, 1600)["thermistor_counts"]) for _ in range(3000)]
    assert np.std(counts) == pytest.approx(5.0, rel=0.1)


def test_a_bead_that_came_off_is_found_while_the_coil_is_below_its_limit() -> None:
    """At forces that end between a little above the limit and far beyond it."""
    rig = load_rig("recommended")
    for force_cN in (440, 640):
        limits = replace(limits_of(rig), force_limit_cN64=32_000, duty_gain_q16=65_535)
        settings = replace(settings_of(rig), force_limit_cN64=32_000, tick_us=1000, duty_gain_q16=20_000)
        core = Core(settings, constant_force(min(32_000, 64 * force_cN)), limits)
        plant = RigPlant(rig, seed=None, stop_us=1600)
        inputs = plant.inputs.copy()
        core.arm()
        coil_K, hottest_K = 0.0, 0.0
        for tick in range(60_000):
            inputs["time_us"], inputs["sum"] = 1000 * tick, 51_200 + tick % 2
            duty = core.tick(inputs)["duty_q15"] / 32768
            coil_K += 1e-3 / rig.coil.heat_s * (limits.full_duty_rise_K * duty**2 - coil_K)
            hottest_K = max(hottest_K, coil_K)
            if core.mode is Mode.FAULT:
                break
        assert core.fault in (Fault.THERMISTOR_COLD, Fault.OVER_HEAT)
        assert hottest_K < limits.heat_limit_K
