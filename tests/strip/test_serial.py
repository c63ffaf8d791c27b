"""The LED strip's driver on a real terminal line, in real time."""

from __future__ import annotations

import os
import threading
import time
import tty
from collections.abc import Iterator
from contextlib import suppress

import pytest

from fdvv.errors import DeviceError
from fdvv_strip.board import LedPointingTask, StripRound
from fdvv_strip.library import LibraryStrip, open_strip

QUICK = StripRound(200, 0.3, zone_px=40, after_s=0.1)


class StripBehindTerminal(threading.Thread):
    """A strip's board that runs in real time behind a pseudo-terminal, slower on a busy machine."""

    def __init__(self) -> None:
        super().__init__(daemon=True)
        self.line, self.slave = os.openpty()
        tty.setraw(self.slave)
        os.set_blocking(self.line, False)
        self.spec = f"serial:{os.ttyname(self.slave)}"
        self.board = LibraryStrip()
        self.over = threading.Event()

    def run(self) -> None:
        last_s = time.monotonic()
        while not self.over.wait(0.001):
            with suppress(BlockingIOError):
                self.board.write(os.read(self.line, 4096))
            passed_s, last_s = time.monotonic() - last_s, time.monotonic()
            os.write(self.line, self.board.read(self.board.now_s() + min(passed_s, 0.01)))

    def end(self) -> None:
        self.over.set()
        self.join()


@pytest.fixture
def behind() -> Iterator[StripBehindTerminal]:
    found = StripBehindTerminal()
    found.start()
    yield found
    found.end()
    os.close(found.slave)
    os.close(found.line)


def test_a_round_over_a_serial_port_ends_with_the_time_of_its_press(behind: StripBehindTerminal) -> None:
    with open_strip(behind.spec) as task:
        start = task.begin(QUICK)
        behind.board.press_at(start.target_s + 0.05)
        result = task.wait(start)
        assert result.is_whole
        assert result.activations_s[0] - start.target_s == pytest.approx(0.05, abs=2e-6)


def test_a_strip_that_was_unplugged_is_one_clear_line(behind: StripBehindTerminal) -> None:
    task: LedPointingTask = open_strip(behind.spec)
    behind.over.set()
    behind.join()
    with pytest.raises(DeviceError, match=r"no answer \(status, 0.4 s\)"):
        task.status()
    task.close()
