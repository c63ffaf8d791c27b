"""The design that is best for a whole group of simulated people, without a trial of anybody. Simulated."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from importlib import resources

import msgspec
import numpy as np

FILE = "fixed_designs.json"


@dataclass(frozen=True)
class FixedDesign:
    """A design of the paper's space that is a button.

    Attributes
    ----------
    group, level : whose it is, at what. design : by parameter.
    judged_ms : expected asynchrony with people who had no part in the choice, one each.
    """

    group: str
    level: str
    design: dict[str, float]
    judged_ms: tuple[float, ...]

    @property
    def mean_ms(self) -> float:
        """What the group scores with it on average."""
        return float(np.mean(self.judged_ms))


def fixed_design(group: str, level: str | None) -> FixedDesign | None:
    """Return the best fixed design of a group at a level of temporal pointing; None where none is known.

    Computed by ``python -m benchmarks.fixed_design`` on people who judge no engine.
    """
    return next((one for one in _all() if (one.group, one.level) == (group, level)), None)


@lru_cache(maxsize=1)
def _all() -> tuple[FixedDesign, ...]:
    text = resources.files(__package__).joinpath(FILE).read_bytes()
    return msgspec.convert(msgspec.json.decode(text)["designs"], tuple[FixedDesign, ...])
