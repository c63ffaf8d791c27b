"""The safety part of the firmware compiled for the tests: plain, sanitised or measured for coverage."""

from __future__ import annotations

import ctypes
import os
import subprocess
import tempfile
from functools import cache
from pathlib import Path

REPOSITORY = Path(__file__).resolve().parents[2]
CORE = REPOSITORY / "firmware" / "core"
DRIVERS = tuple(Path(__file__).with_name(name) for name in ("_driver.c", "_replay.c"))
NAMES = ("arithmetic", "crc32", "heat", "image", "image_check", "settings", "supervisor", "thermistor")
SOURCES = tuple(CORE / f"{name}.c" for name in NAMES)
WARNINGS = ("-std=c99", "-Wall", "-Wextra", "-Werror")
SANITISED = ("-O1", "-g", "-fsanitize=address,undefined", "-fno-sanitize-recover=all")
LIBRARY = "FDVV_SAFETY_LIBRARY"
"""Environment variable: a library, built otherwise, that the same tests shall run on."""


def compile_c(
    target: Path, *flags: str, sources: tuple[Path, ...] = (*DRIVERS, *SOURCES), after: tuple[str, ...] = ()
) -> Path:
    """Compile and link, the libraries after the sources; the compiler's words on failure."""
    out = subprocess.run(
        ["cc", *WARNINGS, f"-I{CORE}", *flags, "-o", str(target), *map(str, sources), *after],
        capture_output=True,
        text=True,
        check=False,
        cwd=target.parent,
    )
    if out.returncode:
        raise AssertionError(out.stderr)
    return target


@cache
def safety_library() -> ctypes.CDLL:
    """Return the driver and the sources as one library, compiled once per test process."""
    if LIBRARY in os.environ:
        return ctypes.CDLL(os.environ[LIBRARY])
    with tempfile.TemporaryDirectory(prefix="fdvv-safety-") as folder:
        return ctypes.CDLL(str(compile_c(Path(folder) / "libsafety.so", "-O1", "-fPIC", "-shared")))
