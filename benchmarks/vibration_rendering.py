"""How like its target is a rendered vibration, plain and through the exciter's inverse? Simulated.

Run as ``python -m benchmarks.vibration_rendering``, with --rigs N for fewer drawn rigs. Rigs and fingers are
drawn over the ranges that their parameters state; none of their seeds was used to choose a setting.
"""

from __future__ import annotations

import argparse
from collections.abc import Iterator
from dataclasses import dataclass, replace
from functools import cache, cached_property

import numpy as np

from fdvv.device.boards import HostBoard
from fdvv.device.linked import LinkedDevice
from fdvv.device.twin import SimulatedPerson
from fdvv.errors import FdvvError, ModelError
from fdvv.firmware.core import Core
from fdvv.model.curve import Stroke
from fdvv.model.file import load_builtin
from fdvv.model.surface import ForceSurface
from fdvv.model.vibration import Mode, Vibration
from fdvv.program.button import button_program
from fdvv.program.compile import compile_program
from fdvv.program.render_vibration import render_vibration
from fdvv.program.surface import Limits
from fdvv.program.synth import RATE_HZ, ConvertedVibration, Slot, Waveform
from fdvv.protocol.tables import NONE, Settings
from fdvv.rendering.exciter import identify_exciter, tone_image
from fdvv.twin.draw import draw_finger, draw_rig
from fdvv.twin.finger import Finger
from fdvv.twin.gesture import plan
from fdvv.twin.image import image_of
from fdvv.twin.pace import solve_program_pace
from fdvv.twin.plant import RigPlant
from fdvv.twin.rig import Rig
from fdvv.twin.settings import settings_of
from fdvv.twin.trace import Trace
from fdvv.units import FloatArray, m_from_mm
from fdvv.vibration.exciter import KnownExciter, measure_tone
from fdvv.vibration.inverse import (
    InverseSettings,
    acceleration_m_s2,
    correlation,
    drive_for,
    spectral_similarity,
    spqi,
    st_sim,
)
from tests.support.loop import AWAY

FIRST_SEED = 2000
"""Below it seeds were used to choose settings."""
RIGS = 40
UNO_s = 2e-4
SPEEDS_mm_s = (50.0, 100.0, 200.0)
AT_mm = 2.0
WINDOW_s = 0.01
"""Looked at beyond a vibration's end, as in rig_vibration."""
BUTTON = load_builtin("mx-clear")
SURFACE = ForceSurface.of_model(BUTTON, [50.0, 100.0, 150.0, 200.0])
TARGETS = {
    "239 Hz, 16 ms": ((239.0, 4.6, np.log(5) / 0.016),),
    "150 Hz, 20 ms": ((150.0, 3.0, 80.0),),
    "400 Hz, 10 ms": ((400.0, 8.0, 200.0),),
    "239 + 480 Hz, 16 ms": ((239.0, 4.0, 100.0), (480.0, 3.0, 150.0)),
}
LASTS_s = {"239 Hz, 16 ms": 0.016, "150 Hz, 20 ms": 0.02, "400 Hz, 10 ms": 0.01, "239 + 480 Hz, 16 ms": 0.016}


def target(name: str) -> Vibration:
    modes = tuple(Mode(*numbers) for numbers in TARGETS[name])
    return Vibration(Stroke.PRESS, None, AT_mm, LASTS_s[name], modes)


def uno(rig: Rig) -> Rig:
    """Return the rig with a synthesiser without jitter and no card, so that two presses can be subtracted."""
    return replace(rig, exciter=replace(rig.exciter, latency_s=UNO_s, jitter_s=0.0))


def true_exciter(rig: Rig) -> KnownExciter:
    """Return what the free cap and the magnet would do, from the rig's parameters: nobody can know it."""
    e, frame_kg = rig.exciter, rig.frame_kg
    reduced_kg = e.mass_kg * frame_kg / (e.mass_kg + frame_kg)
    held = 2 * np.pi * e.resonance_Hz
    stiffness = e.mass_kg * held**2
    damping = e.mass_kg * held / e.quality + e.motor_N_A**2 / e.resistance_ohm
    volts_V = e.drive_V / 2.5
    return KnownExciter(
        e.motor_N_A / e.resistance_ohm / frame_kg * volts_V,
        float(np.sqrt(stiffness / reduced_kg) / 2 / np.pi),
        float(np.sqrt(stiffness * reduced_kg) / damping),
    )


