"""How exact are the core's velocities and vibration onsets? ``python -m benchmarks.core_accuracy``.

Even and speeding presses, simulated without a finger, at 25 phases of a 4 kHz tick; the readings are those of
the rig voltage (converter steps, no noise). Each figure is the worst of its phases.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import numpy.typing as npt

from fdvv.protocol.tables import NONE, Settings
from tests.support.core.programs import REST, armed, event, image
from tests.support.inputs import inputs_at

SETTINGS = replace(Settings(), velocity_scale_q12=4096, slew_cN64_tick=32000, stuck_ticks=65535)
SPEEDS_MM_S = (0.5, 2.0, 10.0, 50.0, 100.0, 150.0, 200.0, 300.0, 450.0, 600.0)
ROWS = [0, 4000, 8000, 12000, 16000]
# its force in cN64 is the decided velocity in mm_s16
TELLS = image(
    states=[(replace(REST, velocity_source=1), ())], tables=[(0, 16000, ROWS, [[row, row] for row in ROWS])]
)
POINT_MM = 2.2
FELT = image(states=[(replace(REST, velocity_source=2), ())], vibrations=[event(int(16000 * POINT_MM))])
PHASES = np.linspace(0, 0.98, 25)


def ticks_s(first_s: float, last_s: float, phase: float) -> npt.NDArray[np.float64]:
    tick_s = SETTINGS.tick_us * 1e-6
    return np.arange(first_s, last_s, tick_s) + phase * tick_s


def velocity_errors(speed_mm_s: float) -> tuple[float, float]:
    """Return the worst errors (%) of the decided and of the settled continuous velocity."""
    decided, continuous = [], []
    for phase in PHASES if speed_mm_s > 5 else PHASES[::12]:
        path_mm = speed_mm_s * ticks_s(-0.3 / speed_mm_s, 1.3 / speed_mm_s, float(phase))
        outputs = armed(TELLS, SETTINGS).run(inputs_at(SETTINGS, path_mm))
        decided.append(outputs["commanded_cN64"][-1] / 16 / speed_mm_s - 1)
        late = outputs["velocity_mm_s16"][SETTINGS.continuous_samples :]
        continuous.append(np.abs(late / 16 / speed_mm_s - 1).max() if late.size else np.nan)
    return 100 * float(np.abs(decided).max()), 100 * float(np.max(continuous))


def onset_errors_ms(speed_mm_s: float, acceleration_mm_s2: float, latency_us: int) -> tuple[float, float]:
    """Return the earliest and latest onset (ms) after the cap crossed the point at that speed."""
    settings, v, a = replace(SETTINGS, vibration_latency_us=latency_us), speed_mm_s, acceleration_mm_s2
    errors = []
    for phase in PHASES:
        t = ticks_s(-2.9 / v, 0.02, float(phase))
        moving = np.maximum(t, -v / a) if a else t
        path_mm = np.minimum(POINT_MM + v * moving + 0.5 * a * moving**2, 3.9)
        slots = armed(FELT, settings).run(inputs_at(settings, path_mm))["slot"]
        errors.append(1e3 * t[np.argmax(slots != NONE)] + latency_us * 1e-3)
    return min(errors), max(errors)


def main() -> None:
    print("velocity, worst of the phases, simulated: mm/s, decided %, continuous %")
    for speed in SPEEDS_MM_S:
        decided, continuous = velocity_errors(speed)
        print(f"{speed:8.1f}  {decided:6.2f}  {continuous:6.2f}")
    print(
        "vibration onset after the point was crossed, ms, simulated: mm/s, mm/s², latency 1 ms, latency 7 ms"
    )
    for acceleration in (0.0, 2000.0, 5000.0):
        for speed in (50.0, 100.0, 150.0, 200.0, 300.0):
            ranges = [onset_errors_ms(speed, acceleration, latency) for latency in (1000, 7000)]
            print(
                f"{speed:6.0f} {acceleration:6.0f}  " + "  ".join(f"{a:+.2f} to {b:+.2f}" for a, b in ranges)
            )


if __name__ == "__main__":
    main()
