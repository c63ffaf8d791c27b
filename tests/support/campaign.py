"""What random tests of one run share."""

from __future__ import annotations

import os
import shutil
import subprocess
from pathlib import Path


def find_seed() -> str:
    """Return FDVV_SEED, else the commit, else 0."""
    if seed := os.environ.get("FDVV_SEED"):
        return seed
    command = [shutil.which("git") or "true", "rev-parse", "--short=12", "HEAD"]
    ran = subprocess.run(command, cwd=Path(__file__).parent, capture_output=True, text=True, check=False)
    return ran.stdout.strip() or "0"


SEED = os.environ["FDVV_SEED"] = find_seed()
"""Of this run and of the processes that it starts."""
