"""Compile the C kernels and the portable core into one shared library; write the tables of the protocol.

Run as a script to rebuild both in place. CC names another compiler, with its options; a machine without one
uses ziglang, which pip installs. docs/how-to/release.md says what a wheel is built with.
"""

from __future__ import annotations

import importlib.util
import os
import platform
import re
import shlex
import shutil
import subprocess
import sys
import sysconfig
import tempfile
from pathlib import Path
from typing import Any, NamedTuple

ROOT = Path(__file__).parent
SOURCES = ROOT if (ROOT / "firmware").is_dir() else ROOT.parents[1]
"""Where firmware and protocol are: beside this file in an sdist, at the root of a checkout."""
NATIVE = ROOT / "src" / "fdvv" / "_native"
CORE = SOURCES / "firmware" / "core"
FORCE_LOOP = SOURCES / "firmware" / "force_loop"
HOST = SOURCES / "firmware" / "boards" / "host"
PROTOCOL = SOURCES / "tools" / "make_protocol.py"
TABLES = ROOT / "src" / "fdvv" / "protocol" / "tables.py"
# -ffp-contract=off and no -march=native: the same bits on every x86-64 machine.
FLAGS = [
    "-std=c99",
    "-O3",
    "-g0",  # nothing of the folder it was built in
    "-ffp-contract=off",
    "-fno-strict-aliasing",
    "-Wall",
    "-Wextra",
    f"-I{CORE}",
    f"-I{FORCE_LOOP}",
    "-DFDVV_FORCE_LOOP",
]
# warnings are errors in a checkout; an unknown compiler must not break an installation by a warning
STRICT = ["-Werror"] if (SOURCES / ".git").exists() else []
MACOS = "11.0"
NO_COMPILER = (
    "fdvv: no C compiler found. {}, or `pip install ziglang`,\n"
    "fdvv: or name one in CC; pip then needs --no-build-isolation to see what was installed beside it."
)


class System(NamedTuple):
    """Names and compiler flags of one operating system.

    library : its name. shared : flags of a library. maths : where the C library keeps them apart. program :
    the firmware as a program, which needs POSIX. compilers : looked for in this order. remedy : how to get
    one.
    """

    library: str
    shared: tuple[str, ...]
    maths: tuple[str, ...]
    program: str | None
    compilers: tuple[str, ...]
    remedy: str


SYSTEMS = {
    "linux": System(
        *("libfdvv.so", ("-fPIC", "-shared"), ("-lm",), "fdvv-host", ("cc", "gcc", "clang")),
        "Install one (Debian: apt-get install gcc libc6-dev)",
    ),
    "darwin": System(
        "libfdvv.dylib",
        ("-fPIC", "-dynamiclib", "-Wl,-install_name,@rpath/libfdvv.dylib"),
        *((), "fdvv-host", ("cc", "clang", "gcc")),
        "Install Apple's (xcode-select --install)",
    ),
    "win32": System(
        *("fdvv.dll", ("-shared",), (), None, ("gcc",)),
        "Install GCC (MinGW-w64)",
    ),
}


def system_of(name: str = sys.platform) -> System:
    """Return the entry of a system; an unknown one is treated as Linux."""
    return SYSTEMS.get(name, SYSTEMS["linux"])


def compile_native(folder: Path = NATIVE, name: str = sys.platform) -> list[Path]:
    """Build the library of all kernels and, on POSIX, the firmware as a program; return their paths."""
    system, core = system_of(name), sorted([*CORE.glob("*.c"), *FORCE_LOOP.glob("*.c")])
    kernels = [*sorted(NATIVE.glob("*.c")), *core, HOST / "board.c"]
    flags = [*FLAGS, *STRICT, *_architectures(name)]
    built = [_compile(folder / system.library, kernels, [*flags, *system.shared], system)]
    if system.program:
        sources = [HOST / "main.c", HOST / "board.c", *core]
        built.append(_compile(folder / system.program, sources, flags, system))
    return built


