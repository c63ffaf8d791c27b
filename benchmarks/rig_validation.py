"""Does the rig's twin obey what is known in closed form or by other solvers? Simulated; one table.

Run as ``python -m benchmarks.rig_validation``. The rows name what was asked for and say plainly what fails.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np

from benchmarks.rig_vibration import VELOCITIES_mm_s
from fdvv.model.file import load_builtin
from fdvv.model.surface import ForceSurface
from fdvv.twin.finger import Finger
from fdvv.twin.gesture import vary
from fdvv.twin.image import image_of
from fdvv.twin.noise import draw_noise
from fdvv.twin.pace import solve_program_pace
from fdvv.twin.rig import Rig
from fdvv.twin.rig_moves import Coil
from fdvv.units import FloatArray
from tests.support.cap_vibration import cap_vibration, ways
from tests.support.closed_forms import coil_error_ratio, mean_response, ripple_N
from tests.support.loop import LinearLoop, bare_loop, cycles, grainy_loop, onset_N_m, quantisation_limit_N_m
from tests.support.reference.reference import reference_simulate
from tests.support.table_press import simulate

PACES_mm_s = (50.0, 100.0, 150.0, 200.0)
FELT_um = 0.1
"""Vibration that a fingertip feels at 250 Hz at best; recalled."""


@dataclass(frozen=True)
class Check:
    """One row: what was asked, what was found, and whether that is enough."""

    name: str
    found: str
    asked: str
    passed: bool


def solver_errors(
    velocity_mm_s: float, method: Literal["DOP853", "Radau"]
) -> tuple[float, float, float, float]:
    """Compare one varied press with a reference: um rms, cN rms, reads that differ, energy ratio."""
    rig, finger, button = Rig(), Finger(), load_builtin("mx-clear")
    surface, travel = ForceSurface.of_model(button, PACES_mm_s), button.travel_mm
    random = np.random.default_rng(7)
    pace_s = solve_program_pace(rig, finger, image_of(surface, travel).image, velocity_mm_s)
    gesture = vary(finger, travel / 1000, pace_s, velocity_mm_s / 1000, random)
    noise = draw_noise(rig, finger, gesture, random)
    call = (rig, finger, gesture, surface, travel, noise, velocity_mm_s)
    slow, fast, audited = reference_simulate(*call, method), simulate(*call), simulate(*call, audit=True)
    assert audited.energy_J is not None  # asked for
    work_J = np.sum(np.abs(fast.force_cN[1:] / 100 * np.diff(fast.displacement_mm) / 1000))
    return (
        1e3 * _rms(fast.displacement_mm - slow.displacement_mm),
        _rms(fast.force_cN - slow.force_cN),
        float(np.mean(np.abs(fast.sensed_mm - slow.sensed_mm) > 1e-9)),
        float(np.abs(audited.energy_J).max() / work_J),
    )


def _rms(values: FloatArray) -> float:
    return float(np.sqrt(np.mean(values**2)))


def checks() -> list[Check]:
    """Run every check; about a minute."""
    rows = [_row("V5 coil step against its closed form", 100 * coil_error_ratio(), "{:.3f} %", 0.1)]
    for velocity, method in [(v, "DOP853") for v in PACES_mm_s] + [(100.0, "Radau")]:
        um, cN, _, energy = solver_errors(velocity, "Radau" if method == "Radau" else "DOP853")
        name = f"V6 {velocity:g} mm/s, against {method}"
        rows.append(_row(f"{name}: displacement", um, "{:.4f} um rms", 1.0))
        rows.append(_row(f"{name}: force", cN, "{:.4f} cN rms", 0.1))
        rows.append(_row(f"{name}: energy unaccounted for", 100 * energy, "{:.4f} % of the work", 0.1))
    rows.append(
        _row("V7 sliding mean of 25 at 1 kHz leaves of 40 Hz", mean_response(40.0)[0], "{:.5f}", 1e-3)
    )
    worst = max(abs(a - b) for a, b in (mean_response(f) for f in (5.0, 13.0, 27.0, 60.0, 111.0)))
    rows.append(_row("V7 sliding mean against its closed form", worst, "{:.5f}", 1e-3))
    for switching_Hz in (732.0, 2e4, 187.5e3):
        force_N = ripple_N(Coil(), switching_Hz)
        um = 1e6 * force_N / (Rig().mover.mass_kg * (2 * np.pi * switching_Hz) ** 2)
        name = f"ripple of {100 * force_N:.0f} cN left out at {switching_Hz / 1000:g} kHz"
        rows.append(_row(name, um, "{:.4f} um of the cap", FELT_um))
    return rows + loop_checks() + vibration_checks()


def loop_checks() -> list[Check]:
    """Compare where the loop begins to cycle with the eigenvalues and with the quantisation's limit."""
    rows = []
    for name, rig in (("1 kHz", bare_loop()), ("4 kHz", bare_loop(2.5e-4))):
        limit = LinearLoop(rig).limit_N_m()
        found = onset_N_m(rig, 0.7 * limit, 1.5 * limit)
        text = f"{found:.0f} N/m, eigenvalues say {limit:.0f}"
        rows.append(Check(f"V8 onset of cycling, {name}", text, "5 %", abs(found / limit - 1) < 0.05))
    rig = grainy_loop()
    limit = quantisation_limit_N_m(rig)
    rests, moves = not cycles(rig, 0.95 * limit, 1e-3), cycles(rig, 1.05 * limit, 1e-3)
    text = f"at 0.95 of {limit:.0f} N/m it {_does(not rests)}, at 1.05 it {_does(moves)}"
    return [*rows, Check("V9 quantisation against friction", text, "rests below", rests)]


def _does(moving: bool) -> str:
    return "cycles" if moving else "rests"


def vibration_checks() -> list[Check]:
    """Time the onset of a vibration on the cap at every pace, and look at its shape."""
    rows = []
    for name, rig, settings, at_mm in ways():
        seen = [cap_vibration(rig, settings, at_mm, v) for v in VELOCITIES_mm_s]
        worst = max((f.late_ms for f in seen), key=abs)
        text = " ".join(f"{f.late_ms:+.1f}" for f in seen) + " ms"
        rows.append(Check(f"V13 onset, {name}", text, "within 1 ms", abs(worst) <= 1.0))
    last = seen[1]
    rows.append(
        Check(
            "V13 frequency",
            f"{last.frequency_Hz:.0f} Hz",
            "239 Hz, 5 %",
            abs(last.frequency_Hz / 239 - 1) < 0.05,
        )
    )
    rows.append(Check("V13 likeness to its target", f"{last.likeness:.2f}", "0.9", last.likeness >= 0.9))
    return rows


def _row(name: str, value: float, form: str, most: float) -> Check:
    unit = form[form.index("}") + 1 :]
    return Check(name, form.format(value), f"{most:g}{unit}", value < most)


def main() -> None:
    print("the rig's twin, simulated")
    for check in checks():
        mark = "ok  " if check.passed else "FAIL"
        print(f"{mark} {check.name:56} {check.found:44} asked: {check.asked}")


if __name__ == "__main__":
    main()
