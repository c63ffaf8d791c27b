"""Devices behind the link: limits, uploads, faults; a device that a person presses."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import suppress
from typing import Self

import numpy as np

from fdvv.device.client import Client
from fdvv.device.contract import (
    DeviceInfo,
    FaultReport,
    PressError,
    SPEED_LIMITS_mm_s,
    check_speed,
    check_table,
)
from fdvv.device.remote_loop import RemoteLoop
from fdvv.device.telemetry import TickColumns
from fdvv.device.wire import Port, RefusedError
from fdvv.errors import DeviceError, ModelError
from fdvv.model.press import Press
from fdvv.model.surface import ForceSurface
from fdvv.protocol.messages import CN64_PER_cN, UM16_PER_mm, travel_mm_of
from fdvv.protocol.tables import BoardFlag, CellSpec, Fault, ForceLoopGains, Mode, Refusal, Settings, TickFlag
from fdvv.twin.image import image_of

BATCH_s = 0.05
TOP_mm = 0.15
"""Above it the cap is at rest."""
DEEP_RATIO = 0.9
"""Part of the travel that a press must reach; a lighter touch is passed over."""
LEAD_TICKS = 20
"""Kept before the cap leaves the top, and after it is back."""
POLL_s = 0.02
SETTLED_s, READ_s = 0.5, 0.3
"""Until a cap without force lies still, and how long its load cell is then read."""


def surface_image(surface: ForceSurface, travel_mm: float, paced: bool = False) -> bytes:
    """Make a program of one state that follows the surface; DeviceError if a device cannot hold it."""
    try:
        return image_of(surface, travel_mm, paced=paced).image
    except ModelError as error:
        raise DeviceError(str(error)) from error


class Remote:
    """What every device behind the link has in common: limits, uploads, faults, the force loop.

    Attributes
    ----------
    client : the connection.
    force_loop : the loop of a board that has one.
    travel_mm, image : of the active program as uploaded here; None and empty before.
    """

    def __init__(self, client: Client) -> None:
        self.client = client
        self._settings = client.read_settings()
        self.travel_mm: float | None = None
        self.image = b""
        self._closed = False
        self.force_loop = RemoteLoop(client)

    def info(self) -> DeviceInfo:
        hello, settings = self.client.hello, self._settings
        return DeviceInfo(
            hello.name.rstrip(b"\0").decode("ascii", "replace"),
            bool(hello.board_flags & (BoardFlag.SIMULATED | BoardFlag.EMULATED)),
            settings.force_limit_cN64 / CN64_PER_cN,
            hello.travel_um16_256 * 256 / UM16_PER_mm,
            settings.tick_us * 1e-6,
        )

    @property
    def has_exciter(self) -> bool:
        """Whether a vibration board answers; nothing says whether an exciter hangs on it."""
        return bool(self.parts & BoardFlag.VIBRATION)

    @property
    def parts(self) -> BoardFlag:
        """What the board has, or says it has."""
        return BoardFlag(self.client.hello.board_flags)

    def settings(self) -> Settings:
        return self._settings

    def configure(self, settings: Settings) -> None:
        """Replace calibration and limits, whole or not at all; the device forgets its program.

        Raises DeviceError with the device's reason, one of which is that it is rendering.
        """
        self.client.write_settings(settings)
        self._settings, self.travel_mm = settings, None
        self.force_loop.read()

    @property
    def load_cell(self) -> CellSpec | None:
        return self.force_loop.load_cell

    @property
    def loop(self) -> ForceLoopGains | None:
        return self.force_loop.gains

    def fit_cell(self, cell: CellSpec | None) -> None:
        """Say which load cell is fitted; opens the loop. DeviceError on a board without a force loop."""
        self.travel_mm = None
        self.force_loop.fit(cell)

    def close_loop(self, gains: ForceLoopGains | None) -> None:
        """Close the loop, or open it; upload again afterwards. DeviceError without a cell, or with the
        device's reason, one of which is that it is rendering.
        """
        self.force_loop.close(gains)
        self.travel_mm = None

    def free_cell_cN(self) -> float:
        """Return what the load cell reads at zero force, hands off the cap. DeviceError without a cell."""
        if self.load_cell is None:
            raise DeviceError(f"{self.client.port.name}: this rig has no load cell to check")
        self.stop()
        pieces = [piece.force_cN for piece in watch(self, SETTLED_s + READ_s)]
        return float(np.concatenate(pieces)[-round(READ_s / (self._settings.tick_us * 1e-6)) :].mean())

    def upload(self, surface: ForceSurface, travel_mm: float, paced: bool = False) -> None:
        check_table(self.info(), surface, travel_mm)
        self.upload_program(surface_image(surface, travel_mm, paced))

    def upload_program(self, image: bytes) -> None:
        travel_mm = travel_mm_of(image)
        try:
            self.client.upload(image)
        except RefusedError as error:
            self._explain(error)
            raise
        self.travel_mm, self.image = travel_mm, image

    def press(self, velocity_mm_s: float) -> Press:
        """Have someone press once, at about this speed."""
        raise NotImplementedError

    def _explain(self, error: RefusedError) -> None:
        """Raise RefusedError with the latched fault, if that is why a request was refused."""
        if error.refusal in (Refusal.WRONG_MODE, Refusal.FAULT_LATCHED):
            report = self.fault()
            if report.fault is not Fault.NONE:
                why = f"a fault is latched, {report}; mend its cause, then run fdvv device clear"
                known = error.message, error.refusal, error.detail
                raise RefusedError(self.client.port.name, *known, why) from error

    def stop(self) -> None:
        try:
            self.client.disarm()
        except RefusedError as error:
            if error.refusal is not Refusal.FAULT_LATCHED:
                raise  # in a fault there is no force to end
        self.client.stream(0)

    def fault(self) -> FaultReport:
        reply = self.client.read_fault()
        at = reply.displacement_um16 / UM16_PER_mm, reply.commanded_cN64 / CN64_PER_cN
        cause = Fault(reply.fault), reply.value, reply.bound
        return FaultReport(*cause, reply.time_us * 1e-6, *at, reply.count)

    def clear_fault(self) -> None:
        self.force_loop.forget()  # a fault opens it
        self.client.clear_fault(self.fault().fault)

    def close(self) -> None:
        if self._closed:
            return
        self._closed = True
        try:
            with suppress(DeviceError):  # it is gone, or in fault, and then at zero force already
                self.stop()
        finally:
            self.client.close()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def _check_press(self, velocity_mm_s: float) -> float:
        """Return the active program's travel; DeviceError without one, or at an absurd speed."""
        name = self.client.port.name
        if self.travel_mm is None:
            raise DeviceError(f"{name}: press before upload; upload a surface or a program first")
        check_speed(name, velocity_mm_s)
        return self.travel_mm

    def _fail_on_fault(self) -> None:
        """Raise DeviceError if the device fell to zero force."""
        report = self.fault()
        if report.fault is not Fault.NONE:
            self.force_loop.forget()
            raise DeviceError(f"{self.client.port.name}: fell to zero force, {report}; clear the fault")


