"""The firmware's synthesiser and receiver as the compiled library holds them, mirrored for tests."""

from __future__ import annotations

import ctypes

import numpy as np
import numpy.typing as npt

from fdvv._native import library
from fdvv.program.synth import Slot
from tests.support.program.vibration_wire import bank_messages

SLOTS, POOL_BYTES, MESSAGE_BYTES = 16, 1024, 33
NOTHING, SLOT, STRENGTH, RIGHT = range(4)


class CSlot(ctypes.Structure):
    _fields_ = [
        ("frequency_Hz16", ctypes.c_uint16),
        ("duration_samples", ctypes.c_uint16),
        ("amplitude_counts", ctypes.c_uint16),
        ("decay_q16", ctypes.c_uint16),
        ("wave_at", ctypes.c_uint16),
        ("wave_samples", ctypes.c_uint16),
        ("waveform", ctypes.c_uint8),
    ]


class CBank(ctypes.Structure):
    _fields_ = [
        ("slots", CSlot * SLOTS),
        ("increments", ctypes.c_uint32 * SLOTS),
        ("pool", ctypes.c_int8 * POOL_BYTES),
    ]


class CVoice(ctypes.Structure):
    _fields_ = [
        ("phase", ctypes.c_uint32),
        ("increment", ctypes.c_uint32),
        ("wave", ctypes.c_void_p),
        ("wave_samples", ctypes.c_uint16),
        ("remaining_samples", ctypes.c_uint16),
        ("amplitude_q5", ctypes.c_uint16),
        ("block_end_q5", ctypes.c_uint16),
        ("step_q5", ctypes.c_uint16),
        ("decay_q16", ctypes.c_uint16),
        ("block_samples", ctypes.c_uint8),
        ("waveform", ctypes.c_uint8),
    ]


class CReceiver(ctypes.Structure):
    _fields_ = [
        ("bank", ctypes.c_void_p),
        ("message", ctypes.c_uint8 * MESSAGE_BYTES),
        ("state", ctypes.c_uint8),
        ("received", ctypes.c_uint8),
        ("checksum", ctypes.c_uint8),
        ("accepted", ctypes.c_uint8),
        ("errors", ctypes.c_uint8),
    ]


class CStatus(ctypes.Structure):
    _fields_ = [(name, ctypes.c_uint8) for name in ("version", "flags", "accepted", "errors", "checksum")]


class Board:
    """A bank, its receiver and one voice, driven as the Uno drives them."""

    def __init__(self) -> None:
        self._c = library()
        self._c.fdvv_vibration_report.restype = CStatus
        for name in ("fdvv_vibration_byte", "fdvv_synth_set", "fdvv_synth_load"):
            getattr(self._c, name).restype = ctypes.c_uint8
        self.bank, self.voice, self.receiver = CBank(), CVoice(), CReceiver()
        self._c.fdvv_vibration_init(ctypes.byref(self.receiver), ctypes.byref(self.bank))

    def store(self, *slots: Slot) -> None:
        for message in bank_messages(slots):
            self.send(message)
        assert self.receiver.errors == 0

    def send(self, data: bytes, stop: bool = True) -> list[int]:
        """Send bytes after a START; return what each brought."""
        self._c.fdvv_vibration_begin(ctypes.byref(self.receiver))
        brought = [int(self._c.fdvv_vibration_byte(ctypes.byref(self.receiver), byte)) for byte in data]
        if stop:
            self._c.fdvv_vibration_end(ctypes.byref(self.receiver))
        return brought

    def status(self, flags: int = 0) -> bytes:
        return bytes(self._c.fdvv_vibration_report(ctypes.byref(self.receiver), ctypes.c_uint8(flags)))

    def contents(self) -> bytes:
        """Return all that can be played, to detect a change."""
        return bytes(self.bank)

    def play(self, index: int, strength: int = 255) -> None:
        self._c.fdvv_synth_choose(ctypes.byref(self.voice), ctypes.byref(self.bank), ctypes.c_uint8(index))
        self._c.fdvv_synth_start(ctypes.byref(self.voice), ctypes.c_uint8(strength))

    def set(self, index: int, slot: CSlot) -> bool:
        return bool(
            self._c.fdvv_synth_set(ctypes.byref(self.bank), ctypes.c_uint8(index), ctypes.byref(slot))
        )

    def load(self, at: int, samples: bytes) -> bool:
        count = ctypes.c_uint8(len(samples))
        return bool(self._c.fdvv_synth_load(ctypes.byref(self.bank), ctypes.c_uint16(at), samples, count))

    def render(self, samples: int) -> npt.NDArray[np.uint16]:
        counts = np.empty(samples, dtype=np.uint16)
        self._c.fdvv_synth_render(
            ctypes.byref(self.voice), ctypes.c_void_p(counts.ctypes.data), ctypes.c_uint32(samples)
        )
        return counts
