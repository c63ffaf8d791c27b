"""What is built out of the sources, once a run, and the tools that build it."""

from __future__ import annotations

import importlib.util
import os
import shutil
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path
from types import ModuleType

import pytest

REPOSITORY = Path(__file__).resolve().parents[2]
BUILD = """
import sys, hatchling.build as build
print(getattr(build, f"build_{sys.argv[1]}")(sys.argv[2]))
"""


def clean_environment(**more: str) -> dict[str, str]:
    """Return this environment without what leads to the checkout."""
    kept = {name: value for name, value in os.environ.items() if name not in ("PYTHONPATH", "CC")}
    return {**kept, "PYTHONUTF8": "1", **more}


def module_of(path: Path) -> ModuleType:
    """Import a file that is no part of the package."""
    spec = importlib.util.spec_from_file_location(path.stem, path)
    assert spec
    assert spec.loader
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def new_environment(folder: Path, *packages: str) -> Path:
    """Make a virtual environment with packages; return its Python."""
    subprocess.run([sys.executable, "-m", "venv", str(folder)], check=True)
    python = folder / "bin" / "python"
    uv = [
        str(Path(sys.executable).with_name("uv")),
        "pip",
        "install",
        "-q",
        "--python",
        str(python),
        *packages,
    ]
    # ten times faster; where it cannot reach what pip can, pip does the same work
    if subprocess.run(uv, env=clean_environment(), capture_output=True, check=False).returncode:
        pip = [str(python), "-m", "pip", "--disable-pip-version-check", "-q", "install", *packages]
        subprocess.run(pip, check=True, env=clean_environment())
    return python


@dataclass(frozen=True)
class Builder:
    """Builds packages of a folder of sources, as pip does it."""

    python: Path

    def build(self, kind: str, sources: Path, output: Path, **environment: str) -> Path:
        """Build a `wheel` or an `sdist`; return the file."""
        command = [str(self.python), "-c", BUILD, kind, str(output)]
        ran = subprocess.run(
            command,
            cwd=sources,
            env=clean_environment(**environment),
            capture_output=True,
            text=True,
            check=True,
        )
        return output / ran.stdout.split()[-1]


@dataclass(frozen=True)
class Packages:
    """The sdist of the core, the sources in it, the wheel that was built from those, and the wheels above."""

    sdist: Path
    sources: Path
    wheel: Path
    others: tuple[Path, ...]


@pytest.fixture(scope="session")
def builder(tmp_path_factory: pytest.TempPathFactory) -> Builder:
    """Return a builder of packages, in an environment of its own."""
    return Builder(new_environment(tmp_path_factory.mktemp("builder"), "hatchling"))


@pytest.fixture(scope="session")
def packages(builder: Builder, tmp_path_factory: pytest.TempPathFactory) -> Packages:
    """Build the sdist of each package, and the wheel from it."""
    output = tmp_path_factory.mktemp("packages")
    built = []
    for name in ("fdvv", "fdvv-studio", "fdvv-people", "fdvv-campaigns"):
        sdist = builder.build("sdist", REPOSITORY / "packages" / name, output)
        sources = unpacked(sdist, output / name)
        built.append((sdist, sources, builder.build("wheel", sources, output)))
    return Packages(*built[0], tuple(wheel for _, _, wheel in built[1:]))


def unpacked(sdist: Path, folder: Path) -> Path:
    """Unpack an sdist; return the folder of its sources."""
    shutil.unpack_archive(sdist, folder, filter="data")
    (sources,) = folder.iterdir()
    return sources


@pytest.fixture(scope="session")
def zig() -> list[str]:
    """Return the compiler that pip installs, or skip by name where `make zig-tools` did not run."""
    python = Path(os.environ.get("FDVV_ZIG", REPOSITORY / "build" / "zig" / "bin" / "python"))
    if not python.exists():
        pytest.skip("ziglang is not installed: make zig-tools")
    return [str(python), "-m", "ziglang", "cc"]
