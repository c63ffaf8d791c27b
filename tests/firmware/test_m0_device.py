"""The emulated ItsyBitsy M0 under the contract of every device, and by its name."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from fdvv.device.contract import ProgramDevice
from fdvv.device.linked import LinkedDevice
from fdvv.device.open import open_device
from fdvv.errors import DeviceError, InputError
from fdvv.testing.conformance import ProgramConformance, plain_surface
from fdvv.twin.files import load_rig
from fdvv_m0.board import EmulatedBoard
from tests.firmware._m0 import CONTROLLER, build
from tests.support.scripted_person import ScriptedPerson

pytestmark = pytest.mark.firmware


@pytest.fixture(scope="module")
def elf() -> Path:
    return build(CONTROLLER)


class TestEmulatedBoard(ProgramConformance):
    elf: Path

    @pytest.fixture(autouse=True)
    def _built(self, elf: Path) -> None:
        self.elf = elf

    def make(self) -> ProgramDevice:
        return LinkedDevice(EmulatedBoard(self.elf), ScriptedPerson())


def test_a_rig_whose_sensor_has_more_bits_than_the_board_is_refused(elf: Path) -> None:
    with pytest.raises(DeviceError, match="choose a rig whose sensor has 12 bits"):
        open_device(f"emulated:{elf}", load_rig("light"))


def test_a_press_on_the_simulated_rig_is_nearly_that_of_the_host_program(elf: Path) -> None:
    felt = []
    for name in (f"emulated:{elf}", "host"):
        device = open_device(name, seed=4)
        device.upload(plain_surface(), 4.0)
        press = device.press(100.0)
        felt.append(np.interp(np.linspace(0.05, 0.2, 50), press.t_s, press.force_cN))
        info = device.info()
        assert info.simulated
        assert isinstance(device, LinkedDevice)
        device.close()
    # the emulated board's tick falls at another instant of the press: force differs where it changes fast
    assert np.median(np.abs(felt[0] - felt[1])) < 0.05 * np.ptp(felt[1])


def test_a_program_that_is_not_there_is_refused_in_one_line() -> None:
    with pytest.raises(InputError, match="no such file"):
        open_device("emulated:nowhere.elf")
