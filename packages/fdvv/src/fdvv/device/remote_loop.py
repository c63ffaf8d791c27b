"""The force loop of a board behind the link: its cell, the gains it was closed with, what opened it."""

from __future__ import annotations

from fdvv.device.client import Client
from fdvv.device.contract import PressError
from fdvv.errors import DeviceError
from fdvv.model.press import Press
from fdvv.protocol.tables import BoardFlag, CellSpec, ForceLoopGains, LoopFault, LoopState

NO_CELL = CellSpec(plate_kg=0.0, stiffness_N_m=0.0, damping_N_s_m=0.0, filter_s=0.0)


class RemoteLoop:
    """What the host knows of a board's force loop.

    The loop belongs to the connection in which it was closed; a fault and other settings open it too.

    Attributes
    ----------
    load_cell : in use; None without one, and on a board without a force loop.
    """

    def __init__(self, client: Client) -> None:
        self._client = client
        self.load_cell: CellSpec | None = None
        self._closed: tuple[ForceLoopGains, int] | None = None
        self.read()

    @property
    def exists(self) -> bool:
        """Whether the firmware can close a force loop."""
        return bool(self._client.hello.board_flags & BoardFlag.FORCE_LOOP)

    @property
    def gains(self) -> ForceLoopGains | None:
        """The gains that were sent in this connection; None once the loop is open."""
        if self._closed is None or self._closed[1] != self._client.connections:
            return None
        return self._closed[0]

    def read(self) -> None:
        """Ask for the load cell; the settings were written, so the loop is open."""
        self.forget()
        if not self.exists:
            return
        reply = self._client.read_force_loop()
        cell = CellSpec(**{name: getattr(reply, name) for name in CellSpec.REALS})
        self.load_cell = cell if cell.stiffness_N_m > 0 else None

    def forget(self) -> None:
        """Take the loop for open."""
        self._closed = None

    def fit(self, cell: CellSpec | None) -> None:
        """Say which load cell is fitted. DeviceError on a board without a force loop."""
        self.forget()
        self._greet()
        self._client.write_load_cell(cell or NO_CELL)
        self.read()

    def close(self, gains: ForceLoopGains | None) -> None:
        """Close the loop, or open it; DeviceError as `Remote.close_loop`."""
        if gains is not None and self.load_cell is None:
            lacks = "this rig has no load cell" if self.exists else "this board has no force loop"
            raise DeviceError(f"{self._client.port.name}: {lacks}; it renders by tables only")
        if self.exists:
            self._greet()
            if gains is None:
                self._client.open_force_loop()
            else:
                self._client.close_force_loop(gains)
        self._closed = None if gains is None else (gains, self._client.connections)

    def _greet(self) -> None:
        """Compare definitions: after a new connection the board knows nothing of the last one."""
        self._client.read_force_loop()

    def state(self) -> str:
        """Say what the board does with its loop: none, open, closed, or failed and why."""
        if not self.exists:
            return "none"
        reply = self._client.read_force_loop()
        state = LoopState(reply.state).name.lower()
        return f"{state}, {LoopFault(reply.fault).name.lower()}" if reply.fault else state

    def check(self, press: Press | None = None) -> None:
        """Raise PressError, with the press, if the loop was opened by itself since it was closed."""
        if self.gains is None:
            return
        fault = LoopFault(self._client.read_force_loop().fault)
        if fault is not LoopFault.SOUND:
            self.forget()
            raise PressError(
                f"{self._client.port.name}: the force loop opened, {fault.name.lower()}; "
                "check the load cell and its cable, then close the loop again",
                press,
            )
