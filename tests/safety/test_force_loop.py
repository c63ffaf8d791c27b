"""A load cell that fails in a press: the loop opens, the command stays within its limit. Simulated."""

from __future__ import annotations

import numpy as np
import pytest

from fdvv.firmware.core import Core
from fdvv.protocol.tables import LoopFault, Mode
from tests.support.force_loop_press import SETTINGS, clear_image, loop_constants, press

FAULTS = {
    "unplugged": LoopFault.CELL_DEAD,
    "torn off": LoopFault.CELL_SATURATED,
    "short circuit": LoopFault.CELL_SATURATED,
    "reversed": LoopFault.CELL_WRONG,
    "stepped by 0.6 N": LoopFault.CELL_WRONG,
}


@pytest.mark.parametrize("cell", FAULTS)
def test_a_cell_that_fails_opens_the_loop_and_the_press_ends_on_tables(cell: str) -> None:
    pressed = press(cell)
    assert pressed.core.loop_fault is FAULTS[cell]
    assert pressed.core.mode is Mode.ARMED
    assert np.abs(pressed.outputs["commanded_cN64"]).max() <= SETTINGS.force_limit_cN64
    assert pressed.outputs["displacement_um16"][-1] < 0.3 * 16000


def test_a_sound_cell_keeps_the_loop_closed() -> None:
    pressed = press()
    assert pressed.core.loop_fault is LoopFault.SOUND
    assert pressed.outputs["displacement_um16"].max() > 3.8 * 16000
    assert np.abs(pressed.outputs["commanded_cN64"]).max() < SETTINGS.force_limit_cN64


def test_other_settings_open_the_loop() -> None:
    core = press("torn off").core
    core.set(SETTINGS)
    assert core.loop_fault is LoopFault.SOUND


def test_what_is_not_a_number_asks_for_no_force() -> None:
    core = Core(SETTINGS, clear_image())
    core.close_loop(np.full_like(loop_constants(), np.nan))
    core.arm()
    out = core.run(press(ticks=100).inputs)
    assert out["enable"].all()
    assert not out["commanded_cN64"].any()
    assert not out["duty_q15"].any()
