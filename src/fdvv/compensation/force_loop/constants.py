"""The constants of the firmware's force loop and its cell's data sheet, from protocol/force_loop.toml."""

from __future__ import annotations

from typing import Any

from fdvv.protocol.tables import CellSpec, ForceLoopGains

__all__ = ["OWN_VALUES", "CellSpec", "ForceLoopGains", "of_earlier_version"]

OWN_VALUES = 8
"""Of the rig's own force, over its travel."""


def of_earlier_version(record: dict[str, Any]) -> dict[str, Any]:
    """Return gains as a file holds them; earlier files know a weight, and a speed at which friction turns."""
    found = dict(record)
    if "weight_N" in found:
        found |= {"own_N": [-found.pop("weight_N")] * OWN_VALUES, "own_per_m": 1.0}
    if "friction_m_s" in found:
        del found["friction_m_s"]
        found["friction_m"] = 1e-4
    return found
