"""The rig's controller, emulated, as a board in lockstep."""

from __future__ import annotations

from pathlib import Path

from fdvv.device.open import BUILT_ELF
from fdvv.device.plant import Inputs, Outputs
from fdvv.errors import DeviceError, InputError
from fdvv.protocol.tables import NONE, Settings
from fdvv_m0.elf import read_elf
from fdvv_m0.emulator import M0Emulator
from fdvv_m0.m4 import FLASH_START, M4Emulator
from fdvv_m0.records import COUNTS_MAX, TickInputs

BOOT_TICKS = 400
SHARE_OF_TICK = 0.95  # after which what a tick brought is on the pins
PLAY_HEADER = 0x22


def open_board(where: str) -> EmulatedBoard:
    """Emulate the ELF file ``where``, or the built one. Raises InputError if there is no such file."""
    path = Path(where) if where else BUILT_ELF
    if not path.is_file():
        remedy = "run make firmware in the repository, or name the file as emulated:FILE"
        raise InputError("--device", f"emulated:{path}", "no such file", remedy)
    return EmulatedBoard(path)


class EmulatedBoard:
    """The program that is flashed onto the ItsyBitsy M0 or M4, run instruction by instruction.

    elf : build/firmware/itsybitsy_m0.elf or _m4.elf of `make firmware`. Of the outputs, the pins show duty,
    enable, stop pulse, slot and whether the key is down; mode and command go over the link alone. Raises
    DeviceError if the port does not open.
    """

    name = "emulated"

    def __init__(self, elf: Path) -> None:
        middle = (Settings().reading_low + Settings().reading_high) // 2
        self._inputs = TickInputs(middle)
        # behind the bootloader of either chip
        is_m4 = min((load for load, _data in read_elf(elf).parts), default=0) == FLASH_START
        kind = M4Emulator if is_m4 else M0Emulator
        self.emulator: M0Emulator = kind(elf, lambda _outputs: self._inputs)
        while not self.emulator.usb.is_open:
            self.emulator.run_ticks(1)
            if self.emulator.tick > BOOT_TICKS:
                raise DeviceError("emulated: the USB port does not open; build the firmware again")
        self.ticks = self.emulator.tick

    def tick(self, inputs: Inputs) -> Outputs:
        """Run from one tick nearly to the next. DeviceError where the converter cannot have such readings."""
        if inputs.highest > COUNTS_MAX:
            reason = f"its converter ends at {COUNTS_MAX} counts, the simulated sensor gave {inputs.highest}"
            raise DeviceError(f"emulated: {reason}; choose a rig whose sensor has 12 bits, such as voltage")
        others = {
            "supply_counts": min(round(inputs.supply_mV / self.emulator.supply_mV_counts), COUNTS_MAX),
            "force_counts": inputs.force_counts,
            "thermistor_counts": inputs.thermistor_counts,
        }
        burst = (inputs.sum, inputs.lowest, inputs.highest, self.emulator.reads)
        self._inputs = TickInputs.of_burst(*burst, **others)
        before = len(self.emulator.wire_log)
        self.emulator.run_ticks(inputs.elapsed_ticks)
        self.emulator.run_us(SHARE_OF_TICK * self.emulator.tick_us)
        now = self.emulator.outputs()
        return Outputs(now.duty_q15, int(now.enable), self._slot(before), round(now.stop_us), int(now.key))

    def _slot(self, before: int) -> int:
        for message in self.emulator.wire_log[before:]:
            if message.data[:1] == bytes([PLAY_HEADER]) and message.data[2]:
                return message.data[1]
        return NONE

    def write(self, data: bytes) -> None:
        """Put bytes on the link."""
        self.emulator.write(data)

    def read(self) -> bytes:
        """Return what the board has put on the link."""
        return self.emulator.read()

    def unplug(self) -> None:
        """Pull the cable."""
        self.emulator.unplug()

    def plug(self) -> None:
        """Plug it in again, and wait until the port is open."""
        self.emulator.plug()
        start = self.emulator.tick
        while not self.emulator.usb.is_open and self.emulator.tick < start + BOOT_TICKS:
            self.emulator.run_ticks(1)

    def close(self) -> None:
        """Nothing outlives the board."""
