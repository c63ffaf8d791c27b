"""What the models of a run said last: a run that is closed and opened again is spared the same fits."""

from __future__ import annotations

from collections.abc import Callable
from typing import Generic, TypeVar

from fdvv_people.optimize.engines.multi_objective import ParetoFront

Result = TypeVar("Result")


class LastResult(Generic[Result]):
    """The last result of a pure function, kept as long as its inputs are equal."""

    def __init__(self) -> None:
        self._last: tuple[object, Result] | None = None

    def of(self, inputs: object, compute: Callable[[], Result]) -> Result:
        """Return the result of these inputs, computed if the last one was of others.

        What compute raises is not kept.
        """
        last = self._last
        if last is None or last[0] != inputs:
            last = self._last = inputs, compute()
        return last[1]


class RunMemory:
    """What to hand to a run that is opened again, in one thread at a time.

    Attributes
    ----------
    front : of several objectives. best : the design that an engine recommends.
    """

    def __init__(self) -> None:
        self.front, self.best = LastResult[ParetoFront](), LastResult[dict[str, float]]()
