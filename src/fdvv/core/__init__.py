"""The firmware's tick, called from Python: the very code that runs on a board."""

from fdvv.core._core import Ask, Core
from fdvv.core._records import INPUTS, OUTPUTS, RecordArray, inputs_at, inputs_like

__all__ = ["INPUTS", "OUTPUTS", "Ask", "Core", "RecordArray", "inputs_at", "inputs_like"]
