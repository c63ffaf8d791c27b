"""Presses on the recommended rig, by the compiled twin and by the reference with its noise. Simulated."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from fdvv.firmware.core import INPUTS, Core, RecordArray
from fdvv.twin.finger import Finger, PressVariability, bare
from fdvv.twin.gesture import Gesture, plan
from fdvv.twin.noise import Noise, draw_ticks
from fdvv.twin.pace import solve_program_pace
from fdvv.twin.plant import RigPlant
from fdvv.units import FloatArray, cN_from_N, mm_from_m
from tests.support.force_loop_press import RIG, SETTINGS, clear_image, loop_constants
from tests.support.reference.cell_rig import CAP, CellRig
from tests.support.reference.hybrid import Method

STOP_m, STOP_us = 4e-3, 1600
DWELL_s, TAIL_s = 0.02, 0.02
IMPACT_s = (-0.002, 0.02)
"""What counts as the impact, around the first contact with the bottom stop."""


@dataclass(frozen=True)
class CellPress:
    """A press by ticks: force at the finger, displacement, what the board read, drive, (n,) each."""

    force_cN: FloatArray
    displacement_mm: FloatArray
    inputs: RecordArray
    drive: list[tuple[int, bool]]


@dataclass(frozen=True)
class Departure:
    """How far one press is from another: force at the finger, rms and largest, cN; displacement, rms, um.

    between : with the cap off both stops. impact : around the first contact with the bottom.
    counts : share of the ticks in which the cell's reading differs; most_counts : by how much at most.
    """

    between_cN: float
    between_most_cN: float
    impact_cN: float
    impact_most_cN: float
    displacement_um: float
    counts_ratio: float
    most_counts: int


def gesture_at(velocity_mm_s: float, lift_m: float = 0.0) -> Gesture:
    """Plan a press of this mean speed, short at the bottom."""
    person = bare(Finger(habit=replace(PressVariability(), lift_m=lift_m)))
    pace_s = solve_program_pace(RIG, person, clear_image(), velocity_mm_s, settings=SETTINGS)
    return replace(plan(person, STOP_m, pace_s), dwell_s=DWELL_s, tail_s=TAIL_s)


def noise_of(ticks: int, seed: int) -> Noise:
    """Draw the noise that RigPlant(seed=seed) draws."""
    random, block = np.random.default_rng(seed), RigPlant.block_ticks
    drawn = [draw_ticks(RIG, Finger(), block, random) for _ in range(-(-ticks // block))]
    return Noise(*(np.concatenate([vars(one)[name] for one in drawn]) for name in vars(drawn[0])))


def closed_core(velocity_mm_s: float) -> Core:
    """Return an armed core whose force loop is closed on MX Clear."""
    core = Core(SETTINGS, clear_image())
    core.close_loop(loop_constants())
    core.announce(round(16 * velocity_mm_s))
    core.arm()
    return core


def compiled_press(gesture: Gesture, velocity_mm_s: float, seed: int, ticks: int | None = None) -> CellPress:
    """Press the compiled twin, its loop closed by the core; ticks: of the whole press if None."""
    # the finger waits where this gesture begins
    person = Finger(habit=replace(PressVariability(), lift_m=max(-gesture.start_m, 0.0)))
    plant, core = RigPlant(RIG, person, seed, STOP_us), closed_core(velocity_mm_s)
    plant.press(gesture)
    inputs, drive = [], []
    for _ in range(ticks or ticks_of(gesture)):
        inputs.append(plant.inputs)
        out = core.tick(inputs[-1])
        drive.append((int(out["duty_q15"]), bool(out["enable"])))
        plant.step(*drive[-1], STOP_us)
    trace = plant.record()
    return CellPress(trace.force_cN, trace.displacement_mm, np.array(inputs, INPUTS), drive)


def reference_press(
    gesture: Gesture,
    velocity_mm_s: float,
    seed: int,
    drive: list[tuple[int, bool]] | None = None,
    method: Method = "DOP853",
) -> CellPress:
    """Press the reference; drive: duty and enable of each tick to replay, None: the core closes the loop."""
    n, core = len(drive or []) or ticks_of(gesture), closed_core(velocity_mm_s)
    plant = CellRig(RIG, Finger(), gesture, STOP_m, noise_of(n, seed), method)
    reading, inputs, given, seen = plant.first_readings(), [], [], np.zeros((n, 2))
    for k in range(n):
        inputs.append(reading)
        seen[k] = plant.finger_N(), plant.y[CAP]
        if drive is None:
            out = core.tick(reading)
            given.append((int(out["duty_q15"]), bool(out["enable"])))
        else:
            given.append(drive[k])
        reading = plant.step(*given[-1])
    return CellPress(cN_from_N(seen[:, 0]), mm_from_m(seen[:, 1]), np.array(inputs, INPUTS), given)


def ticks_of(gesture: Gesture) -> int:
    """Count the ticks of a press."""
    return round(gesture.duration_s / RIG.controller.tick_s)


def departure(one: CellPress, other: CellPress) -> Departure:
    """Compare two presses."""
    stop_mm, tick_s = float(mm_from_m(STOP_m)), RIG.controller.tick_s
    off = one.force_cN - other.force_cN
    deepest = np.maximum(one.displacement_mm, other.displacement_mm)
    highest = np.minimum(one.displacement_mm, other.displacement_mm)
    between = off[(highest > 0) & (deepest < stop_mm)]
    bottom = int(np.argmax(deepest >= stop_mm))
    assert bottom, "the press does not reach the bottom"
    before, after = (bottom + round(s / tick_s) for s in IMPACT_s)
    impact = off[before:after]
    counts = np.abs(np.subtract(*(p.inputs["force_counts"].astype(int) for p in (one, other))))
    return Departure(
        rms(between),
        float(np.abs(between).max()),
        rms(impact),
        float(np.abs(impact).max()),
        1e3 * rms(one.displacement_mm - other.displacement_mm),
        float(np.mean(counts > 0)),
        int(counts.max()),
    )


def rms(values: FloatArray) -> float:
    return float(np.sqrt(np.mean(values**2)))
