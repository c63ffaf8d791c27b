"""What every device refuses before anything is sent or pressed."""

from __future__ import annotations

import numpy as np

from fdvv.device._contract import DeviceInfo
from fdvv.errors import DeviceError
from fdvv.model import ForceSurface

SPEED_LIMITS_mm_s = (0.5, 500.0)
"""From a machine that probes statically, as the paper's did, to more than a finger does."""


def check_table(info: DeviceInfo, surface: ForceSurface, travel_mm: float) -> None:
    """Refuse a table or travel beyond the limits. DeviceError."""
    largest = max(float(np.abs(table).max()) for table in (surface.press_cN, surface.release_cN))
    if largest > info.force_limit_cN:
        raise DeviceError(
            f"{info.name}: the table reaches {largest:.4g} cN, the limit is {info.force_limit_cN:g} cN; "
            "clip the table before uploading it"
        )
    check_travel(info, travel_mm)


def check_travel(info: DeviceInfo, travel_mm: float) -> None:
    """Refuse a travel that the stop cannot set. DeviceError."""
    if not 0 < travel_mm <= info.travel_limit_mm:
        raise DeviceError(
            f"{info.name}: travel {travel_mm:g} mm is not within 0 to {info.travel_limit_mm:g} mm; "
            "choose a travel that the stop can set"
        )


def check_speed(name: str, velocity_mm_s: float) -> None:
    """Refuse an absurd speed of a press on the device of that name. DeviceError."""
    low, high = SPEED_LIMITS_mm_s
    if not low <= velocity_mm_s <= high:
        raise DeviceError(f"{name}: speed {velocity_mm_s:g} mm/s is not within {low:g} to {high:g} mm/s")
