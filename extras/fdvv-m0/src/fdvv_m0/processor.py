"""The processor itself: unicorn, with the bus and the cycle hook of m0_cycles.c behind it."""

from __future__ import annotations

import ctypes
from importlib import import_module
from typing import Any

from fdvv._native import library
from fdvv.errors import DeviceError
from fdvv_m0.bus import RAM_START, Bus, address_of

CALIBRATION_START, CALIBRATION_BYTES = 0x00800000, 0x10000
FOREVER = 0xFFFFFFFE
LOOP = b"\xfe\xe7"  # b .


class Processor:
    """Runs from an address until stopped; DeviceError if unicorn is absent."""

    def __init__(self, bus: Bus) -> None:
        try:
            self._unicorn: Any = import_module("unicorn")
            self._arm: Any = import_module("unicorn.arm_const")
            self._low: Any = import_module("unicorn.unicorn_py3.unicorn").uclib
        except ImportError as error:
            raise DeviceError("the emulated board needs unicorn; pip install unicorn==2.1.4") from error
        self._bus = bus
        self._uc: Any = self._unicorn.Uc(
            self._unicorn.UC_ARCH_ARM, self._unicorn.UC_MODE_THUMB | self._unicorn.UC_MODE_MCLASS
        )
        self._uc.ctl_set_cpu_model(getattr(self._arm, bus.chip.model))
        self._map_memory()
        self._attach()

    def _map_memory(self) -> None:
        code = self._unicorn.UC_PROT_READ | self._unicorn.UC_PROT_EXEC
        chip = self._bus.chip
        self._uc.mem_map_ptr(0, chip.flash_bytes, code, address_of(self._bus.flash))
        self._uc.mem_map_ptr(RAM_START, chip.ram_bytes, self._unicorn.UC_PROT_ALL, address_of(self._bus.ram))
        self._uc.mem_map(CALIBRATION_START, CALIBRATION_BYTES, self._unicorn.UC_PROT_READ)
        for address, word in chip.factory.items():
            self._uc.mem_write(address, word.to_bytes(4, "little"))

    def _attach(self) -> None:
        native, handle = library(), ctypes.c_size_t()
        read, write, block = (
            ctypes.cast(getattr(native, f"fdvv_m0_{name}"), ctypes.c_void_p)
            for name in ("read", "write", "block")
        )
        engine = self._uc._uch
        for base, size in self._bus.chip.windows.items():
            window = ctypes.byref(self._bus.windows[base])
            self._accept(self._low.uc_mmio_map(engine, base, size, read, window, write, window))
        clockwork = ctypes.byref(self._bus.clockwork)
        every = ctypes.c_uint64(1), ctypes.c_uint64(0)
        kind = self._unicorn.UC_HOOK_BLOCK
        self._accept(self._low.uc_hook_add(engine, ctypes.byref(handle), kind, block, clockwork, *every))
        self._uc.ctl_flush_tb()  # blocks translated before are not hooked

    def _accept(self, status: int) -> None:
        if status:
            raise DeviceError(f"unicorn refuses with status {status}")

    def run(self, address: int) -> str | None:
        """Run from an address until stopped; give what went wrong, None if nothing did."""
        try:
            self._uc.emu_start(address | 1, FOREVER)
        except self._unicorn.UcError as error:
            return str(error)
        return None

    def stop(self) -> None:
        """Stop before the block that is about to run."""
        self._bus.clockwork.is_stopped = 1
        self._uc.emu_stop()

    def at(self) -> int:
        """Return the address it has come to."""
        return int(self._uc.reg_read(self._arm.UC_ARM_REG_PC))

    def register(self, number: int) -> int:
        """Return a low register, 0 to 7."""
        return int(self._uc.reg_read(self._arm.UC_ARM_REG_R0 + number))

    def set_stack(self, address: int) -> None:
        """Put the stack pointer somewhere."""
        self._uc.reg_write(self._arm.UC_ARM_REG_SP, address)

    def loop_at(self, address: int) -> None:
        """Replace an instruction by a loop for ever."""
        self._uc.mem_write(address, LOOP)
        self._uc.ctl_flush_tb()
