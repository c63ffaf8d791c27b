"""What a task measures: quantities to be made small or large, and their values."""

from __future__ import annotations

import math
from dataclasses import dataclass

from msgspec import Struct

from fdvv.errors import ModelError


class Objective(Struct, frozen=True, forbid_unknown_fields=True):
    """One quantity to be made small (or large).

    Attributes
    ----------
    name : with its unit, as ``asynchrony_ms``. larger_is_better : the direction.
    """

    name: str
    larger_is_better: bool = False

    @property
    def sign(self) -> float:
        """What makes smaller better: -1 where larger is."""
        return -1.0 if self.larger_is_better else 1.0


@dataclass(frozen=True)
class Score:
    """The value of one objective.

    Attributes
    ----------
    value : in the objective's unit. error : standard error of it, None if unknown.
    """

    value: float
    error: float | None = None

    def __post_init__(self) -> None:
        if not math.isfinite(self.value) or not (self.error is None or 0 <= self.error < math.inf):
            raise ModelError(f"a score needs a finite value and an error of at least 0, got {self}")
