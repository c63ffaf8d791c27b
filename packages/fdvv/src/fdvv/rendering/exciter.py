"""Identification of a rig's exciter: play tones and measure the cap with the rig's position sensor."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace

import numpy as np

from fdvv.compensation.identification.rig_model import RigModel
from fdvv.device.contract import Device
from fdvv.device.remote import Remote
from fdvv.errors import DeviceError, FitError, InputError
from fdvv.model.vibration import Mode
from fdvv.program.compile import compile_program
from fdvv.program.program import Program, Signal, State
from fdvv.program.surface import Limits, Surface
from fdvv.protocol.tables import Settings
from fdvv.rendering.press_made import clear_latched
from fdvv.units import FloatArray
from fdvv.vibration.exciter import (
    FULL_SCALE_V,
    KnownExciter,
    ToneBench,
    clear_frequencies_Hz,
    clock_ratio,
    fit_exciter,
    measure_tone,
)
from fdvv.vibration.inverse import InverseSettings

TONES_Hz = np.arange(260.0, 861.0, 40.0)
"""Below this range friction holds the cap, above it the cap hardly moves."""
APART_Hz = 150.0
TRAVEL_mm, SPRING_cN_mm = 4.0, 20.0
"""The motor holds the cap at mid travel on a spring too soft to affect the measurement."""
SETTLE_s, START_s, END_s = 0.6, 0.1, 0.02
"""Assumed: until the cap has come up to mid travel, until a tone is steady, and a margin before its end."""
LONGEST_s = 4.0  # a slot lasts 65,535 samples at 16 kHz at most: 4.096 s
COUNTS = 2047  # full amplitude of the board's 12-bit converter (synth.AMPLITUDE_MAX_counts)
KNOWN_LAG_ratio = 0.1  # assumed; of some 0.9 ms 0.11 ms are uncertain (docs/explanation/identification.md)
Progress = Callable[[int, int], None]
Record = tuple[FloatArray, FloatArray]


def identify_exciter(
    device: Device,
    rig: RigModel | None = None,
    tone_s: float = 3.0,
    progress: Progress = lambda _done, _total: None,
    notice: Callable[[str], None] = lambda _text: None,
) -> KnownExciter:
    """Play tones one after the other on an untouched cap, and fit the exciter to its motion.

    rig : gives the lag of the position sensor; without it the gain is uncertain by a third.
    progress, notice : called after every tone, and with notices.
    tone_s : duration of each of about 14 tones; errors fall with its root. The device is left without force,
    with the program of the tones. Raises InputError if it cannot play on command, DeviceError, FitError.
    """
    if not isinstance(device, Remote):
        reason = "it plays vibrations within presses only"
        raise InputError("--device", device.info().name, reason, "use host or serial:PORT")
    if not 0.3 <= tone_s <= LONGEST_s:
        raise InputError("--tone-s", f"{tone_s:g}", "out of range", f"choose 0.3 to {LONGEST_s:g} s")
    settings = device.settings()
    frequencies = clear_frequencies_Hz(TONES_Hz, 1e6 / settings.tick_us, APART_Hz).tolist()
    clear_latched(device, notice)
    device.upload_program(tone_image(frequencies, tone_s))
    records = _records(device, len(frequencies), tone_s, progress)
    ratio = clock_ratio(records, frequencies)
    tones = [measure_tone(*record, f * ratio) for record, f in zip(records, frequencies, strict=True)]
    bench = ToneBench(COUNTS * FULL_SCALE_V / 2048)
    if rig and rig.position_lag_s > 0:
        bench = replace(bench, lag_s=rig.position_lag_s, lag_ratio=KNOWN_LAG_ratio)
    info = device.info()
    try:
        return fit_exciter(tones, bench, 1e-6 * settings.vibration_latency_us, info.simulated)
    except FitError as error:
        reason = f"{error}; check that the exciter plays and nobody touches"
        raise FitError(f"{info.name}: {reason}") from error


def tone_image(frequencies_Hz: Sequence[float], tone_s: float) -> bytes:
    """Return the program that holds the cap at mid travel, with a steady tone in each slot."""
    middle_cN = SPRING_cN_mm * TRAVEL_mm / 2
    hold = Surface("hold", (0.0, TRAVEL_mm), ((-middle_cN, middle_cN),))
    signals = tuple(Signal(f"{f:g} Hz", tone_s, (Mode(f, float(COUNTS), 0.0),)) for f in frequencies_Hz)
    program = Program("tones", TRAVEL_mm, "hold", (State("hold", "hold", "hold"),), (hold,), signals)
    return compile_program(program, replace(Limits(), counts_per_m_s2=1.0)).image


def with_lead(settings: Settings, exciter: KnownExciter, lead_s: float | None = None) -> Settings:
    """Return settings that start vibrations early by latency and drive lead; unchanged without a latency.

    lead_s : of the drive; that of InverseSettings if None.
    """
    if exciter.latency_s is None:
        return settings
    lead = InverseSettings().lead_s if lead_s is None else lead_s
    return replace(settings, vibration_latency_us=round(1e6 * (exciter.latency_s + lead)))


def prepare_exciter(device: Device, exciter: KnownExciter) -> None:
    """Configure a device with with_lead(); unless that changes nothing, it loses its program."""
    before = device.settings()
    wanted = with_lead(before, exciter)
    if wanted != before:
        device.configure(wanted)


def _records(device: Remote, count: int, tone_s: float, progress: Progress) -> list[Record]:
    client, port = device.client, device.client.port
    client.stream(1)
    try:
        client.arm()
        client.listen(port.now_s() + SETTLE_s)
        records = []
        for slot in range(count):
            client.vibrate(slot)
            client.listen(port.now_s() + START_s)
            client.telemetry.clear()
            client.listen(port.now_s() + tone_s - START_s - END_s)
            telemetry = client.telemetry.columns()
            if telemetry.tick.size < 20:
                raise DeviceError(f"{port.name}: no telemetry arrived during a tone")
            t_s = (telemetry.tick - telemetry.tick[0]) * 1e-6 * device.settings().tick_us
            records.append((t_s, 1e-3 * telemetry.displacement_mm))
            client.listen(port.now_s() + END_s + START_s)
            progress(slot + 1, count)
        return records
    finally:
        device.stop()
