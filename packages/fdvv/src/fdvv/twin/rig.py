"""The rig under the finger: its parts, and the loop that runs it, in SI units.

Default values are a plausible version of the CHI 2020 rig. Sources: "paper" is that paper; "class" a data
sheet or published model of a part of the same class; "rule" an arithmetic consequence of the paper's
parts; "assumed" has no source and must be swept.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field

from fdvv.errors import ModelError
from fdvv.twin.quantity import Section, choice, quantity, setting
from fdvv.twin.rig_moves import Coil, Exciter, Mover, Servo, Stops

PAPER_TRAVEL_m = 0.0064
"""Deepest stop of the wire before its range was widened to 20 mm: up to it every plausible servo stays valid,
even where the firmware would limit its pulse."""
LONGEST_PULSE_us = 2600.0  # the firmware limits pulses to it (fdvv_clamp in firmware/core/core.c)


@dataclass(frozen=True)
class PositionSensor(Section):
    """The differential transformer, its demodulator and converter."""

    bandwidth_Hz: float = quantity(300.0, "first-order demodulator", "Hz", (100.0, 500.0), (10.0, 2e4))
    noise_m: float = quantity(5e-6, "noise per tick within that band, rms", "m", (1e-6, 1e-5), (0.0, 1e-3))
    linearity_ratio: float = quantity(
        0.0025, "largest bend of the scale, of half the range", "", (0.0, 0.0025), (0.0, 0.1), "class"
    )
    range_m: float = setting(0.0127, "full range", "m", (0.0127, 0.0127), (0.001, 0.03), "class")
    converter_bits: int = setting(12, "bits over the range", "", (10, 12), (8, 16), "rule")
    converter_noise_ratio: float = quantity(
        0.5, "noise per read, rms, of one step of the converter", "", (0.3, 2.0), (0.0, 20.0)
    )
    reads: int = setting(25, "reads averaged in a burst before each tick", "", (1, 25), (1, 64), "paper")
    burst_s: float = setting(2.5e-4, "length of the burst", "s", (5e-5, 2.5e-4), (0.0, 0.05))


@dataclass(frozen=True)
class ForceSensor(Section):
    """The sensor worn on the fingertip: a cone on the cap, the pulp behind it, and its filter."""

    mass_kg: float = quantity(0.002, "cone and plunger", "kg", (0.001, 0.003), (2e-4, 0.1))
    contact_stiffness_N_m: float = quantity(8e4, "cone on cap", "N/m", (2e4, 2e5), (1e3, 5e5))
    contact_loss_s_m: float = quantity(6.0, "alpha of that contact", "s/m", (0.2, 10.0), (0.0, 50.0))
    filter_s: float = quantity(
        3.33e-4, "RC of 333 ohm and 1 uF, 478 Hz", "s", (3.2e-4, 3.4e-4), (2e-5, 0.1), "paper"
    )
    noise_N: float = quantity(0.003, "noise, rms", "N", (0.0013, 0.003), (0.0, 1.0))
    gain_error_ratio: float = quantity(
        0.0, "error of the calibration", "", (-0.03, 0.03), (-0.5, 0.5), "class"
    )
    hysteresis_N: float = quantity(
        0.01,
        "play; 0.02-0.06 N is reported for full-range cycles, presses use a tenth",
        "N",
        (0.0, 0.06),
        (0.0, 1.0),
    )
    full_scale_N: float = setting(9.81, "range, both signs", "N", (4.45, 9.81), (0.1, 1000.0), "class")
    converter_bits: int = setting(10, "bits over the range (0: continuous)", "", (10, 12), (0, 24), "class")


@dataclass(frozen=True)
class KeycapSensor(Section):
    """An optional sensor in the cap that the controller reads: the contact's force, or its acceleration."""

    kind: str = choice("none", "what it feels", ("none", "force", "acceleration"))
    full_scale_N: float = setting(
        4.45, "range of the force, both signs", "N", (4.45, 4.45), (0.1, 100.0), "class"
    )
    full_scale_m_s2: float = setting(
        80.0, "range of the acceleration, both signs", "m/s2", (20.0, 160.0), (1.0, 5000.0), "class"
    )
    bandwidth_Hz: float = quantity(2000.0, "first-order filter", "Hz", (500.0, 4000.0), (10.0, 8000.0))
    noise_ratio: float = quantity(3e-4, "noise in proportion to the range, rms", "", (1e-4, 1e-3), (0.0, 0.1))
    converter_bits: int = setting(12, "bits over both signs together", "", (10, 12), (8, 16), "class")


