"""The thermistor's rule again, in exact Python numbers; the table is the one of tools/make_thermistor.py."""

from __future__ import annotations

from dataclasses import dataclass

from tools.make_thermistor import MARGIN_K, STEP, rise_K_q8

from fdvv.protocol.tables import BoardLimits, Fault, Settings

TICKS, OPEN, SHORT, COLD_K = 100, 3900, 64, 10
K, MOST = 2**16, 2**32 - 1
TABLE = [rise_K_q8(STEP * i) for i in range(4096 // STEP + 1)]


def rise_K_q16(counts: int) -> int:
    """Return the chord of the table."""
    i, rest = divmod(counts, STEP)
    return (TABLE[i] << 8) - (((TABLE[i] - TABLE[i + 1]) * rest) << 8) // STEP


def share(value: int, part_q32: int) -> int:
    """Return a part of a value, rounded down."""
    return value * part_q32 >> 32


@dataclass
class Thermistor:
    """State between samples. fault: of the last sample, with value and bound."""

    fault: Fault = Fault.NONE
    evidence: tuple[int, int] = (0, 0)
    load: int = 0
    excess: int = 0
    least: int = 0
    follower: int = 0
    reading: int = 0
    known: bool = False
    ticks: int = 0
    before: int = 0
    fitted: bool = False
    keep: int = 0
    cooling: int = 0
    warming: int = 0
    inverse: int = 0
    jump: int = 0
    counts: int = 0

    def set(self, limits: BoardLimits, settings: Settings, heating_q32: int) -> None:
        """Use a tick and a board, once the load of the old tick is taken."""
        self._take(heating_q32)
        lag, time = 1000 * limits.thermistor_lag_ms, 1000 * limits.heat_time_ms
        span = TICKS * settings.tick_us
        self.fitted = lag > 0
        self.keep = 2**32 * lag // (lag + span) + 1
        self.cooling = 2**32 * span // (time + span)
        self.warming = 2**32 * settings.tick_us // time // 2
        if settings.full_duty_rise_K > limits.full_duty_rise_K:
            part = 2**32 * limits.full_duty_rise_K // settings.full_duty_rise_K
            self.warming = share(self.warming, part)
        self.inverse = 2**32 // limits.thermistor_share_q8 // 256 + 1
        self.jump = 8 * K + share(4 * limits.heat_limit_K * K, MOST - self.keep)

    def tick(self, end_K_q16: int, ticks: int) -> bool:
        """Take the load of a tick and of those missed before it; return whether a sample is due."""
        self.load += end_K_q16 + (ticks - 1) * self.before
        self.before = end_K_q16
        self.ticks = min(65535, self.ticks + ticks)
        return self.ticks >= TICKS

    def sample(self, counts: int, heat: int, heating_q32: int) -> int:
        """Return the new bound on the coil's rise."""
        self.counts = counts
        late, self.ticks = self.ticks >= 2 * TICKS, 0
        self.excess = share(self.excess, self.keep) + 1
        self.least -= share(self.least, self.cooling)
        self._take(heating_q32)
        self.follower = share(self.follower, self.keep) + share(self.least, MOST - self.keep)
        self.fault = Fault.NONE
        if counts > OPEN:
            return self._fail(Fault.THERMISTOR_OPEN, min(counts, 32767), OPEN, heat)
        if counts < SHORT:
            return self._fail(Fault.THERMISTOR_SHORT, counts, SHORT, heat)
        rise = rise_K_q16(counts)
        last, self.reading = self.reading, self._as_coil(rise)
        change = abs(self.reading - last)
        if self.known and not late and change > self.jump:
            return self._fail(Fault.THERMISTOR_JUMP, change // K, self.jump // K, heat)
        if self.follower > self.reading + COLD_K * K:
            return self._fail(Fault.THERMISTOR_COLD, self.reading // K, self.follower // K, heat)
        if not self.known:
            self.known = True
            most = min(MOST, heat + self._as_coil(int(2 * MARGIN_K) * K))
            self.excess = max(0, most - self.reading)
        highest = min(MOST, self.reading + self.excess)
        return max(min(heat, highest), rise - int(2 * MARGIN_K) * K, 0)

    def _as_coil(self, rise: int) -> int:
        return (rise * self.inverse >> 16) + 1

    def _fail(self, fault: Fault, value: int, bound: int, heat: int) -> int:
        self.fault, self.known = fault, False
        self.evidence = tuple((n + 2**15) % 2**16 - 2**15 for n in (value, bound))  # type: ignore[assignment]
        return heat

    def _take(self, heating_q32: int) -> None:
        load_q8 = self.load // 256 + 1
        self.excess = min(MOST, self.excess + self._warmed(load_q8, heating_q32))
        self.least = min(MOST, self.least + self._warmed(load_q8, self.warming))
        self.load = 0

    @staticmethod
    def _warmed(load_q8: int, part_q32: int) -> int:
        return MOST if load_q8 > MOST else min(MOST, (load_q8 * part_q32 >> 24) + 1)
