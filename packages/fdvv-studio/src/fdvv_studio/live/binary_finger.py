"""A finger driven by a key, a mouse button or a touch: down or up."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

from fdvv.units import N_from_cN, mm_from_m
from fdvv_studio.live.press import LivePress
from fdvv_studio.live.press_subject import PressSubject

FINGER_PAD_mm = 0.5
"""Compression of the finger pad."""
LIFTED_mm = -2.0
TAPPED_mm_s = 300.0
"""Peak speed of one who taps as fast as they can: that of the quickest of simulated people, whose mean speed
is up to 150 mm/s with a peak of 1.9 times as much (assumed)."""


@dataclass(frozen=True)
class BinaryFinger:
    """Presses a button always in the same way, to the bottom, like a practised person.

    Attributes
    ----------
    bottom_mm : referent of the muscle: deeper than the stop by the compliance of finger and pad.
    pace_mm_s : peak speed at which the referent goes down and up, whatever the button.
    top_mm : referent between two presses; 0 touches the cap at rest.
    """

    bottom_mm: float
    pace_mm_s: float = 120.0
    top_mm: float = LIFTED_mm

    @classmethod
    def of(cls, subject: PressSubject, push_cN: float = 120.0) -> BinaryFinger:
        """Return the finger for a button: with push_cN more than the button's largest force."""
        force_cN = float(subject.target_cN(0.0)[0].max()) + push_cN
        yields_m = N_from_cN(force_cN) / subject.finger.impedance.stiffness_N_m
        return cls(subject.travel_mm + float(mm_from_m(yields_m)) + FINGER_PAD_mm)

    @classmethod
    def tapping(cls, subject: PressSubject) -> BinaryFinger:
        """Return the finger of one who taps as fast as they can: it stays at the cap, and is quicker."""
        return replace(cls.of(subject), pace_mm_s=TAPPED_mm_s, top_mm=0.0)

    def down(self, press: LivePress) -> None:
        press.lead(self.bottom_mm, near_1_s=self._near_1_s)

    def up(self, press: LivePress) -> None:
        press.lead(self.top_mm, near_1_s=self._near_1_s)

    @property
    def _near_1_s(self) -> float:
        """Rate of a critically damped motion: its peak speed is distance times rate over e."""
        return math.e * self.pace_mm_s / (self.bottom_mm - self.top_mm)
