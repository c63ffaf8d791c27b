"""A rig, the firmware's core and a finger that follows interactive input while they run."""

from __future__ import annotations

import ctypes
from collections.abc import Sequence
from copy import copy, deepcopy
from dataclasses import dataclass, fields, replace

import numpy as np
import numpy.typing as npt

from fdvv._native import address
from fdvv.errors import ModelError
from fdvv.firmware.core import OUTPUTS, Core
from fdvv.protocol.messages import CN64_PER_cN, MM_S16_PER_mm_s
from fdvv.protocol.tables import Fault, ForceLoopGains, LoopFault, Settings, TickFlag
from fdvv.twin.finger import Finger
from fdvv.twin.noise import Effort, Noise
from fdvv.twin.plant import CursorInput, LIFTED_m, NEAR_1_s, RunningRig
from fdvv.twin.rig import Rig
from fdvv.twin.rig_kernel import (
    RIG_COLUMNS,
    TICK_COLUMNS,
    Rows,
    STEP_s,
    noise_pointers,
    plant_of,
    rig_library,
)
from fdvv.twin.settings import limits_of, settings_of
from fdvv.twin.trace import CUT, controller_columns
from fdvv.units import FloatArray, N_from_cN, cN_from_N, m_from_mm, mm_from_m

SETTLE_s = 0.15
"""Passes before a led rig is handed out, so that filters and the cap have come to rest."""


@dataclass(frozen=True, eq=False)
class InteractiveTicks:
    """What happened at every tick of a stretch, simulated; every column (n,).

    Attributes
    ----------
    t_s : since the rig was handed out.
    displacement_mm, velocity_mm_s : of the cap, true.
    force_cN : between cap and finger, true.
    commanded_cN, sensed_mm, state, key, slot, mode, flags : the controller's; slot is the waveform started in
        that tick or NONE, flags are bits of fdvv.protocol.tables.TickFlag.
    saturated : the command was cut by limit, slew or heat.
    finger_mm : where the finger is; below 0 it is above the cap at rest.
    warm_K : of the coil.
    """

    t_s: FloatArray
    displacement_mm: FloatArray
    velocity_mm_s: FloatArray
    force_cN: FloatArray
    commanded_cN: FloatArray
    sensed_mm: FloatArray
    state: npt.NDArray[np.uint8]
    key: npt.NDArray[np.uint8]
    slot: npt.NDArray[np.uint8]
    mode: npt.NDArray[np.uint8]
    flags: npt.NDArray[np.uint8]
    saturated: npt.NDArray[np.bool_]
    finger_mm: FloatArray
    warm_K: FloatArray

    @classmethod
    def of_rows(cls, rows: Rows, first_tick: int, tick_s: float) -> InteractiveTicks:
        """Convert the kernel's rows, one a tick, to record units."""
        x, v, force, finger = (rows.physics[:, i].copy() for i in (1, 2, 4, 7))
        out = rows.outputs
        return cls(
            t_s=tick_s * np.arange(first_tick, first_tick + len(out), dtype=np.float64),
            displacement_mm=mm_from_m(x),
            velocity_mm_s=mm_from_m(v),
            force_cN=cN_from_N(force),
            saturated=(out["flags"] & CUT) > 0,
            finger_mm=mm_from_m(finger),
            warm_K=rows.sensed[:, 1].copy(),
            **controller_columns(out),
        )

    @classmethod
    def concatenate(cls, parts: Sequence[InteractiveTicks]) -> InteractiveTicks:
        """Join stretches that followed each other."""
        if len(parts) == 1:
            return parts[0]
        return cls(*(np.concatenate([getattr(part, f.name) for part in parts]) for f in fields(cls)))

    @property
    def release(self) -> npt.NDArray[np.bool_]:
        """Return where the controller took the stroke for a release."""
        return (self.flags & TickFlag.RELEASE) > 0


