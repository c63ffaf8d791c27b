"""Random rigs and people for benchmarks of rendering: the paper's parts, and what lifts them. Simulated."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass, replace
from typing import Any, TypeVar

import numpy as np

from fdvv.errors import FdvvError
from fdvv.model.curve import Stroke
from fdvv.model.file import load_builtin
from fdvv.model.model import FDVVModel
from fdvv.twin.draw import draw_finger, draw_rig
from fdvv.twin.finger import Finger
from fdvv.twin.rig import Rig

FIRST_SEED = 500
"""Below it seeds were used to tune."""
SPEEDS_mm_s = (50.0, 100.0, 150.0, 200.0)
BUTTONS = ("mx-clear", "mx-blue", "mx-brown", "mx-black", "mx-red", "rubber-dome")
STRONG_RATIO = 1.25
"""A person who is asked to press to the stop pushes so much harder than the button at its deepest."""
JUDGE = 5000

Found = TypeVar("Found")
Options = dict[str, dict[str, Any]]

LOOP_4_kHz: Options = {
    "controller": {"tick_s": 2.5e-4, "compute_s": 1e-4, "reversal_m": 5e-5},
    "position_sensor": {"burst_s": 2e-4},
}
LOOP_10_kHz: Options = {
    "controller": {"tick_s": 1e-4, "compute_s": 3e-5, "reversal_m": 5e-5},
    "position_sensor": {"burst_s": 5e-5},
}
CURRENT: Options = {"coil": {"drive": "current"}}
LIGHT_12_g: Options = {"mover": {"mass_kg": 0.012}}
SENSOR: Options = {
    "position_sensor": {
        "bandwidth_Hz": 4000.0,
        "noise_m": 1e-6,
        "converter_bits": 14,
        "linearity_ratio": 0.0005,
    }
}
LIGHT_6_g: Options = {
    "exciter": {"fitted": "no", "mass_kg": 0.004},
    "mover": {"mass_kg": 0.006},
}
FAST_COIL: Options = {
    "coil": {
        **{"drive": "current", "current_loop_s": 5e-5, "supply_V": 24.0},
        **{"inductance_H": 1e-3, "reluctance_H_m": 0.05},
    }
}


def with_options(rig: Rig, *options: Options) -> Rig:
    """Build a drawn rig with other parts; of options for one number the last counts."""
    wanted: Options = {}
    for one in options:
        for part, values in one.items():
            wanted[part] = {**wanted.get(part, {}), **values}
    parts = {name: replace(getattr(rig, name), **values) for name, values in wanted.items()}
    return replace(rig, **parts)


@dataclass(frozen=True)
class Case:
    """One rig, one person, one button."""

    seed: int
    button: str
    options: tuple[Options, ...]

    @property
    def model(self) -> FDVVModel:
        """Load the button."""
        return load_builtin(self.button)

    def parts(self) -> tuple[Rig, Finger]:
        """Draw rig and person."""
        random = np.random.default_rng(self.seed)
        rig, finger = draw_rig(random), draw_finger(random)
        deepest = np.array([self.model.travel_mm])
        need_N = 0.01 * max(
            float(self.model.force_cN(deepest, speed, Stroke.PRESS)[0]) for speed in SPEEDS_mm_s
        )
        push_N = max(finger.habit.push_N, STRONG_RATIO * need_N)
        strong = replace(finger, habit=replace(finger.habit, push_N=push_N))
        return with_options(rig, *self.options), strong


def run_all(work: Callable[[Case], Found], cases: list[Case]) -> Iterator[tuple[Case, Found | str]]:
    """Work on cases with both cores; give what was found, or why a case ended without it."""
    with ProcessPoolExecutor(2) as pool:
        yield from zip(cases, pool.map(_Safe(work), cases), strict=True)


@dataclass(frozen=True)
class _Safe:
    work: Callable[[Case], Any]

    def __call__(self, case: Case) -> Any:
        try:
            return self.work(case)
        except FdvvError as error:
            return str(error)


def spread(values: list[float]) -> str:
    """Write median and 5 to 95 %."""
    if not values:
        return "-"
    low, middle, high = np.percentile(values, [5, 50, 95])
    return f"{middle:.1f} ({low:.1f}-{high:.1f})"
