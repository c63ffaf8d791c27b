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

NATIVE = Path(__file__).parent / "src" / "fdvv" / "_native"
CORE = Path(__file__).parent / "firmware" / "core"
# -ffp-contract=off and no -march=native: the same bits on every x86-64 machine.
FLAGS = ["-std=c99", "-O3", "-fPIC", "-shared", "-ffp-contract=off", "-Wall", "-Wextra", "-Werror"]


def compile_library(folder: Path = NATIVE) -> Path:
    compiler = os.environ.get("CC") or shutil.which("cc") or shutil.which("gcc") or shutil.which("clang")
    if not compiler:
        raise SystemExit("fdvv: no C compiler found; install one (Debian: apt-get install gcc) or set CC")
    library = folder / "libfdvv.so"
    # a process may have the old library mapped: write beside it, then rename
    fresh = library.with_suffix(f".{os.getpid()}.tmp")
    sources = [str(path) for part in (folder, CORE) for path in sorted(part.glob("*.c"))]
    subprocess.run([compiler, *FLAGS, f"-I{CORE}", "-o", str(fresh), *sources, "-lm"], check=True)
    fresh.replace(library)
    return library


try:
    from hatchling.builders.hooks.plugin.interface import BuildHookInterface
except ImportError:  # run as a script, where hatchling need not be installed
    pass
else:

    class NativeBuildHook(BuildHookInterface):  # type: ignore[misc]
        """Hatchling's door to compile_library."""

        PLUGIN_NAME = "custom"

        def initialize(self, version: str, build_data: dict[str, Any]) -> None:
            compile_library()
            build_data["pure_python"] = False
            build_data["tag"] = f"py3-none-{_platform_tag()}"


def _platform_tag() -> str:
    import sysconfig

    return sysconfig.get_platform().replace("-", "_").replace(".", "_")


if __name__ == "__main__":
    sys.stdout.write(f"{compile_library()}\n")
