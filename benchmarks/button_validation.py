"""Does the real-button twin do what real buttons, fingers and equations do? One table. Simulated.

Run as ``python -m benchmarks.button_validation [FOLDER]``; FOLDER holds the real measurements (bluepylons,
haata), for units that no shipped button was made from. A line says what was measured, what was wanted, and
whether it is met.
"""

from __future__ import annotations

import math
import sys
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import numpy as np

from benchmarks.button_capture import budget
from benchmarks.button_lines import Line, rms
from fdvv.button.fit import fit_file
from fdvv.errors import FdvvError
from fdvv.twin.button import ButtonPhysics, button_of_model
from fdvv.twin.cam import identify
from fdvv.twin.files import button_names, load_button
from fdvv.twin.finger import Finger, FingerPad
from fdvv.twin.gesture import Gesture, plan
from fdvv.twin.rig import ForceSensor
from fdvv.twin.simulate_button import (
    ButtonTrace,
    draw_button_noise,
    no_button_noise,
    probe_button,
    simulate_button,
)
from fdvv.units import FloatArray, cN_from_N, mm_from_m
from tests.support.reference.button import reference_button

# units that no shipped button is made from; where the file does not tell where the circuit closes, assumed
HELD_OUT = {
    "bluepylons/Cherry-MX-Clear-stem-w-Cherry-MX-Hyperglide-Blue-Bottom.ods": None,
    "bluepylons/Alphakeys-Dusk-Panda.ods": None,
    "haata/Cherry MX Black.csv": 1.82,
    "haata/Cherry MX Brown.csv": 2.1,
    "haata/Cherry MX Clear.csv": 2.15,
    "haata/Cherry MX Red.csv": 1.4,
}
SEATED_mm = 0.1


# -- V1: slowly led, the twin gives back the curves it was made from --


def slow_errors_cN(button: ButtonPhysics) -> tuple[float, float, float, float]:
    """Return rms errors of press and release from 0, and from 0.1 mm, where the cap has left its seat."""
    probed = probe_button(button, mm_from_m(button.curve.speed_m_s))
    at_mm = mm_from_m(button.curve.step_m) * np.arange(button.press_N.size)
    found = []
    for seat_mm in (0.0, SEATED_mm):
        inside = (probed.displacement_mm >= seat_mm) & (probed.displacement_mm <= at_mm[-1])
        for got_cN, force_N in ((probed.press_cN, button.press_N), (probed.release_cN, button.release_N)):
            wanted_cN = np.interp(probed.displacement_mm, at_mm, cN_from_N(force_N))
            found.append(rms((got_cN - wanted_cN)[inside]))
    return found[0], found[1], found[2], found[3]


def statics() -> Iterator[Line]:
    for name in button_names():
        yield _static_line(load_button(name), f"V1 {name}")


def _static_line(button: ButtonPhysics, what: str) -> Line:
    errors = slow_errors_cN(button)
    got = "{:.2f} / {:.2f} ({:.2f} / {:.2f} from 0.1 mm) cN".format(*errors)
    return Line(f"{what}: press / release, slow, rms", got, "<= 1 cN each", max(errors[:2]) <= 1.0)


def held_out(folder: Path) -> Iterator[Line]:
    """Identify units that no shipped button holds."""
    for name, close_mm in HELD_OUT.items():
        what = f"V1 held out, {Path(name).stem[:18]}"
        try:
            yield _static_line(button_of_model(fit_file(folder / name).model, close_mm), what)
        except FdvvError as error:
            yield Line(what, str(error), "<= 1 cN each", False)


def identified() -> Iterator[Line]:
    """Show what the identification of the leaf switches found."""
    for name in button_names():
        button = load_button(name)
        if button.curve.kind == "dome":
            continue
        cam, travel_m = identify(button), button.curve.travel_m
        tail = (cam.x_m > 0.65 * travel_m) & (cam.x_m < 0.9 * travel_m)
        slope, start_N = np.polyfit(cam.x_m[tail], cam.elastic_N[tail], 1)
        riding = cam.friction_ratio[(cam.x_m > 3e-4) & (cam.x_m < 1.5e-3)]
        rest_N, coefficient = float(np.interp(0.0, cam.x_m, cam.normal_N)), float(np.median(riding))
        found = (
            f"{100 * start_N:.1f} cN + {slope / 10:.1f} cN/mm, "
            f"{100 * rest_N:.0f}, {100 * cam.preload_N:.0f} cN, "
            f"mu {coefficient:.2f} ({riding.min():.2f} to {riding.max():.2f}), "
            f"off at {1e3 * cam.x_m[cam.normal_N > 0].max():.1f} mm"
        )
        what = f"{name}: spring, cam force at rest and at closing"
        yield Line(what, found, "mu 0.1 to 0.3", 0.1 < coefficient < 0.3)


