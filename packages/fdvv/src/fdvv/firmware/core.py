"""The firmware's core, its records and the calls to it."""

from __future__ import annotations

import ctypes
from copy import copy
from enum import IntEnum
from functools import cache
from typing import Any

import numpy as np
import numpy.typing as npt

from fdvv._native import address, library, words
from fdvv.errors import BuildError, DeviceError, ModelError
from fdvv.firmware.limits import limits_like, refused_because
from fdvv.protocol.tables import IMAGE_BYTES, BoardLimits, Evidence, Fault, LoopFault, Mode, Refusal, Settings

RecordArray = np.ndarray[Any, np.dtype[np.void]]
"""Records of one kind, one for each tick (n,)."""
INPUTS = np.dtype(
    [
        *((name, "<u4") for name in ("time_us", "sum")),
        *(
            (name, "<u2")
            for name in (
                "lowest",
                "highest",
                "elapsed_ticks",
                "supply_mV",
                "force_counts",
                "thermistor_counts",
            )
        ),
        ("board", "u1"),
    ],
    align=True,
)
"""Readings of one tick: device clock, sum of the position readings, lowest and highest of them, ticks since
the last call, supply, keycap force sensor, thermistor of the coil, bits of what the board found wrong."""
OUTPUTS = np.dtype(
    [
        ("duty_q15", "<i2"),
        ("enable", "u1"),
        ("slot", "u1"),
        ("stop_us", "<u2"),
        ("key", "u1"),
        ("mode", "u1"),
        ("displacement_um16", "<i4"),
        ("velocity_mm_s16", "<i2"),
        ("commanded_cN64", "<i2"),
        ("force_cN64", "<i2"),
        ("state", "u1"),
        ("flags", "u1"),
    ],
    align=True,
)
"""Duty, bridge enable, waveform to start (NONE: none), servo pulse, reported key, mode, the tick's record
(fdvv.protocol.tables.TickRecord)."""


class CoreRequest(IntEnum):
    """What may be asked of the supervisor (firmware/core/supervisor.h)."""

    BOOTED = 0
    TEST = 1
    TESTED = 2
    ARM = 3
    DISARM = 4
    CLEAR = 5


@cache
def doors() -> ctypes.CDLL:
    """Return the library once its records are known to be laid out as ours; else raise BuildError."""
    lib = library()
    lib.fdvv_bridge_ask.restype = lib.fdvv_bridge_check_image.restype = ctypes.c_uint8
    lib.fdvv_bridge_mode.restype = lib.fdvv_bridge_latched.restype = ctypes.c_uint8
    lib.fdvv_bridge_evidence.restype = ctypes.c_void_p
    lib.fdvv_settings_check.restype = lib.fdvv_core_loop_fault.restype = ctypes.c_uint8
    found = layout(lib)[1:]
    ours = [INPUTS.itemsize, OUTPUTS.itemsize]
    ours += [field[1] for field in (INPUTS.fields or {}).values()]
    ours += [field[1] for field in (OUTPUTS.fields or {}).values()][:7]
    if found != ours:
        raise BuildError(f"the compiled library lays out records as {found}, not as {ours}; rebuild fdvv")
    return lib


def layout(lib: ctypes.CDLL) -> list[int]:
    """Ask for the size of the core, then sizes and offsets of its records."""
    numbers = np.zeros(19, np.int64)
    lib.fdvv_bridge_layout(address(numbers))
    return [int(number) for number in numbers]


