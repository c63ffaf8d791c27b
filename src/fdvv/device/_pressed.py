"""A device that a person presses: presses are found in its telemetry."""

from __future__ import annotations

import numpy as np

from fdvv.device._client import Client
from fdvv.device._port import Port
from fdvv.device._remote import Remote
from fdvv.device._telemetry import TickColumns
from fdvv.errors import DeviceError
from fdvv.model import Press
from fdvv.protocol import Mode, TickFlag

TOP_mm = 0.15
"""Above it the cap is at rest."""

DEEP_RATIO = 0.9
"""Part of the travel that a press must reach; a lighter touch is passed over."""

LEAD_TICKS = 20
"""Kept before the cap leaves the top, and after it is back."""

GLANCE_s = 0.02


class PressedDevice(Remote):
    """A device on a line, and someone at it.

    Its records hold what the rig sensed: true displacement is not known, and without a force sensor on the
    cap the force is the commanded one.

    Parameters
    ----------
    port : an open line.
    patience_s : how long to wait for a press.
    """

    def __init__(self, port: Port, patience_s: float = 30.0) -> None:
        self._patience_s = patience_s
        try:
            super().__init__(Client(port))
        except BaseException:
            port.close()
            raise

    def press(self, velocity_mm_s: float) -> Press:
        """Wait until someone has pressed; DeviceError on a fault or if nobody does."""
        travel_mm = self._check_press(velocity_mm_s)
        self.client.announce(velocity_mm_s)
        self.client.telemetry.clear()
        self.client.stream(1)
        try:
            self.client.arm()
            found = self._wait(travel_mm)
        finally:
            self.stop()
        return self._record(found, velocity_mm_s)

    def _wait(self, travel_mm: float) -> TickColumns:
        port, telemetry = self.client.port, self.client.telemetry
        until_s = port.now_s() + self._patience_s
        while port.now_s() < until_s:
            self.client.listen(port.now_s() + GLANCE_s)
            told = telemetry.columns()
            rows = find_press(told, travel_mm)
            if rows is not None:
                return told.part(rows)
            if telemetry.last is not None and telemetry.last.mode == Mode.FAULT:
                self._fail_on_fault()
        raise DeviceError(
            f"{port.name}: nobody pressed within {self._patience_s:g} s; press the button fully"
        )

    def _record(self, told: TickColumns, velocity_mm_s: float) -> Press:
        t_s = (told.tick - told.tick[0]) * self._settings.tick_us * 1e-6
        force_cN = told.force_cN if self._settings.force_gain_q14 else told.commanded_cN
        return Press(
            t_s,
            told.displacement_mm,
            force_cN,
            velocity_mm_s,
            told.displacement_mm,
            told.force_cN,
            told.commanded_cN,
            (told.flags & TickFlag.LIMITED) > 0,
            np.ones(t_s.size, dtype=np.bool_),
            simulated=self.info().simulated,
        )


def find_press(told: TickColumns, travel_mm: float) -> np.ndarray[tuple[int], np.dtype[np.bool_]] | None:
    """Choose the rows of the first whole press and release that went deep enough; None if there is none."""
    down = told.displacement_mm > TOP_mm
    edges = np.flatnonzero(np.diff(down)) + 1
    if down.size and down[0]:
        edges = edges[1:]  # it was held as the records began
    for left, back in zip(edges[::2], edges[1::2], strict=False):
        if told.displacement_mm[left:back].max() >= DEEP_RATIO * travel_mm and back + LEAD_TICKS <= down.size:
            chosen = np.zeros(down.size, dtype=np.bool_)
            chosen[max(0, left - LEAD_TICKS) : back + LEAD_TICKS] = True
            return chosen
    return None
