"""Where this checkout is, and the real measurements beside it."""

from __future__ import annotations

import os
from pathlib import Path

REPOSITORY = Path(__file__).resolve().parents[2]


def shared_folder() -> Path:
    """Return the folder of real measurements: FDVV_SHARED, else beside the checkout."""
    return Path(os.environ.get("FDVV_SHARED", REPOSITORY.parent / "shared"))
