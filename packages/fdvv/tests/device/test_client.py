"""The host's side of the link over lines that lose, damage and break."""

from __future__ import annotations

import random

import pytest

from fdvv.device.boards import HostBoard, LibraryBoard
from fdvv.device.client import Client
from fdvv.device.linked import LinkedDevice, LockstepPort
from fdvv.device.wire import RefusedError
from fdvv.errors import DeviceError
from fdvv.protocol.tables import FaultedRequest, Refusal, Settings
from tests.support.link_rigs import LONG, PROGRAMS, linked
from tests.support.scripted_person import ScriptedPerson


class BadLine(LibraryBoard):
    """A board at the end of a line that loses and damages bytes, both ways."""

    def __init__(self, seed: int, rate: float) -> None:
        super().__init__()
        self.random, self.rate = random.Random(seed), rate

    def spoiled(self, data: bytes) -> bytes:
        if not data or self.random.random() > self.rate:
            return data
        place = self.random.randrange(len(data))
        other = self.random.choice((b"", bytes([self.random.randrange(256)]), b"\0\0"))
        return data[:place] + other + data[place + 1 :]

    def write(self, data: bytes) -> None:
        super().write(self.spoiled(data))

    def read(self) -> bytes:
        return self.spoiled(super().read())


@pytest.mark.parametrize("seed", range(8))
def test_an_upload_over_a_bad_line_arrives_whole(seed: int) -> None:
    board = BadLine(seed, 0.08)
    person = ScriptedPerson()
    client = Client(LockstepPort(board, person.rest(Settings()), 250))
    for image in (LONG, *PROGRAMS):
        client.upload(image)
        assert board.program() == image
    assert client._wire.repeated > 0


def test_a_bad_line_loses_telemetry_that_is_counted() -> None:
    board = BadLine(3, 0.1)
    device = LinkedDevice(board, ScriptedPerson())
    device.upload_program(PROGRAMS[0])
    telemetry = device.client.telemetry
    press = device.press(100.0)
    assert telemetry.missing_frames > 0
    assert press.tick is not None
    # of a frame lost at the very end nobody knows
    assert 0 < (~press.tick).sum() <= telemetry.missing_ticks + 16


def test_a_dead_line_is_reported_within_a_second() -> None:
    board = BadLine(1, 1.0)
    board.spoiled = lambda data: b""  # type: ignore[method-assign]
    port = LockstepPort(board, ScriptedPerson().rest(Settings()), 250)
    with pytest.raises(DeviceError, match=r"no answer to hello in 0\.6 s; is it powered"):
        Client(port)
    assert port.now_s() < 1


def test_a_refusal_names_the_request_and_the_reason() -> None:
    device = linked()
    with pytest.raises(RefusedError, match="library: refused arm: it has no program") as caught:
        device.client.arm()
    assert caught.value.refusal is Refusal.NO_IMAGE


@pytest.mark.parametrize("kind", [LibraryBoard, HostBoard])
def test_after_a_pulled_cable_one_may_go_on(kind: type[LibraryBoard | HostBoard]) -> None:
    device = LinkedDevice(kind(), ScriptedPerson())
    device.upload_program(PROGRAMS[0])
    device.port.unplug()
    with pytest.raises(DeviceError, match="the line is closed"):
        device.press(100.0)
    for _ in range(50):
        device.port.step()
    device.client.reconnect()
    assert device.press(100.0).force_cN.max() > 10
    device.close()


def test_a_cable_pulled_while_armed_ends_force_in_time() -> None:
    faults: list[FaultedRequest] = []
    person = ScriptedPerson()
    port = LockstepPort(HostBoard(), person.rest(Settings()), 250)
    client = Client(port, on_fault=faults.append)
    client.upload(PROGRAMS[0])
    client.arm()
    begun_s = port.now_s()
    port.unplug()
    while port.step().duty_q15:
        assert port.now_s() - begun_s < 0.252
    client.reconnect()
    assert client.read_fault().fault == 9
    client.close()


def test_pings_relate_the_clocks() -> None:
    client = linked().client
    for _ in range(20):
        client.ping()
    relation = client.clocks()
    # in lockstep both clocks are one: the offset is half a round trip of a tick or two
    assert abs(relation.offset_us) <= relation.error_us + 1
    assert relation.residual_us < 1
    assert relation.exchanges == 10


def test_a_host_that_only_listens_keeps_the_device_armed() -> None:
    device = linked()
    device.upload_program(PROGRAMS[0])
    device.client.arm()
    device.client.listen(device.port.now_s() + 1.0)
    assert device.port.outputs.duty_q15 > 0
