"""How well is the vibration of a snap measured from presses of the twin's buttons? Simulated; four minutes.

Run as ``python -m benchmarks.vibration``, or with the sensors wanted and the first seed. Truth: onset is when
the leaf first strikes the fixed contact (press) or the cam begins to take its load off it (release);
frequency and decay are those of the plate's first mode; duration is that in which its envelope falls to a
tenth. Sensors:

mic_1k   the capture bench's microphone: RC filter, 1 kHz, 10 bit, no filter against aliases
mic_10k  the same sound at 10 kHz, 16 bit, without the RC filter, with the same noise per sample
plate    an accelerometer on the housing, 10 kHz, 0.03 m/s2 rms per sample (40 ug/sqrt(Hz))
"""

from __future__ import annotations

import math
import sys
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np

from fdvv.model.curve import Stroke
from fdvv.twin.button import ButtonPhysics
from fdvv.twin.capture.rig import CaptureRig
from fdvv.twin.files import button_names, load_button
from fdvv.twin.finger import Finger
from fdvv.twin.gesture import vary
from fdvv.twin.pace import solve_button_pace
from fdvv.twin.rig import ForceSensor
from fdvv.twin.simulate_button import ButtonTrace, draw_button_noise, simulate_button
from fdvv.units import FloatArray, cN_from_N, mm_from_m
from fdvv.vibration.damped import cramer_rao, duration_s
from fdvv.vibration.pool import MeasuredVibration, SnapEnergy, snap_energy
from fdvv.vibration.shared import PacePresses, measure_paces
from fdvv.vibration.snap import HeardPress, NotFound, Snap, find_snap

SENSORS = ("mic_1k", "mic_10k", "plate")
PACES_mm_s = (50.0, 100.0, 150.0, 200.0)
PRESSES, FIRST_SEED = 15, 100
BENCH_BIAS_mm = 0.1
"""Scatter between takes of where the cap is seen to rest, as the capture bench has it."""
PLATE_NOISE_m_s2 = 0.03
BLIND_mm = (0.2, 0.85)
"""Window for a search without a fall of force, in parts of the travel: the middle of the stroke."""


@dataclass(frozen=True)
class Case:
    """One press of one stroke: what a bench has of it, and the truth."""

    press: HeardPress
    onset_s: float
    trace: ButtonTrace


def traces(name: str, velocity_mm_s: float, seeds: Sequence[int]) -> list[ButtonTrace]:
    """Press a button; incomplete presses are left out as a bench would."""
    button, finger, sensor = load_button(name), Finger(), ForceSensor()
    press_s, found = solve_button_pace(button, finger, velocity_mm_s, sensor), []
    for seed in seeds:
        random = np.random.default_rng(seed)
        gesture = vary(finger, button.curve.travel_m, press_s, velocity_mm_s / 1e3, random)
        noise = draw_button_noise(finger, gesture, random, sensor)
        trace = simulate_button(button, finger, gesture, noise, sensor)
        if trace.displacement_mm.max() >= mm_from_m(button.curve.travel_m) and trace.opening_s is not None:
            found.append(trace)
    return found


def heard(
    trace: ButtonTrace, sensor: str, random: np.random.Generator
) -> tuple[FloatArray, FloatArray, float]:
    """Return times (the filter's delay taken off), signal and noise per sample."""
    rig = CaptureRig()
    if sensor == "mic_1k":
        lsb = rig.sound_range_V / 2**rig.sound_bits
        volts = heard_V(trace, rig)[trace.tick] + rig.sound_noise_V * random.standard_normal(trace.tick.sum())
        noise = math.hypot(rig.sound_noise_V, lsb / math.sqrt(12))
        return trace.t_s[trace.tick] - rig.sound_filter_s, lsb * np.round(volts / lsb), noise
    step = float(trace.t_s[1])
    if sensor == "plate":
        clean = 1e-3 * np.gradient(trace.plate_velocity_mm_s, step)
        return trace.t_s, clean + PLATE_NOISE_m_s2 * random.standard_normal(clean.size), PLATE_NOISE_m_s2
    wide = heard_V(trace, replace(rig, sound_filter_s=0.0))
    lsb = rig.sound_range_V / 2**16
    volts = wide + rig.sound_noise_V * random.standard_normal(wide.size)
    return trace.t_s, lsb * np.round(volts / lsb), rig.sound_noise_V


