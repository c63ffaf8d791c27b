"""What a self-test of the rig measured, before anything is concluded from it."""

from __future__ import annotations

import math
from dataclasses import dataclass

NAN = math.nan
GAUGES_mm = (4.5, 2.0)
"""Things of known size between stop and cap, in the order in which they are laid."""
WEIGHT_g = 50.0
"""Laid onto the force sensor."""


@dataclass(frozen=True)
class Lift:
    """What it takes to move the cap: commanded forces at which it leaves the bottom and comes back down.

    Attributes
    ----------
    lift_cN, drop_cN : as commanded; NaN if it did not move.
    reversed : it rose as the command fell.
    """

    lift_cN: float = NAN
    drop_cN: float = NAN
    reversed: bool = False

    @property
    def weight_cN(self) -> float:
        """Mean of both: what the coil carries, in its own scale."""
        return (self.lift_cN + self.drop_cN) / 2

    @property
    def friction_cN(self) -> float:
        """Half of their distance."""
        return (self.lift_cN - self.drop_cN) / 2

    @property
    def moved(self) -> bool:
        """Return whether the cap went up and came down."""
        return math.isfinite(self.lift_cN) and math.isfinite(self.drop_cN)


@dataclass(frozen=True)
class Latched:
    """A fault of the firmware with its evidence, in the firmware's units."""

    fault: str
    value: int
    bound: int


@dataclass(frozen=True)
class Evidence:
    """What was measured; NaN where a step could not be done.

    Attributes
    ----------
    link_missing : telemetry records that did not come, over those that should have.
    late_ticks : ticks that the firmware missed.
    nominal_mV, supply_mV : of the supply, as the settings state it and as the firmware reads it at rest.
    sag_mV : reading at which the firmware stopped while the coil pushed hard against the top; NaN: it held.
    position_ok : the firmware found its readings within bounds.
    rest_sd_um : spread of the displacement from tick to tick, at rest on the last gauge, coil off.
    gauge_mm : displacement on each of GAUGES_mm.
    fallen_mm : where the cap came to rest once nothing but the stop at free_stop_mm held it.
    stops_mm : displacement on the stop, by the travel that was commanded.
    empty, loaded : lifting the cap without and with the weight.
    hard_mm : place, pushed as hard as the settings allow.
    weight_cN : of what was laid on the cap.
    sensor_zero_cN, sensor_weight_cN : force sensor without and with it. has_sensor : the settings have one.
    vibration_answers : the board on the wire answers; None: it was not asked.
    tone_um, tone_floor_um : motion of the cap at the tones' frequencies, and beside them, rms of amplitudes.
    tone_ratio : mean over the tones of power over power beside; about 1 in silence.
    pwm_um, pwm_floor_um : motion at 732 Hz and beside it while the coil pushes.
    has_exciter : one is expected.
    faults : that the firmware latched meanwhile. notes : why a step could not be done, in the device's words.
    """

    link_missing: float = 0.0
    late_ticks: int = 0
    nominal_mV: float = NAN
    supply_mV: float = NAN
    sag_mV: float = NAN
    position_ok: bool = True
    rest_sd_um: float = NAN
    gauge_mm: tuple[float, ...] = ()
    free_stop_mm: float = NAN
    fallen_mm: float = NAN
    stops_mm: tuple[tuple[float, float], ...] = ()
    empty: Lift = Lift()
    loaded: Lift = Lift()
    hard_mm: float = NAN
    weight_cN: float = NAN
    sensor_zero_cN: float = NAN
    sensor_weight_cN: float = NAN
    has_sensor: bool = True
    vibration_answers: bool | None = None
    tone_um: float = NAN
    tone_floor_um: float = NAN
    tone_ratio: float = NAN
    pwm_um: float = NAN
    pwm_floor_um: float = NAN
    has_exciter: bool = True
    faults: tuple[Latched, ...] = ()
    notes: tuple[str, ...] = ()

    @property
    def gauge_line(self) -> tuple[float, float]:
        """Slope of the displacement over the gauges' sizes, 1 if right, and its zero, mm."""
        (high, low), (on_high, on_low) = GAUGES_mm, self.gauge_mm
        slope = (on_high - on_low) / (high - low)
        return slope, sum(self.gauge_mm) / 2 - slope * (high + low) / 2

    @property
    def gain(self) -> float | None:
        """Force of the coil over its command: the weight over the change of command that it asks for."""
        more_cN = self.loaded.weight_cN - self.empty.weight_cN
        return self.weight_cN / more_cN if math.isfinite(more_cN) and more_cN > 0 else None