@dataclass(frozen=True)
class Bench:
    """A rig, a finger and a button, to press with and without a slot.

    lead_s : the latency that the firmware is set to beyond the board's own.
    """

    rig: Rig
    finger: Finger
    lead_s: float = 0.0

    @cached_property
    def settings(self) -> Settings:
        return replace(settings_of(self.rig), vibration_latency_us=round(1e6 * (UNO_s + self.lead_s)))

    def press(self, slot: Slot, velocity_mm_s: float) -> Trace:
        """Return a press without noise."""
        silent = Vibration(Stroke.PRESS, None, AT_mm, 0.01, (Mode(100.0, 1.0, 0.0),))
        program = button_program(replace(BUTTON, vibrations=(silent,)), SURFACE)
        limits = replace(Limits(), weight_cN=0.0)
        image = compile_program(program, limits, lambda _: ConvertedVibration(slot, 0.0, 0.0)).image
        pace_s = pace_of(self, velocity_mm_s)
        core = Core(self.settings, image)
        core.announce(round(16 * velocity_mm_s))
        core.arm()
        stop_us = self.settings.stop_zero_us + self.settings.stop_us_mm * BUTTON.travel_mm
        plant = RigPlant(self.rig, self.finger, seed=None, stop_us=stop_us)
        plant.load(image)
        gesture = plan(self.finger, float(m_from_mm(BUTTON.travel_mm)), pace_s)
        plant.press(replace(gesture, onset_s=0.1))
        for _ in range(round((0.16 + pace_s) / self.rig.controller.tick_s)):
            out = core.tick(plant.inputs)
            plant.step(out["duty_q15"], out["enable"], out["stop_us"], out["slot"])
        return plant.record()

    def added(self, slot: Slot, velocity_mm_s: float, lasts_s: float) -> tuple[FloatArray, float]:
        """Return the acceleration that a slot adds, from a tenth of its largest value on, and its rate."""
        with_it, without = self.press(slot, velocity_mm_s), silent_press(self, velocity_mm_s)
        found = with_it.cap_acceleration_m_s2 - without.cap_acceleration_m_s2
        begun = int(np.argmax(np.abs(found) > 0.1 * np.abs(found).max()))
        rate_Hz = float(1 / (with_it.t_s[1] - with_it.t_s[0]))
        return found[begun : begun + round((lasts_s + WINDOW_s) * rate_Hz)], rate_Hz

    def late_ms(self, slot: Slot, wanted: Vibration, velocity_mm_s: float) -> float:
        """Return how much later than the cap's crossing the waveform lies that is most alike."""
        with_it, without = self.press(slot, velocity_mm_s), silent_press(self, velocity_mm_s)
        step_s = float(with_it.t_s[1] - with_it.t_s[0])
        # the twin's exciter is connected so that volts push the cap outward
        added = without.cap_acceleration_m_s2 - with_it.cap_acceleration_m_s2
        crossed = int(np.argmax(without.displacement_mm >= AT_mm))
        shape = wanted.acceleration_m_s2(np.arange(round(wanted.duration_s / step_s)) * step_s)
        same_sign = np.correlate(added, shape, "valid")
        return 1e3 * step_s * (int(np.argmax(same_sign)) - crossed)


@cache
def silent_press(bench: Bench, velocity_mm_s: float) -> Trace:
    return bench.press(Slot(Waveform.SINE, 16, 1, 0), velocity_mm_s)


@cache
def pace_of(bench: Bench, velocity_mm_s: float) -> float:
    return solve_program_pace(
        bench.rig, bench.finger, image_of(SURFACE, BUTTON.travel_mm).image, velocity_mm_s
    )


def likenesses(bench: Bench, slot: Slot, wanted: Vibration, velocity_mm_s: float) -> list[float]:
    """Score what a slot adds: correlation (V13), spectrum, ST-SIM, SPQI, and strength over that asked for."""
    felt, rate_Hz = bench.added(slot, velocity_mm_s, wanted.duration_s)
    t_s = np.arange(round((wanted.duration_s + WINDOW_s) * rate_Hz)) / rate_Hz
    shape = wanted.acceleration_m_s2(t_s)
    scores = [f(felt, shape, rate_Hz) for f in (spectral_similarity, st_sim, spqi)]
    like = correlation(felt, shape)
    return [like, *scores, like * float(np.linalg.norm(felt) / np.linalg.norm(shape))]


def plain_slot(wanted: Vibration) -> Slot:
    """Play the waveform as it is, as strong as its largest count allows."""
    from fdvv.program.synth import slot_of_vibration

    t_s = np.linspace(0, wanted.duration_s, 2001)
    strongest = max(float(np.abs(wanted.acceleration_m_s2(t_s)).max()), wanted.modes[0].amplitude_m_s2)
    return slot_of_vibration(wanted, 1990 / strongest).slot


