"""What passes between the emulated board and the world around it."""

from __future__ import annotations

from dataclasses import dataclass

CPU_MHZ = 48
COUNTS_MAX = 4095


@dataclass(frozen=True)
class WireMessage:
    """One I2C message of the board, from START to STOP; `acknowledged` bytes of it were taken."""

    started_us: float
    stopped_us: float
    address: int
    data: bytes
    acknowledged: bool


@dataclass(frozen=True)
class TickOutputs:
    """What the board's pins do at the instant of a tick.

    duty_q15 is the mean voltage across the coil in parts of the supply, 0 while the bridge is off.
    stop_us is the servo's pulse, 0 while there is none. messages ended since the last tick. key:
    whether the key line is high.
    """

    tick: int
    time_us: float
    duty_q15: int
    enable: bool
    stop_us: float
    messages: tuple[WireMessage, ...]
    key: bool = False


@dataclass(frozen=True)
class TickInputs:
    """What the converter finds from a tick on: one position reading for all, or one for each, in counts.

    supply_counts, force_counts and thermistor_counts are those of the converter's other inputs. Raises
    ValueError for counts that 12 bits cannot hold.
    """

    readings: int | tuple[int, ...]
    supply_counts: int = 2686  # 12 V through the divider: 12 V * 22 / 122 / 3.3 V * 4096
    force_counts: int = 0
    thermistor_counts: int = 2200  # at 21 C

    def __post_init__(self) -> None:
        readings = self.readings if isinstance(self.readings, tuple) else (self.readings,)
        for counts in (*readings, self.supply_counts, self.force_counts, self.thermistor_counts):
            if not 0 <= counts <= COUNTS_MAX:
                raise ValueError(f"a reading must lie in 0 to {COUNTS_MAX}, got {counts}")

    @classmethod
    def of_burst(cls, total: int, lowest: int, highest: int, reads: int, **others: int) -> TickInputs:
        """Return inputs whose `reads` readings have this sum, and these extremes if that is possible.

        others are supply_counts, force_counts and thermistor_counts. Raises ValueError for counts that 12
        bits cannot hold.
        """
        inner = reads - 2
        rest = total - lowest - highest
        if inner > 0 and lowest * inner <= rest <= highest * inner:
            return cls((lowest, *_spread(rest, inner), highest), **others)
        return cls(_spread(total, reads), **others)

    def reading(self, number: int) -> int:
        """Return the counts of a conversion of the burst, the last one for all beyond it."""
        if isinstance(self.readings, int):
            return self.readings
        return self.readings[min(number, len(self.readings) - 1)]


def _spread(total: int, count: int) -> tuple[int, ...]:
    share, more = divmod(total, count)
    return (share + 1,) * more + (share,) * (count - more)


@dataclass(frozen=True)
class PwmChange:
    """A new duty: when the processor wrote it, when the timer took it over, and what it is."""

    written_us: float
    effective_us: float
    duty_q15: int
    enable: bool


@dataclass(frozen=True)
class KeyChange:
    """The key line rose or fell, and when."""

    time_us: float
    is_down: bool


@dataclass(frozen=True)
class TickCost:
    """What serving one tick cost, emulated.

    burst_us: from the tick to the last reading. latency_us: from the tick to the new duty, None if none was
    written. longest_pass_us: longest time between two looks for readings. busy_cycles: beyond those of idle
    passes.
    """

    tick: int
    burst_us: float | None
    latency_us: float | None
    longest_pass_us: float
    busy_cycles: int
