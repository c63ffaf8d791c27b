"""Are the standard errors of landmarks those by which whole recordings differ? Simulated; half a minute.

Run as ``python -m benchmarks.spread``, or with the number of recordings. The same simulated button is
recorded anew, 15 presses at each pace, with another session's errors and another finger's luck. Shown are the
standard deviation of each landmark between recordings, and the median of the errors that the models tell.
With twelve recordings the first is known to a fifth; what a session gets wrong as a whole is in it, and in no
model's error.
"""

from __future__ import annotations

import sys
import time
from collections import defaultdict

import numpy as np

from fdvv.bench.model import model_of_recording
from fdvv.bench.vibration import RecordedVibrations
from fdvv.model.landmarks import landmark_errors, landmarks
from fdvv.preprocess.process import Processed
from fdvv.recording.types import Recording
from fdvv.testing.captured import captured_session

PACES_mm_s = (50.0, 100.0, 150.0, 200.0)
NAMES = (
    "peak_cN",
    "valley_cN",
    "release_peak_cN",
    "release_valley_cN",
    "actuation_mm",
    "reset_mm",
    "travel_mm",
)
SESSIONS = 12


def no_vibration(_recording: Recording, _processed: Processed) -> RecordedVibrations:
    """Leave the sound alone: only force and displacement are looked at here."""
    return RecordedVibrations((), (), ())


def main() -> None:
    """Print a table of landmarks."""
    count = int(sys.argv[1]) if len(sys.argv) > 1 else SESSIONS
    found: dict[tuple[str, float], list[tuple[float, float]]] = defaultdict(list)
    spent_s = []
    for seed in range(1, count + 1):
        recording = captured_session("mx-clear", seed).recording
        begun = time.process_time()
        model = model_of_recording(recording, find_vibrations=no_vibration).model
        spent_s.append(time.process_time() - begun)
        for pace in PACES_mm_s:
            marks, errors = landmarks(model, pace).to_dict(), landmark_errors(model, pace)
            for name in NAMES:
                value = marks[name]
                if value is not None and name in errors:
                    found[name, pace].append((value, errors[name].error))
    print(f"simulated, {count} recordings of 60 presses; {np.median(spent_s):.2f} s of processor time each")
    print("landmark           mm/s     mean  between recordings  reported")
    for (name, pace), pairs in sorted(found.items()):
        values, reported = np.array(pairs).T
        print(
            f"{name:17} {pace:5g} {values.mean():8.3f} {values.std(ddof=1):12.3f} {np.median(reported):13.3f}"
        )


if __name__ == "__main__":
    main()
