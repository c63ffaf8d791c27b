"""A computer at the other end of the USB cable: enumerates the board, opens its serial port, moves bytes."""

from __future__ import annotations

import struct
from collections.abc import Callable, Generator
from typing import TypeVar

from fdvv.errors import DeviceError
from fdvv_m0.bus import Bus
from fdvv_m0.usb_device import RESUME, SUSPEND, Answer, UsbDevice

# shorter than a real computer's 100, 10 and 10 ms
DEBOUNCE_US, RESET_US, SETTLE_US = 1000, 500, 500
RETRY_US, PATIENCE_US, SUSPEND_US = 20, 50_000, 3000
PACKET_BYTES, OVERHEAD_BYTES, BYTE_US = 64, 13, 8 / 12
DEVICE, CONFIGURATION, STRING = 1, 2, 3
CLASS_DATA = 10

Steps = Generator[float, None, None]
Transfer = Generator[float, None, bytes]
Asked = TypeVar("Asked")


class _SilentError(Exception):
    """The device has nothing to say for too long."""


class UsbHost:
    """Enumerates whenever the device attaches; then carries `outgoing` and `incoming` as fast as the wire.

    Full-speed packets take their bytes and 13 more of overhead. The computer's own latency is left out, the
    waits of enumeration are shortened.
    """

    def __init__(self, bus: Bus) -> None:
        self._bus = bus
        self._steps: Steps | None = None
        self._round = 0  # of being attached
        self._is_pumping = False
        self._in = self._out = 0  # endpoints of the port; 0 before it is open
        self.is_plugged = True
        self.is_open = False
        self.outgoing, self.incoming = bytearray(), bytearray()
        self.device_descriptor, self.configuration, self.strings = b"", b"", list[str]()
        self.device = UsbDevice(bus, self.attached, self.pump)

    # -- cable -----------------------------------------------------------------------------------------------

    def attached(self) -> None:
        """Notice a device on the bus."""
        if self.is_plugged:
            self._begin(self._enumerate())

    def plug(self) -> None:
        """Put the cable in."""
        self.is_plugged = True
        self.device.raise_flag(RESUME)
        self._begin(self._enumerate())

    def unplug(self) -> None:
        """Pull the cable: what was on its way is lost, and the device sees the bus fall silent."""
        self.forget()
        self.is_plugged = False
        self._bus.after(SUSPEND_US * self._bus.cpu_mhz, lambda: self.device.raise_flag(SUSPEND))

    def forget(self) -> None:
        """Lose the device: pulled out or reset."""
        self._round += 1
        self._steps, self.is_open, self._in, self._out = None, False, 0, 0
        self._is_pumping = False
        self.outgoing.clear()

    # -- steps in time ---------------------------------------------------------------------------------------

    def _begin(self, steps: Steps) -> None:
        self._round += 1
        self._steps = steps
        self._step(self._round)

    def _step(self, this: int) -> None:
        if this != self._round or self._steps is None:
            return
        wait_us = next(self._steps, None)
        if wait_us is not None:
            self._bus.after(round(wait_us * self._bus.cpu_mhz), lambda: self._step(this))

    def _enumerate(self) -> Steps:
        try:
            yield from self._introduce()
        except _SilentError:
            self.is_open = False

    def _introduce(self) -> Steps:
        yield DEBOUNCE_US
        self.device.bus_reset()
        yield RESET_US
        self.device_descriptor = yield from self._control(0x80, 6, DEVICE << 8, 0, 18)
        yield from self._control(0x00, 5, 7, 0, 0)
        yield SETTLE_US
        head = yield from self._control(0x80, 6, CONFIGURATION << 8, 0, 9)
        size = struct.unpack_from("<H", head, 2)[0]
        self.configuration = yield from self._control(0x80, 6, CONFIGURATION << 8, 0, size)
        yield from self._read_strings()
        yield from self._control(0x00, 9, self.configuration[5], 0, 0)
        self._find_port()
        yield from self._control(0x21, 0x20, 0, 0, 7, struct.pack("<IBBB", 115200, 0, 0, 8))
        yield from self._control(0x21, 0x22, 3, 0, 0)
        self.is_open = True
        self.pump()

    def _read_strings(self) -> Steps:
        self.strings.clear()
        for index in self.device_descriptor[14:17]:
            text = yield from self._control(0x80, 6, STRING << 8 | index, 0x0409, 255)
            self.strings.append(text[2:].decode("utf-16-le"))

    def _find_port(self) -> None:
        at, is_data = 0, False
        while at < len(self.configuration):
            size, kind = self.configuration[at], self.configuration[at + 1]
            if kind == 4:
                is_data = self.configuration[at + 5] == CLASS_DATA
            elif kind == 5 and is_data:
                endpoint = self.configuration[at + 2]
                if endpoint & 0x80:
                    self._in = endpoint & 15
                else:
                    self._out = endpoint
            at += size
        if not self._in or not self._out:
            raise DeviceError("the emulated board has no serial port among its USB interfaces")

    # -- transfers -------------------------------------------------------------------------------------------

    def _control(
        self, kind: int, request: int, value: int, index: int, length: int, data: bytes = b""
    ) -> Transfer:
        self.device.setup(struct.pack("<BBHHH", kind, request, value, index, length))
        yield _packet_us(8)
        received = b""
        if kind & 0x80:
            while len(received) < length:
                packet = yield from self._patient_give(request)
                received += packet
                if len(packet) < PACKET_BYTES:
                    break
            yield from self._patient_take(b"", request)
        else:
            if data:
                yield from self._patient_take(data, request)
            yield from self._patient_give(request)
        return received

    def _patient_give(self, request: int) -> Transfer:
        answer = yield from self._patiently(request, lambda: self.device.give(0))
        packet = answer if isinstance(answer, bytes) else b""
        yield _packet_us(len(packet))
        return packet

    def _patient_take(self, packet: bytes, request: int) -> Steps:
        yield from self._patiently(request, lambda: self.device.take(0, packet))
        yield _packet_us(len(packet))

    def _patiently(self, request: int, ask: Callable[[], Asked]) -> Generator[float, None, Asked]:
        for _ in range(0, PATIENCE_US, RETRY_US):
            answer = ask()
            if answer is Answer.STALL:
                raise DeviceError(f"the emulated board refuses USB request {request:#x}")
            if answer is not Answer.NAK:
                return answer
            yield RETRY_US
        raise _SilentError

    def pump(self) -> None:
        """Carry bulk packets while there is something to carry; called when either side has something."""
        if self.is_open and not self._is_pumping:
            self._is_pumping = True
            this = self._round
            self._bus.after(round(_packet_us(0) * self._bus.cpu_mhz), lambda: self._carry(this))

    def _carry(self, this: int) -> None:
        if this != self._round:
            return
        moved = 0.0
        packet = self.device.give(self._in)
        if isinstance(packet, bytes):
            self.incoming += packet
            moved += _packet_us(len(packet))
        if self.outgoing and self.device.take(self._out, bytes(self.outgoing[:PACKET_BYTES])) is None:
            moved += _packet_us(min(len(self.outgoing), PACKET_BYTES))
            del self.outgoing[:PACKET_BYTES]
        self._is_pumping = moved > 0
        if moved:
            self._bus.after(round(moved * self._bus.cpu_mhz), lambda: self._carry(this))


def _packet_us(count: int) -> float:
    return (count + OVERHEAD_BYTES) * BYTE_US
