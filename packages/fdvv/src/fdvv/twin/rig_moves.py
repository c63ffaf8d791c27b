"""What moves on the rig: coil, mover, stops, servo and exciter, in SI units."""

from __future__ import annotations

from dataclasses import dataclass

from fdvv.errors import ModelError
from fdvv.twin.quantity import Section, choice, quantity, setting


@dataclass(frozen=True)
class Coil(Section):
    """The voice coil and its amplifier; pulse width is averaged (ripple: testing.closed_forms.ripple_N)."""

    drive: str = choice("voltage", "what the amplifier holds", ("voltage", "current"))
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
        0.0031, "displacement of the full force constant", "m", (0.002, 0.0042), (-0.02, 0.02)
    )
    stroke_m: float = setting(0.0062, "usable stroke", "m", (0.0062, 0.0127), (0.001, 0.05), "paper")
    resistance_ohm: float = quantity(2.9, "resistance when cold", "ohm", (2.5, 8.0), (0.05, 100.0), "class")
    bridge_ohm: float = quantity(
        0.2, "resistance of the bridge and its wires", "ohm", (0.1, 0.5), (0.0, 10.0)
    )
    source_ohm: float = quantity(
        0.1, "resistance of the supply: it sags by this times its current", "ohm", (0.0, 0.5), (0.0, 10.0)
    )
    inductance_H: float = quantity(0.0015, "inductance", "H", (5e-4, 5e-3), (5e-5, 0.1))
    reluctance_H_m: float = quantity(
        0.05,
        "growth of the inductance on the way in; pulls with half of it times the current squared",
        "H/m",
        (0.0, 0.3),
        (-0.2, 0.5),
        "class, assumed",
    )
    copper_1_K: float = quantity(
        0.0039, "growth of the resistance with temperature", "1/K", (0.0039, 0.0039), (0.0, 0.01), "rule"
    )
    heat_K_W: float = quantity(12.0, "coil to air, warming per power", "K/W", (8.0, 20.0), (0.1, 200.0))
    heat_s: float = quantity(60.0, "its time constant", "s", (30.0, 120.0), (0.1, 600.0))
    supply_V: float = setting(12.0, "largest voltage, both signs", "V", (5.0, 24.0), (3.0, 48.0))
    bipolar: str = choice("yes", "whether the bridge can pull", ("yes", "no"))
    current_loop_s: float = quantity(
        1e-4, "time constant of the current loop, if drive is current", "s", (5e-5, 5e-4), (3e-5, 0.1)
    )
    command_bits: int = setting(
        11, "bits of the command over the supply (0: continuous)", "", (8, 12), (0, 15), "rule"
    )

    def __post_init__(self) -> None:
        super().__post_init__()
        if abs(self.reluctance_H_m) > self.steepest_H_m:
            raise ModelError(
                f"Coil: reluctance_H_m must be within {self.steepest_H_m:g} H/m, so that an inductance of "
                f"{self.inductance_H:g} H stays above 0 over the stroke, got {self.reluctance_H_m:g}"
            )

    @property
    def steepest_H_m(self) -> float:
        """Return the slope at which a quarter of the inductance is left at the farther end of the stroke."""
        return 0.75 * self.inductance_H / max(abs(self.centre_m), abs(self.stroke_m - self.centre_m))


@dataclass(frozen=True)
class Mover(Section):
    """What moves with the cap: coil, shaft, cap, sensor core, exciter."""

    mass_kg: float = quantity(0.02, "moving mass", "kg", (0.012, 0.04), (5e-4, 1.0), "class, assumed")
    gravity_m_s2: float = setting(
        9.81, "gravity along the stroke: 9.81 upright, 0 lying", "m/s2", (0.0, 9.81), (-9.9, 9.9), "rule"
    )
    coulomb_N: float = quantity(0.03, "friction of the bushing", "N", (0.01, 0.1), (0.0, 5.0))
    presliding_m: float = quantity(3e-6, "elastic way before it slips", "m", (1e-6, 1e-5), (1e-7, 1e-3))
    viscous_N_s_m: float = quantity(0.3, "viscous drag", "N s/m", (0.1, 1.0), (0.0, 100.0))


