"""What a rig gives a program to work with, and what its mechanics take away."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from fdvv.errors import ModelError
from fdvv.protocol import CN64_PER_cN, Settings


@dataclass(frozen=True)
class Limits:
    """The bounds that programs are compiled and checked against; the defaults are the paper's rig.

    Attributes
    ----------
    settings : of the controller: force limit, slew, tick, heat, latency of the vibration board.
    largest_travel_mm : deepest place of the bottom stop; the paper's 6.2.
    counts_per_m_s2 : converter counts of the vibration board per m/s² of the cap.
    grid_error_cN : what a coarser grid of a surface may cost while there is room.
    worst_grid_error_cN : what it may cost at most where room is short; beyond, the program is refused.
    mass_kg : what moves: coil, shaft, cap.
    damping_N_s_m : drag that is sure to be there: back-EMF of the coil at voltage drive, k_t²/R, and bushing.
    most_damping_N_s_m : the most it may be; only times depend on it.
    weight_cN : of what moves, along the stroke: 20 g in a rig that stands upright. Every state of an image
        carries it, so that forces are felt as they are written. 0 for a rig that lies and for learned forces.
    opposing_cN : largest force that may keep the cap down with the finger off: friction.
    rebound_ratio : speed after over speed before hitting a stop, at most.
    top_mm : above it the cap counts as returned: the rig's re-arming height.
    delay_us : from the middle of the readings to the new force.
    """

    settings: Settings = field(default_factory=Settings)
    largest_travel_mm: float = 6.2
    counts_per_m_s2: float = 100.0
    grid_error_cN: float = 0.1
    worst_grid_error_cN: float = 1.0
    mass_kg: float = 0.02
    damping_N_s_m: float = 4.0
    most_damping_N_s_m: float = 8.0
    weight_cN: float = 19.6
    opposing_cN: float = 5.0
    rebound_ratio: float = 0.3
    top_mm: float = 0.1
    delay_us: float = 800.0

    def __post_init__(self) -> None:
        positive = (
            "largest_travel_mm", "counts_per_m_s2", "grid_error_cN", "worst_grid_error_cN", "mass_kg",
            "damping_N_s_m", "most_damping_N_s_m", "top_mm", "delay_us",
        )  # fmt: skip
        for name in positive:
            if not (np.isfinite(getattr(self, name)) and getattr(self, name) > 0):
                raise ModelError(f"{name} must be positive, got {getattr(self, name)}")
        if not np.isfinite(self.weight_cN):
            raise ModelError(f"weight_cN must be finite, got {self.weight_cN}")
        if not (np.isfinite(self.opposing_cN) and self.opposing_cN >= 0):
            raise ModelError(f"opposing_cN must be 0 or more, got {self.opposing_cN}")
        if not 0 <= self.rebound_ratio < 1:
            raise ModelError(f"rebound_ratio must be 0 to below 1, got {self.rebound_ratio}")

    @property
    def force_cN(self) -> float:
        """Give the largest force, both signs."""
        return self.settings.force_limit_cN64 / CN64_PER_cN

    @property
    def slew_cN_s(self) -> float:
        """Give the fastest change of the force."""
        return self.settings.slew_cN64_tick / CN64_PER_cN * 1e6 / self.settings.tick_us

    @property
    def stiffness_cN_mm(self) -> float:
        """Give the stiffness beyond which a held cap may buzz: damping over half a tick and the delay.

        The rule of the sampled wall, K < b / (T / 2 + t_d) (Colgate and Schenkel 1997, with delay).
        1 N/m is 0.1 cN/mm.
        """
        return 0.1 * self.damping_N_s_m / (1e-6 * (self.settings.tick_us / 2 + self.delay_us))

    def rise_K(self, force_cN: float) -> float:
        """Give how much warmer the coil ends if a force is held for ever, by the controller's own model."""
        counts = abs(force_cN) * CN64_PER_cN
        duty = min(1.0, counts * self.settings.duty_gain_q16 / 2**16 / 2**15)
        return self.settings.full_duty_rise_K * duty**2