def compiler(system: System) -> list[str] | None:
    """Return the command of CC, else of the system's compiler, else of ziglang; None without any."""
    if named := os.environ.get("CC"):
        return shlex.split(named, posix=os.name != "nt")
    if found := next(filter(None, map(shutil.which, system.compilers)), None):
        return [found]
    if importlib.util.find_spec("ziglang"):
        # left alone it compiles for this very processor
        return [sys.executable, "-m", "ziglang", "cc", "-mcpu=baseline"]
    return None


def _compile(target: Path, sources: list[Path], flags: list[str], system: System) -> Path:
    command = compiler(system)
    if not command:
        raise SystemExit(NO_COMPILER.format(system.remedy))
    # a process may have the old one mapped: write beside it, then rename; a library keeps its first name
    with tempfile.TemporaryDirectory(prefix=".", suffix=".tmp", dir=target.parent) as folder:
        fresh = Path(folder) / target.name
        try:
            subprocess.run(
                [*command, *flags, "-o", str(fresh), *map(str, sources), *system.maths], check=True
            )
            fresh.replace(target)
        except (OSError, subprocess.CalledProcessError) as error:
            raise SystemExit(f"fdvv: {target.name} cannot be built: {error}") from error
    return target


def _architectures(name: str) -> list[str]:
    """Return macOS's flags; ARCHFLAGS may name two processors."""
    if name != "darwin":
        return []
    version = os.environ.get("MACOSX_DEPLOYMENT_TARGET", MACOS)
    return [*shlex.split(os.environ.get("ARCHFLAGS", "")), f"-mmacosx-version-min={version}"]


def platform_tag(built: list[Path], name: str = sys.platform) -> str:
    """Return the platform tag (PEP 425, PEP 600) of a wheel with these files."""
    if name == "darwin":
        version = os.environ.get("MACOSX_DEPLOYMENT_TARGET", MACOS).replace(".", "_")
        architectures = re.findall(r"-arch (\S+)", os.environ.get("ARCHFLAGS", ""))
        processor = "universal2" if len(architectures) > 1 else (architectures or [platform.machine()])[0]
        return f"macosx_{version}_{processor}"
    plain = re.sub(r"[-.]", "_", sysconfig.get_platform())
    if needed := [version for path in built for version in glibc_needs(path)]:
        return plain.replace("linux", "manylinux_{}_{}".format(*max(needed)), 1)
    return plain


def glibc_needs(path: Path) -> set[tuple[int, int]]:
    """Return the glibc versions of the symbols that a file imports, read from its string tables."""
    return {(int(a), int(b)) for a, b in re.findall(rb"\0GLIBC_(\d+)\.(\d+)", path.read_bytes())}


def write_protocol_tables() -> Path:
    """Write fdvv.protocol.tables from protocol/fdvv.toml; return its path."""
    spec = importlib.util.spec_from_file_location("make_protocol", PROTOCOL)
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    sys.modules[spec.name] = module  # dataclasses look their module up
    spec.loader.exec_module(module)
    path: Path = module.write_tables(TABLES)
    return path


try:
    from hatchling.builders.hooks.plugin.interface import BuildHookInterface
except ImportError:  # run as a script, where hatchling need not be installed
    pass
else:

    class NativeBuildHook(BuildHookInterface):  # type: ignore[misc]
        """Build what a wheel or an editable installation needs and git does not hold."""

        PLUGIN_NAME = "custom"

        def dependencies(self) -> list[str]:
            return [] if compiler(system_of()) else ["ziglang"]

        def initialize(self, version: str, build_data: dict[str, Any]) -> None:
            built = compile_native()
            files = [*built, write_protocol_tables()]
            build_data["artifacts"] += [path.relative_to(ROOT).as_posix() for path in files]
            build_data["pure_python"] = False
            build_data["tag"] = f"py3-none-{platform_tag(built)}"


if __name__ == "__main__":
    for path in (write_protocol_tables(), *compile_native()):
        sys.stdout.write(f"{path}\n")
