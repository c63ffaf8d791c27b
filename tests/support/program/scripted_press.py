"""Press a program along a scripted path: the firmware's core, held against the interpreter in every tick."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from fdvv.firmware.core import Core, RecordArray
from fdvv.program.compile import compile_program
from fdvv.program.program import Program
from fdvv.program.surface import Limits
from fdvv.protocol.tables import NONE, Mode, Settings
from tests.support.inputs import inputs_at
from tests.support.program.interpreter import interpret

TICKS_PER_S = 4000
MOST_cN = 0.35
"""Grid error of 0.1 cN, and the velocity and displacement of a tick are rounded."""

Array = np.ndarray[tuple[int], np.dtype[np.float64]]


def path(*points: tuple[float, float]) -> Array:
    """Return displacements (mm) of every tick on straight lines through (time s, displacement mm) points."""
    times, places = zip(*points, strict=True)
    t = np.arange(round(times[-1] * TICKS_PER_S) + 1) / TICKS_PER_S
    x_mm: Array = np.interp(t, times, places)
    return x_mm


@dataclass(frozen=True)
class Pressed:
    """What a press gave, per tick."""

    x_mm: Array
    states: list[str]
    keys: list[int]
    signals: list[str | None]
    forces_cN: Array

    def entries(self) -> list[tuple[str, float]]:
        """Return every state in order of entering, with the sensed displacement at which it was entered."""
        found = [(self.states[0], float(self.x_mm[0]))]
        for state, x in zip(self.states, self.x_mm, strict=True):
            if state != found[-1][0]:
                found.append((state, float(x)))
        return found

    def times_s(self, signal: str) -> list[float]:
        """Return the times at which a signal was played."""
        return [i / TICKS_PER_S for i, played in enumerate(self.signals) if played == signal]


def press(program: Program, x_mm: Array, events: Mapping[int, int] | None = None) -> Pressed:
    """Run the core over a trajectory; assert that it does in every tick what the program's words say.

    events : tick to host event. Signals tied to displacements are the core's own tests' and left out there.
    """
    settings, host_events = Settings(), events or {}
    core = Core(settings, compile_program(program, Limits(weight_cN=0.0)).image)
    core.arm()
    # a reading that never changes is a dead sensor to the rig
    alive_mm = 0.0003 * (np.arange(len(x_mm)) % 2)
    inputs = inputs_at(settings, x_mm + alive_mm)
    outputs = np.concatenate([_run(core, inputs[i : i + 1], host_events.get(i)) for i in range(len(x_mm))])
    assert set(outputs["mode"]) == {Mode.ARMED}
    sensed = outputs["displacement_um16"].astype(np.int64)
    speeds = np.abs(outputs["velocity_mm_s16"].astype(float)) / 16
    ticks = interpret(program, sensed, speeds, host_events, settings)
    states = [program.states[i].name for i in outputs["state"]]
    assert states == [tick.state for tick in ticks]
    assert outputs["key"].tolist() == [tick.key for tick in ticks]
    signals = [None if s == NONE else program.signals[s].name for s in outputs["slot"]]
    if not program.vibrations:
        assert signals == [tick.signal for tick in ticks]
    forces = outputs["commanded_cN64"] / 64
    assert np.max(np.abs(forces - [tick.force_cN for tick in ticks])) < MOST_cN
    return Pressed(sensed / 16000, states, outputs["key"].tolist(), signals, forces)


def _run(core: Core, inputs: RecordArray, event: int | None) -> RecordArray:
    if event is not None:
        core.event(event)
    return core.run(inputs)
