"""The firmware without hardware: inside this process, or as a program at the end of a terminal line."""

from __future__ import annotations

import ctypes
import os
import select
import struct
import subprocess
import sys
from pathlib import Path

from fdvv import _native
from fdvv.device.plant import OUTPUTS_BYTES, Inputs, Outputs
from fdvv.errors import BuildError, DeviceError
from fdvv.firmware.limits import limits_like
from fdvv.protocol.messages import UM16_PER_mm
from fdvv.protocol.tables import BoardLimits, ImageHeader, Settings

TAIL = struct.Struct("<II")
SENT = struct.Struct("<I")
ANSWER_BYTES = OUTPUTS_BYTES + SENT.size
PAPER_TRAVEL_mm = 6.2
"""The deepest stop of a board that is built for no other rig."""
PATIENCE_s = 10.0
"""Real time for one tick of the host program; it takes some 20 us."""


class LibraryBoard:
    """The firmware called as a library: the quickest board; one at a time and thread."""

    name = "library"
    ticks = 0

    def __init__(self) -> None:
        self._library = library = _native.library()
        library.fdvv_host_new.restype = library.fdvv_host_program.restype = ctypes.c_void_p
        library.fdvv_host_announced_mm_s16.restype = ctypes.c_uint16
        library.fdvv_host_receive.restype = library.fdvv_host_transmit.restype = ctypes.c_uint16
        self._handle = ctypes.c_void_p()
        self.build(limits_like(Settings()))
        self._outputs = ctypes.create_string_buffer(OUTPUTS_BYTES)
        self._room = ctypes.create_string_buffer(4096)
        self._waiting = b""
        self._plugged = True

    def build(self, limits: BoardLimits, travel_mm: float = PAPER_TRAVEL_mm) -> None:
        """Start as a build for another rig."""
        travel_um16 = ctypes.c_uint32(round(UM16_PER_mm * travel_mm))
        self._library.fdvv_host_free(self._handle)
        self._handle = ctypes.c_void_p(self._library.fdvv_host_new(limits.pack(), travel_um16))

    def tick(self, inputs: Inputs) -> Outputs:
        if not self._handle.value:
            raise DeviceError(f"{self.name}: the board is switched off; open it again")
        self._hand_over()
        self._library.fdvv_host_tick(self._handle, inputs.pack(), self._outputs)
        return Outputs.unpack(self._outputs.raw)

    def _hand_over(self) -> None:
        if self._waiting:
            count = min(len(self._waiting), 4096)
            taken = self._library.fdvv_host_receive(self._handle, self._waiting[:count], count)
            self._waiting = self._waiting[taken:]

    def write(self, data: bytes) -> None:
        if self._plugged:
            self._waiting += data

    def read(self) -> bytes:
        if not self._plugged:
            return b""
        count = self._library.fdvv_host_transmit(self._handle, self._room, len(self._room))
        return self._room.raw[:count] if count else b""

    def program(self) -> bytes | None:
        """Return the image that is rendered, None if there is none."""
        pointer = self._library.fdvv_host_program(self._handle)
        if not pointer:
            return None
        head = ImageHeader.unpack(ctypes.string_at(pointer, ImageHeader.length_bytes()))
        return ctypes.string_at(pointer, head.size_bytes)

    @property
    def announced_mm_s(self) -> float:
        """Speed of the next press, as its host announced it."""
        return float(self._library.fdvv_host_announced_mm_s16(self._handle)) / 16

    def unplug(self) -> None:
        self._library.fdvv_host_unplug(self._handle)
        self._waiting, self._plugged = b"", False

    def plug(self) -> None:
        self._plugged = True

    def close(self) -> None:
        self._library.fdvv_host_free(self._handle)
        self._handle = ctypes.c_void_p()  # freeing it again does nothing


