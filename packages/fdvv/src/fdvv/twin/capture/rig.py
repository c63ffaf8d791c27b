"""Errors of a simulated capture bench: microphone, cameras, clocks."""

from __future__ import annotations

from dataclasses import dataclass

from fdvv.twin.quantity import Section, quantity, setting


@dataclass(frozen=True)
class CaptureRig(Section):
    """What the bench gets wrong, the force sensor's own errors apart; all zeros are a perfect one.

    One microcontroller samples force each millisecond, sound and the housing's acceleration at their own
    rates; cameras see two markers on the cap and a light that the microcontroller switches, at their own rate
    and on their own clock.
    """

    frame_Hz: float = quantity(256.0, "frames of the cameras", "Hz", (240.0, 256.0), (10.0, 2000.0), "paper")
    exposure_s: float = quantity(3e-4, "exposure that a frame averages", "s", (2e-4, 5e-4), (0.0, 0.05))
    marker_noise_m: float = quantity(
        4e-5, "noise of each marker per frame, rms", "m", (2e-5, 7e-5), (0.0, 0.01), "class"
    )
    marker_bias_m: float = quantity(
        1e-4, "scatter between takes of where the cap is seen to rest, rms", "m", (0.0, 1.2e-4), (0.0, 0.01)
    )
    rocking_rad: float = quantity(
        0.02, "tilt of the pressed cap, either way", "rad", (0.009, 0.035), (0.0, 0.5)
    )
    lever_m: float = quantity(
        0.008, "distance of either marker from the axis", "m", (0.005, 0.01), (0.0, 0.1)
    )
    lever_mismatch_ratio: float = quantity(0.1, "difference of the two distances", "", (0.0, 0.2), (0.0, 1.0))
    sideways_m: float = quantity(
        5e-5, "play of the pressed cap across its axis", "m", (0.0, 1e-4), (0.0, 0.002)
    )
    askew_rad: float = quantity(
        0.03, "angle between the cameras' axis and the cap's, rms", "rad", (0.01, 0.05), (0.0, 0.5)
    )
    dropped_ratio: float = quantity(0.005, "frames that are lost", "", (0.0, 0.01), (0.0, 0.9))
    unseen_ratio: float = quantity(
        0.002, "frames in which a marker is not found", "", (0.0, 0.01), (0.0, 0.9)
    )
    light_noise: float = quantity(
        0.02, "noise of how lit a frame is, rms, 1 being lit all through", "", (0.0, 0.05), (0.0, 1.0)
    )
    clock_ppm: float = quantity(50.0, "difference of the two clocks, rms", "ppm", (20.0, 100.0), (0.0, 2e4))
    force_zero_N: float = quantity(
        0.02, "where the force sensor's zero lies off what is stated, rms", "N", (0.0, 0.05), (0.0, 1.0)
    )
    sound_Hz: float = setting(1000.0, "samples of the microphone", "Hz", (1000.0, 1e4), (100.0, 1e4), "paper")
    sound_V_s_m: float = quantity(
        2.0, "microphone, per speed of cap and plate", "V s/m", (1.0, 5.0), (0.0, 1e3)
    )
    sound_low_Hz: float = quantity(90.0, "its high pass", "Hz", (80.0, 100.0), (0.0, 500.0))
    sound_filter_s: float = quantity(
        3.33e-4, "RC before its converter, 0 for a wide band", "s", (3.2e-4, 3.4e-4), (0.0, 0.1)
    )
    sound_noise_V: float = quantity(0.01, "noise of the room, rms", "V", (0.005, 0.02), (0.0, 1.0))
    sound_range_V: float = quantity(3.3, "range of its converter", "V", (3.3, 5.0), (0.1, 100.0), "rule")
    sound_bits: int = quantity(10, "bits over the range (0: continuous)", "", (10, 12), (0, 24), "paper")
    shake_Hz: float = setting(
        1e4,
        "samples of the accelerometer on the housing, 0: there is none",
        "Hz",
        (8e3, 1e4),
        (0.0, 1e4),
        "rule",
    )
    shake_noise_m_s2: float = quantity(
        0.03, "its noise per sample, rms: 40 ug per root hertz", "m/s2", (0.02, 0.1), (0.0, 10.0), "class"
    )
    shake_step_m_s2: float = quantity(
        0.01, "step of its converter (0: continuous)", "m/s2", (0.005, 0.02), (0.0, 1.0), "rule"
    )
