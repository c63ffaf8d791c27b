"""Numbers of the force loop that its protocol leaves open, and its constants in files of earlier versions."""

from __future__ import annotations

from typing import Any

from fdvv.protocol.tables import ForceLoopGains

OWN_VALUES = ForceLoopGains.RUNS["own_N"]
"""Of the rig's own force, over its travel."""
FRICTION_m = 1e-4
"""As over reversal_m of the recommended rig: what turns with the stroke turns together."""


def of_earlier_version(record: dict[str, Any]) -> dict[str, Any]:
    """Return gains as a file holds them; earlier files know a weight, and a speed at which friction turns."""
    gains = dict(record)
    if "weight_N" in gains:
        gains |= {"own_N": [-gains.pop("weight_N")] * OWN_VALUES, "own_per_m": 1.0}
    if "friction_m_s" in gains:
        del gains["friction_m_s"]
        gains["friction_m"] = FRICTION_m
    return gains
