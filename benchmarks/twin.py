"""How fast is the rig's twin: beside plain SciPy, over paces and loops, on one core and two? Simulated.

Run as ``python -m benchmarks.twin``. The plain loop is the twin's reference: the same equations written in
Python, integrated with SciPy's DOP853 between the ticks. Times are of the thread, so that a busy machine does
not count; simulated time is that of the record alone, without the settling before it, which is paid for too.
"""

from __future__ import annotations

import time
from collections import deque
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from functools import partial

import numpy as np

from fdvv.model.file import load_builtin
from fdvv.model.surface import ForceSurface
from fdvv.twin.finger import Finger
from fdvv.twin.gesture import plan, vary
from fdvv.twin.image import image_of
from fdvv.twin.noise import draw_noise, silence
from fdvv.twin.pace import solve_program_pace
from fdvv.twin.rig import Controller, Rig
from fdvv.twin.rig_moves import Exciter
from fdvv.twin.simulate import simulate_program
from fdvv.twin.trace import Trace
from fdvv.units import m_from_mm
from tests.support.reference.reference import reference_simulate
from tests.support.table_press import simulate

PACES_mm_s = (50.0, 75.0, 100.0, 125.0, 150.0, 175.0, 200.0)
STEPS_s = (2e-5, 1e-5, 5e-6, 2.5e-6)
RIGS = {
    "default, 1 kHz": Rig(),
    "without exciter": Rig(exciter=Exciter(fitted="no")),
    "4 kHz": Rig(controller=Controller(tick_s=2.5e-4, compute_s=1e-4)),
}
BUTTON = load_builtin("mx-clear")
SURFACE = ForceSurface.of_model(BUTTON, [50.0, 100.0, 150.0, 200.0])


def press_of(rig: Rig, velocity_mm_s: float, seed: int) -> Callable[[], Trace]:
    """Vary one press."""
    random, finger = np.random.default_rng(seed), Finger()
    pace_s = solve_program_pace(rig, finger, image_of(SURFACE, BUTTON.travel_mm).image, velocity_mm_s)
    gesture = vary(finger, float(m_from_mm(BUTTON.travel_mm)), pace_s, velocity_mm_s / 1000, random)
    image = image_of(SURFACE, BUTTON.travel_mm).image
    noise = draw_noise(rig, finger, gesture, random)
    return partial(simulate_program, rig, finger, gesture, image, noise, velocity_mm_s)


def times_real_time(press: Callable[[], Trace], rounds: int = 9) -> float:
    """Return simulated over computing time, median of rounds."""
    spent = []
    for _ in range(rounds):
        begun = time.thread_time()
        trace = press()
        spent.append(time.thread_time() - begun)
    return float(trace.t_s[-1]) / float(np.median(spent))


def speeds() -> None:
    print("times real time, one core, median over presses at 50 to 200 mm/s (least to greatest), simulated")
    for name, rig in RIGS.items():
        ratios = [times_real_time(press_of(rig, v, k)) for k, v in enumerate(PACES_mm_s)]
        print(f"  {name:20} {np.median(ratios):6.0f}  ({min(ratios):.0f} to {max(ratios):.0f})")


def steps() -> None:
    """Compare steps with the reference on one quiet press, and time them."""
    rig, finger = Rig(), Finger()
    pace_s = solve_program_pace(rig, finger, image_of(SURFACE, BUTTON.travel_mm).image, 100.0)
    gesture = plan(finger, float(m_from_mm(BUTTON.travel_mm)), pace_s)
    call = (rig, finger, gesture, SURFACE, BUTTON.travel_mm, silence(rig, gesture), 100.0)
    begun = time.thread_time()
    slow = reference_simulate(*call)
    plain_s = time.thread_time() - begun
    print("step, computing time, and difference from SciPy's DOP853 (rms um, rms cN), 100 mm/s, simulated")
    for step_s in STEPS_s:
        begun = time.thread_time()
        fast = simulate(*call, step_s)
        spent_s = time.thread_time() - begun
        um = 1e3 * np.sqrt(np.mean((fast.displacement_mm - slow.displacement_mm) ** 2))
        cN = np.sqrt(np.mean((fast.force_cN - slow.force_cN) ** 2))
        print(f"  {1e6 * step_s:4.1f} us {1e3 * spent_s:7.2f} ms  {um:.6f}  {cN:.5f}")
    print(f"  plain SciPy {1e3 * plain_s:.0f} ms")


def batches() -> None:
    print("many presses at 200 mm/s, presses per second by the clock, simulated")
    press = press_of(Rig(), 200.0, 1)
    for count, threads in ((1000, 1), (1000, 2), (10_000, 2)):
        begun = time.perf_counter()
        with ThreadPoolExecutor(threads) as pool:
            deque(pool.map(lambda _: press().force_cN[-1], range(count)), maxlen=0)
        spent_s = time.perf_counter() - begun
        print(f"  {count:6} on {threads} threads {count / spent_s:7.0f}/s")


def main() -> None:
    speeds()
    steps()
    batches()


if __name__ == "__main__":
    main()
