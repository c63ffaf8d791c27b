"""The tests of this folder again, with the address and the undefined-behaviour sanitiser."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest
from tests.safety._build import LIBRARY, REPOSITORY, SANITISED, compile_c

FOLDER = Path(__file__).parent
RUNS = ("test_image_check.py",)


def asan_runtime() -> str:
    """Where the sanitiser lives: it must be loaded before the interpreter's own libraries."""
    out = subprocess.run(["cc", "-print-file-name=libasan.so"], capture_output=True, text=True, check=True)
    return str(Path(out.stdout.strip()).resolve())


@pytest.mark.timeout(120)
def test_nothing_is_read_outside_and_nothing_is_undefined(tmp_path: Path) -> None:
    library = compile_c(tmp_path / "libsafety.so", *SANITISED, "-fPIC", "-shared")
    out = subprocess.run(
        [sys.executable, "-m", "pytest", "-q", "-p", "no:cacheprovider", "-m", "not slow"]
        + [str(FOLDER / name) for name in RUNS],
        env=os.environ
        | {LIBRARY: str(library), "LD_PRELOAD": asan_runtime(), "ASAN_OPTIONS": "detect_leaks=0"},
        cwd=REPOSITORY,
        capture_output=True,
        text=True,
        check=False,
    )
    assert out.returncode == 0, out.stdout[-3000:] + out.stderr[-3000:]