def heard_V(trace: ButtonTrace, rig: CaptureRig) -> FloatArray:
    """Return what the microphone makes of a press before noise and converter, on the trace's rows."""
    from scipy.signal import lfilter

    step = float(trace.t_s[1])
    moved = 1e-3 * rig.sound_V_s_m * (trace.velocity_mm_s + trace.plate_velocity_mm_s)
    high = lfilter([1.0, -1.0], [1.0, -math.exp(-2 * math.pi * rig.sound_low_Hz * step)], moved)
    fade = math.exp(-step / rig.sound_filter_s) if rig.sound_filter_s else 0.0
    return np.asarray(lfilter([1 - fade], [1.0, -fade], high))


def onset_s(trace: ButtonTrace, stroke: Stroke) -> float:
    """Return the truth: the leaf strikes the contact, or the cam begins to take its load off it."""
    assert trace.closing_s is not None
    assert trace.opening_s is not None
    if stroke is Stroke.PRESS:
        return trace.closing_s
    end = int(np.searchsorted(trace.t_s, trace.opening_s))
    held = float(np.median(trace.fixed_cN[max(0, end - 400) : end - 150]))
    loaded = np.flatnonzero(trace.fixed_cN[:end] >= 0.97 * held)
    # a dome has no leaf: its circuit opening is all there is
    return float(trace.t_s[loaded[-1]]) if held > 0 and loaded.size else trace.opening_s


def cases(made: list[ButtonTrace], stroke: Stroke, sensor: str) -> list[Case]:
    found = []
    for number, trace in enumerate(made):
        random = np.random.default_rng([number, SENSORS.index(sensor), stroke is Stroke.PRESS])
        t, signal, noise = heard(trace, sensor, random)
        seen_mm = trace.displacement_mm + BENCH_BIAS_mm * random.standard_normal()
        press = HeardPress(t, signal, trace.t_s, seen_mm, stroke, noise)
        found.append(Case(press, onset_s(trace, stroke), trace))
    return found


def energy_of(button: ButtonPhysics, stroke: Stroke) -> SnapEnergy | None:
    """Measure the fall of force on the slow curve."""
    force = cN_from_N(button.press_N if stroke is Stroke.PRESS else button.release_N)
    return snap_energy(mm_from_m(button.curve.step_m) * np.arange(force.size), force)


def window_of(button: ButtonPhysics, energy: SnapEnergy | None) -> tuple[float, float]:
    travel_mm = float(mm_from_m(button.curve.travel_m))
    return energy.window_mm if energy else (BLIND_mm[0] * travel_mm, BLIND_mm[1] * travel_mm)


def single(found: list[Case], window_mm: tuple[float, float]) -> str:
    """Return how many single presses show a turn, and how far from the truth."""
    snaps = [find_snap(case.press, window_mm) for case in found]
    pairs = zip(found, snaps, strict=True)
    errors = np.array([1e3 * (s.onset_s - case.onset_s) for case, s in pairs if isinstance(s, Snap)])
    if not errors.size:
        return f"one press: 0/{len(found)} found"
    low, middle, high = np.percentile(errors, [5, 50, 95])
    inside = np.mean(np.abs(errors) <= 1)
    return (
        f"one press: {errors.size}/{len(found)} found, onset {middle:+.2f} ({low:+.2f} to {high:+.2f}) ms, "
        f"{100 * inside:.0f} % within 1 ms"
    )


def pooled(found: list[Case], measured: MeasuredVibration | NotFound, button: ButtonPhysics) -> str:
    """Return errors of the pooled vibration."""
    if isinstance(measured, NotFound):
        return f"pooled: not found ({measured.reason})"
    true_mm = np.median([np.interp(c.onset_s, c.trace.t_s, c.trace.displacement_mm) for c in found])
    off_ms = 1e3 * (measured.onset_mm.value - true_mm) / measured.snap_velocity_mm_s.value
    by_press = {id(case.press): case.onset_s for case in found}
    pairs = zip(measured.heard, measured.snaps, strict=True)
    shown = [1e3 * (snap.onset_s - by_press[id(press)]) for press, snap in pairs]
    text = (
        f"pooled: {measured.shown}/{measured.presses} show it, {100 * np.mean(np.abs(shown) <= 1):.0f} % "
        f"of them within 1 ms, onset_mm off by {off_ms:+.2f} ms"
    )
    if isinstance(measured.ring, NotFound):
        return f"{text}; ring not found ({measured.ring.reason})"
    f, d = true_mode(button)
    mode, lasts = measured.ring.mode, measured.ring.duration_s
    return (
        f"{text}; {mode.frequency_Hz:.0f} +- {mode.frequency_sd_Hz:.1f} Hz "
        f"({100 * (mode.frequency_Hz / f - 1):+.1f} %), {1e3 * lasts:.1f} +- "
        f"{1e3 * measured.ring.duration_sd_s:.1f} ms ({100 * (lasts / duration_s(d) - 1):+.0f} %), "
        f"left over {measured.ring.noise_ratio:.1f} x noise"
    )


