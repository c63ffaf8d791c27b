"""The simulated far ends of the drives, each a process on a pseudo-terminal."""

from __future__ import annotations

import importlib.util
import os
import sys
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest

from fdvv_drives.device import DriveDevice
from fdvv_drives.open import open_moteus, open_odrive, open_simplefoc
from fdvv_drives.testing.process import FarProcess

OPEN: dict[str, Callable[[str], DriveDevice]] = {
    "moteus": open_moteus,
    "odrive": open_odrive,
    "simplefoc": open_simplefoc,
}
GENEROUS = ("--answer-ms", "200", "--late-ms", "900", "--watchdog-ms", "600")
"""For what a test does not look at: machines that test are busy."""


LIBRARIES = {"moteus": "moteus", "odrive": "can", "simplefoc": "serial"}


def need(kind: str) -> None:
    """Skip where the library of a drive is not installed; where CI is set it must be."""
    if importlib.util.find_spec(LIBRARIES[kind]) is None:
        missing = pytest.fail if os.environ.get("CI") else pytest.skip
        missing(f"needs {LIBRARIES[kind]}")


@pytest.fixture(scope="module")
def far_of(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Callable[[str], FarProcess]]:
    """Return the far end of a kind of drive, the same for all tests of a module."""
    if sys.platform == "win32":
        pytest.skip("far ends need pseudo-terminals")
    started: dict[str, FarProcess] = {}

    def find(kind: str) -> FarProcess:
        need(kind)
        if kind not in started:
            started[kind] = FarProcess(kind, tmp_path_factory.mktemp("far"), *GENEROUS)
        return started[kind]

    yield find
    for far in started.values():
        far.close()


@pytest.fixture
def start(tmp_path: Path) -> Iterator[Callable[..., FarProcess]]:
    """Start the far end of a kind of drive; it is gone after the test."""
    if sys.platform == "win32":
        pytest.skip("far ends need pseudo-terminals")
    started: list[FarProcess] = []

    def begin(kind: str, *options: str) -> FarProcess:
        need(kind)
        folder = tmp_path / f"far-{len(started)}"
        folder.mkdir()
        started.append(FarProcess(kind, folder, *(options or GENEROUS)))
        return started[-1]

    yield begin
    for far in started:
        far.close()


def opened(kind: str, far: FarProcess) -> DriveDevice:
    """Open the device of a far end, whose hand presses as soon as the cap is up."""
    device = OPEN[kind](str(far.stage))
    device.armed = far.press
    return device
