"""Taps of people to a metronome: read, and split by person."""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from fdvv.errors import InputError
from fdvv.units import FloatArray

COLUMNS = ["subject", "trial", "isi", "asynch"]


@dataclass(frozen=True, eq=False)
class Taps:
    """Asynchronies, every column (n,) in the order of tapping.

    Attributes
    ----------
    person, trial : who, in which trial. period_ms : of the metronome. late_ms : tap - beat.
    """

    person: FloatArray
    trial: FloatArray
    period_ms: FloatArray
    late_ms: FloatArray

    @property
    def people(self) -> tuple[int, ...]:
        """Get the numbers of all people, rising."""
        return tuple(int(one) for one in np.unique(self.person))

    @property
    def periods_ms(self) -> tuple[float, ...]:
        """Get the periods there are, rising."""
        return tuple(np.unique(self.period_ms).tolist())

    def of(self, people: Collection[int], period_ms: float | None = None) -> Taps:
        """Keep the taps of some people, and of one period if it is told."""
        keep = np.isin(self.person, list(people))
        if period_ms is not None:
            keep &= self.period_ms == period_ms
        return Taps(self.person[keep], self.trial[keep], self.period_ms[keep], self.late_ms[keep])


def read_taps(path: Path) -> Taps:
    """Read columns subject, trial, isi, asynch (ms), as Baath and Madison's data have them (MIT).

    Taps further than half a period from their beat belong to no beat and are left out. InputError.
    """
    lines = path.read_text(encoding="utf-8", errors="replace").splitlines()
    if not lines or lines[0].split(",") != COLUMNS:
        raise InputError(path, "line 1", "no table of taps", f"give the columns {','.join(COLUMNS)}")
    try:
        table = np.array([[float(cell) for cell in line.split(",")] for line in lines[1:] if line])
        person, trial, period, late = table.reshape(-1, len(COLUMNS)).T
    except ValueError as error:
        reason = f"a row cannot be read ({error})"
        raise InputError(path, "table", reason, "give four numbers a row") from error
    near = np.abs(late) < period / 2
    return Taps(person[near], trial[near], period[near], late[near])
