"""The rig under the finger: coil, mover, stops, sensors and controller, in SI units.

Default values are a plausible version of the CHI 2020 rig. Sources: "paper" is that paper; "class" a data
sheet or published model of a part of the same class; "rule" an arithmetic consequence of the paper's
parts; "assumed" has no source and must be swept.
"""

from __future__ import annotations

from dataclasses import dataclass, field

from fdvv.errors import ModelError
from fdvv.twin._quantity import check, choice, quantity


@dataclass(frozen=True)
class Coil:
    """The voice coil and its amplifier; pulse width is averaged, so ripple is not modelled."""

    drive: str = choice("voltage", "what the amplifier holds", ("voltage", "current"), "assumed")
    force_constant_N_A: float = quantity(
        3.9, "force constant at mid stroke, also V s/m", "N/A", (2.5, 6.0), (0.1, 100.0), "class"
    )
    droop_ratio: float = quantity(
        0.08,
        "loss of the force constant at the ends of the stroke",
        "",
        (0.03, 0.2),
        (0.0, 0.8),
        "class, assumed",
    )
    centre_m: float = quantity(
        0.0031, "displacement of the full force constant", "m", (0.002, 0.0042), (-0.02, 0.02), "assumed"
    )
    stroke_m: float = quantity(
        0.0062, "usable stroke", "m", (0.0062, 0.0127), (0.001, 0.05), "paper", chosen=True
    )
    resistance_ohm: float = quantity(2.9, "resistance when cold", "ohm", (2.5, 8.0), (0.05, 100.0), "class")
    inductance_H: float = quantity(0.0015, "inductance", "H", (5e-4, 5e-3), (5e-5, 0.1), "assumed")
    supply_V: float = quantity(
        12.0, "largest voltage, both signs", "V", (5.0, 24.0), (0.1, 200.0), "assumed", chosen=True
    )
    bipolar: str = choice("yes", "whether the bridge can pull", ("yes", "no"), "assumed")
    current_loop_s: float = quantity(
        1e-4,
        "time constant of the current loop, if drive is current",
        "s",
        (5e-5, 5e-4),
        (3e-5, 0.1),
        "assumed",
    )
    command_bits: int = quantity(
        11, "bits of the command over the supply (0: continuous)", "", (8, 12), (0, 24), "rule", chosen=True
    )

    def __post_init__(self) -> None:
        check(self)


@dataclass(frozen=True)
class Mover:
    """What moves with the cap: coil, shaft, cap, sensor core, exciter."""

    mass_kg: float = quantity(0.02, "moving mass", "kg", (0.012, 0.04), (5e-4, 1.0), "class, assumed")
    gravity_m_s2: float = quantity(
        9.81,
        "gravity along the stroke: 9.81 upright, 0 lying",
        "m/s2",
        (0.0, 9.81),
        (-9.9, 9.9),
        "rule",
        chosen=True,
    )
    coulomb_N: float = quantity(0.03, "friction of the bushing", "N", (0.01, 0.1), (0.0, 5.0), "assumed")
    coulomb_speed_m_s: float = quantity(
        0.001,
        "speed at which friction is fully there, smoothed",
        "m/s",
        (0.0005, 0.005),
        (1e-4, 0.1),
        "assumed",
    )
    viscous_N_s_m: float = quantity(0.3, "viscous drag", "N s/m", (0.1, 1.0), (0.0, 100.0), "assumed")

    def __post_init__(self) -> None:
        check(self)


