"""Build the programs of the ItsyBitsy M0 and M4, read what the check tells. All figures here are emulated."""

from __future__ import annotations

import fcntl
import shutil
import struct
import subprocess
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from importlib.util import find_spec
from pathlib import Path

from tests.firmware._simavr import require

REPOSITORY = Path(__file__).resolve().parents[2]
BOARDS = REPOSITORY / "firmware" / "boards"
BOARD, SHARED = BOARDS / "itsybitsy_m0", BOARDS / "samd"
BUILD = REPOSITORY / "build" / "firmware"
TINYUSB = REPOSITORY / "build" / "tinyusb" / ".ready"
CHECK, CONTROLLER = BUILD / "itsybitsy_m0_check.elf", BUILD / "itsybitsy_m0.elf"
M4_CHECK, M4_CONTROLLER = BUILD / "itsybitsy_m4_check.elf", BUILD / "itsybitsy_m4.elf"


def require_tools() -> None:
    """See that a controller can be built and emulated."""
    others = {"unicorn (extra dev)": bool(find_spec("unicorn")), "tinyusb-source": TINYUSB.is_file()}
    require("arm-none-eabi-gcc", "arm-none-eabi-size", "make", **others)


def build(program: Path) -> Path:
    """Bring a program up to date, one process at a time, and return it."""
    require_tools()
    with locked():
        make(program, BOARDS)
    return program


def build_with(program: Path, folder: Path, source: str, old: str, new: str) -> Path:
    """Plant a fault: build a program in a folder from sources in which one text of one file is another."""
    build(program)
    sources, objects = folder / "firmware", f"{board_of(program)}.objects"
    shutil.copytree(REPOSITORY / "firmware", sources)
    with locked():
        shutil.copytree(BUILD / objects, folder / objects)  # no older than the sources: one is compiled
    text = (sources / "boards" / source).read_text()
    assert text.count(old) == 1
    (sources / "boards" / source).write_text(text.replace(old, new))
    return make(folder / program.name, sources / "boards")


@contextmanager
def locked() -> Iterator[None]:
    """Keep other processes from the built files."""
    BUILD.mkdir(parents=True, exist_ok=True)
    with (BUILD / "lock").open("w") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        yield


def board_of(program: Path) -> str:
    """Return the board that a program is for."""
    return program.stem.removesuffix("_check")


def make(program: Path, boards: Path) -> Path:
    """Make a program in its folder from the sources of its board."""
    tinyusb = TINYUSB.parent / "usr" / "src" / "tinyusb" / "src"
    places = [f"BUILD={program.parent}", f"TINYUSB={tinyusb}"]
    command = ["make", "-s", "-C", str(boards / board_of(program)), *places, str(program)]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    return program


def sizes_bytes(elf: Path) -> tuple[int, int]:
    """Return flash and static RAM."""
    done = subprocess.run(["arm-none-eabi-size", str(elf)], capture_output=True, text=True, check=True)
    text, data, bss = (int(word) for word in done.stdout.splitlines()[1].split()[:3])
    return text + data, data + bss


@dataclass(frozen=True)
class TickFrame:
    """What the check program tells of a tick."""

    reset_cause: int
    elapsed_ticks: int
    time_us: int
    sum: int
    lowest: int
    highest: int
    supply_mV: int
    force_counts: int
    duty_q15: int
    served_us: int


TICK = struct.Struct("<BBIIHHHHhH")


def frames(data: bytes) -> tuple[list[TickFrame], bytes]:
    """Split what the check program says into ticks and what it echoes."""
    ticks, echoed, at = [], b"", 0
    while at < len(data):
        kind, size = data[at], data[at + 1]
        body = data[at + 2 : at + size]
        if kind == ord("T"):
            ticks.append(TickFrame(*TICK.unpack(body)))
        else:
            assert kind == ord("E"), f"a frame of kind {kind} at byte {at}"
            echoed += body
        at += size
    return ticks, echoed
