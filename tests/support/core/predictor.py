"""Looking ahead in plain Python: what firmware/core/predictor.c is held against."""

from __future__ import annotations

from dataclasses import dataclass

from fdvv.protocol.tables import Settings
from tests.support.core.arithmetic import Ratio, clamp, inverse, product, ratio_of

FURTHEST = 16000


def times(*factors: int | Ratio) -> Ratio | None:
    """Multiply from left to right, each product cut; None if a factor is 0."""
    if 0 in factors:
        return None
    first, *rest = (ratio_of(f) if isinstance(f, int) else f for f in factors)
    for factor in rest:
        first = product(first, factor)
    return first


def scaled(value: int, ratio: Ratio | None, right: int) -> int:
    """Return value * ratio / 2^right to the nearest, halves up, after 16 bits of the product were cut."""
    if ratio is None or ratio.shift + right > 45:
        return 0
    top, shift = value * ratio.mantissa >> 16, ratio.shift + right - 16
    if shift < 0:  # a gain of 1 or more is kept just below it
        return value * 65535 >> 16
    return (2 * top + 2**shift) >> (shift + 1) if shift else top


@dataclass
class Predictor:
    """Place in 2^-10 um16, velocity in the same per tick, half the acceleration in 2^-16 um16 per tick^2."""

    settings: Settings
    place: int | None = None
    step: int = 0
    bend: int = 0

    def __post_init__(self) -> None:
        s = self.settings
        q, tick = s.predictor_q16, inverse(ratio_of(s.tick_us))
        self.on = q > 0
        self.gains = (
            (times(q, 3 * 2**16 - 3 * q + q * q // 2**16), 32),
            (times(q, q, 3 * (2**17 - q)), 49),
            (times(q, q, q), 49 - 6),
        )
        lead, brake = times(s.lead_us, tick) or 0, times(s.brake_lead_us, tick) or 0
        drag = times(s.drag_q13, 1000, tick) or 0
        slope = times(s.friction_cN64, inverse(ratio_of(s.friction_mm_s16))) or 0
        self.lead_step, self.lead_bend = times(lead), times(lead, lead)
        self.drag_step, self.drag_bend, self.friction = (
            times(drag),
            times(drag, brake),
            times(slope, 1000, tick),
        )
        limit_us = min(s.tick_us, 1000)  # beyond, 4 mm and 2 mm more in each tick
        self.fastest, self.strongest = limit_us * 2**16, limit_us**2 * 2**10

    def tick(self, um16: int, elapsed: int) -> None:
        if not self.on:
            return
        if self.place is None or elapsed > 8 or not self.follow(um16, elapsed):
            self.place, self.step, self.bend = um16 * 1024, 0, 0

    def follow(self, um16: int, elapsed: int) -> bool:
        """Predict and correct; False if the cap is elsewhere."""
        assert self.place is not None
        for _ in range(elapsed):
            self.place += self.step + (self.bend + 32) // 64
            self.step = clamp(self.step + (self.bend + 16) // 32, -self.fastest, self.fastest)
        beyond = um16 * 1024 - self.place
        if abs(beyond) > FURTHEST * 1024:
            return False
        place, step, bend = (scaled(64 * beyond, gain, 6 + right) for gain, right in self.gains)
        self.place += place
        self.step = clamp(self.step + step, -self.fastest, self.fastest)
        self.bend = clamp(self.bend + bend, -self.strongest, self.strongest)
        return True

    def ahead_um16(self) -> int:
        assert self.place is not None
        lead = scaled(self.step, self.lead_step, 10) + scaled(self.bend, self.lead_bend, 16)
        return (self.place + 512) // 1024 + clamp(lead, -FURTHEST, FURTHEST)

    def resistance_cN64(self) -> int:
        most = self.settings.friction_cN64
        drag = scaled(self.step, self.drag_step, 23) + scaled(self.bend, self.drag_bend, 28)
        return drag + clamp(scaled(self.step, self.friction, 10), -most, most)