@dataclass(frozen=True)
class LoadCell(Section):
    """An optional load cell in the cap, under the bare finger: it takes the place of the worn sensor."""

    fitted: str = choice("no", "whether there is one", ("yes", "no"))
    plate_kg: float = quantity(4e-4, "plate between finger and cell", "kg", (2e-4, 5e-4), (5e-5, 0.05))
    stiffness_N_m: float = quantity(5e5, "stiffness", "N/m", (3e5, 7.5e5), (1e4, 2e6), "class, assumed")
    damping_ratio: float = quantity(
        0.05, "damping of the plate, of the critical", "", (0.02, 0.1), (0.001, 2.0)
    )
    bandwidth_Hz: float = setting(
        4000.0, "first-order filter", "Hz", (4000.0, 4000.0), (10.0, 8000.0), "class"
    )
    full_scale_N: float = setting(4.45, "range, both signs", "N", (4.45, 9.81), (0.1, 100.0), "class")
    converter_bits: int = setting(12, "bits over both signs together", "", (12, 14), (8, 16), "class")
    noise_ratio: float = quantity(3e-4, "noise in proportion to the range, rms", "", (1e-4, 5e-4), (0.0, 0.1))
    gain_error_ratio: float = quantity(
        0.0, "error of the calibration", "", (-0.01, 0.01), (-0.5, 0.5), "class"
    )
    offset_N: float = quantity(0.0, "offset left after zeroing", "N", (-0.006, 0.006), (-1.0, 1.0))

    @property
    def damping_N_s_m(self) -> float:
        """Return the damping of the plate on the cell."""
        return 2 * self.damping_ratio * math.sqrt(self.stiffness_N_m * self.plate_kg)


@dataclass(frozen=True)
class Thermistor(Section):
    """An optional thermistor in the coil's bobbin: it follows the coil with a lag, and stays a little colder.

    The heat that it takes up is counted as the coil's.
    """

    fitted: str = choice("no", "whether there is one", ("yes", "no"))
    condition: str = choice("sound", "of it and its wire", ("sound", "open", "short"))
    lag_s: float = setting(4.0, "time constant of its way to the coil", "s", (2.0, 8.0), (0.5, 40.0))
    share_ratio: float = setting(0.9, "its rise at the end, of the coil's", "", (0.8, 1.0), (0.3, 1.0))
    resistance_ohm: float = setting(1e4, "at 25 C", "ohm", (9.9e3, 1.01e4), (9e3, 1.1e4), "class")
    beta_K: float = setting(
        3435.0,
        "from 25 to 85 C; R = R25 exp(beta (1/T - 1/298 K))",
        "K",
        (3400.0, 3470.0),
        (3e3, 4e3),
        "class",
    )
    pull_up_ohm: float = setting(1e4, "from it to the reference", "ohm", (9.9e3, 1.01e4), (9e3, 1.1e4))
    noise_counts: float = setting(0.5, "noise of a reading of 12 bits, rms", "", (0.3, 1.0), (0.0, 20.0))
    room_C: float = setting(22.0, "the room, and the coil when cold", "C", (15.0, 30.0), (-20.0, 60.0))


