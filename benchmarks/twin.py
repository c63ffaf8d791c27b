"""How fast is the twin, beside plain SciPy solving the same press in the same run? Simulated.

Run as ``python -m benchmarks.twin``. The plain loop is the twin's reference: the same equations written in
Python, integrated with SciPy's DOP853 between the controller's ticks.
"""

from __future__ import annotations

import time

import numpy as np

from benchmarks.fit import time_ms
from fdvv.model import ForceSurface, load_builtin
from fdvv.twin import Finger, Rig, plan, reference_simulate, silence, simulate, solve_pace
from fdvv.units import m_from_mm

VELOCITY_mm_s = 100.0


def main() -> None:
    rig, finger, button = Rig(), Finger(), load_builtin("mx-clear")
    surface = ForceSurface.of_model(button, [50.0, 100.0, 150.0, 200.0])
    pace_s = solve_pace(rig, finger, surface, button.travel_mm, VELOCITY_mm_s)
    gesture = plan(finger, m_from_mm(button.travel_mm), pace_s)
    quiet = silence(rig, gesture)
    call = (rig, finger, gesture, surface, button.travel_mm, quiet, VELOCITY_mm_s)
    trace = simulate(*call)
    length_s = float(trace.t_s[-1])
    median, least, greatest = time_ms(lambda: simulate(*call), 20)
    begun = time.perf_counter()
    reference = reference_simulate(*call)
    plain_ms = 1e3 * (time.perf_counter() - begun)
    print(f"one press of {1e3 * length_s:.0f} ms at {VELOCITY_mm_s:g} mm/s, simulated, one core")
    ratio, steps_per_s = 1e3 * length_s / median, length_s / 5e-6 / (1e-3 * median)
    print(f"twin, C at 5 us steps   {median:9.2f} ms  ({least:.2f} to {greatest:.2f})")
    print(f"                        {ratio:9.0f} x real time, {steps_per_s:.2e} steps/s")
    print(f"plain SciPy, DOP853     {plain_ms:9.0f} ms  {plain_ms / median:.0f} x slower")
    count = min(trace.t_s.size, reference.t_s.size)
    for name in ("displacement_mm", "force_cN"):
        error = getattr(trace, name)[:count] - getattr(reference, name)[:count]
        print(f"  difference of {name}: rms {np.sqrt(np.mean(error**2)):.2e}, max {np.abs(error).max():.2e}")


if __name__ == "__main__":
    main()