# -- V2: domes grow stiffer with speed --


def dome_gain(button: ButtonPhysics, fast_mm_s: float) -> float:
    """Return how much the peak grows from 0.5 mm/s to a faster probe."""
    peaks = []
    for speed_mm_s in (0.5, fast_mm_s):
        probed = probe_button(button, speed_mm_s)
        snap = probed.displacement_mm < 0.6 * probed.displacement_mm[-1]
        peaks.append(float(probed.press_cN[snap].max()))
    return peaks[1] / peaks[0] - 1


def domes() -> Iterator[Line]:
    for name in ("hp-pr1101u", "macbook-pro-2011"):
        button = load_button(name)
        for law in ("log", "linear"):
            chosen = replace(button, dome=replace(button.dome, law=law))
            gain, far = dome_gain(chosen, 80.0), dome_gain(chosen, 200.0)
            got = f"{gain:+.1%} (200 mm/s: {far:+.0%})"
            yield Line(f"V2 {name}, {law} law: 80 over 0.5 mm/s", got, "+12 to +15 %", 0.12 <= gain <= 0.15)


# -- V3: a tap on a rigid wall, by the pulp alone --


def tap(pulp: FingerPad, mass_kg: float, speed_m_s: float) -> tuple[float, float]:
    """Return the part of the energy that the pulp dissipates and the time to its peak force (ms)."""
    from scipy.integrate import solve_ivp

    a, beta, still = pulp.scale_N, pulp.exponent_1_m, pulp.relaxed_ratio
    shares = ((1 - still) * pulp.fast_share, (1 - still) * (1 - pulp.fast_share))

    def force(y: FloatArray) -> FloatArray:
        return np.asarray(still * a * np.expm1(beta * y[0]) + y[2] + y[3])

    def rates(_: float, y: FloatArray) -> list[float]:
        growth = a * beta * math.exp(beta * y[0]) * y[1]
        arms = [shares[0] * growth - y[2] / pulp.fast_s, shares[1] * growth - y[3] / pulp.slow_s]
        return [y[1], -float(force(y)) / mass_kg, *arms]

    def off(t: float, y: FloatArray) -> float:
        return float(force(y)) if t > 1e-4 else 1.0

    off.terminal, off.direction = True, -1  # type: ignore[attr-defined]
    found = solve_ivp(rates, (0, 0.5), [0, speed_m_s, 0, 0], rtol=1e-8, atol=1e-12, events=off, max_step=2e-4)
    return 1 - float(found.y[1, -1] / speed_m_s) ** 2, 1e3 * float(found.t[np.argmax(force(found.y))])


def taps() -> Iterator[Line]:
    lost, rise_ms = tap(FingerPad(), Finger().impedance.mass_kg, 0.25)
    yield Line(
        "V3 pulp tap at 0.25 m/s: energy dissipated", f"{lost:.0%}", "81 +- 3 %", abs(lost - 0.81) <= 0.03
    )
    softest = FingerPad(relaxed_ratio=0.2, fast_share=0.7, fast_s=0.003)
    most = tap(softest, Finger().impedance.mass_kg, 0.25)[0]
    yield Line(
        "V3 with relaxed 0.2, fast share 0.7 in 3 ms", f"{most:.0%}", "81 +- 3 %", abs(most - 0.81) <= 0.03
    )
    yield Line("V3 rise of the force", f"{rise_ms:.1f} ms", "< 5 ms", rise_ms < 5)


# -- V4: peak forces of typing --


def typed_peak_cN(button: ButtonPhysics, push_N: float, press_s: float = 0.06) -> float:
    """Type a key once with a bare finger that pushes lightly and does not dwell."""
    habit = replace(Finger().habit, push_N=push_N, dwell_s=0.0)
    finger = Finger(habit=habit)
    gesture = plan(finger, button.curve.travel_m, press_s)
    return float(simulate_button(button, finger, gesture, no_button_noise(gesture)).force_cN.max())


