"""The constants of the firmware's force loop, as it holds them, and the data sheet of its cell."""

from __future__ import annotations

from dataclasses import astuple, dataclass

import numpy as np
import numpy.typing as npt

from fdvv.errors import ModelError


@dataclass(frozen=True)
class CellSpec:
    """A load cell in the cap, from its data sheet.

    Attributes
    ----------
    plate_kg : between finger and cell. stiffness_N_m, damping_N_s_m : of the cell.
    filter_s : time constant of its filter.
    """

    plate_kg: float
    stiffness_N_m: float
    damping_N_s_m: float
    filter_s: float


@dataclass(frozen=True)
class ForceLoopGains:
    """The constants of firmware/core/force_loop.h, in its order and units; see there.

    free_gains, stop_gains : of the estimator, four each.
    """

    tick_s: float
    compute_ratio: float
    mass_kg: float
    plate_kg: float
    drag_N_s_m: float
    brake_N_s_m: float
    friction_N: float
    friction_m_s: float
    weight_N: float
    gain: float
    gain_1_m: float
    gain_1_m2: float
    coil_rate: float
    cell_rate: float
    position_rate: float
    free_gains: tuple[float, ...]
    stop_gains: tuple[float, ...]
    lead_s: float
    velocity_lead_s: float
    proportional: float
    derivative_s: float
    lowpass_rate: float
    integral_1_s: float
    leak: float
    damping_N_s_m: float
    highpass_rate: float
    contact_rate: float

    def __post_init__(self) -> None:
        if not np.isfinite(self.pack()).all() or not (self.tick_s > 0 and self.mass_kg > 0 and self.gain > 0):
            raise ModelError(
                f"a force loop needs finite gains, a tick, a mass and a gain above 0, got {self}"
            )

    def pack(self) -> npt.NDArray[np.float32]:
        """Return all numbers in order, as the firmware holds them."""
        return np.hstack(astuple(self)).astype(np.float32)
