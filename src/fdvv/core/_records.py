"""What a tick takes and gives, as NumPy records laid out like the C structures of firmware/core/inputs.h."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

from fdvv.protocol import Settings, UM16_PER_mm

RecordArray = np.ndarray[Any, np.dtype[np.void]]
"""Records of one kind, one for each tick (n,)."""

INPUTS = np.dtype(
    [
        ("time_us", "<u4"),
        ("sum", "<u4"),
        ("lowest", "<u2"),
        ("highest", "<u2"),
        ("elapsed_ticks", "<u2"),
        ("supply_mV", "<u2"),
        ("force_counts", "<u2"),
        ("board", "u1"),
    ],
    align=True,
)
"""Readings of one tick: device clock, sum of the position readings, lowest and highest of them, ticks since
the last call, supply, keycap force sensor, bits of what the board found wrong."""

OUTPUTS = np.dtype(
    [
        ("duty_q15", "<i2"),
        ("enable", "u1"),
        ("slot", "u1"),
        ("stop_us", "<u2"),
        ("key", "u1"),
        ("mode", "u1"),
        ("displacement_um16", "<i4"),
        ("velocity_mm_s16", "<i2"),
        ("commanded_cN64", "<i2"),
        ("force_cN64", "<i2"),
        ("state", "u1"),
        ("flags", "u1"),
    ],
    align=True,
)
"""Duty, bridge enable, waveform to start (NONE: none), servo pulse, reported key, mode, the tick's record
(fdvv.protocol.TickRecord)."""


def inputs_like(settings: Settings, sums: npt.ArrayLike) -> RecordArray:
    """Give undisturbed inputs, one tick per sum of readings.

    Ticks follow each other without a gap from time 0, single readings are the mean, the supply is nominal,
    the keycap force sensor reads its offset.
    """
    counts = np.asarray(sums, np.uint32)
    inputs = np.zeros(counts.size, INPUTS)
    inputs["sum"] = counts
    inputs["time_us"] = (np.arange(counts.size, dtype=np.uint64) * settings.tick_us).astype(np.uint32)
    inputs["lowest"] = inputs["highest"] = np.minimum(counts // settings.reads, 65535)
    inputs["elapsed_ticks"] = 1
    inputs["supply_mV"] = settings.nominal_supply_mV
    inputs["force_counts"] = settings.force_offset_counts
    return inputs


def inputs_at(settings: Settings, displacement_mm: npt.ArrayLike) -> RecordArray:
    """Give undisturbed inputs of a cap at these displacements (mm), as near as sums of readings can tell."""
    um16 = UM16_PER_mm * np.asarray(displacement_mm, float) - settings.position_offset_um16
    sums = np.round(um16 * 2**14 / settings.position_gain_q14)
    return inputs_like(settings, np.clip(sums, 0, 65535 * settings.reads))