def drawn(count: int, first: int = FIRST_SEED) -> Iterator[Bench]:
    """Draw rigs that a firmware can hold."""
    seed = first
    while count:
        random = np.random.default_rng(seed)
        rig, finger, seed = uno(draw_rig(random)), draw_finger(random), seed + 1
        try:
            settings_of(rig)
        except ModelError:
            continue
        count -= 1
        yield Bench(rig, finger)


def known_by_tones(bench: Bench, seed: int) -> KnownExciter | None:
    """Identify the exciter through the host board; None where its tones do not rise from the noise."""
    device = LinkedDevice(HostBoard(), SimulatedPerson(bench.rig, bench.finger, seed))
    try:
        return identify_exciter(device)
    except FdvvError:
        return None
    finally:
        device.close()


def summary(rows: list[list[float]]) -> str:
    """Write medians with the 5th and 95th percentile."""
    low, middle, high = np.percentile(np.array(rows), [5, 50, 95], axis=0)
    return "  ".join(f"{m:.2f} ({a:.2f}–{b:.2f})" for a, m, b in zip(low, middle, high, strict=True))


def print_identified(benches: list[Bench], known: list[KnownExciter | None]) -> None:
    found = [(k, true_exciter(b.rig)) for k, b in zip(known, benches, strict=True) if k]
    print(f"identified by tones of 3 s through the position sensor: {len(found)} of {len(benches)}")
    for name in ("gain_m_s2_V", "resonance_Hz", "quality"):
        ratio = np.array([getattr(k, name) / getattr(t, name) for k, t in found])
        error = np.median([k.error[name] for k, _ in found])
        low, middle, high = np.percentile(ratio, [5, 50, 95])
        print(f"  {name:14} found over true {middle:.2f} ({low:.2f}–{high:.2f}), standard error {error:.2f}")


def print_likeness(benches: list[Bench], known: list[KnownExciter | None]) -> None:
    columns = "correlation, spectrum, ST-SIM, SPQI, strength"
    for name in TARGETS:
        wanted = target(name)
        print(f"{name}: {columns}; median (5–95 %) over {len(benches)} rigs")
        for speed in SPEEDS_mm_s:
            rows: dict[str, list[list[float]]] = {"plain": [], "inverse, identified": [], "inverse, true": []}
            for bench, found in zip(benches, known, strict=True):
                rows["plain"].append(likenesses(bench, plain_slot(wanted), wanted, speed))
                truth = render_vibration(wanted, true_exciter(bench.rig)).slot
                rows["inverse, true"].append(likenesses(bench, truth, wanted, speed))
                slot = render_vibration(wanted, found).slot if found else plain_slot(wanted)
                rows["inverse, identified"].append(likenesses(bench, slot, wanted, speed))
            for way, scores in rows.items():
                print(f"  {speed:4g} mm/s {way:20} {summary(scores)}")


def print_settings() -> None:
    """Lead and gain of the inverse on rigs below FIRST_SEED, at 50 mm/s."""
    print("choice of lead and gain, 239 Hz, 16 ms, 12 rigs of other seeds, 50 mm/s: correlation, strength")
    benches, wanted = list(drawn(12, 900)), target("239 Hz, 16 ms")
    for lead_ms in (0.0, 0.5, 1.0, 2.0):
        for gain_dB in (5.0, 10.0, 15.0, 20.0):
            settings = InverseSettings(gain_dB=gain_dB, lead_s=1e-3 * lead_ms)
            rows = []
            for bench in benches:
                slot = render_vibration(wanted, true_exciter(bench.rig), settings).slot
                scores = likenesses(bench, slot, wanted, 50.0)
                rows.append([scores[0], scores[-1]])
            print(f"  lead {lead_ms:g} ms, gain {gain_dB:2g} dB: {summary(rows)}")


def print_fingers() -> None:
    """One rig, one drive, many fingers."""
    rig, wanted = uno(Rig()), target("239 Hz, 16 ms")
    slot = render_vibration(wanted, true_exciter(rig)).slot
    rows = [
        likenesses(Bench(rig, draw_finger(np.random.default_rng(FIRST_SEED + i))), slot, wanted, 50.0)
        for i in range(20)
    ]
    print(f"rig voltage, one drive, 20 drawn fingers, 50 mm/s: {summary(rows)}")


