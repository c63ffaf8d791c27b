"""How well, and how fast, are vibrations estimated from whole capture sessions?

Simulated; a minute for ten seeds.

Run as ``python -m benchmarks.recorded_vibration``, or with the first seed and how many. A session is the
paper's: 15 presses at each of 50, 100, 150 and 200 mm/s, on the bench with a 10 kHz accelerometer on the
housing. Truth: onset is when the leaf first strikes the fixed contact; the first mode rings at 237.8 Hz
and falls to a tenth in 15.3 ms. Errors are those of what a model holds.
"""

from __future__ import annotations

import math
import sys
import time
from collections import defaultdict

import numpy as np

from fdvv.bench.vibration import RecordedVibrations, find_vibrations
from fdvv.model.curve import Stroke
from fdvv.model.vibration import Vibration
from fdvv.preprocess.process import process
from fdvv.testing.captured import CapturedSession, captured_session
from fdvv.twin.files import button_names
from fdvv.units import FloatArray

FIRST_SEED, SEEDS = 300, 10


def true_onset_mm(session: CapturedSession, velocity_mm_s: float) -> float:
    """Return the median over good presses of where the leaf struck the contact."""
    traces = [take.truth.trace for take in session.of("good", velocity_mm_s)]
    return float(
        np.median(
            [
                np.interp(t.closing_s, t.t_s, t.displacement_mm)
                for t in traces
                if t and t.closing_s is not None
            ]
        )
    )


def errors(
    session: CapturedSession, estimated: RecordedVibrations, vibration: Vibration
) -> tuple[float, ...]:
    """Return the errors of onset (ms), frequency (%) and duration (%)."""
    assert vibration.velocity_mm_s is not None
    housing, velocity = session.button.housing, vibration.velocity_mm_s
    f = housing.first_Hz * math.sqrt(1 - housing.first_damping_ratio**2)
    lasts_s = math.log(10) / (2 * math.pi * housing.first_Hz * housing.first_damping_ratio)
    heard = next(h for h in estimated.strokes if (h.stroke, h.velocity_mm_s) == (vibration.stroke, velocity))
    speed = heard.report()["snap_velocity_mm_s"]
    return (
        1e3 * (vibration.onset_mm - true_onset_mm(session, velocity)) / speed,
        100 * (vibration.modes[0].frequency_Hz / f - 1),
        100 * (vibration.duration_s / lasts_s - 1),
    )


def main(first_seed: int = FIRST_SEED, seeds: int = SEEDS) -> None:
    print(f"seeds {first_seed} to {first_seed + seeds - 1}, simulated; median (least to most) over seeds")
    for name in button_names():
        rows, spent = defaultdict[tuple[str, float], list[tuple[float, ...]]](list), list[float]()
        releases, exponents = 0, list[float]()
        for seed in range(first_seed, first_seed + seeds):
            session = captured_session(name, seed)
            processed = process(session.recording)
            start = time.process_time()
            estimated = find_vibrations(session.recording, processed)
            spent.append(time.process_time() - start)
            exponents += [s.scaling.exponent for s in estimated.scalings if s.stroke is Stroke.PRESS]
            for vibration in estimated.vibrations:
                if vibration.stroke is Stroke.PRESS and vibration.velocity_mm_s is not None:
                    rows[name, vibration.velocity_mm_s].append(errors(session, estimated, vibration))
                releases += vibration.stroke is Stroke.RELEASE
        law = (
            f"{np.median(exponents):.2f} ({min(exponents):.2f} to {max(exponents):.2f})" if exponents else "–"
        )
        print(
            f"{name}: {len(spent)} sessions, {np.median(spent):.2f} s of "
            f"processor (at most {max(spent):.2f}), {releases} vibrations on releases, exponent {law}"
        )
        for (_, pace), found in sorted(rows.items()):
            print(
                f"  press {pace:g} mm/s: {len(found)}/{len(spent)} found; {line(np.array(found))}", flush=True
            )


def line(found: FloatArray) -> str:
    """Summarize errors over seeds, and how many are within 1 ms, 5 % and 10 %."""
    parts = []
    for column, (what, unit, bound) in zip(
        found.T, (("onset", "ms", 1), ("frequency", "%", 5), ("duration", "%", 10)), strict=True
    ):
        inside = int(np.sum(np.abs(column) <= bound))
        parts.append(
            f"{what} {np.median(column):+.2g} ({column.min():+.2g} to {column.max():+.2g}) {unit}, "
            f"{inside} within {bound} {unit}"
        )
    return "; ".join(parts)


if __name__ == "__main__":
    words = [int(word) for word in sys.argv[1:]]
    main(*words)
