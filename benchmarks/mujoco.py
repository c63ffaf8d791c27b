"""How many steps a second does the button kernel take, beside MuJoCo on the same one-axis contact? Simulated.

Run as ``python -m benchmarks.mujoco`` after ``pip install mujoco``, which the project itself does not need.

The scene, for both: 3 g fly at a wall of 20 kN/m without damping and come back. It has an exact answer
(depth v √(m/k), the same speed back), so both are scored on it, at the same steps of 5 µs and in one thread.
MuJoCo gets what makes it fast: one slide joint, a frictionless contact, no gravity, its loop over steps in C
(mj_step with nstep), and a contact made to be a spring (solref negative, impedance 0.9999). The kernel gets
no such favour: finger, pulp, sensor and plate are stepped along, and once more with the leaf of a button.
"""

from __future__ import annotations

import ctypes
import time
from dataclasses import replace
from typing import Any

import numpy as np

from fdvv.twin.button_kernel import CELL_COLUMNS, ButtonGrid, button_plant, prepare, run_button
from fdvv.twin.files import load_button
from fdvv.twin.finger import Finger
from fdvv.twin.gesture import plan
from fdvv.twin.rig import ForceSensor
from fdvv.units import FloatArray

MASS_kg, WALL_N_m, WAY_m, PUSH_N = 0.003, 2e4, 0.001, 0.3
STEP_s, STEPS, REPEATS = 5e-6, 400_000, 15
SCENE = """
<mujoco>
  <option timestep="{step}" gravity="0 0 0" integrator="Euler" jacobian="dense" iterations="4" tolerance="0">
    <flag energy="disable"/>
  </option>
  <worldbody>
    <geom name="wall" type="plane" size="1 1 .1" condim="1" solref="-{k} -1e-6" solimp=".9999 .9999 .001"/>
    <body pos="0 0 {height}">
      <joint type="slide" axis="0 0 1"/>
      <geom type="sphere" size=".01" mass="{mass}" condim="1" solref="-{k} -1e-6" solimp=".9999 .9999 .001"/>
    </body>
  </worldbody>
</mujoco>
"""


def flight() -> tuple[ctypes.Structure, FloatArray, FloatArray]:
    """Return a slider pushed over the first half and free over the second: plant, table, effort."""
    finger = Finger()
    gesture = replace(plan(finger, WAY_m, 0.1), start_m=-0.05, end_m=-0.05)
    ticks = round(STEPS * STEP_s / 1e-3)
    plant = button_plant(
        load_button("hp-pr1101u"), finger, gesture, ForceSensor(), clamped=True, step_s=STEP_s
    )
    scene = {
        "slider_mass_kg": MASS_kg, "bottom_stiffness_N_m": WALL_N_m, "bottom_loss_s_m": 0.0,
        "travel_m": WAY_m, "viscous_N_s_m": 0.0, "law_ratio": 0.0, "law_s_m": 0.0, "table_start_m": -1e-4,
        "table_step_m": 1e-5,
    }  # fmt: skip
    for name, value in scene.items():
        setattr(plant, name, value)
    table = np.zeros((130, CELL_COLUMNS))
    table[:60, 0] = -PUSH_N
    return plant, table, np.zeros(ticks + 1)


def kernel_error() -> tuple[float, float]:
    """Return the relative errors of the kernel's depth and of its speed back."""
    plant, table, effort = flight()
    grid = ButtonGrid(0, 40, 200, 1, len(table))
    rows, _ = run_button(plant, grid, table, effort[:41])
    return errors(rows[1] - WAY_m, rows[2])


def errors(depth_m: FloatArray, speed_m_s: FloatArray) -> tuple[float, float]:
    """Compare the first contact with the exact one."""
    inside = np.flatnonzero(depth_m > 0)
    first = int(inside[0])
    last = first + int(np.argmax(depth_m[first:] <= 0))
    arriving, leaving = speed_m_s[first - 1], -speed_m_s[last]
    exact_m = arriving * np.sqrt(MASS_kg / WALL_N_m)
    return float(depth_m[first:last].max() / exact_m - 1), float(leaving / arriving - 1)


