"""Presses on the recommended rig with its force loop closed by the core in this process. Simulated."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
import numpy.typing as npt

from fdvv.compensation.force_loop.gains import force_loop_gains
from fdvv.compensation.force_loop.stability import LoopController
from fdvv.compensation.identification.rig_model import RigModel
from fdvv.device.twin import TwinDevice
from fdvv.firmware.core import INPUTS, OUTPUTS, Core, RecordArray
from fdvv.firmware.limits import limits_like
from fdvv.model.file import load_builtin
from fdvv.model.surface import ForceSurface
from fdvv.protocol.tables import BoardLimits, CellSpec, Settings
from fdvv.twin.files import load_rig
from fdvv.twin.finger import Finger
from fdvv.twin.gesture import plan
from fdvv.twin.image import image_of
from fdvv.twin.plant import RigPlant
from fdvv.twin.settings import limits_of, settings_of

RIG, CLEAR = load_rig("recommended"), load_builtin("mx-clear")
SETTINGS = settings_of(RIG)
ANNOUNCED_mm_s16 = 1600
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

CELLS: dict[str, Callable[[int], int]] = {
    "sound": lambda counts: counts,
    "unplugged": lambda _: 2048,
    "torn off": lambda _: 0,
    "short circuit": lambda _: 4095,
    "reversed": lambda counts: 4096 - counts,
    "stepped by 0.6 N": lambda counts: counts + 276,
}
"""What a cell reads instead of the true counts."""


@dataclass(frozen=True)
class LoopPress:
    """What a core read and did in each tick, and the core afterwards."""

    core: Core
    image: bytes
    inputs: RecordArray
    outputs: RecordArray


def clear_image() -> bytes:
    """Return the program of MX Clear."""
    surface = ForceSurface.of_model(CLEAR, [100.0])
    return bytes(image_of(surface, CLEAR.travel_mm, paced=True).image)


def loop_constants() -> npt.NDArray[np.float32]:
    """Return the constants of the loop on this rig."""
    cell = TwinDevice(RIG).load_cell
    assert isinstance(cell, CellSpec)
    return np.frombuffer(force_loop_gains(KNOWN, cell, 1e-4, CONTROLLER).pack(), np.float32)


def board_for(settings: Settings) -> BoardLimits:
    """Return a board for the rig, thermistor included, that takes these settings."""
    bead = limits_of(RIG)
    names = ("thermistor_lag_ms", "thermistor_share_q8")
    return replace(limits_like(settings), **{name: getattr(bead, name) for name in names})


def press(
    cell: str = "sound",
    *,
    settings: Settings = SETTINGS,
    image: bytes | None = None,
    press_s: float = 0.25,
    ticks: int = 7000,
    closed: bool = True,
) -> LoopPress:
    """Press, and release as fast, on a board whose cell is this one of CELLS from FAILS_AT on.

    image : of the program, MX Clear's if None. closed : the loop is.
    """
    program = clear_image() if image is None else image
    core = Core(settings, program, board_for(settings))
    core.close_loop(loop_constants() if closed else None)
    core.announce(ANNOUNCED_mm_s16)
    core.arm()
    plant = RigPlant(RIG, Finger(), seed=3, stop_us=1600)
    plant.press(plan(Finger(), 4e-3, press_s))
    inputs, outputs = np.zeros(ticks, INPUTS), np.zeros(ticks, OUTPUTS)
    for tick in range(ticks):
        inputs[tick] = plant.inputs
        if tick >= FAILS_AT:
            inputs[tick]["force_counts"] = np.clip(CELLS[cell](int(inputs[tick]["force_counts"])), 0, 4095)
        out = outputs[tick] = core.tick(inputs[tick])
        plant.step(out["duty_q15"], out["enable"], out["stop_us"], out["slot"])
    return LoopPress(core, program, inputs, outputs)
