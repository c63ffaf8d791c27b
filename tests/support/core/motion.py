"""Where the cap is, which way it goes and how fast, in plain Python."""

from __future__ import annotations

from collections import deque
from dataclasses import dataclass, field

from fdvv.protocol.tables import Settings
from tests.support.core.arithmetic import Ratio, clamp, inverse, product, ratio_of, scale, slope

PRESS, RELEASE = "press", "release"


@dataclass
class Position:
    """Where the cap is and which way it goes."""

    settings: Settings
    recent: deque[int] = field(default_factory=deque)
    um16: int = 0
    extreme: int | None = None
    stroke: str = PRESS
    turned: str | None = None

    def tick(self, sum_counts: int) -> None:
        s = self.settings
        high, low = divmod(sum_counts, 256)  # products of 32 bits
        product = abs(s.position_gain_q14) * high + (abs(s.position_gain_q14) * low >> 8)
        way = (product + 32 >> 6) % 2**19
        raw = s.position_offset_um16 + (way if s.position_gain_q14 >= 0 else -way)
        self.recent.append(raw)
        while len(self.recent) > s.sliding_ticks:
            self.recent.popleft()
        n = len(self.recent)
        self.um16 = (sum(self.recent) + n // 2) // n
        self.find_direction()

    def find_direction(self) -> None:
        s, x = self.settings, self.um16
        self.turned = None
        if self.extreme is None:
            self.extreme = x
        if self.stroke == PRESS:
            self.extreme = max(self.extreme, x)
            if x < self.extreme - s.reversal_um16:
                self.stroke = self.turned = RELEASE
        else:
            self.extreme = min(self.extreme, x)
            if x > self.extreme + s.reversal_um16 or x < s.rearm_um16:
                self.stroke = self.turned = PRESS
        if self.turned:
            self.extreme = x


@dataclass
class Velocity:
    """How fast: once per press, and every tick."""

    settings: Settings
    tick_count: int = 0
    all: list[tuple[int, int]] = field(default_factory=list)
    even: list[int] = field(default_factory=list)
    inside: list[tuple[int, int]] = field(default_factory=list)
    decided: int | None = None
    continuous: int | None = None

    def tick(self, position: Position, elapsed: int) -> None:
        self.tick_count += elapsed
        if elapsed > 64:
            self.all, self.inside = [], []
        if elapsed != 1:
            self.even = []
        self.all = [*self.all, (self.tick_count, position.um16)][-32:]
        self.even = [*self.even, position.um16][-self.settings.continuous_samples :]
        if len(self.even) >= 3:
            self.continuous = self.estimate()
        self.watch(position)

    def estimate(self) -> int:
        n = len(self.even)
        weighted = sum((2 * i - (n - 1)) * x for i, x in enumerate(self.even))
        rate = product(ratio_of(6000), inverse(ratio_of(self.settings.tick_us)))
        return clamp(scale(weighted, product(rate, inverse(ratio_of(n * (n * n - 1))))), -32767, 32767)

    def watch(self, position: Position) -> None:
        s, x = self.settings, position.um16
        if x < s.rearm_um16:
            self.decided, self.inside = None, []
            return
        if position.stroke == RELEASE:
            self.inside = []
            return
        if self.decided is not None or x < s.window_start_um16:
            return
        if x <= s.window_end_um16:
            if self.inside and self.tick_count - self.inside[0][0] >= 32768:
                self.inside = []
            self.inside.append((self.tick_count, x))
        else:
            self.decide()

    def decide(self) -> None:
        s, used = self.settings, self.inside
        if len(used) < s.fewest_samples:
            used = self.all[-s.fewest_samples :]
            if len(used) < s.fewest_samples:
                return
            floor = used[-1][1] - 65535
            used = [(t, floor + clamp(x - floor, 0, 65535)) for t, x in used]
        up, spread = slope([(t - used[0][0], x - used[0][1]) for t, x in used])
        self.decided = self.scaled(up, spread) if up > 0 else 0

    def scaled(self, up: int, spread: int) -> int:
        s = self.settings
        found = product(ratio_of(up), inverse(ratio_of(spread)))
        to_mm_s16 = product(ratio_of(1000 * s.velocity_scale_q12), inverse(ratio_of(s.tick_us)))
        found = product(found, Ratio(to_mm_s16.mantissa, to_mm_s16.shift + 12))
        return min(scale(1, found), 65535)