def mujoco_scene() -> tuple[Any, Any, Any]:
    """Build MuJoCo's version, flying at the wall."""
    import mujoco  # type: ignore[import-untyped,import-not-found,unused-ignore]

    text = SCENE.format(step=STEP_s, k=WALL_N_m / MASS_kg, height=0.0105, mass=MASS_kg)
    model = mujoco.MjModel.from_xml_string(text)
    data = mujoco.MjData(model)
    data.qvel[0] = -np.sqrt(2 * PUSH_N * WAY_m / 2 / MASS_kg)
    return mujoco, model, data


def mujoco_error() -> tuple[float, float]:
    """Return the relative errors of MuJoCo's depth and of its speed back."""
    mujoco, model, data = mujoco_scene()
    depth, speed = [], []
    for _ in range(2000):
        mujoco.mj_step(model, data)
        depth.append(-0.0005 - data.qpos[0])
        speed.append(-data.qvel[0])
    return errors(np.array(depth), np.array(speed))


def mujoco_rate() -> float:
    """Count MuJoCo's steps per second with the contact held closed by a push, as a pressed button's is."""
    mujoco, model, data = mujoco_scene()
    data.qvel[0], data.qpos[0], data.qfrc_applied[0] = 0.0, -0.00051, -PUSH_N
    steps = 100_000
    mujoco.mj_step(model, data, nstep=1000)
    begun = time.thread_time()
    mujoco.mj_step(model, data, nstep=steps)
    taken_s = time.thread_time() - begun
    assert data.ncon == 1, "the contact opened"
    return steps / taken_s


def kernel_rates() -> dict[str, float]:
    """Count the kernel's steps per second: this scene, and a whole press of a leaf switch."""
    plant, table, effort = flight()
    scene = (plant, ButtonGrid(0, len(effort) - 1, 200, 20, len(table)), table, effort)
    button, finger = load_button("mx-clear"), Finger()
    real = button_plant(button, finger, plan(finger, button.curve.travel_m, 0.8), ForceSensor())
    whole = (real, ButtonGrid(0, len(effort) - 1, 200, 20, len(prepare(button).table)), prepare(button).table)
    return {"this scene": rate(scene), "press of mx-clear": rate((*whole, effort))}


def rate(call: tuple[ctypes.Structure, ButtonGrid, FloatArray, FloatArray]) -> float:
    begun = time.thread_time()
    run_button(*call)
    return STEPS / (time.thread_time() - begun)


def main() -> None:
    # taken in turns, so that a slower or faster moment of the machine meets both
    pairs = [(mujoco_rate(), kernel_rates()) for _ in range(REPEATS)]
    depth, back = mujoco_error()
    print(
        f"time of the processor, one thread, steps of {STEP_s:g} s, simulated; medians of {REPEATS} in turns"
    )
    print(f"MuJoCo, one slide joint, one contact  {np.median([one for one, _ in pairs]):10.3g} steps/s")
    print(f"  error of depth {depth:+.1e}, of speed back {back:+.1e}")
    for name in pairs[0][1]:
        value = np.median([ours[name] for _, ours in pairs])
        ratios = [ours[name] / theirs for theirs, ours in pairs]
        fastest = max(ours[name] for _, ours in pairs) / max(one for one, _ in pairs)
        spread = f"{min(ratios):.1f} to {max(ratios):.1f}; of both fastest {fastest:.1f}"
        print(f"button kernel, {name:<22} {value:10.3g} steps/s  {np.median(ratios):6.1f} x ({spread})")
    depth, back = kernel_error()
    print(f"  error of depth {depth:+.1e}, of speed back {back:+.1e}")


if __name__ == "__main__":
    main()