class Core:
    """The controller of a board, run in this process.

    Parameters
    ----------
    settings : calibration and limits of the rig; ModelError if the firmware would refuse them.
    image : program to render (layout in protocol/fdvv.toml), or None; ModelError if it would be refused.
    limits : of the board, which no settings may loosen; None: those of a board built for these settings.
    """

    def __init__(
        self,
        settings: Settings | None = None,
        image: bytes | None = None,
        limits: BoardLimits | None = None,
    ) -> None:
        self._lib = doors()
        self._memory = np.zeros(layout(self._lib)[0] // 8 + 1, np.uint64)
        self._core = address(self._memory)
        self.settings = Settings() if settings is None else settings
        self.limits = limits_like(self.settings) if limits is None else limits
        self._limits = words(self.limits.pack())  # the core goes on reading it
        self._lib.fdvv_core_init(self._core, address(self._checked(self.settings)), address(self._limits))
        self.activate(image)

    def set(self, settings: Settings) -> None:
        """Use other settings; forgets position and velocity."""
        self._lib.fdvv_core_set(self._core, address(self._checked(settings)))
        self.settings = settings

    def activate(self, image: bytes | None) -> None:
        """Render this program from the next tick on (None: none); ModelError if it would be refused."""
        fresh = None if image is None else self._checked_image(image)
        self._lib.fdvv_core_activate(self._core, None if fresh is None else address(fresh))
        self._image = fresh  # the core goes on reading it

    def close_loop(self, constants: bytes | npt.NDArray[np.float32] | None) -> None:
        """Close the force loop with ForceLoopGains.pack(), unchecked; None opens it, and so does set()."""
        held = None if constants is None else np.frombuffer(constants, np.float32).copy()
        self._lib.fdvv_core_close_loop(self._core, None if held is None else address(held))

    @property
    def loop_fault(self) -> LoopFault:
        """Why the loop was opened by itself."""
        return LoopFault(self._lib.fdvv_core_loop_fault(self._core))

    def copy(self) -> Core:
        """Copy the core with its program; the two are independent from then on."""
        other = copy(self)
        other._memory = self._memory.copy()
        other._core = address(other._memory)
        return other

    def ask(self, ask: CoreRequest, number: int = 0) -> Refusal:
        """Ask the supervisor for a change of mode; number is the fault to clear."""
        return Refusal(self._lib.fdvv_bridge_ask(self._core, ctypes.c_uint8(ask), ctypes.c_uint8(number)))

    def arm(self) -> None:
        """Go through boot to armed; DeviceError with the refusal if that is not possible."""
        if self.mode in (Mode.ARMED, Mode.DERATED):
            return
        if self.mode is Mode.BOOT:
            self.ask(CoreRequest.BOOTED)
        refusal = self.ask(CoreRequest.ARM)
        if refusal:
            raise DeviceError(f"the core was not armed from mode {self.mode.name}: {refusal.name}")

    def disarm(self) -> None:
        """Ask for zero force."""
        self.ask(CoreRequest.DISARM)

    def hear(self, time_us: int) -> None:
        """Let the host be heard at a time of the device clock."""
        self._lib.fdvv_bridge_hear(self._core, ctypes.c_uint32(time_us))

    def event(self, event: int) -> None:
        """Send host event 0 to 31 to the program."""
        self._lib.fdvv_core_event(self._core, ctypes.c_uint8(event))

    def announce(self, velocity_mm_s16: int) -> None:
        """Say how fast the next press is meant to be."""
        self._lib.fdvv_core_announce(self._core, ctypes.c_uint16(velocity_mm_s16))

    def fail(self, fault: Fault, value: int = 0, bound: int = 0) -> None:
        """Latch a fault found outside the tick."""
        numbers = ctypes.c_int32(value), ctypes.c_int32(bound)
        self._lib.fdvv_bridge_fault(self._core, ctypes.c_uint8(fault), *numbers)

    @property
    def address(self) -> ctypes.c_void_p:
        """Where the core lies in memory (fdvv_core), for compiled loops; valid as long as this object."""
        return self._core

    @property
    def image_address(self) -> ctypes.c_void_p:
        """Where the active image lies, valid until another is activated; ModelError if there is none."""
        if self._image is None:
            raise ModelError("the core has no program; activate one")
        return address(self._image)

    @property
    def mode(self) -> Mode:
        """What the supervisor lets the device do."""
        return Mode(self._lib.fdvv_bridge_mode(self._core))

    @property
    def fault(self) -> Fault:
        """Why it is in fault, if it is."""
        return Fault(self._lib.fdvv_bridge_latched(self._core))

    @property
    def evidence(self) -> Evidence:
        """What was so when the fault was latched."""
        at = self._lib.fdvv_bridge_evidence(self._core)
        return Evidence.unpack(ctypes.string_at(at, Evidence.length_bytes()))

    def tick(self, inputs: np.void, *, host_heard: bool = True) -> np.void:
        """Run one tick on one record of INPUTS; give one of OUTPUTS."""
        one: np.void = self.run(np.asarray(inputs, INPUTS).reshape(1), host_heard=host_heard)[0]
        return one

    def run(self, inputs: RecordArray, *, host_heard: bool = True) -> RecordArray:
        """Run one tick per record of INPUTS; give as many of OUTPUTS. The host is heard always or never."""
        given = np.ascontiguousarray(inputs, INPUTS)
        outputs = np.zeros(given.size, OUTPUTS)
        count, heard = ctypes.c_int64(given.size), ctypes.c_int32(host_heard)
        self._lib.fdvv_bridge_run(self._core, address(given), address(outputs), count, heard)
        return outputs

    def _checked(self, settings: Settings) -> np.ndarray[tuple[int], np.dtype[np.uint32]]:
        packed = words(settings.pack())
        wrong = self._lib.fdvv_settings_check(address(packed), address(self._limits))
        if wrong:
            why = refused_because(list(Settings.LIMITS)[wrong - 1], settings, self.limits)
            raise ModelError(f"the firmware refuses the settings: {why}")
        return packed

    def _checked_image(self, image: bytes) -> np.ndarray[tuple[int], np.dtype[np.uint32]]:
        if len(image) > IMAGE_BYTES:
            raise ModelError(f"an image has at most {IMAGE_BYTES} bytes, got {len(image)}")
        fresh, detail = words(image), np.zeros(1, np.uint16)
        size, crc32 = ctypes.c_uint16(len(image)), ctypes.c_uint32(int.from_bytes(image[4:8], "little"))
        found = self._lib.fdvv_bridge_check_image(self._core, address(fresh), size, crc32, address(detail))
        refusal = Refusal(found)
        if refusal:
            raise ModelError(f"the firmware refuses the image: {refusal.name.lower()} at byte {detail[0]}")
        return fresh
