"""How well do four presses tell a rig? Simulated; some minutes.

Run as ``python -m benchmarks.identify``, or with the first and the last seed, or with these and the amplitude
of the ripples in cN. Rigs and fingers drawn at random over their plausible ranges, loop of 4 kHz; one press
each at 50, 100, 150 and 200 mm/s on the identification surface, judged on four fresh presses of the plain
model, lifted. MX Clear and MX Red in turn.
Forces and their numbers are in the units of the finger's sensor, so its error of calibration is not counted.
Rigs are left out whose coil is weaker than the firmware accepts, or too stiff for the twin's steps.
"""

from __future__ import annotations

import sys
import time
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from fdvv.compensation.identification.balance import PARAMETERS
from fdvv.compensation.identification.excitation import identification_surface
from fdvv.compensation.identification.identify import identify
from fdvv.compensation.identification.rig_model import Prior, RigModel
from fdvv.device.twin import TwinDevice
from fdvv.errors import ModelError
from fdvv.model.file import load_builtin
from fdvv.model.surface import ForceSurface
from fdvv.twin.finger import Finger
from fdvv.twin.rig import Rig
from fdvv.units import FloatArray
from tests.support.rig_truth import draw_fast_rig, missed_cN, rig_truth

SPEEDS_mm_s = (50.0, 100.0, 150.0, 200.0)
SEEDS = range(300, 350)
BUTTONS = ("mx-clear", "mx-red")
MIDDLE_mm = 2.0
COLUMNS = {
    "gain at 2 mm": (100.0, "%"),
    "delay in all": (1e3, "ms"),
    "electric lag": (1e3, "ms"),
    "position lag": (1e3, "ms"),
    "drag at 2 mm": (1.0, "N s/m"),
    "friction": (1.0, "cN"),
    "weight": (1.0, "cN"),
    "mass": (1.0, "g"),
    "play": (1.0, "cN"),
}
"""Name in the table, scale, unit."""
ERRORS = (
    *("gain", "delay_s", "electric_lag_s", "position_lag_s", "drag_N_s_m"),
    *("friction_cN", "weight_cN", "mass_g", "play_cN"),
)


def prior_model() -> RigModel:
    """Return the model assumed for any rig before it is pressed."""
    m = dict(zip(PARAMETERS, Prior().vectors(2.5e-4)[0].tolist(), strict=True))
    return RigModel(
        gain=(m["gain_0"], m["gain_1"], m["gain_2"]),
        delay_s=m["command_delay_s"] + m["electric_lag_s"],
        electric_lag_s=m["electric_lag_s"],
        position_lag_s=m["position_lag_s"],
        drag_N_s_m=m["viscous_N_s_m"] + m["back_emf_N_s_m"],
        back_emf_N_s_m=m["back_emf_N_s_m"],
        friction_cN=m["friction_cN"],
        weight_cN=m["weight_cN"],
        mass_g=m["mass_g"],
        play_cN=2 * m["half_play_cN"],
    )


def numbers(known: RigModel) -> FloatArray:
    """Return the numbers of the table."""
    at = np.array(MIDDLE_mm)
    shown = (known.gain_at(at), known.delay_s, known.electric_lag_s, known.position_lag_s, known.drag_at(at))
    return np.array(
        [*shown, known.friction_cN, known.weight_cN, known.mass_g, known.play_cN], dtype=np.float64
    )


@dataclass(frozen=True, eq=False)
class Judged:
    """One rig: errors of its numbers, these in standard errors, rms of the force, seconds."""

    missed: FloatArray
    in_errors: FloatArray
    force_cN: tuple[float, float, float]
    spent_s: float


def judge(seed: int, drive: str, ripple_cN: float) -> Judged | None:
    """Identify one rig and hold it against its truth; None if it cannot be pressed."""
    rig, finger = draw_fast_rig(seed, drive)
    try:
        return held_against_truth(seed, rig, finger, ripple_cN)
    except ModelError:
        return None


def held_against_truth(seed: int, rig: Rig, finger: Finger, ripple_cN: float) -> Judged:
    button = load_builtin(BUTTONS[seed % 2])
    target = ForceSurface.of_model(button, SPEEDS_mm_s, 0.05)
    device = TwinDevice(rig, finger, seed)
    device.upload(identification_surface(target, ripple_cN=ripple_cN), button.travel_mm, paced=True)
    presses = [device.press(v) for v in SPEEDS_mm_s]
    begun = time.perf_counter()
    known = identify(presses, button.travel_mm)
    spent_s = time.perf_counter() - begun
    true = rig_truth(rig)
    missed = numbers(known) - numbers(true)
    fresh = TwinDevice(rig, finger, seed + 5000)
    fresh.upload(identification_surface(target, ripple_cN=0.0), button.travel_mm)
    traces = [fresh.press_trace(v) for v in SPEEDS_mm_s]
    rms = [missed_cN(k, rig, traces, button.travel_mm) for k in (prior_model(), known, true)]
    error = np.array([known.error[name] for name in ERRORS])
    return Judged(missed, missed / error, (rms[0], rms[1], rms[2]), spent_s)


def table(judged: list[Judged], drive: str) -> Iterator[str]:
    """Return the lines of one drive."""
    missed, z = np.array([j.missed for j in judged]), np.array([j.in_errors for j in judged])
    title = f"{drive} drive, {len(judged)} rigs, simulated"
    yield f"| {title} | median | 5 % | 95 % | median of size | in standard errors, rms |"
    yield "|---|---|---|---|---|---|"
    for k, (name, (scale, unit)) in enumerate(COLUMNS.items()):
        column = scale * missed[:, k]
        low, middle, high = np.percentile(column, [5, 50, 95])
        size, wide = np.median(np.abs(column)), np.sqrt(np.mean(z[:, k] ** 2))
        yield f"| {name}, {unit} | {middle:.2f} | {low:.2f} | {high:.2f} | {size:.2f} | {wide:.1f} |"
    force = np.array([j.force_cN for j in judged])
    for k, name in enumerate(("before, prior alone", "identified", "true numbers")):
        low, middle, high = np.percentile(force[:, k], [5, 50, 95])
        yield f"| force on fresh presses, cN rms, {name} | {middle:.2f} | {low:.2f} | {high:.2f} | | |"
    spent = [j.spent_s for j in judged]
    yield f"one identification: median {np.median(spent):.2f} s, longest {max(spent):.2f} s"


def main() -> None:
    first, last = (int(a) for a in sys.argv[1:3]) if len(sys.argv) > 2 else (SEEDS[0], SEEDS[-1])
    ripple_cN = float(sys.argv[3]) if len(sys.argv) > 3 else 8.0
    for drive in ("voltage", "current"):
        tried = (judge(seed, drive, ripple_cN) for seed in range(first, last + 1))
        print("\n".join(table([one for one in tried if one], drive)), flush=True)


if __name__ == "__main__":
    main()
