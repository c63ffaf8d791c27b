"""The rig under the finger: its parts, and the loop that runs it, in SI units.

Default values are a plausible version of the CHI 2020 rig. Sources: "paper" is that paper; "class" a data
sheet or published model of a part of the same class; "rule" an arithmetic consequence of the paper's
parts; "assumed" has no source and must be swept.
"""

from __future__ import annotations

from dataclasses import dataclass, field

from fdvv.errors import ModelError
from fdvv.twin._quantity import check, choice, quantity
from fdvv.twin._rig_moves import Coil, Exciter, Mover, Servo, Stops
from fdvv.twin._rig_senses import ForceSensor, KeycapSensor, PositionSensor


@dataclass(frozen=True)
class Controller:
    """The loop: average, direction, speed, table, command. Run by the firmware's own core (_settings.py)."""

    tick_s: float = quantity(
        0.001, "period of the loop", "s", (0.0001, 0.001), (1e-4, 0.001), "paper", chosen=True
    )
    compute_s: float = quantity(
        3e-4, "from the sample to the new drive", "s", (1e-5, 3e-4), (0.0, 0.02), "paper", chosen=True
    )
    averaging: str = choice("burst", "what the 25-sample average runs over", ("burst", "sliding"), "paper")
    average_ticks: int = quantity(
        25, "ticks of the sliding average", "", (1, 25), (1, 32), "paper", chosen=True
    )
    window_start_m: float = quantity(
        5e-4, "where the search for speed begins", "m", (4e-4, 6e-4), (5e-5, 0.003), "paper", chosen=True
    )
    window_end_m: float = quantity(
        1e-3, "where speed is decided", "m", (9e-4, 1.2e-3), (1e-4, 0.004), "paper", chosen=True
    )
    fewest_samples: int = quantity(
        3,
        "samples a speed needs; the window widens backwards to hold them",
        "",
        (3, 5),
        (3, 16),
        "paper",
        chosen=True,
    )
    velocity_scale: float = quantity(
        1.2,
        "mean speed of a stroke per speed found in the window; 1 is the paper's word",
        "",
        (0.7, 1.5),
        (0.25, 4.0),
        "calibrated on this twin, simulated",
        chosen=True,
    )
    reversal_m: float = quantity(
        1e-4, "way back that turns press into release", "m", (5e-5, 3e-4), (5e-6, 0.001), chosen=True
    )
    rearm_m: float = quantity(
        1e-4, "height at which a new press begins", "m", (5e-5, 3e-4), (5e-6, 0.001), chosen=True
    )
    force_limit_N: float = quantity(
        4.4, "largest command, both signs", "N", (4.4, 4.4), (0.01, 5.0), "paper", chosen=True
    )
    slew_N: float = quantity(
        5.0, "largest change of the command from tick to tick", "N", (0.5, 5.0), (0.01, 5.0), chosen=True
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
    servo: Servo = field(default_factory=Servo)
    exciter: Exciter = field(default_factory=Exciter)
    position_sensor: PositionSensor = field(default_factory=PositionSensor)
    force_sensor: ForceSensor = field(default_factory=ForceSensor)
    keycap_sensor: KeycapSensor = field(default_factory=KeycapSensor)
    controller: Controller = field(default_factory=Controller)

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

    @property
    def frame_kg(self) -> float:
        """Give what moves rigidly with the cap: the mover without the exciter's magnet."""
        return self.mover.mass_kg - (self.exciter.mass_kg if self.exciter.fitted == "yes" else 0.0)
