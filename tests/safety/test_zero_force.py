"""How soon the whole core lets go: in the very tick that sees the condition, for any tick of 0.05 to 4 ms."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

from fdvv.firmware.core import Core, RecordArray
from fdvv.protocol.tables import Fault, Mode, Settings, Surface
from tests.safety._images import Parts
from tests.support.core.programs import REST
from tests.support.inputs import inputs_at

TICKS_US = (50, 250, 500, 1000, 4000)
ARMED_TICKS = 40
Disturb = Callable[[RecordArray], None]


def constant_force(force_cN64: int) -> bytes:
    """A program of one state that always pushes so hard."""
    surface = Surface(start_um16=0, step_um16=16000, columns=2, rows=1, velocities_at=84, forces_at=86)
    pool = bytes(20) + np.array([1600], "<u2").tobytes() + np.array([force_cN64, force_cN64], "<i2").tobytes()
    return Parts(states=[REST], surfaces=[surface], pool=pool).image()


def rendering(settings: Settings, force_cN64: int = 6400) -> tuple[Core, RecordArray]:
    """Return a core that renders, and the inputs of its next ticks with a little noise, as sensors have."""
    core = Core(settings, constant_force(force_cN64))
    inputs = inputs_at(settings, np.full(ARMED_TICKS + max(2000, 300_000 // settings.tick_us), 2.0))
    inputs["sum"] += np.arange(inputs.size, dtype=np.uint32) % 2
    core.arm()
    outputs = core.run(inputs[:ARMED_TICKS])
    assert outputs["duty_q15"][-1] > 0
    assert outputs["enable"][-1] == 1
    return core, inputs[ARMED_TICKS:].copy()


def setter(name: str, value: int) -> Disturb:
    """Return a function that sets a field of the first tick."""

    def disturb(inputs: RecordArray) -> None:
        inputs[name][0] = value

    return disturb


DISTURBANCES: dict[Fault, Disturb] = {
    Fault.POSITION_LOW: setter("lowest", 19),
    Fault.POSITION_HIGH: setter("highest", 4076),
    Fault.POSITION_JUMP: setter("sum", 60_000),
    Fault.OVER_FORCE: setter("force_counts", 65535),
    Fault.SUPPLY_LOW: setter("supply_mV", 8999),
    Fault.SUPPLY_HIGH: setter("supply_mV", 14001),
    Fault.WATCHDOG: setter("board", 1),
    Fault.BROWN_OUT: setter("board", 2),
    Fault.OUTPUT: setter("board", 4),
    Fault.LATE: setter("elapsed_ticks", 5),
}


@pytest.mark.parametrize("tick_us", TICKS_US)
@pytest.mark.parametrize("fault", DISTURBANCES, ids=lambda fault: str(fault.name))
def test_the_duty_is_zero_in_the_tick_that_sees_the_condition(fault: Fault, tick_us: int) -> None:
    core, inputs = rendering(replace(Settings(), tick_us=tick_us, force_gain_q14=16384))
    DISTURBANCES[fault](inputs)
    output = core.run(inputs[:1])[0]
    assert (core.mode, core.fault) == (Mode.FAULT, fault)
    assert (output["duty_q15"], output["enable"]) == (0, 0)


@pytest.mark.parametrize("tick_us", TICKS_US)
def test_a_silent_host_ends_the_force_within_a_tick_of_the_timeout(tick_us: int) -> None:
    settings = replace(Settings(), tick_us=tick_us)
    core, inputs = rendering(settings)
    last_heard_us = int(inputs["time_us"][0]) - tick_us
    outputs = core.run(inputs, host_heard=False)
    silent_us = int(inputs["time_us"][np.flatnonzero(outputs["enable"] == 0)[0]]) - last_heard_us
    assert 0 < silent_us - 1000 * settings.host_timeout_ms <= tick_us
    assert core.fault is Fault.HOST_LOST


@pytest.mark.parametrize("tick_us", TICKS_US)
def test_a_dead_sensor_ends_the_force_once_it_is_called_dead(tick_us: int) -> None:
    settings = replace(Settings(), tick_us=tick_us, stuck_ticks=50)
    core, inputs = rendering(settings)
    inputs["sum"] = inputs["sum"][0] + 7
    outputs = core.run(inputs)
    assert np.flatnonzero(outputs["enable"] == 0)[0] == settings.stuck_ticks
    assert core.fault is Fault.POSITION_STUCK


@pytest.mark.parametrize("tick_us", TICKS_US)
def test_too_warm_a_coil_ends_the_force_in_the_tick_after(tick_us: int) -> None:
    # many ticks missed at full force: otherwise derating keeps the coil below its limit
    heat_ms = max(100, min(1000, 4 * tick_us))
    settings = replace(
        Settings(), tick_us=tick_us, late_ticks=1000, heat_time_ms=heat_ms, full_duty_rise_K=20_000
    )
    core, inputs = rendering(settings, settings.force_limit_cN64)
    inputs["elapsed_ticks"][0] = 1000
    outputs = core.run(inputs[:2])
    assert outputs["enable"].tolist() == [1, 0]
    assert outputs["duty_q15"][1] == 0
    assert core.fault is Fault.OVER_HEAT
    assert core.evidence.value >= core.evidence.bound == settings.heat_limit_K


def test_any_flipped_bit_of_the_settings_ends_the_force_in_the_next_tick() -> None:
    for bit in range(8 * Settings.length_bytes()):
        core, inputs = rendering(Settings())
        memory = core._memory.view(np.uint8)
        assert memory.tobytes().count(Settings().pack()) == 1
        memory[memory.tobytes().index(Settings().pack()) + bit // 8] ^= 1 << bit % 8
        output = core.run(inputs[:1])[0]
        assert (output["duty_q15"], output["enable"]) == (0, 0), bit
        assert core.mode is Mode.FAULT


@pytest.mark.parametrize("fault", [Fault.IMAGE_CORRUPT, Fault.INTERNAL])
def test_a_fault_found_elsewhere_ends_the_force_in_the_next_tick(fault: Fault) -> None:
    core, inputs = rendering(Settings())
    core.fail(fault, 3, 4)
    output = core.run(inputs[:1])[0]
    assert (output["duty_q15"], output["enable"]) == (0, 0)
    assert (core.evidence.value, core.evidence.bound) == (3, 4)


def test_a_silent_vibration_board_leaves_the_force_and_says_so() -> None:
    core, inputs = rendering(Settings())
    inputs["board"] = 8
    assert core.run(inputs[:100])["enable"].all()
    assert (core.mode, core.fault) == (Mode.ARMED, Fault.VIBRATION_BOARD)
