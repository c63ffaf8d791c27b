"""Records of ticks as they arrive, and an honest count of those that did not."""

from __future__ import annotations

from dataclasses import dataclass, fields

import numpy as np
import numpy.typing as npt

from fdvv.protocol.messages import CN64_PER_cN, UM16_PER_mm
from fdvv.protocol.tables import Mode, RecordsRequest
from fdvv.units import FloatArray

IntArray = npt.NDArray[np.int64]
TICK_RECORD = np.dtype(
    [
        ("displacement_um16", "<i4"),
        ("velocity_mm_s16", "<i2"),
        ("commanded_cN64", "<i2"),
        ("force_cN64", "<i2"),
        ("state", "u1"),
        ("flags", "u1"),
    ]
)


@dataclass(frozen=True, eq=False)
class TickColumns:
    """Ticks in rising order; gaps are where `tick` jumps. Every column (n,).

    Attributes
    ----------
    tick : since the device booted.
    displacement_mm, velocity_mm_s, commanded_cN, force_cN : as the device has them; force 0 without a sensor.
    state, flags : of the program; bits of fdvv.protocol.tables.TickFlag.
    """

    tick: IntArray
    displacement_mm: FloatArray
    velocity_mm_s: FloatArray
    commanded_cN: FloatArray
    force_cN: FloatArray
    state: IntArray
    flags: IntArray

    def part(self, chosen: npt.NDArray[np.bool_]) -> TickColumns:
        return TickColumns(*(getattr(self, field.name)[chosen] for field in fields(self)))


class Telemetry:
    """What has arrived since the last `clear`.

    Attributes
    ----------
    last : the newest frame's head, None before the first.
    missing_frames : frames from the device that the line lost or damaged, by their sequence numbers.
    lost_records : records for which the device had no room, by its own count.
    late_ticks : ticks that the device itself missed.
    missing_ticks : ticks between records that should have come and did not.
    """

    def __init__(self) -> None:
        self.last: RecordsRequest | None = None
        self.missing_frames = self.lost_records = self.late_ticks = self.missing_ticks = 0
        self._sequence: int | None = None
        self._due: int | None = None
        self._pieces: list[tuple[RecordsRequest, bytes]] = []

    def count_missing(self, sequence: int) -> None:
        """Count the frames that should have come before this one."""
        if self._sequence is not None:
            self.missing_frames += (sequence - self._sequence - 1) % 256
        self._sequence = sequence

    def add(self, head: RecordsRequest, records: bytes, sequence: int) -> None:
        self.count_missing(sequence)
        if self.last is not None:
            self.lost_records += max(0, head.lost - self.last.lost)
            self.late_ticks += max(0, head.late - self.last.late)
        if self._due is not None:
            self.missing_ticks += max(0, (head.first_tick - self._due) // head.every)
        self._due = head.first_tick + head.every * head.count
        self.last = head
        self._pieces.append((head, records))

    def clear(self) -> None:
        """Forget records and counts, as before telemetry is switched on; the sequence is still followed."""
        self._pieces, self._due = [], None
        self.missing_frames = self.lost_records = self.late_ticks = self.missing_ticks = 0

    def armed(self) -> npt.NDArray[np.bool_]:
        """Return for each record of columns() whether the device rendered then."""
        armed = [head.mode in (Mode.ARMED, Mode.DERATED) for head, _ in self._pieces]
        return np.repeat(np.array(armed, dtype=np.bool_), [head.count for head, _ in self._pieces])

    def take(self) -> TickColumns:
        """Return what has arrived and forget it; counts and gaps go on."""
        columns = self.columns()
        self._pieces = []
        return columns

    def columns(self) -> TickColumns:
        heads = [head for head, _ in self._pieces]
        rows = np.frombuffer(b"".join(records for _, records in self._pieces), TICK_RECORD)
        ticks = [head.first_tick + head.every * np.arange(head.count, dtype=np.int64) for head in heads]
        return TickColumns(
            np.concatenate(ticks) if ticks else np.empty(0, np.int64),
            rows["displacement_um16"] / UM16_PER_mm,
            rows["velocity_mm_s16"] / 16.0,
            rows["commanded_cN64"] / CN64_PER_cN,
            rows["force_cN64"] / CN64_PER_cN,
            rows["state"].astype(np.int64),
            rows["flags"].astype(np.int64),
        )
