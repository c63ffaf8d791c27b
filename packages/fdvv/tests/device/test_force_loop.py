"""The force loop over the wire: closed, refused with a reason, opened by whatever ends its session."""

from __future__ import annotations

import subprocess
from collections.abc import Callable
from dataclasses import replace
from functools import partial
from pathlib import Path

import numpy as np
import pytest

from fdvv.compensation.force_loop.gains import force_loop_gains
from fdvv.device import client
from fdvv.device.boards import HostBoard, LibraryBoard
from fdvv.device.contract import ForceLoopDevice
from fdvv.device.linked import LinkedDevice
from fdvv.device.plant import Inputs, Outputs
from fdvv.device.remote import PressedDevice
from fdvv.device.serial import SerialPort
from fdvv.device.twin import SimulatedPerson, TwinDevice
from fdvv.device.wire import RefusedError
from fdvv.errors import DeviceError, ModelError
from fdvv.firmware.core import INPUTS, Core
from fdvv.protocol.frame import FrameDecoder
from fdvv.protocol.record import Record
from fdvv.protocol.tables import (
    FORCE_LOOP_HASH,
    BoardFlag,
    CellSpec,
    Fault,
    ForceLoopGains,
    LoopFault,
    LoopState,
    Message,
    ReadForceLoopRequest,
    Refusal,
)
from fdvv.testing.conformance import plain_surface
from fdvv.twin.settings import cell_of
from tests.support.force_loop_press import CONTROLLER, KNOWN, RIG
from tests.support.link_rigs import linked
from tests.support.pressed_rig import SETTINGS, Rig
from tests.support.scripted_person import ScriptedPerson

HOST = Path(__file__).resolve().parents[4] / "firmware" / "boards" / "host"
CELL = cell_of(RIG) or CellSpec(plate_kg=0.0, stiffness_N_m=0.0, damping_N_s_m=0.0, filter_s=0.0)
GAINS = force_loop_gains(KNOWN, CELL, 1e-4, CONTROLLER)


def opened(board: LibraryBoard | HostBoard | None = None, seed: int = 2) -> LinkedDevice:
    return LinkedDevice(board or LibraryBoard(), SimulatedPerson(RIG, seed=seed))


def closed(board: LibraryBoard | HostBoard | None = None) -> LinkedDevice:
    device = opened(board)
    device.close_loop(GAINS)
    device.upload(plain_surface(), 4.0)
    return device


def state(device: LinkedDevice) -> LoopState:
    return LoopState(device.client.read_force_loop().state)


class Witness(LibraryBoard):
    """Keeps what the board was sent and what it read and did, since its settings were written."""

    def __init__(self) -> None:
        super().__init__()
        self.log: list[tuple[Inputs, Outputs] | Message] = []
        self._decoder, self._due = FrameDecoder(), list[Message]()

    def write(self, data: bytes) -> None:
        super().write(data)
        self._due += [Message(frame.message) for frame in self._decoder.feed(data)]

    def tick(self, inputs: Inputs) -> Outputs:
        """Run a tick; what was sent before it is carried out after it."""
        outputs = super().tick(inputs)
        self.log += [(inputs, outputs), *self._due]
        if Message.WRITE_SETTINGS in self._due:
            self.log.clear()
        self._due.clear()
        return outputs


def test_a_loop_closed_over_the_wire_does_what_the_core_does_bit_for_bit() -> None:
    board = Witness()
    device = closed(board)
    device.press(100.0)
    core, image, armed = Core(device.settings()), device.image, 0
    begin: dict[Message, Callable[[], None]] = {
        Message.CLOSE_FORCE_LOOP: partial(core.close_loop, GAINS.pack()),
        Message.ACTIVATE: partial(core.activate, image),
        Message.ANNOUNCE: partial(core.announce, 1600),
        Message.ARM: core.arm,
        Message.DISARM: core.disarm,
    }
    for entry in board.log:
        if isinstance(entry, Message):
            begin.get(entry, lambda: None)()
            continue
        inputs, outputs = entry
        found = core.tick(np.array([tuple(inputs)], INPUTS)[0])
        assert (found["duty_q15"], found["commanded_cN64"]) == (outputs.duty_q15, outputs.commanded_cN64)
        armed += outputs.enable
    assert armed > 5000


def test_the_same_press_as_on_the_twin_within_what_two_presses_differ() -> None:
    twin = TwinDevice(RIG, seed=2)
    twin.close_loop(GAINS)
    twin.upload(plain_surface(), 4.0)
    off = [[np.abs(error_cN(device)).mean() for _ in range(4)] for device in (twin, closed())]
    assert np.median(off[1]) == pytest.approx(np.median(off[0]), abs=0.15)
    assert max(off[0] + off[1]) < 1.0


def error_cN(device: TwinDevice | LinkedDevice) -> np.ndarray[tuple[int], np.dtype[np.float64]]:
    """Return the true error of a press half way down, where the force is 40 cN + 5 cN/mm."""
    press = device.press(100.0)
    x, turn = press.displacement_mm, int(press.displacement_mm.argmax())
    rows = np.flatnonzero((x[:turn] > 1.0) & (x[:turn] < 3.5))
    return np.asarray(press.force_cN[rows] - 40.0 - 5.0 * x[rows])