def true_mode(button: ButtonPhysics) -> tuple[float, float]:
    """Return frequency (Hz) and decay (1/s) at which the plate's first mode rings."""
    h = button.housing
    full = 2 * math.pi * h.first_Hz
    return h.first_Hz * math.sqrt(1 - h.first_damping_ratio**2), full * h.first_damping_ratio


def bound(found: list[Case], sensor: str, button: ButtonPhysics) -> str:
    """Return what noise alone leaves of frequency and duration, were the onset known: Cramer and Rao."""
    f, d = true_mode(button)
    # as much of the first mode as the true plate's motion holds after the onset, by least squares
    times, weights = [], []
    for case in found:
        stop = float(np.interp(0.98, [0, 1], [case.onset_s, case.onset_s + 0.025]))
        after = (case.trace.t_s >= case.onset_s) & (case.trace.t_s < min(stop, until(case)))
        t = case.trace.t_s[after] - case.onset_s
        if t.size < 40:
            continue
        fall, turn = np.exp(-d * t), 2 * np.pi * f * t
        matrix = np.column_stack([fall * np.sin(turn), fall * np.cos(turn), np.vander(t, 4)])
        solved = np.linalg.lstsq(matrix, 1e-3 * case.trace.plate_velocity_mm_s[after], rcond=None)[0]
        weights.append(float(np.hypot(*solved[:2])))
        period = case.press.period_s
        times.append(np.arange(0.5 * period, t[-1], period))
    if not times:
        return "bound: the stop follows too soon"
    scale = {"mic_1k": 2.0 * 0.84, "mic_10k": 2.0, "plate": 2 * math.pi * f}[sensor]
    noise = found[0].press.noise_rms
    f_sd, d_sd = cramer_rao(times, (f, d, scale * float(np.median(weights)), 0.0), noise, 2)
    return f"bound of the pooled: {100 * f_sd / f:.1f} % of frequency, {100 * d_sd / d:.0f} % of duration"


def until(case: Case) -> float:
    """Return when the stop is truly hit."""
    x, t = case.trace.displacement_mm, case.trace.t_s
    hit = (t > case.onset_s) & ((x >= x.max() - 0.05) if case.press.stroke is Stroke.PRESS else (x <= 0.02))
    return float(t[hit][0]) if hit.any() else float(t[-1])


def main(sensors: Sequence[str] = SENSORS, first_seed: int = FIRST_SEED) -> None:
    seeds = range(first_seed, first_seed + PRESSES)
    print(f"{PRESSES} presses a case, seeds {seeds.start} to {seeds.stop - 1}, simulated")
    for name in button_names():
        made = {pace: traces(name, pace, seeds) for pace in PACES_mm_s}
        for sensor in sensors:
            for line in lines(load_button(name), made, sensor):
                print(f"{name} {line}", flush=True)


def lines(button: ButtonPhysics, made: dict[float, list[ButtonTrace]], sensor: str) -> Iterator[str]:
    """Measure both strokes at all paces; what one tells serves the others."""
    found = [(stroke, pace, cases(made[pace], stroke, sensor)) for stroke in Stroke for pace in made]
    paces = [
        PacePresses(stroke, pace, tuple(case.press for case in group), energy_of(button, stroke))
        for stroke, pace, group in found
    ]
    measured, _ = measure_paces(paces, sensor == "plate")
    for (stroke, pace, group), one, presses in zip(found, measured, paces, strict=True):
        blind = "" if presses.energy else " (no fall of force, searched blindly)"
        parts = single(group, window_of(button, presses.energy)) + blind, pooled(group, one, button)
        yield f"{stroke} {pace:g} mm/s {sensor}: {'; '.join([*parts, bound(group, sensor, button)])}"


if __name__ == "__main__":
    words = sys.argv[1:]
    main(words[0].split(",") if words else SENSORS, int(words[1]) if len(words) > 1 else FIRST_SEED)
