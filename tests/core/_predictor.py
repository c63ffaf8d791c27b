"""Looking ahead in plain Python: what firmware/core/predictor.c is held against."""

from __future__ import annotations

from dataclasses import dataclass

from fdvv.protocol import Settings

from ._arithmetic import Ratio, clamp, inverse, product, ratio_of, scale

NOTHING = Ratio(0, 100)
FURTHEST = 16000


def shifted(ratio: Ratio, right: int) -> Ratio:
    return Ratio(ratio.mantissa, ratio.shift + right)


def times(*factors: int | Ratio) -> Ratio:
    """Multiply from left to right, each product cut; nothing if a factor is 0."""
    if 0 in factors or NOTHING in factors:
        return NOTHING
    first, *rest = (ratio_of(f) if isinstance(f, int) else f for f in factors)
    for factor in rest:
        first = product(first, factor)
    return first


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
        q_ratio = times(shifted(ratio_of(q), 16)) if q else NOTHING
        self.gains = (
            times(q_ratio, shifted(ratio_of(3 * 2**16 - 3 * q + q * q // 2**16), 16)),
            times(q_ratio, q_ratio, shifted(ratio_of(3 * (2**17 - q)), 17)),
            shifted(times(q_ratio, q_ratio, q_ratio), -6),
        )
        lead = times(s.lead_us, tick)
        per_ms = times(1000, tick)
        self.lead_step, self.lead_bend = shifted(lead, 10), shifted(times(lead, lead), 16)
        self.brake_bend = shifted(times(s.brake_lead_us, tick), 5)
        self.drag = shifted(times(s.drag_q13, per_ms), 23)
        slope = times(s.friction_cN64, inverse(ratio_of(s.friction_mm_s16)))
        self.friction = shifted(times(slope, per_ms), 10)
        self.fastest, self.strongest = s.tick_us * 2**16, s.tick_us**2 * 2**10

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
        place, step, bend = (scale(beyond, gain) for gain in self.gains)
        self.place += place
        self.step = clamp(self.step + step, -self.fastest, self.fastest)
        self.bend = clamp(self.bend + bend, -self.strongest, self.strongest)
        return True

    def ahead_um16(self) -> int:
        assert self.place is not None
        lead = scale(self.step, self.lead_step) + scale(self.bend, self.lead_bend)
        return (self.place + 512) // 1024 + clamp(lead, -FURTHEST, FURTHEST)

    def resistance_cN64(self) -> int:
        s = self.settings
        step = clamp(self.step + scale(self.bend, self.brake_bend), -self.fastest, self.fastest)
        friction = clamp(scale(self.step, self.friction), -s.friction_cN64, s.friction_cN64)
        return scale(step, self.drag) + friction