@dataclass(frozen=True)
class Controller(Section):
    """The loop: average, direction, speed, table, command. Run by the firmware's own core (_settings.py)."""

    tick_s: float = setting(0.001, "period of the loop", "s", (0.0001, 0.001), (5e-5, 0.004), "paper")
    compute_s: float = setting(
        3e-4, "from the sample to the new drive", "s", (1e-5, 3e-4), (0.0, 0.02), "paper"
    )
    averaging: str = choice("burst", "what the 25-sample average runs over", ("burst", "sliding"), "paper")
    average_ticks: int = setting(25, "ticks of the sliding average", "", (1, 25), (1, 32), "paper")
    window_start_m: float = setting(
        5e-4, "where the search for speed begins", "m", (4e-4, 6e-4), (5e-5, 0.003), "paper"
    )
    window_end_m: float = setting(1e-3, "where speed is decided", "m", (9e-4, 1.2e-3), (1e-4, 0.004), "paper")
    fewest_samples: int = setting(
        3, "samples a speed needs; the window widens backwards to hold them", "", (3, 5), (3, 16), "paper"
    )
    velocity_scale: float = setting(
        1.2,
        "mean speed of a stroke per speed found in the window; 1 is the paper's word",
        "",
        (0.7, 1.5),
        (0.25, 4.0),
        "calibrated on this twin, simulated",
    )
    reversal_m: float = setting(
        1e-4, "way back that turns press into release", "m", (5e-5, 3e-4), (5e-6, 0.001)
    )
    rearm_m: float = setting(1e-4, "height at which a new press begins", "m", (5e-5, 3e-4), (5e-6, 0.001))
    force_limit_N: float = setting(4.4, "largest command, both signs", "N", (4.4, 4.4), (0.01, 5.0), "paper")
    slew_N: float = setting(
        5.0, "largest change of the command from tick to tick", "N", (0.5, 5.0), (0.01, 5.0)
    )
    gain_error_ratio: float = quantity(
        0.0, "error of the scale from force to drive", "", (-0.05, 0.05), (-0.5, 0.5)
    )

    def __post_init__(self) -> None:
        super().__post_init__()
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
    servo: Servo = field(default_factory=Servo)
    exciter: Exciter = field(default_factory=Exciter)
    position_sensor: PositionSensor = field(default_factory=PositionSensor)
    force_sensor: ForceSensor = field(default_factory=ForceSensor)
    keycap_sensor: KeycapSensor = field(default_factory=KeycapSensor)
    controller: Controller = field(default_factory=Controller)
    load_cell: LoadCell = field(default_factory=LoadCell)
    thermistor: Thermistor = field(default_factory=Thermistor)

    def __post_init__(self) -> None:
        if self.position_sensor.burst_s > self.controller.tick_s:
            raise ModelError(
                f"Rig: burst_s must not exceed tick_s {self.controller.tick_s:g} s, "
                f"got {self.position_sensor.burst_s:g}"
            )
        if self.exciter.fitted == "yes" and self.exciter.mass_kg >= self.mover.mass_kg:
            raise ModelError(
                f"Rig: the exciter is part of the mover of {self.mover.mass_kg:g} kg, "
                f"its magnet cannot weigh {self.exciter.mass_kg:g}"
            )
        deepest_us = self.servo.pulse_zero_us + 1e3 * self.servo.pulse_us_mm * self.stops.travel_limit_m
        if self.stops.travel_limit_m > PAPER_TRAVEL_m and deepest_us > LONGEST_PULSE_us:
            raise ModelError(
                f"Rig: a servo's longest pulse is {LONGEST_PULSE_us:g} us, a stop at "
                f"{self.stops.travel_limit_m:g} m needs {deepest_us:g}: lower pulse_us_mm"
            )

    @property
    def frame_kg(self) -> float:
        """Return what moves rigidly with the cap: the mover without magnet and plate."""
        magnet_kg = self.exciter.mass_kg if self.exciter.fitted == "yes" else 0.0
        return self.mover.mass_kg - magnet_kg - (self.load_cell.plate_kg if self.has_cell else 0.0)

    @property
    def has_cell(self) -> bool:
        """Return whether a bare finger presses a load cell in the cap."""
        return self.load_cell.fitted == "yes"
