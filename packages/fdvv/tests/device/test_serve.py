"""A simulated rig behind a pseudo-terminal: opened, pressed and left like one on a cable."""

from __future__ import annotations

from collections.abc import Iterator

import pytest

from fdvv.device.open import person_of
from fdvv.device.own_rig import OwnRigPerson
from fdvv.device.remote import PressedDevice
from fdvv.device.serial import SerialPort
from fdvv.device.serve import RigServer
from fdvv.model.file import load_builtin
from fdvv.program.button import compile_button
from fdvv.testing.conformance import plain_surface
from tests.support.plain_rig import PlainRig


@pytest.fixture
def server() -> Iterator[RigServer]:
    found = RigServer(OwnRigPerson(PlainRig, 1))
    found.start()
    yield found
    found.end()


def test_a_served_rig_is_pressed_at_the_announced_speed_by_one_host_after_another(server: RigServer) -> None:
    lasted_s = []
    for velocity_mm_s in (50.0, 200.0):
        with PressedDevice(SerialPort(server.path)) as device:
            assert device.settings() == server.settings
            device.upload(plain_surface(), 4.0)
            press = device.press(velocity_mm_s)
        assert press.simulated
        assert press.displacement_mm.max() == pytest.approx(4.0, abs=0.15)
        lasted_s.append(press.t_s[-1])
    assert lasted_s[0] > 1.5 * lasted_s[1]
    assert server.counts["presses"] >= 2


def test_the_twin_is_served_and_pressed_without_an_announced_speed() -> None:
    server = RigServer(person_of("twin"), presses=1)
    server.start()
    with PressedDevice(SerialPort(server.path)) as device:
        device.upload_program(compile_button(load_builtin("mx-clear")).image)
        device.client.arm()
        until_s = device.client.port.now_s() + 20
        while not server.counts["presses"] and device.client.port.now_s() < until_s:
            device.client.listen(device.client.port.now_s() + 0.05)
        device.client.listen(device.client.port.now_s() + 0.05)
        assert server.is_alive()
    assert server.counts["presses"] == 1
    server.end()
