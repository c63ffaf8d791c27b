"""A recording to try things on, and how its records look on file."""

from __future__ import annotations

import numpy as np

from fdvv.recording.types import Bench, Mark, Quantity, Recording, Stage, Stream, Take

ABOUT = Recording("mx-clear", bench=Bench(force_filter_ms=1.0, tip_mass_g=2.5), licence="CC0", person="A")


def take(number: int = 1, samples: int = 50) -> Take:
    rng = np.random.default_rng(number)
    t_s = number + np.arange(samples) / 1000
    frames_s = number + np.arange(samples // 4) / 256
    place = rng.normal(size=(samples // 4, 3))
    place[1] = np.nan
    force, sound = (rng.integers(0, 4096, samples, dtype=kind) for kind in (np.int16, np.int32))
    streams = (
        Stream("force", Quantity.FORCE, "board", t_s, force, 0.05, 9.0),
        Stream("sound", Quantity.SOUND, "board", t_s, sound, 1e-3),
        Stream("left", Quantity.MARKER, "camera", frames_s, place),
        Stream("right", Quantity.MARKER, "camera", frames_s, place.astype(np.float32)),
    )
    return Take(
        number, streams, (Mark("light on", "board", number + 0.01),), Stage.PRESS, 100.0, "2026-01-01"
    )


def head(**changes: object) -> dict[str, object]:
    found = {"format": "fdvv-recording", "version": 1, "name": "a", "licence": "", "person": ""}
    bench = {
        "force_filter_ms": 0,
        "sound_filter_ms": 0,
        "force_play_cN": 0,
        "tip_mass_g": 0,
        "sound_V_s_m": 0,
        "exposure_ms": 0,
        "clocks_go_on": True,
    }
    return {**found, "bench": bench, "simulated": False, "sources": [], "warnings": [], **changes}


TAKE = {"number": 1, "stage": "press", "velocity_mm_s": None, "made": "", "remark": "", "marks": []}
