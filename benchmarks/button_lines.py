"""One line of the table of button_validation, and the measure that it uses."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fdvv.units import FloatArray


@dataclass(frozen=True)
class Line:
    what: str
    got: str
    wanted: str
    met: bool


def rms(values: FloatArray) -> float:
    return float(np.sqrt(np.mean(values**2)))