def test_the_open_loop_is_not_as_good() -> None:
    device = opened()
    device.upload(plain_surface(), 4.0)
    assert np.abs(error_cN(device)).mean() > 4 * np.abs(error_cN(closed())).mean()


def test_a_board_tells_its_load_cell_and_the_state_of_its_loop() -> None:
    device = opened()
    assert isinstance(device, ForceLoopDevice)
    assert device.client.hello.board_flags & BoardFlag.FORCE_LOOP
    assert device.load_cell is not None
    wanted = np.array([getattr(CELL, name) for name in CellSpec.REALS], np.float32)
    assert np.array_equal([getattr(device.load_cell, name) for name in CellSpec.REALS], wanted)
    assert (state(device), device.loop) == (LoopState.OPEN, None)
    device.close_loop(GAINS)
    assert (state(device), device.loop) == (LoopState.CLOSED, GAINS)
    assert device.force_loop.state() == "closed"
    device.close_loop(None)
    assert (state(device), device.loop) == (LoopState.OPEN, None)


def test_closing_and_opening_want_a_new_upload() -> None:
    device = closed()
    for gains in (GAINS, None):
        device.upload(plain_surface(), 4.0)
        device.close_loop(gains)
        with pytest.raises(DeviceError, match="press before upload"):
            device.press(100.0)
        with pytest.raises(RefusedError, match="it has no program"):
            device.client.arm()


def refusal(call: Callable[[], object]) -> tuple[Refusal, int]:
    with pytest.raises(RefusedError) as caught:
        call()
    assert "\n" not in str(caught.value)
    return caught.value.refusal, caught.value.detail


class Raw(ForceLoopGains):
    """Constants that no host would send."""

    def __post_init__(self) -> None:
        """Check nothing."""


def sent(device: LinkedDevice, **changed: object) -> tuple[Refusal, int]:
    """Have constants refused that the host's own check would not let through."""
    body = Raw(**{**vars(GAINS), **changed})
    object.__setattr__(body, "__class__", ForceLoopGains)
    return refusal(lambda: device.client.close_force_loop(body))


def test_constants_that_are_none_are_refused_by_their_number() -> None:
    device = opened()
    assert sent(device, tick_s=float("nan")) == (Refusal.BAD_VALUE, 0)
    assert sent(device, mass_kg=0.0) == (Refusal.BAD_VALUE, 2)
    assert sent(device, stop_gains=(0.0, 0.0, float("inf"), 0.0)) == (Refusal.BAD_VALUE, 29)
    assert sent(device, contact_rate=1.01) == (Refusal.BAD_VALUE, 40)
    assert state(device) is LoopState.OPEN
    with pytest.raises(ModelError, match="mass_kg must be"):
        replace(GAINS, mass_kg=0.0)


def test_every_constant_is_refused_beyond_either_end_of_its_range_and_taken_at_both() -> None:
    device = opened()
    place = 0
    for name, (low, high) in ForceLoopGains.REALS.items():
        value = getattr(GAINS, name)
        for i in range(ForceLoopGains.RUNS.get(name, 1)):
            for end, beyond in ((low, -np.inf), (high, np.inf)):
                outside = float(np.nextafter(np.float32(end), np.float32(beyond)))
                bad = (*value[:i], outside, *value[i + 1 :]) if isinstance(value, tuple) else outside
                assert sent(device, **{name: bad}) == (Refusal.BAD_VALUE, place)
            place += 1
    ends = {name: replaced(name, low) for name, (low, _) in ForceLoopGains.REALS.items() if name != "tick_s"}
    device.close_loop(replace(GAINS, **ends))  # type: ignore[arg-type] # one kind for each
    assert state(device) is LoopState.CLOSED


def replaced(name: str, value: float) -> float | tuple[float, ...]:
    count = ForceLoopGains.RUNS.get(name)
    return (value,) * count if count else value


def test_constants_of_another_tick_are_refused() -> None:
    device = opened()
    assert refusal(lambda: device.close_loop(replace(GAINS, tick_s=2e-4))) == (Refusal.BAD_VALUE, 0)


def test_a_rig_without_a_cell_is_refused_by_the_host_and_by_the_board() -> None:
    device = LinkedDevice(LibraryBoard(), SimulatedPerson(seed=2))
    assert device.load_cell is None
    with pytest.raises(DeviceError, match="no load cell"):
        device.close_loop(GAINS)
    gains = replace(GAINS, tick_s=1e-6 * device.settings().tick_us)
    assert refusal(lambda: device.client.close_force_loop(gains))[0] is Refusal.NO_LOAD_CELL


def test_nothing_about_the_loop_is_changed_while_rendering() -> None:
    device = closed()
    device.client.arm()
    calls: tuple[Callable[[], None], ...] = (
        lambda: device.client.close_force_loop(GAINS),
        device.client.open_force_loop,
        lambda: device.client.write_load_cell(CELL),
    )
    for call in calls:
        assert refusal(call)[0] is Refusal.WRONG_MODE
    assert state(device) is LoopState.CLOSED


