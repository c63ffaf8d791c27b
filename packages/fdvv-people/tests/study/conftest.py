"""Studies write every answer to the disk; nothing here cuts the power, so nobody waits for the disk."""

import pytest


@pytest.fixture(autouse=True)
def _unforced(hasty_disk: None) -> None:
    """Have every test of studies write in haste."""
