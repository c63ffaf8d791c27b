"""Compile the C kernels and the firmware's portable core into one shared library.

Run as a script to rebuild it in place.
"""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from pathlib import Path
from typing import Any

ROOT = Path(__file__).parent
NATIVE = ROOT / "src" / "fdvv" / "_native"
CORE = ROOT / "firmware" / "core"
HOST = ROOT / "firmware" / "boards" / "host"
# -ffp-contract=off and no -march=native: the same bits on every x86-64 machine.
FLAGS = [
    "-std=c99",
    "-O3",
    "-ffp-contract=off",
    "-fno-strict-aliasing",
    "-Wall",
    "-Wextra",
    "-Werror",
    f"-I{CORE}",
]


def compile_native(folder: Path = NATIVE) -> tuple[Path, Path]:
    """Build the library of all kernels, and the firmware as a program; give their paths."""
    core = sorted(CORE.glob("*.c"))
    kernels = [*sorted(NATIVE.glob("*.c")), *core, HOST / "board.c"]
    library = _compile(folder / "libfdvv.so", kernels, ["-fPIC", "-shared"])
    program = _compile(folder / "fdvv-host", [HOST / "main.c", HOST / "board.c", *core], [])
    return library, program


def _compile(target: Path, sources: list[Path], flags: list[str]) -> Path:
    compiler = os.environ.get("CC") or shutil.which("cc") or shutil.which("gcc") or shutil.which("clang")
    if not compiler:
        raise SystemExit("fdvv: no C compiler found; install one (Debian: apt-get install gcc) or set CC")
    # a process may have the old one mapped: write beside it, then rename
    fresh = target.with_suffix(f".{os.getpid()}.tmp")
    subprocess.run([compiler, *FLAGS, *flags, "-o", str(fresh), *map(str, sources), "-lm"], check=True)
    fresh.replace(target)
    return target


try:
    from hatchling.builders.hooks.plugin.interface import BuildHookInterface
except ImportError:  # run as a script, where hatchling need not be installed
    pass
else:

    class NativeBuildHook(BuildHookInterface):  # type: ignore[misc]
        """Hatchling's door to compile_native."""

        PLUGIN_NAME = "custom"

        def initialize(self, version: str, build_data: dict[str, Any]) -> None:
            compile_native()
            build_data["pure_python"] = False
            build_data["tag"] = f"py3-none-{_platform_tag()}"


def _platform_tag() -> str:
    import sysconfig

    return sysconfig.get_platform().replace("-", "_").replace(".", "_")


if __name__ == "__main__":
    for path in compile_native():
        sys.stdout.write(f"{path}\n")
