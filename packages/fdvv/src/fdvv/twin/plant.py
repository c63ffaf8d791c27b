"""A rig under a finger that any board may drive, tick by tick."""

from __future__ import annotations

import ctypes
from collections import deque
from dataclasses import replace
from enum import IntEnum

import numpy as np
import numpy.typing as npt

from fdvv._native import address, words
from fdvv.errors import ModelError
from fdvv.firmware.core import INPUTS, OUTPUTS, RecordArray
from fdvv.protocol.tables import NONE
from fdvv.twin.finger import Finger
from fdvv.twin.gesture import Gesture, plan
from fdvv.twin.noise import Effort, Noise, draw_ticks, silent_ticks
from fdvv.twin.rig import Rig
from fdvv.twin.rig_kernel import (
    RIG_COLUMNS,
    TICK_COLUMNS,
    Rows,
    gesture_times,
    grid_of,
    plant_of,
    rig_bytes,
    rig_library,
)
from fdvv.twin.settings import settings_of
from fdvv.twin.trace import Trace
from fdvv.units import FloatArray, mm_from_m

NEAR_1_s = 125.0
"""How fast a led finger nears what it is led to: 2 / NEAR_1_s = 16 ms behind a hand that moves evenly."""
LIFTED_m = 2e-3
"""A finger that presses nothing waits so high above the cap."""
KEPT_s = 60.0  # assumed; bounds the memory of a plant that runs for hours, and is longer than any press


class CursorInput(IntEnum):
    """What a finger may be led by (rig.h)."""

    PLACE = 1
    PUSH = 2