@dataclass(frozen=True)
class Stops:
    """The bottom stop that the servo sets and the top stop that holds the cap at rest (Hunt-Crossley)."""

    bottom_stiffness_N_m: float = quantity(
        2e4, "stiffness of the printed stop", "N/m", (1e4, 3e4), (100.0, 5e5), "assumed"
    )
    bottom_loss_s_m: float = quantity(
        1.0, "alpha in e = 1 - alpha v, as small v", "s/m", (0.3, 3.0), (0.0, 50.0), "assumed"
    )
    top_stiffness_N_m: float = quantity(2e4, "stiffness of the top stop", "N/m", (1e4, 3e4), (100.0, 5e5))
    top_loss_s_m: float = quantity(5.0, "alpha of the top stop, felted", "s/m", (0.3, 10.0), (0.0, 50.0))
    travel_limit_m: float = quantity(0.0062, "deepest stop", "m", (0.0062, 0.0127), (0.0005, 0.05), "paper")

    def __post_init__(self) -> None:
        check(self)


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
    range_m: float = quantity(0.0127, "full range", "m", (0.0127, 0.0127), (0.001, 0.2), "class")
    converter_bits: int = quantity(
        12, "bits over the range (0: continuous)", "", (10, 12), (0, 24), "rule", chosen=True
    )
    converter_noise_ratio: float = quantity(
        0.5, "noise per read, rms, of one step of the converter", "", (0.3, 2.0), (0.0, 20.0), "assumed"
    )
    reads: int = quantity(
        25, "reads averaged in a burst before each tick", "", (1, 25), (1, 200), "paper", chosen=True
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
    full_scale_N: float = quantity(9.81, "range, both signs", "N", (4.45, 9.81), (0.1, 1000.0), "class")
    converter_bits: int = quantity(
        10, "bits over the range (0: continuous)", "", (10, 12), (0, 24), "class", chosen=True
    )

    def __post_init__(self) -> None:
        check(self)


@dataclass(frozen=True)
class Controller:
    """The 1 kHz loop: average, direction, speed, table, command."""

    tick_s: float = quantity(
        0.001, "period of the loop", "s", (0.0001, 0.001), (5e-5, 0.02), "paper", chosen=True
    )
    compute_s: float = quantity(
        3e-4, "from the sample to the new drive", "s", (1e-4, 1e-3), (0.0, 0.02), "paper", chosen=True
    )
    averaging: str = choice("burst", "what the 25-sample average runs over", ("burst", "sliding"), "paper")
    average_ticks: int = quantity(
        25, "ticks of the sliding average", "", (1, 25), (1, 64), "paper", chosen=True
    )
    window_start_m: float = quantity(
        5e-4, "where the search for speed begins", "m", (4e-4, 6e-4), (0.0, 0.05), "paper", chosen=True
    )
    window_end_m: float = quantity(
        1e-3, "where speed is decided", "m", (9e-4, 1.2e-3), (1e-5, 0.05), "paper", chosen=True
    )
    fewest_samples: int = quantity(
        3,
        "samples a speed needs; the window widens backwards to hold them",
        "",
        (3, 5),
        (2, 64),
        "paper",
        chosen=True,
    )
    velocity_scale: float = quantity(
        1.2,
        "mean speed of a stroke per speed found in the window; 1 is the paper's word",
        "",
        (0.7, 1.5),
        (0.1, 10.0),
        "calibrated on this twin, simulated",
        chosen=True,
    )
    reversal_m: float = quantity(
        1e-4,
        "way back that turns press into release",
        "m",
        (5e-5, 3e-4),
        (1e-6, 0.01),
        "assumed",
        chosen=True,
    )
    rearm_m: float = quantity(
        1e-4, "height at which a new press begins", "m", (5e-5, 3e-4), (0.0, 0.01), "assumed", chosen=True
    )
    force_limit_N: float = quantity(
        4.4, "largest command, both signs", "N", (4.4, 4.4), (0.01, 100.0), "paper", chosen=True
    )
    gain_error_ratio: float = quantity(
        0.0, "error of the scale from force to drive", "", (-0.05, 0.05), (-0.5, 0.5), "assumed"
    )

    def __post_init__(self) -> None:
        check(self)
        if self.window_end_m <= self.window_start_m:
            raise ModelError(
                f"Controller: window_end_m must exceed window_start_m {self.window_start_m:g} m, "
                f"got {self.window_end_m:g}"
            )
        if self.compute_s >= self.tick_s:
            raise ModelError(
                f"Controller: compute_s must be below tick_s {self.tick_s:g} s, got {self.compute_s:g}"
            )


@dataclass(frozen=True)
class Rig:
    """Everything about the hardware; nothing here changes during a press."""

    coil: Coil = field(default_factory=Coil)
    mover: Mover = field(default_factory=Mover)
    stops: Stops = field(default_factory=Stops)
    position_sensor: PositionSensor = field(default_factory=PositionSensor)
    force_sensor: ForceSensor = field(default_factory=ForceSensor)
    controller: Controller = field(default_factory=Controller)

    def __post_init__(self) -> None:
        if self.position_sensor.burst_s > self.controller.tick_s:
            raise ModelError(
                f"Rig: burst_s must not exceed tick_s {self.controller.tick_s:g} s, "
                f"got {self.position_sensor.burst_s:g}"
            )