def print_tones() -> None:
    """Default rig at rest: what a tone does to the cap, and what the position sensor makes of it."""
    rig = uno(Rig())
    free, settings = true_exciter(rig), settings_of(rig)
    frequencies, tone_s = [200.0, 260.0, 300.0, 400.0, 580.0, 740.0, 930.0], 3.0
    core = Core(settings, tone_image(frequencies, tone_s))
    core.arm()
    plant = RigPlant(rig, AWAY, seed=1, stop_us=settings.stop_zero_us + 4 * settings.stop_us_mm)
    plant.load(tone_image(frequencies, tone_s))
    sensor = rig.position_sensor
    print("rig voltage, tones of 3 s at rest: cap and sensor over the free cap's motion, error um")
    for slot in (None, *range(len(frequencies))):
        positions_m = []
        for k in range(round((tone_s - 0.02) / rig.controller.tick_s)):
            out = core.tick(plant.inputs)
            plant.step(out["duty_q15"], out["enable"], out["stop_us"], NONE if slot is None or k else slot)
            positions_m.append(float(out["displacement_um16"]) / 16e6)
        trace = plant.record()
        if slot is None:
            continue
        f = frequencies[slot]
        begun = round(0.1 / rig.controller.tick_s)
        t_s: FloatArray = np.arange(len(positions_m), dtype=np.float64) * rig.controller.tick_s
        seen = measure_tone(t_s[begun:], np.array(positions_m)[begun:], f)
        late = trace.t_s > 0.1
        moved = measure_tone(trace.t_s[late], 1e-3 * trace.displacement_mm[late], f).amplitude
        alone = 2047 / 2048 * 2.5 * abs(complex(free.response(f))) / (2 * np.pi * f) ** 2
        passed = np.sinc(f * sensor.burst_s) / np.hypot(1, f / sensor.bandwidth_Hz)
        print(
            f"  {f:4g} Hz: {moved / alone:.2f}  {seen.amplitude / alone / passed:.2f}  {1e6 * seen.error:.2f}"
        )


def print_filter() -> None:
    """The inverse as a filter in frequency, cut to what a slot may last, against least squares in time."""
    free, wanted = true_exciter(uno(Rig())), target("239 Hz, 16 ms")
    times = (np.arange(8192) + 0.5) / RATE_HZ
    shape = wanted.acceleration_m_s2(times)
    response = free.response(np.fft.rfftfreq(times.size, 1 / RATE_HZ))
    strong = abs(complex(free.response(239.0)))
    print("expected on the rig voltage, drive of 20 ms: likeness")
    print(f"  the waveform as it is {correlation(acceleration_m_s2(free, shape), shape):.2f}")
    for gain_dB in (5.0, 10.0, 15.0, 20.0):
        bound = (strong / 2 / 10 ** (gain_dB / 20)) ** 2
        spectrum = np.fft.rfft(shape) * np.conj(response) / (np.abs(response) ** 2 + bound)
        drive = np.where(times < 0.02, np.fft.irfft(spectrum, times.size), 0.0)
        filtered = correlation(acceleration_m_s2(free, drive), shape)
        fitted = drive_for(free, wanted, InverseSettings(gain_dB=gain_dB, lead_s=0.0)).likeness
        print(f"  {gain_dB:2g} dB: filter in frequency {filtered:.2f}, least squares in time {fitted:.2f}")


def print_onset() -> None:
    """Default rig: when the waveform lies where it is most like the target."""
    rig, wanted = uno(Rig()), target("239 Hz, 16 ms")
    made = render_vibration(wanted, true_exciter(rig))
    print("rig voltage, 0.2 ms synthesiser: the waveform after its displacement, ms, at mm/s")
    for name, slot, lead_s in (
        ("plain", plain_slot(wanted), 0.0),
        ("inverse, lead not positions_m", made.slot, 0.0),
        ("inverse, lead positions_m", made.slot, made.lead_s),
    ):
        bench = Bench(rig, Finger(), lead_s)
        late = [bench.late_ms(slot, wanted, v) for v in (50.0, 100.0, 150.0, 200.0, 300.0)]
        print(f"  {name:24}" + "".join(f"{ms:+7.1f}" for ms in late))


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--rigs", type=int, default=RIGS)
    count = parser.parse_args().rigs
    print("vibrations on the cap, MX Clear, at 2 mm; simulated")
    print_settings()
    print_filter()
    print_tones()
    print_fingers()
    print_onset()
    benches = list(drawn(count))
    known = [known_by_tones(bench, FIRST_SEED + i) for i, bench in enumerate(benches)]
    print_identified(benches, known)
    print_likeness(benches, known)


if __name__ == "__main__":
    main()
