"""A load cell that fails in a press: the loop opens, the command stays within its limit. Simulated."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest

from fdvv.compensation.force_loop.constants import CellSpec
from fdvv.compensation.force_loop.gains import force_loop_gains
from fdvv.compensation.force_loop.stability import LoopController
from fdvv.compensation.identification.rig_model import RigModel
from fdvv.device.twin import TwinDevice
from fdvv.firmware.core import Core, LoopFault
from fdvv.model.file import load_builtin
from fdvv.model.surface import ForceSurface
from fdvv.protocol.tables import Mode
from fdvv.twin.files import load_rig
from fdvv.twin.finger import Finger
from fdvv.twin.gesture import plan
from fdvv.twin.image import image_of
from fdvv.twin.plant import RigPlant
from fdvv.twin.settings import settings_of
from fdvv.units import FloatArray

RIG, CLEAR = load_rig("recommended"), load_builtin("mx-clear")
SETTINGS = settings_of(RIG)
FAILS_AT = 1500
"""Tick: half way down."""

KNOWN = RigModel(
    delay_s=1.3e-4,
    electric_lag_s=5e-5,
    position_lag_s=5.5e-4,
    drag_N_s_m=0.3,
    friction_cN=3.0,
    weight_cN=11.8,
    mass_g=11.6,
    position_noise_mm=0.01,
)
CONTROLLER = LoopController(4.2, 1.4e-3, 4500.0, 0.45, 13.0, 300.0)


def reading(counts: Callable[[int], int]) -> tuple[Core, FloatArray, FloatArray]:
    """Press on a board whose cell reads counts(true reading) from FAILS_AT on; commands and mm per tick."""
    cell = TwinDevice(RIG).load_cell
    assert isinstance(cell, CellSpec)
    core = Core(SETTINGS, image_of(ForceSurface.of_model(CLEAR, [100.0]), CLEAR.travel_mm, paced=True).image)
    core.close_loop(force_loop_gains(KNOWN, cell, 1e-4, CONTROLLER).pack())
    core.announce(1600)
    core.arm()
    plant = RigPlant(RIG, Finger(), seed=3, stop_us=1600)
    plant.press(plan(Finger(), 4e-3, 0.25))
    commands, places = [], []
    for tick in range(7000):
        inputs = plant.inputs
        if tick >= FAILS_AT:
            inputs["force_counts"] = np.clip(counts(int(inputs["force_counts"])), 0, 4095)
        out = core.tick(inputs)
        plant.step(out["duty_q15"], out["enable"], out["stop_us"], out["slot"])
        commands.append(out["commanded_cN64"] / 64)
        places.append(out["displacement_um16"] / 16000)
    return core, np.array(commands), np.array(places)


FAILURES = {
    "unplugged": (lambda _: 2048, LoopFault.CELL_DEAD),
    "torn off": (lambda _: 0, LoopFault.CELL_SATURATED),
    "short circuit": (lambda _: 4095, LoopFault.CELL_SATURATED),
    "reversed": (lambda counts: 4096 - counts, LoopFault.CELL_WRONG),
    "stepped by 0.6 N": (lambda counts: counts + 276, LoopFault.CELL_WRONG),
}


@pytest.mark.parametrize("name", FAILURES)
def test_a_cell_that_fails_opens_the_loop_and_the_press_ends_on_tables(name: str) -> None:
    counts, fault = FAILURES[name]
    core, commands, places = reading(counts)
    assert core.loop_fault is fault
    assert core.mode is Mode.ARMED
    assert np.abs(commands).max() <= SETTINGS.force_limit_cN64 / 64
    assert places[-1] < 0.3


def test_a_sound_cell_keeps_the_loop_closed() -> None:
    core, commands, places = reading(lambda counts: counts)
    assert core.loop_fault is LoopFault.SOUND
    assert places.max() > 3.8
    assert np.abs(commands).max() < SETTINGS.force_limit_cN64 / 64


def test_other_settings_open_the_loop() -> None:
    core, _, _ = reading(lambda counts: 0)
    core.set(SETTINGS)
    assert core.loop_fault is LoopFault.SOUND
