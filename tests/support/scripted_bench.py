"""A board of a capture bench, scripted, on a clock that goes only while somebody waits."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from fdvv.errors import DeviceError

HEAD = ["# fdvv-capture 1", "# channel F force_cN scale=0.958 zero=102", "# channel D way_mm scale=0.001",
        "# bench force_filter_ms=0.33 tip_mass_g=2"]  # fmt: skip


class Board:
    """A port whose board writes a sample each millisecond of a clock that goes only while somebody waits.

    said : lines that come at a time in s, whatever else; silent_s : when it falls silent; first_us : what its
    counter says at 0 s.
    """

    name = "/dev/bench"

    def __init__(
        self, said: dict[float, bytes] | None = None, silent_s: float = 1e9, first_us: int = 5_000_000
    ) -> None:
        self.said, self.silent_s, self.first_us = dict(said or {}), silent_s, first_us
        self.t_s, self.sent, self.open = 0.0, list[bytes](), True
        self.gone_s = 1e9

    def now_s(self) -> float:
        return self.t_s

    def write(self, data: bytes) -> None:
        self.sent.append(data)

    def read(self, until_s: float) -> bytes:
        begun_ms, self.t_s = round(1e3 * self.t_s), max(self.t_s, until_s)
        if self.t_s > self.gone_s:
            raise DeviceError(f"{self.name}: the device is gone (EIO); plug it in again")
        found = b"".join(self.said.pop(at) for at in sorted(self.said) if at <= self.t_s)
        return found + b"".join(
            self.sample(ms) for ms in range(begun_ms, round(1e3 * self.t_s)) if 1e-3 * ms < self.silent_s
        )

    def sample(self, ms: int) -> bytes:
        """Write force and displacement of a millisecond: a pattern, nothing pressed."""
        return self.line(ms, 102 + ms % 7, ms % 11)

    def line(self, ms: int, force: int, way: int) -> bytes:
        return b"FD %d %d %d\r\n" % ((self.first_us + 1000 * ms) % 2**32, force, way)

    def reopen(self) -> None: ...

    def close(self) -> None:
        self.open = False


def spoken(**changes: Any) -> Board:
    head = "".join(f"{line}\r\n" for line in HEAD).encode()
    return Board({0.0: b"1 205\r\n" + head, **changes.pop("said", {})}, **changes)


class PressedBoard(Board):
    """Somebody presses a spring of 4 mm after each count-in, at even speeds as listed; 0 is no press."""

    def __init__(self, speeds_mm_s: Sequence[float]) -> None:
        head = "".join(f"{line}\r\n" for line in HEAD).encode()
        super().__init__({0.0: b"\r\n" + head})
        self.speeds_mm_s, self.begun_s, self.stroke_s = list(speeds_mm_s), 0.0, 0.0

    def write(self, data: bytes) -> None:
        super().write(data)
        if data == b"L\n":
            speed = self.speeds_mm_s.pop(0)
            self.begun_s, self.stroke_s = self.t_s + 1.5, 4 / speed if speed else 0.0

    def sample(self, ms: int) -> bytes:
        at_s = 1e-3 * ms - self.begun_s
        down = min(at_s, 2 * self.stroke_s + 0.05 - at_s) / self.stroke_s if self.stroke_s else 0.0
        x_mm = 4 * min(max(down, 0.0), 1.0)
        force_cN = 30 + 10 * x_mm if x_mm > 1e-3 else 0.0
        return self.line(ms, 102 + round(force_cN / 0.958), round(1000 * x_mm))
