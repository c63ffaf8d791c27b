"""The bench that records real presses: worn force sensor, microphone and motion capture.

One microcontroller samples force and sound at 1 kHz; cameras see two markers on the cap and a light that the
microcontroller switched on, at their own rate and on their own clock. Simulated.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from fdvv.errors import ModelError
from fdvv.twin._noise import lsb_of
from fdvv.twin._quantity import check, quantity
from fdvv.twin._simulate_button import ButtonTrace
from fdvv.units import FloatArray, m_from_mm, mm_from_m


@dataclass(frozen=True)
class CaptureRig:
    """What the bench gets wrong, the force sensor's own errors apart; all zeros are a perfect one."""

    frame_Hz: float = quantity(256.0, "frames of the cameras", "Hz", (240.0, 256.0), (10.0, 2000.0), "paper")
    exposure_s: float = quantity(3e-4, "exposure that a frame averages", "s", (2e-4, 5e-4), (0.0, 0.05))
    marker_noise_m: float = quantity(
        4e-5, "noise of each marker per frame, rms", "m", (2e-5, 7e-5), (0.0, 0.01), "class"
    )
    marker_bias_m: float = quantity(
        1e-4, "scatter between takes of where the cap is seen to rest, rms", "m", (0.0, 1.2e-4), (0.0, 0.01)
    )
    rocking_rad: float = quantity(
        0.02, "tilt of the pressed cap, either way", "rad", (0.009, 0.035), (0.0, 0.5), "assumed"
    )
    lever_m: float = quantity(
        0.008, "distance of either marker from the axis", "m", (0.005, 0.01), (0.0, 0.1)
    )
    lever_mismatch_ratio: float = quantity(
        0.1, "difference of the two distances", "", (0.0, 0.2), (0.0, 1.0), "assumed"
    )
    dropped_ratio: float = quantity(0.005, "frames that are lost", "", (0.0, 0.01), (0.0, 0.9), "assumed")
    clock_ppm: float = quantity(
        50.0, "difference of the two clocks, rms", "ppm", (20.0, 100.0), (0.0, 2e4), "assumed"
    )
    sound_V_s_m: float = quantity(
        2.0, "microphone, per speed of cap and plate", "V s/m", (1.0, 5.0), (0.0, 1e3), "assumed"
    )
    sound_low_Hz: float = quantity(90.0, "its high pass", "Hz", (80.0, 100.0), (0.0, 500.0), "assumed")
    sound_filter_s: float = quantity(3.33e-4, "RC before its converter", "s", (3.2e-4, 3.4e-4), (0.0, 0.1))
    sound_noise_V: float = quantity(0.01, "noise of the room, rms", "V", (0.005, 0.02), (0.0, 1.0), "assumed")
    sound_range_V: float = quantity(3.3, "range of its converter", "V", (3.3, 5.0), (0.1, 100.0), "rule")
    sound_bits: int = quantity(10, "bits over the range (0: continuous)", "", (10, 12), (0, 24), "paper")

    def __post_init__(self) -> None:
        check(self)


@dataclass(frozen=True, eq=False)
class RawCapture:
    """What the bench writes down, simulated.

    Attributes
    ----------
    t_s, force_cN, sound_V : (n,) samples every millisecond of the microcontroller's clock.
    light_s : when the light was switched on, on that clock.
    frame_s : (frames,) on the cameras' clock.
    marker_mm : (frames, 2) height of the two markers below their place at rest; NaN where a frame was lost.
    light : (frames,) part of the exposure that the light was on.
    offset_s : camera clock less microcontroller clock when the record starts: the truth that
        synchronisation has to find.
    """

    t_s: FloatArray
    force_cN: FloatArray
    sound_V: FloatArray
    light_s: float
    frame_s: FloatArray
    marker_mm: FloatArray
    light: FloatArray
    offset_s: float


LIGHT_s = 0.005
"""The light comes on this long after the record starts, and stays."""


