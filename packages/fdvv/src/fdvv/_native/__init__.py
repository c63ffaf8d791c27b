"""The compiled kernels, found and called through ctypes.

Foreign calls release the interpreter lock, so threads run them side by side.
"""

from __future__ import annotations

import ctypes
import sys
from functools import cache
from pathlib import Path

import numpy as np
import numpy.typing as npt

from fdvv.errors import BuildError

LIBRARY = {"darwin": "libfdvv.dylib", "win32": "fdvv.dll"}.get(sys.platform, "libfdvv.so")
"""Its file, beside this one; hatch_build.py makes it."""


@cache
def library() -> ctypes.CDLL:
    """Load the compiled library once; raise BuildError with the way to build it if it is absent."""
    path = Path(__file__).with_name(LIBRARY)
    try:
        return ctypes.CDLL(str(path))
    except OSError as error:
        raise BuildError(
            f"the compiled library {path.name} cannot be loaded ({error}); reinstall fdvv with a C compiler"
        ) from error


def words(data: bytes) -> npt.NDArray[np.uint32]:
    """Copy bytes to memory aligned for the core."""
    return np.frombuffer(data + bytes(-len(data) % 4), np.uint32).copy()


def address(array: npt.NDArray[np.generic]) -> ctypes.c_void_p:
    """Return the address of a C-contiguous array, which lives at least as long as what is returned."""
    if not array.flags.c_contiguous:
        raise ValueError(f"array must be C-contiguous, got strides {array.strides}")
    return array.ctypes.data_as(ctypes.c_void_p)
