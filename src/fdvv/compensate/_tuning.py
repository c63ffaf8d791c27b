"""What a controller does by itself in every tick: look ahead, and push against the rig's own forces."""

from __future__ import annotations

from dataclasses import dataclass, fields

import numpy as np

from fdvv.errors import ModelError


@dataclass(frozen=True)
class Tuning:
    """Feed-forward of one rig, at work in every tick; ``Tuning()`` does nothing.

    With x, v, a estimated from the sensed displacement by a critically damped filter of third order
    (g-h-k, Benedict and Bordner 1962; Brookner 1998), a command is

        table(x + v lead + a lead^2 / 2) - drag (v + a brake_lead) - friction clip(v / friction_mm_s, -1, 1)

    Attributes
    ----------
    bandwidth_Hz : of the filter; 0: the table is read at the sensed displacement and nothing is added.
    lead_s : age of the sensed place when the coil pushes by it: position lag, computing, half
        a tick, and the coil's lag.
    brake_lead_s : the same without the coil's lag, which delays the braking it makes as well.
    drag_N_s_m : taken off the command per speed.
    friction_cN : taken off the command in the direction of motion, in full from friction_mm_s on.
    paced : the table's row is that of the announced speed; else that of the speed decided in the press.
    """

    bandwidth_Hz: float = 0.0
    lead_s: float = 0.0
    brake_lead_s: float = 0.0
    drag_N_s_m: float = 0.0
    friction_cN: float = 0.0
    friction_mm_s: float = 10.0
    paced: bool = False

    def __post_init__(self) -> None:
        numbers = [float(getattr(self, f.name)) for f in fields(self)]
        if not np.isfinite(numbers).all() or min(numbers) < 0 or not self.friction_mm_s > 0:
            raise ModelError(
                f"a tuning needs finite numbers of at least 0, and friction_mm_s above 0, got {self}"
            )


UNTUNED = Tuning()
"""A controller that adds nothing."""
