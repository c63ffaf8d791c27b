"""Devices on drives honour the contract: in simulated time, and each at its simulated far end."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import ExitStack

import pytest

from fdvv.testing.conformance import ProgramConformance
from fdvv_drives.device import DriveDevice
from fdvv_drives.testing.direct import direct_device
from fdvv_drives.testing.process import FarProcess
from tests.drives.conftest import opened


class TestDirect(ProgramConformance):
    def make(self) -> DriveDevice:
        return direct_device()[0]


class FarConformance(ProgramConformance):
    """The same over a pseudo-terminal, in real time."""

    kind: str

    @pytest.fixture(autouse=True)
    def _far(self, far_of: Callable[[str], FarProcess]) -> Iterator[None]:
        self.far = far_of(self.kind)
        with ExitStack() as self.stack:
            yield

    def make(self) -> DriveDevice:
        # two devices on one far end take turns: whichever presses enables it
        return self.stack.enter_context(opened(self.kind, self.far))


@pytest.mark.slow
class TestMoteus(FarConformance):
    kind = "moteus"


@pytest.mark.slow
class TestODrive(FarConformance):
    kind = "odrive"


@pytest.mark.slow
class TestSimpleFOC(FarConformance):
    kind = "simplefoc"
