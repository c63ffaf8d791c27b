"""Undisturbed readings for the firmware's core."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from fdvv.firmware.core import INPUTS, RecordArray
from fdvv.protocol.messages import UM16_PER_mm
from fdvv.protocol.tables import Settings


def inputs_like(settings: Settings, sums: npt.ArrayLike) -> RecordArray:
    """Return undisturbed inputs, one tick per sum of readings.

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
    """Return undisturbed inputs of a cap at these displacements (mm), rounded to sums of readings."""
    um16 = UM16_PER_mm * np.asarray(displacement_mm, float) - settings.position_offset_um16
    sums = np.round(um16 * 2**14 / settings.position_gain_q14)
    return inputs_like(settings, np.clip(sums, 0, 65535 * settings.reads))