class HostBoard:
    """The firmware as a program of its own, or another build of it; its link is a real pseudo-terminal."""

    name = "host"
    ticks = 0

    def __init__(self, program: Path | None = None) -> None:
        if sys.platform == "win32":
            raise BuildError("the board host needs the pseudo-terminals of a POSIX system; use LibraryBoard")
        program = program or Path(_native.__file__).with_name("fdvv-host")
        if not program.exists():
            raise BuildError(f"the program {program.name} is missing; reinstall fdvv with a C compiler")
        import tty  # POSIX only

        self._link, slave = os.openpty()
        tty.setraw(slave)
        os.set_blocking(self._link, False)
        replies, requests = os.pipe(), os.pipe()
        command = [str(program), str(requests[0]), str(replies[1]), os.ttyname(slave)]
        self._process = subprocess.Popen(
            command, pass_fds=(requests[0], replies[1]), stdin=subprocess.DEVNULL
        )
        for file in (requests[0], replies[1]):
            os.close(file)
        # held open, so that the line outlives the moment before the program has opened it
        self._slave = slave
        self._requests, self._replies = requests[1], replies[0]
        self._written = self._heard = 0
        self._waiting = self._arrived = self._answer = b""
        self._plugged, self._open, self._owed = True, True, False
        self._limits, self._travel_mm = limits_like(Settings()), PAPER_TRAVEL_mm
        self._built = False

    def build(self, limits: BoardLimits, travel_mm: float = PAPER_TRAVEL_mm) -> None:
        """Be a build for this rig; DeviceError after the first tick."""
        if self._built:
            raise DeviceError("host: it runs already; open another board for this rig")
        self._limits, self._travel_mm = limits, travel_mm

    @property
    def pid(self) -> int:
        return self._process.pid

    def tick(self, inputs: Inputs) -> Outputs:
        try:
            if not self._built:
                travel_um16 = round(UM16_PER_mm * self._travel_mm)
                os.write(self._requests, self._limits.pack() + SENT.pack(travel_um16))
                self._built = True
            if self._owed:
                self._take()  # Ctrl-C came between question and answer
            self._flush()
            self._owed = True
            os.write(self._requests, inputs.pack() + TAIL.pack(self._written % 2**32, self._plugged))
            answer = self._take()
        except (BrokenPipeError, EOFError):
            status = self._process.poll()
            raise DeviceError(f"host: the program has ended (status {status}); open it again") from None
        if self._plugged:
            self._drain(SENT.unpack(answer[OUTPUTS_BYTES:])[0])
        return Outputs.unpack(answer[:OUTPUTS_BYTES])

    def _drain(self, sent: int) -> None:
        """Read all that the board has put on the link, so that it never waits for room."""
        while self._heard != sent:
            if not select.select([self._link], [], [], PATIENCE_s)[0]:
                raise DeviceError("host: bytes that were sent did not arrive")
            piece = os.read(self._link, 4096)
            self._heard = (self._heard + len(piece)) % 2**32
            self._arrived += piece

    def _take(self) -> bytes:
        while len(self._answer) < ANSWER_BYTES:
            if not select.select([self._replies], [], [], PATIENCE_s)[0]:
                raise DeviceError(f"host: no tick in {PATIENCE_s:g} s; the program hangs")
            piece = os.read(self._replies, ANSWER_BYTES - len(self._answer))
            if not piece:
                raise EOFError
            self._answer += piece
        answer, self._answer, self._owed = self._answer, b"", False
        return answer

    def _flush(self) -> None:
        if self._waiting:
            done = os.write(self._link, self._waiting[:1024])
            self._written += done
            self._waiting = self._waiting[done:]

    def write(self, data: bytes) -> None:
        if self._plugged:
            self._waiting += data

    def read(self) -> bytes:
        """Return all that the board has put on the link in its ticks so far."""
        data, self._arrived = self._arrived, b""
        return data

    def unplug(self) -> None:
        """Pull the cable: what is on it is lost on both sides."""
        self._plugged, self._waiting, self._arrived = False, b"", b""
        self._written = self._heard = 0

    def plug(self) -> None:
        self._plugged = True

    def close(self) -> None:
        if self._open:
            self._open = False
            for file in (self._requests, self._replies, self._link, self._slave):
                os.close(file)
            self._process.terminate()
            self._process.wait()