def watch(device: Remote, duration_s: float, every: int = 1) -> Iterator[TickColumns]:
    """Yield telemetry every 50 ms of device time for a duration; telemetry is switched off after it.

    every : ticks between two records. Nothing is rendered that was not before. Raises DeviceError.
    """
    client = device.client
    client.telemetry.clear()
    client.stream(every)
    try:
        until_s = client.port.now_s() + duration_s
        while client.port.now_s() < until_s:
            client.listen(min(until_s, client.port.now_s() + BATCH_s))
            yield client.telemetry.take()
    finally:
        client.stream(0)


class PressedDevice(Remote):
    """A device on an open line, and someone at it, who presses within patience_s.

    Its records hold what the rig sensed: true displacement is not known, and without a force sensor on the
    cap the force is the commanded one.
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
            self._arm()
            columns = self._wait(travel_mm)
        finally:
            self.stop()
        press = self._record(columns, velocity_mm_s)
        self.force_loop.check(press)
        return press

    def _arm(self) -> None:
        try:
            self.client.arm()
        except RefusedError as error:
            self._explain(error)
            raise

    def _wait(self, travel_mm: float) -> TickColumns:
        port, telemetry = self.client.port, self.client.telemetry
        until_s = port.now_s() + self._patience_s
        while port.now_s() < until_s:
            self.client.listen(port.now_s() + POLL_s)
            columns = telemetry.columns()
            rows = find_press(columns, travel_mm)
            if rows is not None:
                return columns.part(rows)
            if telemetry.last is not None and telemetry.last.mode == Mode.FAULT:
                self._fail_on_fault()
        waited = f"nobody pressed within {self._patience_s:g} s"
        seen = telemetry.columns()
        record = self._record(seen, SPEED_LIMITS_mm_s[0]) if seen.tick.size > LEAD_TICKS else None
        raise PressError(f"{port.name}: {waited}; press the button fully", record)

    def _record(self, columns: TickColumns, velocity_mm_s: float) -> Press:
        t_s = (columns.tick - columns.tick[0]) * self._settings.tick_us * 1e-6
        sensed = columns.displacement_mm, columns.force_cN, columns.commanded_cN
        force_cN = columns.force_cN if self._settings.force_gain_q14 else columns.commanded_cN
        limited, every = (columns.flags & TickFlag.LIMITED) > 0, np.ones(t_s.size, dtype=np.bool_)
        simulated = self.info().simulated
        return Press(t_s, sensed[0], force_cN, velocity_mm_s, *sensed, limited, every, simulated)


def find_press(columns: TickColumns, travel_mm: float) -> np.ndarray[tuple[int], np.dtype[np.bool_]] | None:
    """Choose the rows of the first whole press and release that went deep enough; None if there is none."""
    down = columns.displacement_mm > TOP_mm
    edges = np.flatnonzero(np.diff(down)) + 1
    if down.size and down[0]:
        edges = edges[1:]  # it was held as the records began
    for left, back in zip(edges[::2], edges[1::2], strict=False):
        deepest_mm = columns.displacement_mm[left:back].max()
        if deepest_mm >= DEEP_RATIO * travel_mm and back + LEAD_TICKS <= down.size:
            chosen = np.zeros(down.size, dtype=np.bool_)
            chosen[max(0, left - LEAD_TICKS) : back + LEAD_TICKS] = True
            return chosen
    return None
