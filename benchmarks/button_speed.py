"""How fast is the real-button twin: one core, two threads, thousands of presses? Simulated.

Run as ``python -m benchmarks.button_speed [PRESSES]``; PRESSES is the large batch, 10,000 if left out.
"""

from __future__ import annotations

import sys
import time
from collections import deque
from concurrent.futures import ThreadPoolExecutor
from itertools import cycle, islice

import numpy as np

from fdvv.twin.button import ButtonPhysics
from fdvv.twin.files import button_names, load_button
from fdvv.twin.finger import Finger
from fdvv.twin.gesture import Gesture, plan, vary
from fdvv.twin.pace import solve_button_pace
from fdvv.twin.rig import ForceSensor
from fdvv.twin.simulate_button import ButtonNoise, draw_button_noise, simulate_button
from fdvv.units import m_from_mm
from tests.support.reference.button import reference_button

VELOCITY_mm_s = 100.0
Call = tuple[ButtonPhysics, Finger, Gesture, ButtonNoise, ForceSensor]
"""The arguments of simulate_button."""
PLANS = 500
"""Different presses planned; a larger batch repeats them."""


def press_plan(name: str, velocity_mm_s: float = VELOCITY_mm_s, seed: int = 0) -> Call:
    """Plan a press of a shipped button at a pace, varied as a person varies."""
    button, finger, sensor = load_button(name), Finger(), ForceSensor()
    pace_s = solve_button_pace(button, finger, velocity_mm_s, sensor)
    gesture = plan(finger, button.curve.travel_m, pace_s)
    noise = draw_button_noise(finger, gesture, np.random.default_rng(seed), sensor)
    return button, finger, gesture, noise, sensor


def varied(first: Call, count: int, seed: int = 0) -> list[Call]:
    """Plan count presses of the same person, each different."""
    random, plans = np.random.default_rng(seed), []
    button, finger, planned, _, sensor = first
    for _ in range(count):
        gesture = vary(finger, button.curve.travel_m, planned.press_s, m_from_mm(VELOCITY_mm_s), random)
        noise = draw_button_noise(finger, gesture, random, sensor)
        plans.append((button, finger, gesture, noise, sensor))
    return plans


def batch_s(plans: list[Call], count: int, threads: int) -> float:
    """Time count presses, taken in turn from plans, each let go as it comes."""
    begun = time.perf_counter()
    with ThreadPoolExecutor(threads) as pool:
        calls = islice(cycle(plans), count)
        deque(pool.map(lambda call: simulate_button(*call).force_cN[-1], calls), maxlen=0)
    return time.perf_counter() - begun


def cpu_ms(call: Call) -> float:
    """Time one press in processor time, which other programs on the machine disturb least."""
    begun = time.process_time()
    simulate_button(*call)
    return 1e3 * (time.process_time() - begun)


def single() -> None:
    for name in button_names():
        call = press_plan(name)
        trace = simulate_button(*call)
        times_ms = sorted(cpu_ms(call) for _ in range(60))
        length_ms, median = 1e3 * float(trace.t_s[-1]), times_ms[30]
        print(
            f"{name:<18} press of {length_ms:4.0f} ms: {median:.2f} ms of processor time "
            f"({times_ms[0]:.2f} to {times_ms[-1]:.2f}), {length_ms / median:.0f} x real time "
            f"({length_ms / times_ms[-1]:.0f} to {length_ms / times_ms[0]:.0f})"
        )
    begun = time.perf_counter()
    reference_button(*call)
    print(f"{name:<18} plain SciPy, DOP853: {1e3 * (time.perf_counter() - begun):6.0f} ms")


def many(presses: int) -> None:
    plans = varied(press_plan("mx-clear"), PLANS)
    length_s = float(np.mean([gesture.duration_s for _, _, gesture, *_ in plans]))
    batch_s(plans, 50, 2)
    for count, threads in ((1000, 1), (1000, 2), (presses, 2)):
        taken_s = batch_s(plans, count, threads)
        print(
            f"{count:6} presses of mx-clear, threads: {threads}, {taken_s:6.2f} s, "
            f"{count / taken_s:6.0f} presses/s, {count * length_s / taken_s:5.0f} x real time"
        )


def main() -> None:
    print(f"real-button twin at {VELOCITY_mm_s:g} mm/s, steps of 5 us, sensor worn; one core, simulated")
    single()
    many(int(sys.argv[1]) if len(sys.argv) > 1 and sys.argv[1].isdigit() else 10_000)


if __name__ == "__main__":
    main()
