"""The constants of the firmware's force loop and its cell's data sheet, from protocol/force_loop.toml."""

from __future__ import annotations

from fdvv.protocol.tables import CellSpec, ForceLoopGains

__all__ = ["CellSpec", "ForceLoopGains"]
