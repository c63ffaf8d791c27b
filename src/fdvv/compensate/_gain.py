"""How much of an error one press corrects."""

from __future__ import annotations

from dataclasses import dataclass

from fdvv.errors import ModelError


@dataclass(frozen=True)
class GainSchedule:
    """The proportion of the error that goes into the table, as a function of the error.

    The paper names it (Gamma of error_k) and does not print it. Here it is
    gain = most * (1 - (floor / error)^2), held between least and most: far above the floor a press is
    trusted, near the floor its error is mostly chance and is averaged over many presses.

    Attributes
    ----------
    most, least : bounds of the gain, 0 <= least <= most < 2; equal for a constant gain. With a plant of
        gain g the error shrinks by |1 - g * gain| per press, so beyond 2 / g the law diverges.
    floor_cN : error_k of a perfect table, from noise and from presses that differ.
    """

    most: float = 0.5
    least: float = 0.1
    floor_cN: float = 3.0

    def __post_init__(self) -> None:
        if not 0 <= self.least <= self.most < 2:
            raise ModelError(f"gains must satisfy 0 <= least <= most < 2, got {self.least}, {self.most}")
        if not self.floor_cN >= 0:
            raise ModelError(f"floor_cN must be at least 0, got {self.floor_cN}")

    @classmethod
    def constant(cls, gain: float) -> GainSchedule:
        """Make the schedule that ignores the error."""
        return cls(gain, gain, 0.0)

    def gain(self, error_cN: float) -> float:
        """Give the proportion for one press."""
        trust = 1 - (self.floor_cN / error_cN) ** 2 if error_cN > 0 else 0.0
        return min(max(self.most * trust, self.least), self.most)
