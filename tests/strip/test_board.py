"""The driver of the LED strip's board, over the firmware's own core and over lines that fail."""

from __future__ import annotations

import pytest

from fdvv.errors import DeviceError, ModelError
from fdvv.protocol.frame import Frame, FrameDecoder, encode
from fdvv.protocol.messages import REPLY
from fdvv_strip.board import LedPointingTask, StripRound
from fdvv_strip.library import LibraryStrip
from fdvv_strip.tables import STRIP_HASH, StripHelloReply, StripMessage, StripMode

QUICK = StripRound(200, 0.1, zone_px=40, after_s=0.2)


class Silent:
    """A line at whose end nobody answers, or something that only ever says one thing."""

    name = "/dev/ttyACM7"

    def __init__(self, said: bytes = b"") -> None:
        self.t_s, self.said, self.open = 0.0, said, True

    def now_s(self) -> float:
        return self.t_s

    def write(self, data: bytes) -> None: ...

    def read(self, until_s: float) -> bytes:
        self.t_s = max(self.t_s, until_s)
        said, self.said = self.said, b""
        return said

    def reopen(self) -> None: ...

    def close(self) -> None:
        self.open = False


class Lossy(LibraryStrip):
    """A line that loses every other request, and every other reply to those that arrive."""

    def __init__(self) -> None:
        super().__init__()
        self.count = 0

    def write(self, data: bytes) -> None:
        self.count += 1
        if self.count % 2:
            super().write(data)

    def read(self, until_s: float) -> bytes:
        data = super().read(until_s)
        return b"" if data and self.count % 4 == 1 else data


class Newer(Silent):
    """A board of another version: it answers hello with its own hash."""

    def write(self, data: bytes) -> None:
        for frame in FrameDecoder().feed(data):
            name, other = b"uno-strip".ljust(16, b"\0"), STRIP_HASH ^ 1
            hello = StripHelloReply(hash=other, firmware=512, most_pixels=240, mode=0, flags=0, name=name)
            self.said = encode(Frame(StripMessage.HELLO + REPLY, frame.sequence, hello.pack()))


def test_a_round_is_played_and_its_press_timed(line: LibraryStrip) -> None:
    task = LedPointingTask(line)
    start = task.begin(QUICK)
    line.press_at(start.target_s + 0.0804)
    result = task.wait(start)
    assert (result.presses, result.is_whole) == (1, True)
    assert result.activations_s[0] - result.target_s == pytest.approx(0.0804, abs=1e-6)
    assert start.target_s - start.start_s == pytest.approx(0.2, abs=1e-6)
    assert start.end_s - start.target_s == pytest.approx(0.2, abs=1e-6)


def test_the_bullet_runs_while_the_round_goes_on(line: LibraryStrip) -> None:
    task = LedPointingTask(line)
    start = task.begin(QUICK)
    for share in (0.1, 0.5, 0.9):
        line.read(start.start_s + share * 0.2)
        task.status()
        assert line.bullet_px == pytest.approx(200 * (line.now_s() - start.start_s), abs=1.5)
    assert task.result() is None
    task.stop()
    line.read(line.now_s() + 0.01)
    assert line.bullet_px is None
    assert task.status().mode == StripMode.IDLE


def test_a_silent_line_is_one_clear_line_and_closed() -> None:
    line = Silent()
    with pytest.raises(DeviceError, match=r"^/dev/ttyACM7: no answer \(hello, 3.0 s\); check the port"):
        LedPointingTask(line)
    assert not line.open
    assert line.t_s == pytest.approx(3.0, abs=0.01)


def test_something_else_at_the_port_is_distinguished_from_silence() -> None:
    with pytest.raises(DeviceError, match="what answers there is no LED strip's board"):
        LedPointingTask(Silent(b"FD 1000 5 6\r\n"))


def test_a_board_of_another_version_is_one_clear_line() -> None:
    with pytest.raises(DeviceError, match=r"speaks protocol [0-9a-f]{8}, this fdvv [0-9a-f]{8}; update"):
        LedPointingTask(Newer())


def test_lost_requests_and_replies_cost_a_round_nothing() -> None:
    line = Lossy()
    task = LedPointingTask(line)
    start = task.begin(QUICK)
    line.press_at(start.target_s - 0.05)
    assert task.wait(start).activations_s[0] - start.target_s == pytest.approx(-0.05, abs=1e-6)


def test_a_busy_strip_is_one_clear_line(line: LibraryStrip) -> None:
    LedPointingTask(line).begin(QUICK)
    with pytest.raises(DeviceError, match="at a round of another program; wait for its end, or stop it"):
        LedPointingTask(line)


def test_what_the_wire_cannot_say_is_refused_by_name(line: LibraryStrip) -> None:
    with pytest.raises(ModelError, match="speed_px_s must be 20 to 200, got 300"):
        LedPointingTask(line).begin(StripRound(300))


def test_a_zone_beside_the_strip_is_refused(line: LibraryStrip) -> None:
    with pytest.raises(DeviceError, match=r"refused begin: a value is out of range \(field 6\)"):
        LedPointingTask(line).begin(StripRound(pixels=104))


def test_a_round_of_a_silent_host_is_not_whole(line: LibraryStrip) -> None:
    task = LedPointingTask(line)
    task.begin(StripRound(delay_s=0.1))
    line.read(line.now_s() + 0.8)
    result = task.result()
    assert result is not None
    assert not result.is_whole
    assert line.bullet_px is None


def test_the_clock_may_turn_over_in_a_round(line: LibraryStrip) -> None:
    task = LedPointingTask(line)
    line._time_us = 2**32 - 250_000
    task.status()
    start = task.begin(QUICK)
    assert start.end_s > 2**32 * 1e-6 > start.start_s
    line.press_at(start.target_s + 0.01)
    assert task.wait(start).activations_s[0] == pytest.approx(start.target_s + 0.01, abs=1e-6)