def capture(trace: ButtonTrace, rig: CaptureRig, random: np.random.Generator) -> RawCapture:
    """Record one simulated press as the bench would; the trace needs a worn force sensor."""
    if trace.sensed_cN is None:
        raise ModelError("a capture needs a press with a force sensor, this finger was bare")
    offset_s, drift = float(random.uniform(0.0, 1.0)), 1e-6 * rig.clock_ppm * float(random.standard_normal())
    phase_s = float(random.uniform(0.0, 1.0)) / rig.frame_Hz
    frames = int((trace.t_s[-1] - rig.exposure_s - phase_s) * rig.frame_Hz)
    # the cameras count even frames on their own clock; true time runs a little off it
    own_s = phase_s + np.arange(frames) / rig.frame_Hz
    true_s = own_s / (1 + drift)
    return RawCapture(
        trace.t_s[trace.tick],
        trace.sensed_cN[trace.tick],
        _sound_V(trace, rig, random),
        LIGHT_s,
        own_s + offset_s,
        _markers_mm(trace, rig, true_s, random),
        _part_lit(true_s, rig.exposure_s),
        offset_s,
    )


def _markers_mm(
    trace: ButtonTrace, rig: CaptureRig, true_s: FloatArray, random: np.random.Generator
) -> FloatArray:
    """See the two markers, (frames, 2): exposure, rocking, bias, noise, lost frames."""
    seen_m = m_from_mm(_exposed(trace.t_s, trace.displacement_mm, true_s, rig.exposure_s))
    deepest_m = max(float(seen_m.max()), 1e-9)
    tilt = rig.rocking_rad * float(random.uniform(-1.0, 1.0)) * np.clip(seen_m / deepest_m, 0.0, 1.0)
    levers = rig.lever_m * np.array([1 + rig.lever_mismatch_ratio / 2, rig.lever_mismatch_ratio / 2 - 1])
    noise_m = rig.marker_noise_m * random.standard_normal((true_s.size, 2))
    bias_m = rig.marker_bias_m * random.standard_normal()
    markers_m = seen_m[:, None] + np.sin(tilt)[:, None] * levers + noise_m + bias_m
    markers_m[random.random(true_s.size) < rig.dropped_ratio] = np.nan
    return mm_from_m(markers_m)


def _exposed(t_s: FloatArray, values: FloatArray, at_s: FloatArray, exposure_s: float) -> FloatArray:
    """Average a column over exposures that begin at at_s."""
    if exposure_s == 0:
        return np.interp(at_s, t_s, values)
    area = np.append(0.0, np.cumsum(0.5 * (values[1:] + values[:-1]) * np.diff(t_s)))
    edges = np.interp(np.stack([at_s, at_s + exposure_s]), t_s, area)
    return np.asarray((edges[1] - edges[0]) / exposure_s)


def _part_lit(at_s: FloatArray, exposure_s: float) -> FloatArray:
    if exposure_s == 0:
        return np.asarray((at_s >= LIGHT_s).astype(np.float64))
    return np.clip((at_s + exposure_s - LIGHT_s) / exposure_s, 0.0, 1.0)


def _sound_V(trace: ButtonTrace, rig: CaptureRig, random: np.random.Generator) -> FloatArray:
    """Hear cap and plate in the near field, sampled each millisecond without a filter against aliases."""
    from scipy.signal import lfilter

    step_s = float(trace.t_s[1] - trace.t_s[0])
    heard = rig.sound_V_s_m * m_from_mm(trace.velocity_mm_s + trace.plate_velocity_mm_s)
    keep = math.exp(-2 * math.pi * rig.sound_low_Hz * step_s)
    heard = lfilter([1.0, -1.0], [1.0, -keep], heard) if rig.sound_low_Hz else heard
    fade = math.exp(-step_s / rig.sound_filter_s) if rig.sound_filter_s else 0.0
    heard = lfilter([1 - fade], [1.0, -fade], heard)[trace.tick]
    half = rig.sound_range_V / 2
    volts = np.clip(heard + rig.sound_noise_V * random.standard_normal(heard.size), -half, half)
    lsb = lsb_of(rig.sound_range_V, rig.sound_bits)
    return np.asarray(lsb * np.round(volts / lsb) if lsb else volts)
