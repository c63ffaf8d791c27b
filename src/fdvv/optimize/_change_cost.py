"""What it costs to try another design: a rig needs an upload, or minutes of compensation, for a new force.

The acquisition is divided by the seconds a trial takes (expected improvement per second), and candidates
reuse what is built already; see CABOP (arXiv 2602.01774) for the idea with people.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from fdvv.errors import InputError
from fdvv.optimize._space import DesignSpace
from fdvv.units import FloatArray

SAME = 1e-6
REUSED = 0.5
"""Part of the candidates whose dear parameters are those of a design that was built before."""


@dataclass(frozen=True)
class ChangeCost:
    """Seconds that a trial takes.

    Attributes
    ----------
    trial_s : of the task itself. build_s : by parameter, of a value that no earlier trial had; the dearest of
        those that are new counts. What was built is kept, so coming back to it costs nothing.
    """

    trial_s: float
    build_s: Mapping[str, float]

    def __post_init__(self) -> None:
        for name, seconds in {"trial_s": self.trial_s, **self.build_s}.items():
            if not 0 <= seconds < np.inf or (name == "trial_s" and seconds == 0):
                raise InputError("cost", name, f"is {seconds} s", "give seconds above 0, or 0 to build")

    def dear(self, space: DesignSpace) -> list[int]:
        """List the parameters that cost something to build. InputError on one the space does not have."""
        for name in self.build_s:
            if name not in space.names:
                raise InputError(
                    "cost", name, "is no parameter of this space", f"use {', '.join(space.names)}"
                )
        return [i for i, name in enumerate(space.names) if self.build_s.get(name, 0.0) > 0]

    def seconds(self, space: DesignSpace, places: FloatArray, built: FloatArray) -> FloatArray:
        """Give what trying places (n, d) takes, (n,), after those built, (m, d)."""
        dear = self.dear(space)
        if not dear:
            return np.full(len(places), self.trial_s)
        price = np.array([self.build_s[space.names[i]] for i in dear])
        new = np.abs(places[:, None, dear] - built[None, :, dear]) >= SAME
        # the cheapest of what is there to begin from; with nothing there all is new
        owed = np.where(new, price, 0.0).max(axis=2).min(axis=1, initial=float(price.max()))
        return np.asarray(self.trial_s + owed)

    def reusing(self, space: DesignSpace, places: FloatArray, built: FloatArray, seed: int) -> FloatArray:
        """Give some of places (n, d) the dear values of designs that were built."""
        if not len(built):
            return places
        rng, dear, found = np.random.default_rng([seed, 12]), self.dear(space), places.copy()
        rows = np.flatnonzero(rng.random(len(places)) < REUSED)
        found[rows[:, None], dear] = built[rng.integers(len(built), size=len(rows))[:, None], dear]
        return found
