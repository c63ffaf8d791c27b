"""One synchronised stroke pair, the record that capture, twin and devices share."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fdvv.errors import ModelError
from fdvv.units import FloatArray


@dataclass(frozen=True, eq=False)
class Press:
    """A press and its release on one clock.

    Attributes
    ----------
    t_s : (n,) strictly rising.
    displacement_mm : (n,) true displacement of the cap, into the button.
    force_cN : (n,) force between finger and cap.
    velocity_mm_s : the speed that was asked for.
    sensed_mm, sensed_cN, commanded_cN : (n,) what the rig sensed and commanded; None where there is no rig.
    saturated : (n,) the command was cut to a limit; None where there is no rig.
    tick : (n,) the rig's control loop sampled here; between ticks the sensed and commanded columns hold
        their last values. None where there is no rig.
    simulated : the record comes from the twin.
    """

    t_s: FloatArray
    displacement_mm: FloatArray
    force_cN: FloatArray
    velocity_mm_s: float
    sensed_mm: FloatArray | None = None
    sensed_cN: FloatArray | None = None
    commanded_cN: FloatArray | None = None
    saturated: np.ndarray[tuple[int], np.dtype[np.bool_]] | None = None
    tick: np.ndarray[tuple[int], np.dtype[np.bool_]] | None = None
    simulated: bool = False

    def __post_init__(self) -> None:
        sensed = ("sensed_mm", "sensed_cN", "commanded_cN", "saturated", "tick")
        for name in ("displacement_mm", "force_cN", *sensed):
            column = getattr(self, name)
            if column is not None and column.shape != self.t_s.shape:
                raise ModelError(f"{name} must match t_s, got {column.shape} and {self.t_s.shape}")
        if self.t_s.size < 2 or np.any(np.diff(self.t_s) <= 0):
            raise ModelError("t_s must hold at least 2 strictly rising times")

    def __repr__(self) -> str:
        return f"Press({self.t_s.size} samples at {self.velocity_mm_s:g} mm/s)"
