"""What the compiled kernels are handed, and the kernels under the undefined-behaviour sanitiser."""

from __future__ import annotations

import subprocess
import sys
import weakref
from pathlib import Path

import numpy as np
import pytest

from fdvv._native import address
from tests.safety._build import CORE, REPOSITORY, SANITISED, compile_c

NATIVE = REPOSITORY / "packages/fdvv/src/fdvv/_native"
FORCE_LOOP = REPOSITORY / "firmware" / "force_loop"
FLAGS = (f"-I{NATIVE}", f"-I{FORCE_LOOP}", "-DFDVV_FORCE_LOOP")
SOURCES = tuple(path for part in (NATIVE, CORE, FORCE_LOOP) for path in sorted(part.glob("*.c")))

ON_LIBRARY = """
import ctypes, sys
import fdvv._native as native
other = ctypes.CDLL(sys.argv[1])
native.library = lambda: other
import fdvv.model.fit as fit, fdvv.twin.rig_kernel as kernel
fit.library = kernel.library = native.library
import numpy as np
from fdvv.device.twin import TwinDevice
from fdvv.model.surface import ForceSurface
from fdvv.model.curve import MeasuredCurve, Stroke
from fdvv.model.fit import fit_curve
from fdvv import load_builtin
rng = np.random.default_rng(1)
"""
"""Begins a program that fits and presses with the kernels of another library, which is named to it."""
# run in a process of its own: the sanitiser ends it at the first fault
EXERCISE = (
    ON_LIBRARY
    + """
for count in (4, 16, 17, 120, 800):
    x = np.cumsum(rng.uniform(1e-6, 0.02, count))
    for degree in (1, 2, 3):
        for size in {degree + 1, 4, min(15, count), min(64, count)}:
            if degree < size <= count:
                curve = MeasuredCurve(x, rng.normal(50, 30, count), Stroke.PRESS)
                fit_curve(curve, degree=degree, control_points=size)
button = load_builtin("mx-clear")
device = TwinDevice(seed=1)
device.upload(ForceSurface.of_model(button, [50.0, 200.0]), button.travel_mm)
for velocity in (5.0, 100.0, 500.0):
    device.press(velocity)
print("done")
"""
)


def test_an_array_lives_as_long_as_its_address() -> None:
    """Else a kernel that is handed a temporary array reads what another thread has put in its place."""
    array = np.zeros(3)
    lives, pointer = weakref.ref(array), address(array)
    del array
    assert lives() is not None
    del pointer
    assert lives() is None


@pytest.mark.slow
def test_fits_and_presses_run_without_undefined_behaviour(tmp_path: Path) -> None:
    flags = ("-O1", "-g", "-fPIC", "-shared", "-fsanitize=undefined", "-fno-sanitize-recover=all")
    library = compile_c(tmp_path / "libsanitised.so", *flags, *FLAGS, sources=SOURCES, after=("-lm",))
    out = subprocess.run(
        [sys.executable, "-c", EXERCISE, str(library)], capture_output=True, text=True, check=False
    )
    assert (out.returncode, out.stdout.strip(), out.stderr) == (0, "done", "")


@pytest.mark.slow
def test_the_kernels_free_what_they_take_and_stay_in_bounds(tmp_path: Path) -> None:
    # valgrind would do as well; the address sanitiser comes with the compiler
    program = tmp_path / "program.c"
    program.write_text(
        '#include "fdvv.h"\n#include <stdlib.h>\nint main(void) {\n'
        "  for (int n = 4; n < 400; n += 37) {\n"
        "    double *x = malloc(n * 8), *y = malloc(n * 8), *w = malloc(n * 8), t[68], c[64];\n"
        "    for (int i = 0; i < n; i++) x[i] = i * 0.005, y[i] = (i * 7919) % 101, w[i] = 1;\n"
        "    for (int d = 1; d <= 3; d++) for (int m = d + 1; m <= 64; m += 6)\n"
        "      fdvv_spline_free_knots(n, x, y, w, d, m, 0.004, 5, t, c);\n"
        "    free(x); free(y); free(w);\n  }\n  return 0;\n}\n"
    )
    binary = compile_c(tmp_path / "program", *SANITISED, *FLAGS, sources=(program, *SOURCES), after=("-lm",))
    out = subprocess.run([str(binary)], capture_output=True, text=True, check=False)
    assert (out.returncode, out.stderr) == (0, "")
