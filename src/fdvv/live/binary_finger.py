"""A hand that knows only down and up, as a key, a mouse button or a touch tells it."""

from __future__ import annotations

import math
from dataclasses import dataclass

from fdvv.units import N_from_cN, mm_from_m
from fdvv.workflow._live_press import LivePress
from fdvv.workflow._press_subject import PressSubject

PULP_mm = 0.5
"""What the fingertip gives way by."""
LIFTED_mm = -2.0


@dataclass(frozen=True)
class KeyHand:
    """Presses a button every time alike, to the bottom, as people who know it do.

    Attributes
    ----------
    bottom_mm : where the muscle aims: deeper than the stop by what finger and pulp yield.
    pace_mm_s : peak speed at which the referent goes down and up, whatever the button.
    """

    bottom_mm: float
    pace_mm_s: float = 120.0

    @classmethod
    def of(cls, subject: PressSubject, push_cN: float = 120.0) -> KeyHand:
        """Give the hand for a button: it has push_cN to spare where the button resists most."""
        force_cN = float(subject.meant_cN(0.0)[0].max()) + push_cN
        yields_m = N_from_cN(force_cN) / subject.finger.impedance.stiffness_N_m
        return cls(subject.travel_mm + float(mm_from_m(yields_m)) + PULP_mm)

    def down(self, press: LivePress) -> None:
        """Go down from now on."""
        press.lead(self.bottom_mm, near_1_s=self._near_1_s)

    def up(self, press: LivePress) -> None:
        """Let go from now on."""
        press.lead(LIFTED_mm, near_1_s=self._near_1_s)

    @property
    def _near_1_s(self) -> float:
        """Give the rate of a critically damped move: its peak speed is way times rate over e."""
        return math.e * self.pace_mm_s / (self.bottom_mm - LIFTED_mm)
