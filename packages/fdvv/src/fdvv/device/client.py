"""The host's side of the link: every request as a function, telemetry and notices as they come."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable
from typing import TypeVar

from fdvv.device.telemetry import Telemetry
from fdvv.device.wire import ClockRelation, Exchange, Notice, Port, RefusedError, Wire, relate, unwrap_us
from fdvv.errors import DeviceError
from fdvv.firmware.limits import refused_because
from fdvv.protocol.messages import data_request, head_of
from fdvv.protocol.record import Record
from fdvv.protocol.tables import (
    DATA_BYTES,
    FORCE_LOOP_HASH,
    HASH,
    VERSION,
    AnnounceRequest,
    BeginRequest,
    BoardLimits,
    CellSpec,
    ClearFaultRequest,
    EventRequest,
    Fault,
    FaultedRequest,
    ForceLoopGains,
    HelloReply,
    HelloRequest,
    KeyRequest,
    Message,
    PingReply,
    PingRequest,
    ReadCoilReply,
    ReadCountersReply,
    ReadFaultReply,
    ReadForceLoopReply,
    ReadForceLoopRequest,
    RecordsRequest,
    Refusal,
    SelftestReply,
    Settings,
    TelemetryRequest,
    VibrateRequest,
)

Kind = TypeVar("Kind", bound=Record)
EXCHANGES = 64
KEEP_ALIVE_s = 0.05
"""Between pings while listening; the shortest host timeout that can be set is 20 ms, the default 250 ms."""


class Client:
    """A connection to a device over an open line.

    Attributes
    ----------
    hello : name, version and limits of the device. connections : how often it was greeted.
    telemetry : records received so far.
    on_key, on_fault : called with notices as they come; may be set later.
    """

    def __init__(
        self,
        port: Port,
        on_key: Callable[[KeyRequest], None] | None = None,
        on_fault: Callable[[FaultedRequest], None] | None = None,
    ) -> None:
        self.port = port
        self.telemetry = Telemetry()
        self._wire = Wire(port, self._notice)
        self.on_key, self.on_fault = on_key, on_fault
        self._exchanges: deque[Exchange] = deque(maxlen=EXCHANGES)
        self._heard_s = port.now_s()
        self.connections = 0
        self.hello = self.connect()

    def connect(self) -> HelloReply:
        """Say hello; DeviceError if the device speaks another protocol."""
        self.port.write(b"\0")
        hello = self._request(Message.HELLO, HelloReply, HelloRequest(version=VERSION, hash=HASH))
        if hello.hash != HASH:
            raise DeviceError(
                f"{self.port.name}: its firmware speaks protocol {hello.hash:08x}, this fdvv {HASH:08x}; "
                "update the firmware or fdvv, so that both are of one version"
            )
        self.hello = hello
        self.connections += 1
        return hello

    def reconnect(self) -> HelloReply:
        """Open the line again after it broke, and say hello. The device keeps its active program."""
        self.port.reopen()
        self._wire.reset()
        self._exchanges.clear()
        return self.connect()

    def _command(self, message: Message, body: Record | None = None) -> Record | None:
        reply = self._wire.request(message, body)
        self._heard_s = self.port.now_s()
        return reply

    def _request(self, message: Message, kind: type[Kind], body: Record | None = None) -> Kind:
        reply = self._command(message, body)
        assert isinstance(reply, kind)
        return reply

    @property
    def repeated(self) -> int:
        """How many requests had to be sent again so far."""
        return self._wire.repeated

    def ping(self) -> PingReply:
        """Show that the host is there, and compare the clocks."""
        sent_us = self.port.now_s() * 1e6
        shown_us = int(sent_us) % 2**32
        reply = self._request(Message.PING, PingReply, PingRequest(host_us=shown_us))
        last = self._exchanges[-1] if self._exchanges else None
        near_us = last.device_us + sent_us - last.sent_us if last else reply.device_us
        if reply.host_us == shown_us:
            device_us = unwrap_us(reply.device_us, near_us)
            self._exchanges.append(Exchange(sent_us, self.port.now_s() * 1e6, device_us))
        return reply

    def clocks(self) -> ClockRelation:
        """Relate the device's clock to the port's, from the last pings; DeviceError without one."""
        return relate(tuple(self._exchanges))

    def host_s(self, time_us: int) -> float:
        """Return the port's time of a recent moment of a notice; DeviceError without a ping."""
        clocks = self.clocks()
        return 1e-6 * clocks.host_us(unwrap_us(time_us, self._exchanges[-1].device_us))

    def read_settings(self) -> Settings:
        return self._request(Message.READ_SETTINGS, Settings)

    def read_limits(self) -> BoardLimits:
        """Return what the board was built for."""
        return self._request(Message.READ_LIMITS, BoardLimits)

    def read_coil(self) -> ReadCoilReply:
        """Return how warm the coil may be, and what its thermistor reads."""
        return self._request(Message.READ_COIL, ReadCoilReply)

    def write_settings(self, settings: Settings) -> None:
        """Replace calibration and limits; while idle, and the device forgets its programs.

        RefusedError names the field, and what the board was built for if it is looser than that.
        """
        try:
            self._command(Message.WRITE_SETTINGS, settings)
        except RefusedError as error:
            if error.refusal is not Refusal.BAD_VALUE:
                raise
            why = refused_because(list(Settings.LIMITS)[error.detail], settings, self.read_limits())
            raise RefusedError(self.port.name, error.message, error.refusal, error.detail, why) from None

    def upload(self, image: bytes) -> None:
        """Send a program and have it checked; it becomes the active one whole, or the old one stays."""
        self._command(Message.BEGIN, BeginRequest(size_bytes=len(image), crc32=head_of(image).crc32))
        for offset in range(0, len(image), DATA_BYTES):
            self._command(Message.DATA, data_request(offset, image[offset : offset + DATA_BYTES]))
        self._command(Message.COMMIT)
        self._command(Message.ACTIVATE)

    def arm(self) -> None:
        self._command(Message.ARM)

    def disarm(self) -> None:
        self._command(Message.DISARM)

    def stream(self, every: int) -> None:
        """Have a record of every n-th tick sent; 0 for none."""
        self._command(Message.TELEMETRY, TelemetryRequest(every=every))

    def announce(self, velocity_mm_s: float) -> None:
        self._command(Message.ANNOUNCE, AnnounceRequest(velocity_mm_s16=round(16 * velocity_mm_s)))

    def event(self, number: int) -> None:
        """Send a host event to the program."""
        self._command(Message.EVENT, EventRequest(event=number))

    def vibrate(self, slot: int) -> None:
        self._command(Message.VIBRATE, VibrateRequest(slot=slot))

    def read_force_loop(self) -> ReadForceLoopReply:
        """Return load cell and state of the force loop; RefusedError by a board with another one, or none."""
        request = ReadForceLoopRequest(hash=FORCE_LOOP_HASH)
        return self._request(Message.READ_FORCE_LOOP, ReadForceLoopReply, request)

    def write_load_cell(self, cell: CellSpec) -> None:
        """Say which load cell is fitted; opens the loop, and the device forgets its programs."""
        self._command(Message.WRITE_LOAD_CELL, cell)

    def close_force_loop(self, gains: ForceLoopGains) -> None:
        """Close the loop while idle; the device forgets its programs."""
        self._command(Message.CLOSE_FORCE_LOOP, gains)

    def open_force_loop(self) -> None:
        self._command(Message.OPEN_FORCE_LOOP)

    def read_fault(self) -> ReadFaultReply:
        return self._request(Message.READ_FAULT, ReadFaultReply)

    def clear_fault(self, fault: Fault) -> None:
        self._command(Message.CLEAR_FAULT, ClearFaultRequest(fault=fault))

    def selftest(self) -> SelftestReply:
        return self._request(Message.SELFTEST, SelftestReply)

    def counters(self) -> ReadCountersReply:
        return self._request(Message.READ_COUNTERS, ReadCountersReply)

    def listen(self, until_s: float) -> None:
        """Take telemetry and notices until the port's clock is there, and keep the device's watch fed."""
        while (now_s := self.port.now_s()) < until_s:
            if now_s >= self._heard_s + KEEP_ALIVE_s:
                self.ping()
            self._wire.listen(min(until_s, self._heard_s + KEEP_ALIVE_s))

    def _notice(self, notice: Notice, records: bytes, sequence: int) -> None:
        if isinstance(notice, RecordsRequest):
            self.telemetry.add(notice, records, sequence)
        else:
            self.telemetry.count_missing(sequence)
        if isinstance(notice, KeyRequest) and self.on_key:
            self.on_key(notice)
        if isinstance(notice, FaultedRequest) and self.on_fault:
            self.on_fault(notice)

    def close(self) -> None:
        self.port.close()