class RunningRig:
    """What a rig that runs tick by tick has, whoever controls it: the kernel's memory, a finger, noise."""

    block_ticks: int
    """Noise is drawn for so many ticks at once."""
    effort: Effort | None = None
    """The muscle that goes on from block to block; None: a new one begins with each."""

    def __init__(self, rig: Rig | None, finger: Finger | None, seed: int | None) -> None:
        self.rig, self.finger = rig or Rig(), finger or Finger()
        self._grid = grid_of(self.rig)
        self._random = None if seed is None else np.random.default_rng(seed)
        self._memory = np.zeros(rig_bytes() // 8 + 1, np.uint64)
        self._inputs = np.zeros(1, INPUTS)
        self._ticks = 0

    @property
    def time_s(self) -> float:
        """Time since the start."""
        return self._ticks * self.rig.controller.tick_s

    def press(self, gesture: Gesture) -> None:
        """Let the finger follow a gesture whose time begins now; the referent jumps to its start.

        After it the finger rests where it began.
        """
        numbers = (gesture.stiffness_N_m, gesture.damping_N_s_m, 0.0)
        parts = (ctypes.c_double(n) for n in numbers)
        rig_library().fdvv_rig_press(address(self._memory), ctypes.byref(gesture_times(gesture)), *parts)

    def _rest(self, finger: Finger) -> None:
        """Let the finger stay where a gesture would begin."""
        start = plan(finger, self.rig.stops.travel_limit_m, 1.0)
        self.press(replace(start, end_m=start.start_m))

    def _lead(self, led: CursorInput, goal: float, goal_1_s: float = 0.0, near_1_s: float = NEAR_1_s) -> None:
        if not (np.isfinite([goal, goal_1_s, near_1_s]).all() and near_1_s > 0):
            raise ModelError(f"a finger is led by finite numbers, got {goal}, {goal_1_s}, rate {near_1_s}")
        numbers = (ctypes.c_double(n) for n in (goal, goal_1_s, near_1_s))
        rig_library().fdvv_rig_lead(address(self._memory), ctypes.c_int(led), *numbers)

    def _draw(self) -> Noise:
        if self._random is None:
            return silent_ticks(self.rig, self.block_ticks)
        return draw_ticks(self.rig, self.finger, self.block_ticks, self._random, self.effort)


class RigPlant(RunningRig):
    """Hardware without a controller: duty in, readings out, one tick at a time. Simulated.

    Parameters
    ----------
    rig, finger : the default ones if None.
    seed : of all noise; None: no noise at all.
    stop_us : servo pulse of the calibrated bottom stop at the start; None: the deepest stop.

    The finger rests (or hovers, as its habit says) until press() is called. A tick takes what step() is
    given compute_s (rig.controller) after it began and gives the readings of the tick that follows; inputs
    holds those of the coming tick at any time. Time runs as fast as step() is called.
    """

    block_ticks = 256

    def __init__(
        self,
        rig: Rig | None = None,
        finger: Finger | None = None,
        seed: int | None = 0,
        stop_us: float | None = None,
    ) -> None:
        super().__init__(rig, finger, seed)
        self._sensed = np.zeros(TICK_COLUMNS)
        self._kept: deque[tuple[FloatArray, FloatArray, tuple[int, ...]]] = deque(
            maxlen=round(KEPT_s / self.rig.controller.tick_s)
        )
        servo, deepest_mm = self.rig.servo, float(mm_from_m(self.rig.stops.travel_limit_m))
        deepest_us = servo.pulse_zero_us + servo.pulse_us_mm * deepest_mm
        self._start(deepest_us if stop_us is None else stop_us)

    @property
    def inputs(self) -> np.void:
        """What the board reads at the tick that now begins: one record of fdvv.firmware.core.INPUTS."""
        record: np.void = self._inputs[0].copy()
        return record

    def step(self, duty_q15: int, enable: bool, stop_us: int, slot: int = NONE) -> np.void:
        """Let one tick pass under these outputs of a board; give the readings at its end.

        duty_q15 : -32768 to 32767, of the supply. enable : of the bridge. stop_us : servo pulse, 0 for none.
        slot : waveform to start, loaded before, or NONE.
        """
        rows = np.empty((self._grid.rows_per_tick, RIG_COLUMNS))
        i = self._ticks % self.block_ticks
        if i == 0:
            self._noise = self._draw()
        noise = self._noise
        few = np.array([noise.force_N[i], noise.keycap[i], noise.effort_ratio[i], noise.latency[i]])
        seen = int(self._inputs["sum"][0])
        given = (int(duty_q15), int(enable), int(stop_us), int(slot))
        rig_library().fdvv_rig_step(
            address(self._memory),
            *given,
            address(noise.position_m[i]),
            address(few),
            address(rows),
            address(self._sensed),
            address(self._inputs),
        )
        self._ticks += 1
        self._kept.append((rows, self._sensed.copy(), (seen, *given)))
        return self.inputs

    def push(self, force_N: float) -> None:
        """Let the finger push with a steady force from now on, as a weight that lies on the cap does."""
        self._lead(CursorInput.PUSH, force_N)

    def lift(self, height_m: float = LIFTED_m) -> None:
        """Let the finger wait above the cap from now on."""
        self._lead(CursorInput.PLACE, -height_m)

    def load(self, image: bytes) -> None:
        """Load the waveforms of a program into the vibration board; ModelError if it cannot hold them."""
        held = words(image)
        if not rig_library().fdvv_rig_load(address(self._memory), address(held)):
            raise ModelError("the vibration board has no room for the waveforms of this program")

    def record(self) -> Trace:
        """Return what happened since the last call (60 s at most), from time 0, and forget it.

        What the board decided is not known here: sensed_mm is what the readings amount to, commanded_cN what
        the duty amounts to; release, state, key, mode and flags are 0. ModelError if no tick has passed.
        """
        if not self._kept:
            raise ModelError("no tick has passed since the last record")
        physics, sensed, given = zip(*self._kept, strict=True)
        self._kept.clear()
        rows = Rows(np.concatenate(physics), np.array(sensed), self._outputs(np.array(given)))
        row = np.arange(len(rows.physics))
        rows.physics[:, 0] = row * self.rig.controller.tick_s / self._grid.rows_per_tick
        return Trace.of_rows(rows)

    def _start(self, stop_us: float) -> None:
        model, counts = plant_of(self.rig, self.finger), self._grid.counts()
        lib, held = rig_library(), address(self._memory)
        lib.fdvv_rig_start(held, ctypes.byref(model), ctypes.byref(counts), ctypes.c_double(stop_us))
        self._rest(self.finger)
        lib.fdvv_rig_look(held, address(self._inputs))

    def _outputs(self, given: npt.NDArray[np.int64]) -> RecordArray:
        """Put sums of readings and a board's outputs, (n, 5), into records of OUTPUTS."""
        settings, out = settings_of(self.rig), np.zeros(len(given), OUTPUTS)
        sums, out["duty_q15"], out["enable"], out["stop_us"], out["slot"] = given.T
        place = sums * settings.position_gain_q14 + 8192 >> 14  # rounded as the firmware does
        out["displacement_um16"] = place + settings.position_offset_um16
        force = np.round(given[:, 1] * (65536 / settings.duty_gain_q16))
        out["commanded_cN64"] = np.clip(force, -32767, 32767)
        return out
