"""What a finger on the rig feels of a vibration: how late, how strong, how alike its target. Simulated."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from fdvv.firmware.core import Core
from fdvv.model.file import load_builtin
from fdvv.model.surface import ForceSurface
from fdvv.protocol.tables import Settings, Slot, Stroke, Vibration, Waveform
from fdvv.twin.finger import Finger
from fdvv.twin.gesture import plan
from fdvv.twin.image import image_of
from fdvv.twin.pace import solve_program_pace
from fdvv.twin.plant import RigPlant
from fdvv.twin.rig import Rig
from fdvv.twin.rig_moves import Exciter
from fdvv.twin.settings import settings_of
from fdvv.twin.trace import Trace
from fdvv.units import FloatArray, m_from_mm

SNAP_AT_mm, SNAP_Hz, SNAP_DURATION_s, DECAY_ratio = 2.0, 239.0, 0.016, 0.2
"""The paper's snap: where it is, its frequency, its length, and what is left of it at its end."""
LEAD_mm = 0.3
"""The paper starts the vibration this much early, whatever the speed."""
RATE_Hz, BLOCK = 16000, 32


@dataclass(frozen=True)
class CapVibration:
    """What the cap did: its acceleration with the vibration, less that of the same press without it.

    Attributes
    ----------
    late_ms : first time that it reaches a tenth of its largest value, after the cap crossed the
        displacement; negative is early.
    peak_m_s2 : largest added acceleration.
    frequency_Hz : strongest in the added acceleration while the waveform plays, and 10 ms beyond.
    lasts_ms : from the onset to the last time it exceeds a tenth of its largest value.
    likeness : largest correlation with the target's waveform at any delay; 1 is the same shape.
    """

    late_ms: float
    peak_m_s2: float
    frequency_Hz: float
    lasts_ms: float
    likeness: float


def snap() -> Slot:
    """A sine that decays to a fifth over its 16 ms."""
    samples = round(RATE_Hz * SNAP_DURATION_s)
    return Slot(
        waveform=Waveform.DECAYING_SINE,
        frequency_Hz16=round(16 * SNAP_Hz),
        duration_samples=samples,
        amplitude_counts=2000,
        decay_q16=round(65536 * DECAY_ratio ** (BLOCK / samples)),
        wave_at=0,
        wave_samples=0,
    )


def press_with(rig: Rig, settings: Settings, at_mm: float, velocity_mm_s: float, slots: list[Slot]) -> Trace:
    """One press without noise on MX Clear, from a board that holds these settings."""
    button, finger = load_builtin("mx-clear"), Finger()
    surface = ForceSurface.of_model(button, [50.0, 100.0, 150.0, 200.0])
    event = Vibration(
        at_um16=round(16000 * at_mm),
        slowest_mm_s16=0,
        fastest_mm_s16=65535,
        states=1,
        stroke=Stroke.PRESS,
        slot=0,
    )
    image = image_of(surface, button.travel_mm, [event] * len(slots), slots).image
    pace_s = solve_program_pace(rig, finger, image_of(surface, button.travel_mm).image, velocity_mm_s)
    core = Core(settings, image)
    core.announce(round(16 * velocity_mm_s))
    core.arm()
    plant = RigPlant(rig, finger, seed=None, stop_us=settings.stop_zero_us + 150 * button.travel_mm)
    plant.load(image)
    gesture = plan(finger, float(m_from_mm(button.travel_mm)), pace_s)
    plant.press(replace(gesture, onset_s=0.1))
    for _ in range(round((0.16 + pace_s) / rig.controller.tick_s)):
        out = core.tick(plant.inputs)
        plant.step(out["duty_q15"], out["enable"], out["stop_us"], out["slot"])
    return plant.record()


def cap_vibration(rig: Rig, settings: Settings, at_mm: float, velocity_mm_s: float) -> CapVibration:
    """Compare a press with its vibration and without."""
    with_it, without = (press_with(rig, settings, at_mm, velocity_mm_s, s) for s in ([snap()], []))
    added = with_it.cap_acceleration_m_s2 - without.cap_acceleration_m_s2
    t = with_it.t_s
    strong = np.flatnonzero(np.abs(added) > 0.1 * np.abs(added).max())
    crossed = float(t[np.argmax(without.displacement_mm >= SNAP_AT_mm)])
    onset = float(t[strong[0]])
    window = (t >= onset) & (t < onset + SNAP_DURATION_s + 0.01)
    return CapVibration(
        1e3 * (onset - crossed),
        float(np.abs(added).max()),
        _strongest_Hz(t[window], added[window]),
        1e3 * float(t[strong[-1]] - onset),
        _likeness(t[window], added[window]),
    )


def _strongest_Hz(t_s: FloatArray, a: FloatArray) -> float:
    spectrum = np.abs(np.fft.rfft(a, 1 << 16))
    return float(np.fft.rfftfreq(1 << 16, t_s[1] - t_s[0])[np.argmax(spectrum)])


def _likeness(t_s: FloatArray, a: FloatArray) -> float:
    since = t_s - t_s[0]
    target = np.sin(2 * np.pi * SNAP_Hz * since) * DECAY_ratio ** (since / SNAP_DURATION_s)
    target[since > SNAP_DURATION_s] = 0.0
    scale = float(np.linalg.norm(target) * np.linalg.norm(a))
    return float(np.abs(np.correlate(a, target, "full")).max()) / scale


def ways() -> list[tuple[str, Rig, Settings, float]]:
    """Name the ways of starting a vibration: rig, settings of its firmware, requested displacement."""
    card = Rig(exciter=Exciter(jitter_s=0.0))
    uno = replace(card, exciter=Exciter(latency_s=2e-4, jitter_s=0.0))
    fast = replace(uno, controller=replace(uno.controller, tick_s=2.5e-4, compute_s=1e-4))
    settings = settings_of(card)
    return [
        (
            "7 ms, lead 0.3 mm (the paper's)",
            card,
            replace(settings, vibration_latency_us=0),
            SNAP_AT_mm - LEAD_mm,
        ),
        ("7 ms, lead by velocity", card, settings, SNAP_AT_mm),
        ("0.2 ms (Uno), lead by velocity", uno, settings_of(uno), SNAP_AT_mm),
        ("the same at 4 kHz", fast, settings_of(fast), SNAP_AT_mm),
    ]