@dataclass(frozen=True)
class Stops(Section):
    """The bottom stop that the servo sets and the top stop that holds the cap at rest (Hunt-Crossley)."""

    bottom_stiffness_N_m: float = quantity(
        2e4, "stiffness of the printed stop", "N/m", (1e4, 3e4), (100.0, 5e5)
    )
    bottom_loss_s_m: float = quantity(
        1.0, "alpha in e = 1 - alpha v, as small v", "s/m", (0.3, 3.0), (0.0, 50.0)
    )
    top_stiffness_N_m: float = quantity(2e4, "stiffness of the top stop", "N/m", (1e4, 3e4), (100.0, 5e5))
    top_loss_s_m: float = quantity(5.0, "alpha of the top stop, felted", "s/m", (0.3, 10.0), (0.0, 50.0))
    travel_limit_m: float = setting(0.0062, "deepest stop", "m", (0.0062, 0.0064), (0.0005, 0.02), "paper")


@dataclass(frozen=True)
class Servo(Section):
    """The servo that sets the bottom stop; calibrated when it last stood still, with its play taken up."""

    pulse_zero_us: float = setting(1000.0, "pulse at travel 0", "us", (500.0, 1500.0), (400.0, 2600.0))
    pulse_us_mm: float = setting(150.0, "pulse per travel", "us/mm", (100.0, 250.0), (10.0, 1000.0))
    frame_s: float = setting(
        0.02, "period of the pulses it looks at", "s", (0.003, 0.02), (1e-3, 0.1), "class"
    )
    deadband_us: float = quantity(
        7.0, "change of the pulse that it ignores", "us", (5.0, 10.0), (0.0, 100.0), "class"
    )
    speed_mm_s: float = quantity(
        45.0, "speed of the stop without load", "mm/s", (35.0, 60.0), (1.0, 1000.0), "class"
    )
    lag_s: float = quantity(0.02, "time constant at the end of a move", "s", (0.01, 0.04), (1e-3, 1.0))
    play_m: float = quantity(
        1e-4, "play of the gears; shifts the stop after a move upward", "m", (5e-5, 2e-4), (0.0, 1e-3)
    )


@dataclass(frozen=True)
class Exciter(Section):
    """The vibration exciter under the cap, its synthesiser's converter and its amplifier."""

    fitted: str = choice("yes", "whether there is one", ("yes", "no"), "paper")
    mass_kg: float = quantity(0.006, "magnet, part of the mover's mass", "kg", (0.004, 0.008), (1e-4, 0.1))
    resonance_Hz: float = quantity(
        560.0, "of the magnet on its spring, held frame", "Hz", (450.0, 700.0), (20.0, 1500.0), "class"
    )
    quality: float = quantity(2.5, "mechanical quality of that resonance", "", (1.5, 4.0), (0.3, 50.0))
    motor_N_A: float = quantity(2.0, "force per current", "N/A", (1.5, 3.0), (0.0, 20.0))
    resistance_ohm: float = quantity(7.3, "of its coil", "ohm", (6.8, 7.8), (0.5, 100.0), "class")
    inductance_H: float = quantity(5e-5, "of its coil", "H", (3e-5, 2e-4), (1e-6, 5e-3))
    drive_V: float = setting(2.5, "voltage at full scale of the converter", "V", (1.0, 5.0), (0.0, 20.0))
    clip_V: float = setting(2.5, "largest voltage of the amplifier", "V", (2.5, 2.5), (0.1, 20.0))
    filter_Hz: float = quantity(
        1e4, "low pass behind the converter", "Hz", (8e3, 1.2e4), (500.0, 3e4), "class"
    )
    latency_s: float = setting(
        0.007,
        "command to first sample; a file on a card 7 ms, a synthesiser 0.2 ms",
        "s",
        (0.007, 0.007),
        (0.0, 0.1),
        "paper",
    )
    jitter_s: float = quantity(0.001, "spread of that latency", "s", (5e-4, 2e-3), (0.0, 0.02))
