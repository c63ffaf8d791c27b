"""What all tests share: real measurements where they are present."""

from __future__ import annotations

import os
import signal
from pathlib import Path

import pytest
from hypothesis import settings

settings.register_profile("quick", max_examples=15)
if os.environ.get("FDVV_QUICK"):
    settings.load_profile("quick")

REPOSITORY = Path(__file__).resolve().parents[1]

if signal.getsignal(signal.SIGINT) is signal.SIG_IGN:
    # a shell's background job; what the tests interrupt would inherit it and go on for ever
    signal.signal(signal.SIGINT, signal.default_int_handler)


def shared_folder() -> Path:
    """Return the folder of real measurements: FDVV_SHARED, else beside the checkout."""
    return Path(os.environ.get("FDVV_SHARED", REPOSITORY.parent / "shared"))


@pytest.fixture(scope="session")
def shared_data() -> Path:
    """Return ../shared/data, or skip by name where it is absent."""
    folder = shared_folder() / "data"
    if not folder.is_dir():
        pytest.skip("the real measurements (../shared/data or FDVV_SHARED) are not on this machine")
    return folder


@pytest.fixture
def hasty_disk(monkeypatch: pytest.MonkeyPatch) -> None:
    """Have nobody wait until something is on the disk: for small files that is most of the time."""
    monkeypatch.setattr("os.fsync", lambda _file: None)