def test_a_host_with_another_definition_of_the_loop_is_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    device = linked()
    other = ReadForceLoopRequest(hash=FORCE_LOOP_HASH ^ 1)
    ask: Callable[[Message, Record], object] = device.client._command
    assert refusal(lambda: ask(Message.READ_FORCE_LOOP, other))[0] is Refusal.HASH_MISMATCH
    assert refusal(lambda: device.client.close_force_loop(GAINS))[0] is Refusal.WRONG_ORDER
    device.upload(plain_surface(), 4.0)
    assert device.press(100.0).force_cN.max() > 30, "all but the loop works"
    monkeypatch.setattr(client, "FORCE_LOOP_HASH", FORCE_LOOP_HASH ^ 1)
    with pytest.raises(DeviceError, match="refused read_force_loop: its firmware speaks another version"):
        linked()


def test_a_board_without_a_floating_point_unit_renders_by_tables(tmp_path: Path) -> None:
    subprocess.run(["make", "-s", "-C", str(HOST), f"BUILD={tmp_path}", "LOOP="], check=True)
    with opened(HostBoard(tmp_path / "fdvv-host")) as device:
        assert (device.force_loop.state(), device.load_cell, device.loop) == ("none", None, None)
        assert refusal(device.client.read_force_loop)[0] is Refusal.UNKNOWN_MESSAGE
        with pytest.raises(DeviceError, match="this board has no force loop; it renders by tables only"):
            device.close_loop(GAINS)
        device.close_loop(None)
        device.upload(plain_surface(), 4.0)
        assert device.press(100.0).displacement_mm.max() > 3.9


def test_a_new_upload_and_presses_keep_the_loop_closed() -> None:
    device = closed()
    for force_cN in (30.0, 50.0):
        device.upload(plain_surface(force_cN), 4.0)
        device.press(100.0)
    assert (state(device), device.loop) == (LoopState.CLOSED, GAINS)


def other_settings(device: LinkedDevice) -> None:
    device.configure(replace(device.settings(), lead_us=77))


def another_cell(device: LinkedDevice) -> None:
    device.fit_cell(replace(CELL, plate_kg=3e-4))


def pulled_cable(device: LinkedDevice) -> None:
    device.port.unplug()
    device.port.step()
    device.client.reconnect()


def another_host(device: LinkedDevice) -> None:
    device.client.connect()


def silent_host(device: LinkedDevice) -> None:
    device.client.arm()
    for _ in range(4000):
        device.port.step()
    assert device.fault().fault is Fault.HOST_LOST
    device.clear_fault()


@pytest.mark.parametrize("end", [other_settings, another_cell, pulled_cable, another_host, silent_host])
@pytest.mark.parametrize("board", [LibraryBoard, HostBoard])
def test_what_ends_a_session_opens_the_loop(
    end: Callable[[LinkedDevice], None], board: type[LibraryBoard | HostBoard]
) -> None:
    with closed(board()) as device:
        end(device)
        assert (state(device), device.loop) == (LoopState.OPEN, None)


def test_the_loop_is_closed_over_a_serial_line() -> None:
    rig = Rig(ScriptedPerson(), 1)
    rig.start()
    with PressedDevice(SerialPort(rig.path)) as device:
        device.configure(replace(SETTINGS, force_gain_q14=8192, force_offset_counts=2048))
        device.fit_cell(CELL)
        device.close_loop(replace(GAINS, tick_s=1e-6 * SETTINGS.tick_us))
        assert device.force_loop.state() == "closed"
        device.upload(plain_surface(), 4.0)
        assert device.force_loop.state() == "closed"
        device.client.reconnect()
        assert (device.force_loop.state(), device.loop) == ("open", None)
    rig.end()


def test_a_board_that_starts_has_its_loop_open() -> None:
    closed()
    assert state(linked()) is LoopState.OPEN


class Unplugged(SimulatedPerson):
    """A rig whose load cell reads the same from some tick of a press on."""

    pressed = 0

    def step(self, duty_q15: int, enable: int, stop_us: int, slot: int) -> Inputs:
        inputs = super().step(duty_q15, enable, stop_us, slot)
        self.pressed += self.ticks > 0
        return inputs._replace(force_counts=2048) if self.pressed > 1000 else inputs


def test_a_cell_that_fails_in_a_press_is_reported_and_the_loop_stays_open() -> None:
    device = LinkedDevice(LibraryBoard(), Unplugged(RIG, seed=2))
    device.close_loop(GAINS)
    device.upload(plain_surface(), 4.0)
    with pytest.raises(DeviceError, match="the force loop opened, cell_dead; check the load cell"):
        device.press(100.0)
    found = device.client.read_force_loop()
    assert (found.state, found.fault) == (LoopState.FAILED, LoopFault.CELL_DEAD)
    assert device.force_loop.state() == "failed, cell_dead"
    assert device.loop is None
    device.press(100.0)
    device.close_loop(GAINS)
    assert state(device) is LoopState.CLOSED
