"""A tuning as the settings of a device, and on a device."""

from __future__ import annotations

from dataclasses import replace
from math import exp, pi

from fdvv.compensate import Tuning
from fdvv.device import Device
from fdvv.errors import InputError, ModelError
from fdvv.protocol import CN64_PER_cN, MM_S16_PER_mm_s, Settings
from fdvv.units import cN_from_N

TUNED = (
    "predictor_q16",
    "lead_us",
    "brake_lead_us",
    "drag_q13",
    "friction_cN64",
    "friction_mm_s16",
)
"""Settings that follow from a tuning; the others are the rig's own."""


def settings_with(settings: Settings, tuning: Tuning) -> Settings:
    """Put a tuning into settings, at their tick; whether the table is paced is told with each upload.

    A tuning without bandwidth only turns the filter off, which leaves the rest of it idle. Raises InputError
    if the firmware cannot hold the tuning.
    """
    if not tuning.bandwidth_Hz:
        return replace(settings, predictor_q16=0)
    # 1 cN64 per mm_s16 in N s/m: a force in cN64 over a speed in mm_s16
    drag_q13 = float(cN_from_N(tuning.drag_N_s_m)) * CN64_PER_cN / (1000 * MM_S16_PER_mm_s) * 2**13
    wanted = {
        "predictor_q16": max(
            1, round((1 - exp(-2e-6 * pi * tuning.bandwidth_Hz * settings.tick_us)) * 2**16)
        ),
        "lead_us": round(1e6 * tuning.lead_s),
        "brake_lead_us": round(1e6 * tuning.brake_lead_s),
        "drag_q13": round(drag_q13),
        "friction_cN64": round(CN64_PER_cN * tuning.friction_cN),
        "friction_mm_s16": round(MM_S16_PER_mm_s * tuning.friction_mm_s),
    }
    try:
        return replace(settings, **wanted)
    except ModelError as error:
        reason = f"is beyond what a device can be told: {error}"
        raise InputError("tuning", str(tuning), reason, "ask for less of it") from error


def tune(device: Device, tuning: Tuning) -> bool:
    """Have a device work under a tuning; tell whether it had to be configured, and so lost its table.

    A device whose settings come to the same is left alone: one that never looked ahead is not written to for
    a tuning that does nothing. What was configured stays when a session ends.
    """
    wanted = settings_with(device.settings(), tuning)
    if wanted == device.settings():
        return False
    device.configure(wanted)
    return True
