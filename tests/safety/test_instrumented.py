"""The tests of this folder again with sanitisers and counters: nothing undefined, every line run."""

from __future__ import annotations

import os
import re
import subprocess
import sys
from pathlib import Path

import pytest

from tests.safety._build import CORE, DRIVERS, LIBRARY, REPOSITORY, SANITISED, compile_c

MEASURED = ("supervisor", "heat", "thermistor", "settings", "image_check", "crc32")
BESIDE = ("arithmetic", "image")
RUNS = ("test_supervisor.py", "test_settings.py", "test_image_check.py")


def asan_runtime() -> str:
    """Where the address sanitiser lives: it must be loaded before the interpreter's own libraries."""
    out = subprocess.run(["cc", "-print-file-name=libasan.so"], capture_output=True, text=True, check=True)
    return str(Path(out.stdout.strip()).resolve())


def build(folder: Path, *flags: str) -> Path:
    """Compile each source by itself, so that counters are reported by file, and link."""
    objects = tuple(
        compile_c(folder / f"{name}.o", *flags, "-fPIC", "-c", sources=(CORE / f"{name}.c",))
        for name in (*MEASURED, *BESIDE)
    )
    return compile_c(folder / "libsafety.so", *flags, "-fPIC", "-shared", sources=(*DRIVERS, *objects))


def run_on(library: Path, *choice: str) -> None:
    """Run the tests on that library; nothing is leaked or undefined if they pass."""
    out = subprocess.run(
        [sys.executable, "-m", "pytest", "-q", "-p", "no:cacheprovider", "-s", *choice]
        + [str(Path(__file__).with_name(name)) for name in RUNS],
        env=os.environ
        | {LIBRARY: str(library), "LD_PRELOAD": asan_runtime(), "ASAN_OPTIONS": "detect_leaks=0"},
        cwd=REPOSITORY,
        capture_output=True,
        text=True,
        check=False,
    )
    assert out.returncode == 0, out.stdout[-3000:] + out.stderr[-3000:]


def report(folder: Path, name: str) -> tuple[float, float]:
    """Return the percentages of lines run and of branches taken."""
    command = ["gcov", "-n", "-b", "-o", str(folder), f"{name}.o"]
    said = subprocess.run(command, cwd=folder, capture_output=True, text=True, check=True).stdout
    own = said[said.index(f"{name}.c'") :]
    figures = [re.search(rf"{what}:([\d.]+)%", own) for what in ("Lines executed", "Taken at least once")]
    lines, branches = (float(figure[1]) if figure else 100.0 for figure in figures)
    return lines, branches


def test_every_line_is_run_and_nothing_is_undefined(tmp_path: Path) -> None:
    # what is thought out alone: coverage is not left to chance
    library = build(tmp_path, *SANITISED, "--coverage", "-O0")
    run_on(library, "-k", "not random", "-m", "not slow")
    for name in MEASURED:
        lines, branches = report(tmp_path, name)
        sys.stdout.write(f"{name}.c: {lines} % of the lines, {branches} % of the branches\n")
        assert lines == 100


@pytest.mark.slow
def test_the_sanitiser_sees_a_byte_read_beyond_an_image(tmp_path: Path) -> None:
    text = (CORE / "image_check.c").read_text()
    broken = tmp_path / "image_check.c"
    broken.write_text(text.replace("at + bytes <= check->size_bytes", "at + bytes <= check->size_bytes + 4u"))
    assert broken.read_text() != text
    others = tuple(CORE / f"{name}.c" for name in (*MEASURED, *BESIDE) if name != "image_check")
    library = compile_c(
        tmp_path / "libsafety.so", *SANITISED, "-fPIC", "-shared", sources=(*DRIVERS, *others, broken)
    )
    with pytest.raises(AssertionError, match="heap-buffer-overflow"):
        run_on(library, "-k", "mutated_image", "-m", "not slow")


@pytest.mark.slow
@pytest.mark.campaign
def test_nothing_is_undefined_in_the_long_tests_either(tmp_path: Path) -> None:
    run_on(build(tmp_path, *SANITISED))
