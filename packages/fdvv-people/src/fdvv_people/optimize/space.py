"""What may be varied, between which bounds, and what is known to be impossible before anybody tries it."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np
import numpy.typing as npt

from fdvv.errors import InputError, ModelError
from fdvv.units import FloatArray

LENGTH, BUTTON_LENGTH = 0.2, 0.45
"""Over which scores are expected to change, see `DesignSpace`: of anything, and of a button by a person, on
whom differences between buttons come out smoothed (chosen on simulated people who judge no engine)."""
Design = Mapping[str, float]
"""A value for every parameter of a space, by its name; the unit is the last part of the name."""


@dataclass(frozen=True)
class Parameter:
    """One number that is varied.

    Attributes
    ----------
    name : with its unit, as ``actuation_mm``.
    low, high : bounds, both allowed; low < high.
    scale : log where a ratio counts, not a difference; then low > 0.
    unit : for people, where the name does not end in it.

    Raises ModelError on anything else.
    """

    name: str
    low: float
    high: float
    scale: Literal["linear", "log"] = "linear"
    unit: str = ""

    def __post_init__(self) -> None:
        if not self.name.isidentifier():
            raise ModelError(f"a parameter's name must be an identifier, got {self.name!r}")
        if not (math.isfinite(self.low) and math.isfinite(self.high) and self.low < self.high):
            raise ModelError(
                f"{self.name} needs finite bounds, low below high, got {self.low} and {self.high}"
            )
        if self.scale == "log" and not self.low > 0:
            raise ModelError(f"{self.name} has a log scale and needs bounds above 0, got {self.low}")


@dataclass(frozen=True)
class Constraint:
    """What a design must hold, known without trying it.

    Attributes
    ----------
    name : short. text : what it requires, one sentence for a person.
    slack : of a design: at least 0 where it holds, the more below 0 the worse it is missed. Continuous in the
        design where it can be, so that engines may follow it.
    """

    name: str
    text: str
    slack: Callable[[Design], float]


@dataclass(frozen=True)
class DesignSpace:
    """All designs there are.

    Attributes
    ----------
    name : of the space. parameters : at least one, names differ. constraints : any number.
    length : over which a score is expected to change, in ranges times the root of their number.
    """

    name: str
    parameters: tuple[Parameter, ...]
    constraints: tuple[Constraint, ...] = ()
    length: float = LENGTH

    def __post_init__(self) -> None:
        names = [one.name for one in self.parameters]
        if not names or len(set(names)) != len(names):
            raise ModelError(f"a space needs parameters of different names, got {names}")

    @property
    def names(self) -> tuple[str, ...]:
        return tuple(one.name for one in self.parameters)

    def checked(self, design: Design, source: object = "design") -> dict[str, float]:
        """Return a design in the order of parameters. InputError if a value is missing, alien or outside."""
        self.check_names(design, source)
        for one in self.parameters:
            value = design.get(one.name)
            if value is None or not one.low <= value <= one.high:
                raise InputError(source, one.name, f"is {value}", f"give {one.low:g} to {one.high:g}")
        return {name: float(design[name]) for name in self.names}

    def check_names(self, named: Iterable[str], source: object) -> None:
        """Raise InputError where a name is no parameter's."""
        for name in named:
            if name not in self.names:
                remedy = f"use {', '.join(self.names)}"
                raise InputError(source, name, "is no parameter of this space", remedy)

    def nearest(self, design: Design) -> dict[str, float]:
        """Return a design with every parameter brought to its bounds."""
        return {one.name: float(np.clip(design[one.name], one.low, one.high)) for one in self.parameters}

    def broken(self, design: Design) -> tuple[Constraint, ...]:
        """List the constraints that a design does not hold."""
        return tuple(one for one in self.constraints if not one.slack(design) >= 0)

    def to_unit(self, designs: Sequence[Design]) -> FloatArray:
        """Map designs to the unit cube, (n, d)."""
        rows = [[design[name] for name in self.names] for design in designs]
        low, high = self._scaled(self._bounds)
        places = self._scaled(np.array(rows, dtype=np.float64).reshape(-1, low.size))
        return np.asarray((places - low) / (high - low))

    def of_unit(self, places: npt.ArrayLike) -> list[dict[str, float]]:
        """Map places (n, d) of the unit cube to designs; what lies outside is brought to a bound."""
        low, high = self._scaled(self._bounds)
        rows = low + np.atleast_2d(np.asarray(places)) * (high - low)
        rows[:, self._log] = np.exp(rows[:, self._log])
        rows = np.clip(rows, *self._bounds)
        return [dict(zip(self.names, row.tolist(), strict=True)) for row in rows]

    @property
    def _log(self) -> npt.NDArray[np.bool_]:
        return np.array([one.scale == "log" for one in self.parameters])

    def _scaled(self, rows: FloatArray) -> FloatArray:
        """Return values, (n, d), on the scales that engines search evenly."""
        scaled = rows.copy()
        scaled[:, self._log] = np.log(rows[:, self._log])
        return scaled

    @property
    def _bounds(self) -> FloatArray:
        return np.array([(one.low, one.high) for one in self.parameters]).T
