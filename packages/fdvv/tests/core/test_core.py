"""The core as Python sees it: modes, zero force, command chain, images and settings that cannot be used."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from fdvv.errors import ModelError
from fdvv.firmware.core import Core
from fdvv.protocol.tables import Fault, Mode, Settings, TickFlag
from tests.support.core.programs import REST, Table, armed, image
from tests.support.inputs import inputs_at

RAMP: Table = (0, 16000, [1600], [[0, 1600, 3200, 4800, 6400]])
PROGRAM = image(tables=[RAMP])


def constant(force_cN64: int) -> bytes:
    return image(tables=[(0, 16000, [1600], [[force_cN64, force_cN64]])])


def test_an_armed_core_renders_the_force_of_its_surface() -> None:
    settled = armed(PROGRAM).run(inputs_at(Settings(), np.full(10, 2.0)))[-1]
    assert settled["commanded_cN64"] == pytest.approx(3200, abs=1)
    assert settled["enable"] == 1


def test_a_core_that_was_not_armed_gives_no_force_but_a_record() -> None:
    outputs = Core(Settings(), PROGRAM).run(inputs_at(Settings(), np.full(10, 2.0)))
    assert not outputs["duty_q15"].any()
    assert not outputs["enable"].any()
    assert outputs["displacement_um16"] == pytest.approx(32000, abs=1)


def test_an_armed_core_without_a_program_gives_no_force() -> None:
    core = Core()
    core.arm()
    outputs = core.run(inputs_at(Settings(), np.full(10, 2.0)))
    assert not outputs["duty_q15"].any()
    assert not outputs["enable"].any()


def test_tick_and_run_agree() -> None:
    inputs = inputs_at(Settings(), np.linspace(0, 3, 50))
    one, many = armed(PROGRAM), armed(PROGRAM)
    assert [one.tick(record).tobytes() for record in inputs] == [r.tobytes() for r in many.run(inputs)]


def test_what_the_firmware_would_refuse_is_refused_with_the_reason() -> None:
    with pytest.raises(ModelError, match="the firmware refuses the image: image_layout"):
        Core(Settings(), PROGRAM + bytes(4))
    with pytest.raises(ModelError, match="the firmware refuses the image: checksum"):
        Core(Settings(), PROGRAM[:-4] + bytes(4))
    with pytest.raises(ModelError, match="the firmware refuses the image: image_range"):
        Core(replace(Settings(), force_limit_cN64=6399), PROGRAM)
    with pytest.raises(ModelError, match="an image has at most 7168 bytes, got 7172"):
        Core(Settings(), bytes(7172))
    with pytest.raises(ModelError, match="the firmware refuses the settings: window_end_um16"):
        Core(replace(Settings(), window_end_um16=1600))


def test_a_program_that_is_refused_leaves_the_last_one_active() -> None:
    core = armed(PROGRAM)
    with pytest.raises(ModelError):
        core.activate(PROGRAM[:-4] + bytes(4))
    assert core.run(inputs_at(Settings(), np.full(9, 2.0)))["commanded_cN64"][-1] > 3000


@pytest.mark.parametrize("slew", [16, 1000, 32000])
def test_a_fault_ends_the_force_at_once_whatever_the_slew(slew: int) -> None:
    core = armed(PROGRAM, replace(Settings(), slew_cN64_tick=slew))
    inputs = inputs_at(Settings(), np.full(300, 3.0))
    assert core.run(inputs)["duty_q15"][-1] > 300
    core.fail(Fault.OUTPUT)
    after = core.tick(inputs[-1])
    assert (core.mode, core.fault) == (Mode.FAULT, Fault.OUTPUT)
    assert (after["duty_q15"], after["enable"], after["commanded_cN64"]) == (0, 0, 0)


def test_disarming_ends_the_force_at_once_and_the_record_goes_on() -> None:
    core = armed(PROGRAM)
    inputs = inputs_at(Settings(), np.full(20, 3.0))
    core.run(inputs)
    core.disarm()
    after = core.tick(inputs[-1])
    assert (after["duty_q15"], after["enable"], after["key"]) == (0, 0, 0)
    assert after["displacement_um16"] == pytest.approx(48000, abs=1)


def test_after_arming_the_force_rises_by_the_slew() -> None:
    core = armed(constant(6400), replace(Settings(), slew_cN64_tick=1000))
    outputs = core.run(inputs_at(Settings(), np.full(9, 1.0)))
    assert outputs["commanded_cN64"].tolist() == [1000, 2000, 3000, 4000, 5000, 6000, 6400, 6400, 6400]
    assert ((outputs["flags"] & TickFlag.SLEWED) > 0).tolist() == [True] * 6 + [False] * 3


@pytest.mark.parametrize("sign", [1, -1])
def test_a_limit_below_what_the_program_wants_cuts_it_and_says_so(sign: int) -> None:
    core = Core(Settings(), constant(sign * 6400))
    core.set(replace(Settings(), force_limit_cN64=3000))
    core.arm()
    last = core.run(inputs_at(Settings(), np.full(9, 1.0)))[-1]
    assert last["commanded_cN64"] == sign * 3000
    assert last["flags"] & TickFlag.LIMITED
    assert not last["flags"] & TickFlag.SLEWED


def test_a_hot_coil_has_a_falling_limit_that_no_slew_holds_up() -> None:
    hot = replace(
        Settings(),
        slew_cN64_tick=16,
        duty_gain_q16=65535,
        force_limit_cN64=20000,
        full_duty_rise_K=20000,
        heat_time_ms=100,
        derate_start_K=1,
        heat_limit_K=600,
    )
    core = Core(hot, constant(20000))
    core.arm()
    outputs = core.run(inputs_at(hot, np.full(3000, 1.0)))
    derated = outputs[outputs["mode"] == Mode.DERATED]
    assert derated.size > 100
    assert (derated["flags"] & TickFlag.DERATED).any()
    assert (np.diff(derated["commanded_cN64"].astype(int)) < -16).any()


def test_the_duty_limit_cuts_the_duty_and_says_so() -> None:
    settings = replace(Settings(), duty_gain_q16=65535, duty_limit_q15=1024)
    last = armed(constant(6400), settings).run(inputs_at(settings, np.full(9, 1.0)))[-1]
    assert (last["duty_q15"], last["commanded_cN64"]) == (1024, 6400)
    assert last["flags"] & TickFlag.LIMITED


@pytest.mark.parametrize("supply_mV", [9000, 9001, 11111, 12000, 13999, 14000])
@pytest.mark.parametrize("force_cN64", [-28000, -999, 1, 5000, 28000])
def test_the_duty_makes_up_for_the_supply(supply_mV: int, force_cN64: int) -> None:
    inputs = inputs_at(Settings(), np.full(9, 1.0))
    inputs["supply_mV"] = supply_mV
    last = armed(constant(force_cN64)).run(inputs)[-1]
    exact = force_cN64 * 20793 / 65536 * 12000 / supply_mV
    assert last["duty_q15"] == pytest.approx(exact, rel=1.5e-4, abs=0.51)


@pytest.mark.parametrize("counts", [0, 1, 500, 40000, 65535])
@pytest.mark.parametrize("gain", [-262144, -16385, 16384, 100, 262144])
def test_the_keycap_force_is_exact(counts: int, gain: int) -> None:
    settings = replace(Settings(), force_gain_q14=gain, force_offset_counts=500)
    inputs = inputs_at(settings, np.zeros(1))
    inputs["force_counts"] = counts
    exact = min(max((counts - 500) * gain // 2**14, -32767), 32767)
    assert Core(settings).run(inputs)["force_cN64"][0] == exact


@pytest.mark.parametrize(
    ("zero", "rate", "pulse"), [(1000, 150, 1600), (2000, -300, 800), (400, -1, 400), (2600, 9, 2600)]
)
def test_the_servo_is_set_to_the_travel_of_the_program(zero: int, rate: int, pulse: int) -> None:
    settings = replace(Settings(), stop_zero_us=zero, stop_us_mm=rate)
    inputs = inputs_at(settings, np.zeros(1))
    assert Core(settings, PROGRAM).run(inputs)["stop_us"][0] == pulse
    assert Core(settings).run(inputs)["stop_us"][0] == zero


def test_a_new_program_begins_in_its_start_state_from_the_force_of_the_last() -> None:
    inputs = inputs_at(Settings(), np.full(40, 1.0))
    core = armed(constant(6400))
    core.run(inputs)
    faded = image(states=[(replace(REST, fade_ms=10), ())], tables=[(0, 16000, [1600], [[0, 0]])])
    core.activate(faded)
    forces = core.run(inputs)["commanded_cN64"]
    assert forces == pytest.approx(6400 * (1 - np.arange(40) / 40), abs=1)


def test_the_key_and_its_flag_are_those_of_the_state() -> None:
    down = armed(image(states=[(replace(REST, key=3), ())])).run(inputs_at(Settings(), [0.5]))[0]
    up = armed(image()).run(inputs_at(Settings(), [0.5]))[0]
    assert (down["key"], bool(down["flags"] & TickFlag.KEY_DOWN)) == (3, True)
    assert (up["key"], bool(up["flags"] & TickFlag.KEY_DOWN)) == (0, False)


def test_missed_ticks_are_flagged() -> None:
    inputs = inputs_at(Settings(), np.zeros(3))
    inputs["elapsed_ticks"] = [1, 2, 1]
    assert ((Core().run(inputs)["flags"] & TickFlag.LATE) > 0).tolist() == [False, True, False]
