"""What the processing of a recording takes for granted."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from fdvv.errors import ModelError
from fdvv.preprocess._reject import Limits


@dataclass(frozen=True)
class Settings:
    """What the processing takes for granted.

    Attributes
    ----------
    cap_g : mass of the moving cap, its stem, markers and a third of its spring; 40 % off changes a curve by
        0.7 cN rms at most, since only the tip's share of the motion is taken back.
    limits : when a press is left out.
    paces_mm_s : presses that were not asked for at a pace are given the nearest of these, if it is within
        half as much again; without any they are averaged together.
    """

    cap_g: float = 3.0
    limits: Limits = field(default_factory=Limits)
    paces_mm_s: tuple[float, ...] = ()

    def __post_init__(self) -> None:
        if not (np.isfinite(self.cap_g) and self.cap_g > 0):
            raise ModelError(f"cap_g must be above 0, got {self.cap_g}")
        if not all(np.isfinite(pace) and pace > 0 for pace in self.paces_mm_s):
            raise ModelError(f"paces_mm_s must be above 0, got {self.paces_mm_s}")
