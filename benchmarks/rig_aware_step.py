"""How long does learning from one press take? The finger waits for it.

Run as ``python -m benchmarks.rig_aware_step``. Presses of the simulated rig voltage and of one with a loop of
4 kHz at four speeds; median and largest of the steps that learn on a known rig, the one that identifies it
apart, and of the tables for another button from what the rig has taught.
"""

from __future__ import annotations

import time
from collections.abc import Callable

import numpy as np

from fdvv.compensation.method import CompensationJob
from fdvv.compensation.rig_aware import RigAware, RigState
from fdvv.device.contract import Device
from fdvv.device.twin import TwinDevice
from fdvv.model.file import load_builtin
from fdvv.model.surface import ForceSurface
from fdvv.rendering.tuning import settings_with
from tests.support.rig_truth import draw_fast_rig

SPEEDS_mm_s = (50.0, 100.0, 150.0, 200.0)
BUTTON, OTHER = load_builtin("mx-clear"), load_builtin("mx-red")
METHOD = RigAware(rounds=10)
DEVICES: dict[str, Callable[[], Device]] = {
    "1 kHz": lambda: TwinDevice(seed=1),
    "4 kHz": lambda: TwinDevice(*draw_fast_rig(203, "current"), seed=1),
}


def learned(device: Device) -> tuple[list[float], RigState]:
    """Press and learn to the end; give the time of each step in ms, and the last state."""
    target = ForceSurface.of_model(BUTTON, SPEEDS_mm_s, METHOD.bin_mm)
    state, times_ms = METHOD.init(CompensationJob(target, BUTTON.travel_mm, device.info().force_limit_cN)), []
    while (trial := METHOD.trial(state)) is not None:
        device.configure(settings_with(device.settings(), trial.tuning))
        device.upload(trial.surface, BUTTON.travel_mm, trial.tuning.paced)
        press = device.press(trial.velocity_mm_s)
        begun = time.perf_counter()
        state = METHOD.step(press, state)
        times_ms.append(1000 * (time.perf_counter() - begun))
    return times_ms, state


def tables_ms(state: RigState) -> float:
    """Return the time that tables of another button take, from what the rig has taught."""
    target = ForceSurface.of_model(OTHER, SPEEDS_mm_s, METHOD.bin_mm)
    job, method = CompensationJob(target, OTHER.travel_mm, 440.0), RigAware(0, METHOD.rig_after(state))
    begun = time.perf_counter()
    method.done(method.init(job))
    return 1000 * (time.perf_counter() - begun)


def main() -> None:
    print("time of a step of the rig-aware method, ms (the presses are simulated)")
    for name, make in DEVICES.items():
        times_ms, state = learned(make())
        steps = np.array(times_ms[METHOD.identification_presses :])
        summary = f"median {np.median(steps):.1f}, largest {steps.max():.1f}"
        met = f"identifying the rig {times_ms[METHOD.identification_presses - 1]:.0f}"
        print(f"  {name}: {summary}; {met}; tables of another button {tables_ms(state):.1f}")


if __name__ == "__main__":
    main()
