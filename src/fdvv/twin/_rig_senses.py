"""What the rig feels: its position sensor, the force sensor on the finger, a sensor in the cap; SI units."""

from __future__ import annotations

from dataclasses import dataclass

from fdvv.twin._quantity import check, choice, quantity


@dataclass(frozen=True)
class PositionSensor:
    """The differential transformer, its demodulator and converter."""

    bandwidth_Hz: float = quantity(
        300.0, "first-order demodulator", "Hz", (100.0, 500.0), (10.0, 2e4), "assumed"
    )
    noise_m: float = quantity(5e-6, "noise per tick within that band, rms", "m", (1e-6, 1e-5), (0.0, 1e-3))
    linearity_ratio: float = quantity(
        0.0025, "largest bend of the scale, of half the range", "", (0.0, 0.0025), (0.0, 0.1), "class"
    )
    range_m: float = quantity(
        0.0127, "full range", "m", (0.0127, 0.0127), (0.001, 0.016), "class", chosen=True
    )
    converter_bits: int = quantity(12, "bits over the range", "", (10, 12), (8, 16), "rule", chosen=True)
    converter_noise_ratio: float = quantity(
        0.5, "noise per read, rms, of one step of the converter", "", (0.3, 2.0), (0.0, 20.0), "assumed"
    )
    reads: int = quantity(
        25, "reads averaged in a burst before each tick", "", (1, 25), (1, 64), "paper", chosen=True
    )
    burst_s: float = quantity(
        2.5e-4, "length of the burst", "s", (5e-5, 2.5e-4), (0.0, 0.05), "assumed", chosen=True
    )

    def __post_init__(self) -> None:
        check(self)


@dataclass(frozen=True)
class ForceSensor:
    """The sensor worn on the fingertip: a cone on the cap, the pulp behind it, and its filter."""

    mass_kg: float = quantity(0.002, "cone and plunger", "kg", (0.001, 0.003), (2e-4, 0.1), "assumed")
    contact_stiffness_N_m: float = quantity(8e4, "cone on cap", "N/m", (2e4, 2e5), (1e3, 5e5), "assumed")
    contact_loss_s_m: float = quantity(
        6.0, "alpha of that contact", "s/m", (0.2, 10.0), (0.0, 50.0), "assumed"
    )
    filter_s: float = quantity(
        3.33e-4, "RC of 333 ohm and 1 uF, 478 Hz", "s", (3.2e-4, 3.4e-4), (2e-5, 0.1), "paper"
    )
    noise_N: float = quantity(0.003, "noise, rms", "N", (0.0013, 0.003), (0.0, 1.0), "assumed")
    gain_error_ratio: float = quantity(
        0.0, "error of the calibration", "", (-0.03, 0.03), (-0.5, 0.5), "class"
    )
    hysteresis_N: float = quantity(
        0.01,
        "play; 0.02-0.06 N is told of full-range cycles, presses use a tenth",
        "N",
        (0.0, 0.06),
        (0.0, 1.0),
    )
    full_scale_N: float = quantity(
        9.81, "range, both signs", "N", (4.45, 9.81), (0.1, 1000.0), "class", chosen=True
    )
    converter_bits: int = quantity(
        10, "bits over the range (0: continuous)", "", (10, 12), (0, 24), "class", chosen=True
    )

    def __post_init__(self) -> None:
        check(self)


@dataclass(frozen=True)
class KeycapSensor:
    """An optional sensor in the cap that the controller reads: the contact's force, or its acceleration."""

    kind: str = choice("none", "what it feels", ("none", "force", "acceleration"), "assumed")
    full_scale_N: float = quantity(
        4.45, "range of the force, both signs", "N", (4.45, 4.45), (0.1, 100.0), "class", chosen=True
    )
    full_scale_m_s2: float = quantity(
        80.0,
        "range of the acceleration, both signs",
        "m/s2",
        (20.0, 160.0),
        (1.0, 5000.0),
        "class",
        chosen=True,
    )
    bandwidth_Hz: float = quantity(
        2000.0, "first-order filter", "Hz", (500.0, 4000.0), (10.0, 8000.0), "assumed"
    )
    noise_ratio: float = quantity(
        3e-4, "noise in proportion to the range, rms", "", (1e-4, 1e-3), (0.0, 0.1), "assumed"
    )
    converter_bits: int = quantity(
        12, "bits over both signs together", "", (10, 12), (8, 16), "class", chosen=True
    )

    def __post_init__(self) -> None:
        check(self)
