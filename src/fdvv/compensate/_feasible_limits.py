"""What a rig's firmware lets through, in the units of a table: limits, grain of its sensor, warmth."""

from __future__ import annotations

from dataclasses import dataclass, fields

import numpy as np

from fdvv.errors import ModelError
from fdvv.protocol import CN64_PER_cN, Settings, UM16_PER_mm


@dataclass(frozen=True)
class RigLimits:
    """The part of a rig's settings that decides what it can render.

    Attributes
    ----------
    tick_s : period of the loop.
    force_limit_cN : largest command, both signs, of force limit and duty limit the lower one.
    slew_cN_tick : largest change of the command from tick to tick.
    full_duty_cN : command that takes the whole supply.
    reversal_mm : way back that turns press into release.
    grain_mm : step of one reading of the position.
    heat_s : thermal time constant of the coil.
    full_duty_rise_K : how much warmer it would end at full duty held for ever.
    derate_start_K : rise above which the force limit falls.
    """

    tick_s: float
    force_limit_cN: float
    slew_cN_tick: float
    full_duty_cN: float
    reversal_mm: float
    grain_mm: float
    heat_s: float
    full_duty_rise_K: float
    derate_start_K: float

    def __post_init__(self) -> None:
        values = [getattr(self, f.name) for f in fields(self)]
        if not np.isfinite(values).all() or min(values) <= 0:
            raise ModelError(f"limits of a rig must be finite and above 0, got {self}")

    @classmethod
    def of_settings(cls, settings: Settings) -> RigLimits:
        """Read them from what the firmware holds, at the nominal supply.

        The firmware turns a force into duty without regard to speed, so both limits bound the command; what
        the coil's braking takes or adds at speed is counted with the forces of the rig (``needed_cN``).
        """
        full_cN = 32768 * 65536 / settings.duty_gain_q16 / CN64_PER_cN
        duty_cN = full_cN * settings.duty_limit_q15 / 32768
        return cls(
            tick_s=1e-6 * settings.tick_us,
            force_limit_cN=min(settings.force_limit_cN64 / CN64_PER_cN, duty_cN),
            slew_cN_tick=settings.slew_cN64_tick / CN64_PER_cN,
            full_duty_cN=full_cN,
            reversal_mm=settings.reversal_um16 / UM16_PER_mm,
            grain_mm=settings.reads * settings.position_gain_q14 / 2**14 / UM16_PER_mm,
            heat_s=1e-3 * settings.heat_time_ms,
            full_duty_rise_K=settings.full_duty_rise_K,
            derate_start_K=settings.derate_start_K,
        )