TYPED = ("macbook-pro-2011", "hp-pr1101u", "mx-clear")


def typing() -> Iterator[Line]:
    for push_N in (0.3, 0.5, 0.8):
        peaks = [typed_peak_cN(load_button(name), push_N) / 100 for name in TYPED]
        got = "{:.2f} / {:.2f} / {:.2f} N".format(*peaks)
        rising = peaks[0] < peaks[1] < peaks[2]
        yield Line(
            f"V4 peak, notebook / dome / spring, push {push_N} N", got, "0.59 / 0.68 / 0.86, rising", rising
        )
    dome = load_button("hp-pr1101u")
    for push_N in (0.3, 0.5, 0.8):
        peaks = [
            typed_peak_cN(replace(dome, curve=replace(dome.curve, force_ratio=make_N / 0.6)), push_N)
            for make_N in (0.47, 1.02)
        ]
        gain = peaks[1] / peaks[0] - 1
        yield Line(f"V4 peak, make force 0.47 to 1.02 N, push {push_N} N", f"{gain:+.0%}", "about +40 %",
                   0.3 <= gain <= 0.5)  # fmt: skip


# -- V6: the fixed step beside adaptive solvers --


def a_press(name: str, press_s: float) -> tuple[ButtonPhysics, Finger, Gesture, ForceSensor]:
    button, finger = load_button(name), Finger()
    return button, finger, plan(finger, button.curve.travel_m, press_s), ForceSensor()


def solvers() -> Iterator[Line]:
    for name in button_names():
        button, finger, gesture, sensor = a_press(name, 0.05)
        noise = draw_button_noise(finger, gesture, np.random.default_rng(1), sensor)
        fast = simulate_button(button, finger, gesture, noise, sensor, audit=True)
        slow = [reference_button(button, finger, gesture, noise, sensor, "DOP853")]
        if name == "mx-clear":
            slow.append(reference_button(button, finger, gesture, noise, sensor, "Radau", 1e-7))
        for method, other in zip(("DOP853", "Radau"), slow, strict=False):
            x_um = 1e3 * float(np.abs(fast.displacement_mm - other.displacement_mm).max())
            force_cN = rms(fast.force_cN - other.force_cN)
            yield Line(f"V6 {name}, 5 us steps less {method}", f"{x_um:.4f} um, {force_cN:.4f} cN rms",
                       "< 1 um, < 0.1 cN", x_um < 1 and force_cN < 0.1)  # fmt: skip
        part = unaccounted(fast)
        yield Line(
            f"V6 {name}, energy unaccounted for", f"{part:.1e} of a press's work", "< 1e-3", part < 1e-3
        )


def steps() -> Iterator[Line]:
    """Show how the error falls with the step."""
    button, finger, gesture, sensor = a_press("mx-clear", 0.05)
    noise = draw_button_noise(finger, gesture, np.random.default_rng(1), sensor)
    slow = reference_button(button, finger, gesture, noise, sensor)
    for step_s in (2.5e-6, 5e-6, 10e-6, 20e-6):
        try:
            fast = simulate_button(button, finger, gesture, noise, sensor, step_s)
            got = f"{rms(fast.force_cN - slow.force_cN):.4f} cN rms"
        except FdvvError:
            got = "diverges"
        yield Line(f"V6 mx-clear, steps of {1e6 * step_s:g} us less DOP853", got, "shown", True)


def unaccounted(trace: ButtonTrace) -> float:
    """Return the largest energy unaccounted for over the work that the finger does on the cap."""
    assert trace.energy_J is not None
    down = np.maximum(np.diff(trace.displacement_mm), 0.0)
    work_J = 1e-5 * float(np.sum(trace.force_cN[1:] * down))
    return float(np.abs(trace.energy_J).max()) / work_J


def main() -> None:
    print("simulated; V: line of the validation plan in docs/explanation/real-buttons.md")
    parts = [identified(), statics(), domes(), taps(), typing(), solvers(), steps(), budget()]
    if len(sys.argv) > 1:
        parts.insert(2, held_out(Path(sys.argv[1])))
    for part in parts:
        for line in part:
            print(f"{line.what:<62} {line.got:<52} {line.wanted:<28} {'met' if line.met else 'NOT MET'}")


if __name__ == "__main__":
    main()
