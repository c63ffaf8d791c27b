"""What presses have told about a rig: the few numbers that turn a command into the force on the finger."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, fields

import numpy as np

from fdvv.compensate._lag import late
from fdvv.errors import ModelError
from fdvv.units import FloatArray

cN_PER_N = 100.0
cN_PER_g_m_s2 = 0.1
"""A gram accelerated by 1 m/s2 needs 0.1 cN."""
DRAG_cN = cN_PER_N / 1000.0
"""A drag of 1 N s/m at 1 mm/s."""


@dataclass(frozen=True)
class KnownRig:
    """A rig as its own presses tell it; the finger's force at time t is

        felt(t) = coil(t) + viscous v + friction sign(v) - weight + mass a
        coil(t) + lag coil'(t) = gain(x) command(t - delay_s + lag) + back_emf gain(x)^2 v

    with x, v, a the cap's true motion, positive into the button, and lag the electric one. So to first order
    a command is felt after delay_s, and the coil's braking, coming late, takes some inertia away. The host
    never sees the twin's parameters: every number here is estimated from what a rig senses and commands, in
    the units of the finger's sensor, whose calibration it therefore shares.

    Attributes
    ----------
    gain : (c0, c1, c2) of c0 + c1 x + c2 x^2, x in mm: felt force per commanded force. It holds calibration,
        the coil's droop over its stroke and its resistance.
    delay_s : from the tick that commands a force to the moment when the coil pushes with it: computing, half
        a tick of holding, and the coil's inductance.
    electric_lag_s : the part of delay_s that is a first-order lag, the coil's inductance over its resistance.
    position_lag_s : how old the sensed displacement is.
    drag_N_s_m : viscous friction and, with a voltage drive, back-EMF where the gain is 1.
    back_emf_N_s_m : the part of drag_N_s_m that the coil makes; it follows the square of the gain.
    friction_cN : dry friction, half of the loop between both directions.
    weight_cN : of the mover along the stroke; negative if it hangs.
    mass_g : of all that moves with the cap.
    play_cN : hysteresis of the finger's force sensor, whole loop.
    position_noise_mm, force_noise_cN : rms, as sensed from tick to tick.
    residual_cN : rms of what the model does not explain of the presses it was made from, mean of 8 ms.
    presses : that it was made from.
    error : standard error of every number above that was estimated, by its name; of ``gain`` at mid travel.
    """

    gain: tuple[float, float, float] = (1.0, 0.0, 0.0)
    delay_s: float = 0.0
    electric_lag_s: float = 0.0
    position_lag_s: float = 0.0
    drag_N_s_m: float = 0.0
    back_emf_N_s_m: float = 0.0
    friction_cN: float = 0.0
    weight_cN: float = 0.0
    mass_g: float = 0.0
    play_cN: float = 0.0
    position_noise_mm: float = 0.0
    force_noise_cN: float = 0.0
    residual_cN: float = 0.0
    presses: int = 0
    error: Mapping[str, float] = field(default_factory=dict)

    def __post_init__(self) -> None:
        numbers = [getattr(self, f.name) for f in fields(self) if f.name not in ("gain", "error")]
        if not np.isfinite([*numbers, *self.gain, *self.error.values()]).all():
            raise ModelError(f"a known rig needs finite numbers, got {self}")

    def gain_at(self, displacement_mm: FloatArray) -> FloatArray:
        """Give felt per commanded force, the shape of displacement_mm."""
        c0, c1, c2 = self.gain
        return np.asarray(c0 + displacement_mm * (c1 + displacement_mm * c2))

    def drag_at(self, displacement_mm: FloatArray) -> FloatArray:
        """Give drag in N s/m, the shape of displacement_mm."""
        braking = self.back_emf_N_s_m * self.gain_at(displacement_mm) ** 2
        return np.asarray(self.drag_N_s_m - self.back_emf_N_s_m + braking)

    def opposing_cN(
        self,
        velocity_mm_s: FloatArray,
        acceleration_m_s2: FloatArray,
        displacement_mm: FloatArray | None = None,
    ) -> FloatArray:
        """Give the force on the finger that the rig makes by itself in this motion, at no command.

        All of one shape; without displacement_mm the gain counts as 1. The coil's lag counts to first order.
        """
        drag, emf = np.asarray(self.drag_N_s_m), np.asarray(self.back_emf_N_s_m)
        if displacement_mm is not None:
            drag = self.drag_at(displacement_mm)
            emf = drag - (self.drag_N_s_m - self.back_emf_N_s_m)
        rub = self.friction_cN * np.sign(velocity_mm_s)
        late_g = 1000.0 * emf * self.electric_lag_s
        inertia = cN_PER_g_m_s2 * (self.mass_g - late_g) * acceleration_m_s2
        return np.asarray(DRAG_cN * drag * velocity_mm_s + rub - self.weight_cN + inertia)

    def coil_cN(
        self,
        t_s: FloatArray,
        displacement_mm: FloatArray,
        velocity_mm_s: FloatArray,
        commanded_cN: FloatArray,
    ) -> FloatArray:
        """Give the force of the coil, its braking included, (n,) as every column, on even times.

        commanded_cN : as decided at t_s; straight between ticks, their holding counts in delay_s.
        """
        pushed = np.interp(t_s - self.delay_s + self.electric_lag_s, t_s, commanded_cN)
        emf = DRAG_cN * self.back_emf_N_s_m * self.gain_at(displacement_mm) ** 2
        coil = self.gain_at(displacement_mm) * pushed + emf * velocity_mm_s
        return late(coil, self.electric_lag_s, float(t_s[1] - t_s[0]))

    def felt_cN(
        self,
        t_s: FloatArray,
        displacement_mm: FloatArray,
        velocity_mm_s: FloatArray,
        acceleration_m_s2: FloatArray,
        commanded_cN: FloatArray,
    ) -> FloatArray:
        """Give the force on the finger between the stops, (n,) as every column; commanded_cN as coil_cN()."""
        coil = self.coil_cN(t_s, displacement_mm, velocity_mm_s, commanded_cN)
        viscous = DRAG_cN * (self.drag_N_s_m - self.back_emf_N_s_m) * velocity_mm_s
        rest = viscous + self.friction_cN * np.sign(velocity_mm_s) - self.weight_cN
        return coil + rest + cN_PER_g_m_s2 * self.mass_g * acceleration_m_s2