class InteractiveRig(RunningRig):
    """A rig, the firmware's own core and a finger that is led live, moved on together. Simulated.

    Parameters
    ----------
    image : checked program that the core renders.
    rig, finger : the default ones if None.
    settings : of the firmware; settings_of(rig) if None.
    seed : of all noise; None: no noise at all.
    loop : gains that the force loop is closed with, on a rig with a load cell; None leaves it open.

    Attributes
    ----------
    cell_cN : mean reading of the load cell over the ticks that were advanced last.

    It begins armed and at rest, the finger LIFTED_m above the cap. Time passes only in advance(); the host is
    heard in every tick. The same calls at the same times give the same columns, however time is cut.
    ModelError if rig, settings and image do not go together.
    """

    block_ticks = 512

    def __init__(
        self,
        image: bytes,
        rig: Rig | None = None,
        finger: Finger | None = None,
        settings: Settings | None = None,
        seed: int | None = 0,
        loop: ForceLoopGains | None = None,
    ) -> None:
        super().__init__(rig, finger, seed)
        if loop and not self.rig.has_cell:
            raise ModelError("this rig has no load cell to close a force loop with")
        self.core = Core(settings or settings_of(self.rig), image, limits_of(self.rig))
        self._loop = loop
        self.cell_cN = 0.0
        self._grid = replace(self._grid, steps_per_row=self._grid.steps_per_tick)
        self.effort = Effort(self.finger.habit, self.rig.controller.tick_s)
        self._noise, self._used = self._draw(), 0
        self._begin()

    def lead(self, referent_mm: float, velocity_mm_s: float = 0.0, near_1_s: float = NEAR_1_s) -> None:
        """Lead the finger's referent from now on to a place that moves at a speed: 0 is the cap at rest.

        The referent nears it critically damped and never jumps; the finger gives way under the button's
        force, as fingers do. ModelError on a number that is not finite or a rate not above 0.
        """
        self._lead(CursorInput.PLACE, m_from_mm(referent_mm), m_from_mm(velocity_mm_s), near_1_s)

    def push(self, force_cN: float, rise_cN_s: float = 0.0, near_1_s: float = NEAR_1_s) -> None:
        """Lead the force that the muscle pushes with, as lead() does with a place."""
        self._lead(CursorInput.PUSH, N_from_cN(force_cN), N_from_cN(rise_cN_s), near_1_s)

    def lift(self) -> None:
        """Take the finger off the cap."""
        self.lead(-float(mm_from_m(LIFTED_m)))

    def copy(self, noise: Noise | None = None) -> InteractiveRig:
        """Copy the whole state; the two are independent from then on.

        noise : of the copy's next ticks, after which nothing is random; None: random as this one goes on.
        ModelError if it is that of another rig.
        """
        other = copy(self)
        other.core = self.core.copy()
        other._memory, other._inputs = self._memory.copy(), self._inputs.copy()
        if noise is None:
            other._random, other.effort = deepcopy(self._random), deepcopy(self.effort)
            return other
        noise.check(self._grid.reads)
        other._noise, other._used, other._random = noise, 0, None
        return other

    def announce(self, velocity_mm_s: float) -> None:
        """Say how fast the next press is meant to be, until its own speed is known."""
        self.core.announce(min(65535, max(0, round(MM_S16_PER_mm_s * velocity_mm_s))))

    def arm(self) -> None:
        """Render again after a fault, which has opened the loop. DeviceError as Core.arm.

        A loop that its cell opened stays open.
        """
        self.core.arm()
        if self.loop_fault is LoopFault.SOUND:
            self.close_loop()

    @property
    def loop_fault(self) -> LoopFault:
        """Why the core has opened the loop by itself."""
        return self.core.loop_fault

    def close_loop(self) -> None:
        """Close the loop anew, if there are gains: the core has opened it by itself."""
        if self._loop:
            self.core.close_loop(self._loop.pack())

    def fail(self, fault: Fault) -> None:
        """Latch a fault, as one that a board finds outside its tick."""
        self.core.fail(fault)

    def advance(self, ticks: int) -> InteractiveTicks:
        """Advance by a number of ticks and return their record. ModelError if the motion diverged."""
        rows = Rows(np.empty((ticks, RIG_COLUMNS)), np.empty((ticks, TICK_COLUMNS)), np.zeros(ticks, OUTPUTS))
        done = 0
        while done < ticks:
            if self._used == self._noise.force_N.size:
                self._noise, self._used = self._draw(), 0
            count = min(ticks - done, self._noise.force_N.size - self._used)
            here = slice(done, done + count)
            self._run(count, Rows(rows.physics[here], rows.sensed[here], rows.outputs[here]))
            done += count
        if not np.isfinite(rows.physics).all():
            raise ModelError(f"the motion diverged: rig or finger are too stiff for steps of {STEP_s:g} s")
        self._ticks += ticks
        if ticks:
            self.cell_cN = float(rows.outputs["force_cN64"].mean()) / CN64_PER_cN
        return InteractiveTicks.of_rows(rows, self._ticks - ticks, self.rig.controller.tick_s)

    def _run(self, ticks: int, rows: Rows) -> None:
        end = self._used + ticks
        arrays = [array[self._used : end] for array in self._noise.arrays()]  # kept during the call
        noise = noise_pointers(arrays)
        rig_library().fdvv_twin_run(
            self.core.address,
            address(self._memory),
            ctypes.c_int64(ticks),
            ctypes.byref(noise),
            *(address(part) for part in rows),
            address(self._inputs),
        )
        self._used = end

    def _begin(self) -> None:
        """Arm the core and let everything come to rest under a lifted finger."""
        self.close_loop()
        self.core.arm()
        model, counts, held = plant_of(self.rig, self.finger), self._grid.counts(), address(self._memory)
        parts = (ctypes.byref(model), ctypes.byref(counts), self.core.image_address, address(self._inputs))
        if rig_library().fdvv_twin_begin(self.core.address, held, *parts):
            raise ModelError("the vibration board has no room for the waveforms of this program")
        habit = replace(self.finger.habit, lift_m=LIFTED_m)
        self._rest(replace(self.finger, habit=habit))
        self.advance(round(SETTLE_s / self.rig.controller.tick_s))
        self._ticks = 0
