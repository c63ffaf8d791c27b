"""What importing costs."""

from __future__ import annotations

import subprocess
import sys


def test_importing_the_command_line_imports_neither_numpy_nor_scipy() -> None:
    heavy = ("numpy", "scipy", "matplotlib", "rich")
    code = f"import sys, fdvv.cli.main; print([m for m in {heavy} if m in sys.modules])"
    out = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert out.stdout.strip() == "[]"
