"""Thousands of damaged, reordered, repeated and hostile frames, pulled cables and hosts that die.

Whatever comes: no force beyond the limit, none unless armed, never a program that was not checked whole, and
a reason for every refusal. Each test prints what it counted (pytest -s).
"""

from __future__ import annotations

import random
import struct
import subprocess
import zlib
from collections import Counter
from collections.abc import Callable
from pathlib import Path

import pytest

from fdvv.device.boards import HostBoard, LibraryBoard
from fdvv.device.linked import Board, LockstepPort
from fdvv.device.wire import REASONS
from fdvv.protocol.frame import Frame, FrameDecoder, encode
from fdvv.protocol.messages import data_request, read_notice, read_reply, request_frame
from fdvv.protocol.tables import (
    DATA_BYTES,
    HASH,
    VERSION,
    BeginRequest,
    ClearFaultRequest,
    Fault,
    HelloRequest,
    Message,
    Mode,
    Refusal,
    RefusedReply,
    Settings,
)
from tests.support.campaign import campaign
from tests.support.link_rigs import PROGRAMS
from tests.support.scripted_person import ScriptedPerson

ROOT = Path(__file__).resolve().parents[4]
BASE = Settings()
DUTY_q15 = min(BASE.duty_limit_q15, BASE.force_limit_cN64 * BASE.duty_gain_q16 // 65536 + 1)
RENDERING = (Mode.ARMED, Mode.DERATED)


class Siege:
    """A board under attack, watched in every tick."""

    def __init__(self, make: Callable[[], Board], seed: int) -> None:
        self.random = random.Random(seed)
        self.counts: Counter[str] = Counter()
        self._make = make
        self.programs = set(PROGRAMS)
        self.sequence = 0
        self.restart()

    def restart(self) -> None:
        """Switch the board off and on."""
        self.board = self._make()
        self.port = LockstepPort(self.board, ScriptedPerson(1).rest(BASE), BASE.tick_us)
        self.decoder = FrameDecoder()
        self.counts["boards"] += 1

    def run(self, ticks: int) -> list[Frame]:
        """Run ticks, look at each, and return the frames that came."""
        found: list[Frame] = []
        for _ in range(ticks):
            out = self.port.step()
            assert abs(out.commanded_cN64) <= BASE.force_limit_cN64
            assert abs(out.duty_q15) <= DUTY_q15
            if out.mode not in RENDERING:
                assert (out.duty_q15, out.enable) == (0, 0), Mode(out.mode)
            found += self.decoder.feed(self.board.read())
        self.counts["ticks"] += ticks
        self.look(found)
        return found

    def look(self, frames: list[Frame]) -> None:
        """Check that each frame from the device means something, and the program is whole."""
        for frame in frames:
            if 0xC0 <= frame.message < 0xFF:
                read_notice(frame)
                continue
            _, body = read_reply(frame)
            if isinstance(body, RefusedReply):
                assert REASONS[Refusal(body.refusal)]
                assert body.refusal != Refusal.NONE
                self.counts[f"refused: {Refusal(body.refusal).name.lower()}"] += 1
        if isinstance(self.board, LibraryBoard):
            program = self.board.program()
            assert program is None or program in self.programs
            self.counts["looks at an accepted hostile program"] += program not in (None, *PROGRAMS)

    def request(self, message: Message, payload: bytes) -> bytes:
        """Return the bytes of a request with the next sequence number."""
        self.sequence = (self.sequence + 1) % 256
        return encode(Frame(message, self.sequence, payload))

    def session(self, image: bytes, cut: bool = False) -> list[bytes]:
        """Return the frames of a whole session: hello, upload, arm, stop."""
        data = (data_request(o, image[o : o + DATA_BYTES]) for o in range(0, len(image), DATA_BYTES))
        begin = BeginRequest(size_bytes=len(image), crc32=int.from_bytes(image[4:8], "little"))
        bodies = [
            (Message.HELLO, HelloRequest(version=VERSION, hash=HASH)),
            (Message.BEGIN, begin),
            *((Message.DATA, body) for body in data),
            (Message.COMMIT, None),
            (Message.ACTIVATE, None),
            (Message.ARM, None),
        ]
        frames = [request_frame(message, 0, body).payload for message, body in bodies]
        found = [self.request(m, p) for (m, _), p in zip(bodies, frames, strict=True)]
        return found if cut else [*found, self.request(Message.DISARM, b"")]

    def recover(self) -> None:
        """Behave well again: the device must take a program and render it, after a restart at the latest."""
        for attempt in range(2):
            self.port.unplug()
            self.run(1)
            self.port.reopen()
            self.decoder.reset()
            hello = self.request(Message.HELLO, HelloRequest(version=VERSION, hash=HASH).pack())
            self.exchange(hello)
            self.exchange(self.request(Message.DISARM, b""))
            for fault in Fault:
                self.exchange(self.request(Message.CLEAR_FAULT, ClearFaultRequest(fault=fault).pack()))
            self.exchange(self.request(Message.WRITE_SETTINGS, BASE.pack()))
            for frame in self.session(PROGRAMS[attempt], cut=True):
                self.exchange(frame, 12)
            if self.port.outputs.duty_q15 > 0:
                self.exchange(self.request(Message.DISARM, b""))
                self.run(3)
                self.counts["recovered"] += 1
                return
            self.board.close()
            self.restart()
        pytest.fail("the board does not recover even from a restart")

    def exchange(self, data: bytes, ticks: int = 3) -> list[Frame]:
        """Send and run some ticks."""
        self.port.write(data)
        return self.run(ticks)

    # -- attacks -------------------------------------------------------------------------------------------

    def flip(self, frames: list[bytes]) -> list[bytes]:
        """Flip bits."""
        return [self._flipped(frame) for frame in frames]

    def _flipped(self, frame: bytes) -> bytes:
        place = self.random.randrange(8 * len(frame))
        return bytes(b ^ (1 << place % 8 if i == place // 8 else 0) for i, b in enumerate(frame))

    def truncate(self, frames: list[bytes]) -> list[bytes]:
        """Cut ends off."""
        return [frame[: self.random.randrange(len(frame))] for frame in frames]

    def lose(self, frames: list[bytes]) -> list[bytes]:
        """Lose every third frame."""
        return [frame for frame in frames if self.random.random() > 0.3]

    def reorder(self, frames: list[bytes]) -> list[bytes]:
        """Shuffle."""
        return self.random.sample(frames, len(frames))

    def duplicate(self, frames: list[bytes]) -> list[bytes]:
        """Repeat some, at once or later."""
        return [f for frame in frames for f in [frame] * self.random.randrange(1, 4)] + frames[:3]

    def insert(self, frames: list[bytes]) -> list[bytes]:
        """Put noise between."""
        return [self.random.randbytes(self.random.randrange(1, 40)) + frame for frame in frames]

    def splice(self, frames: list[bytes]) -> list[bytes]:
        """Join halves of different frames."""
        halves = [(f[: len(f) // 2], g[len(g) // 2 :]) for f, g in zip(frames, frames[::-1], strict=True)]
        return [a + b for a, b in halves]

    def hostile_requests(self, frames: list[bytes]) -> list[bytes]:
        """Send well-formed frames with any number and payload; settings keep the limits that are watched."""
        found = [frames[0]]
        for _ in range(len(frames)):
            number = self.random.choice([*range(0x14), 0x7F, 0x80, 0xC0, self.random.randrange(256)])
            payload = self.random.randbytes(self.random.choice([0, 2, 4, 8, 80, self.random.randrange(228)]))
            if number == Message.WRITE_SETTINGS:
                payload = self._settings()
            found.append(encode(Frame(number, self.random.randrange(256), payload)))
        return found

    def _settings(self) -> bytes:
        """Change one field of the settings at random, but not those that bound force and duty."""
        data, place = bytearray(BASE.pack()), 2 * self.random.randrange(12, 40)
        if place not in range(38, 46):  # force limit, slew, duty limit, nominal supply
            data[place : place + 2] = self.random.randbytes(2)
        return bytes(data)

    def hostile_program(self, frames: list[bytes]) -> list[bytes]:
        """Upload a program changed at random, its checksums right."""
        image = bytearray(self.random.choice(PROGRAMS))
        for _ in range(self.random.randrange(1, 6)):
            image[self.random.randrange(8, 100)] = self.random.randrange(256)
        image[4:8] = struct.pack("<I", zlib.crc32(image[8:]))
        self.programs.add(bytes(image))
        return self.session(bytes(image))


ATTACKS: list[Callable[[Siege, list[bytes]], list[bytes]]] = [
    Siege.flip,
    Siege.truncate,
    Siege.lose,
    Siege.reorder,
    Siege.duplicate,
    Siege.insert,
    Siege.splice,
    Siege.hostile_requests,
    Siege.hostile_program,
]


def attack(siege: Siege, frames: int, recover_every: int = 12) -> None:
    """Attack with so many frames, each kind in turn, mixed with frames that are right."""
    sent = 0
    while sent < frames:
        for kind in ATTACKS:
            good = siege.session(siege.random.choice(PROGRAMS))
            bad = kind(siege, good)
            spared = siege.random.random()
            for one in bad:
                siege.exchange(one, siege.random.randrange(1, 5))
                if siege.random.random() < spared / 2:
                    siege.exchange(siege.random.choice(good), 2)
            siege.counts[kind.__name__] += len(bad)
            sent += len(bad)
        siege.counts["rounds"] += 1
        if siege.counts["rounds"] % recover_every == 0:
            siege.recover()
    siege.recover()
    siege.counts["attacking frames"] = sent


def print_counts(title: str, counts: Counter[str]) -> None:
    print(f"\n{title}: " + ", ".join(f"{name} {count}" for name, count in sorted(counts.items())))  # noqa: T201


def test_thirty_thousand_bad_frames_do_no_harm() -> None:
    siege = Siege(LibraryBoard, 1)
    attack(siege, 30_000)
    print_counts("in this process", siege.counts)
    assert siege.counts["attacking frames"] >= 30_000
    assert siege.counts["recovered"] > 10
    assert siege.counts["looks at an accepted hostile program"] > 100


def test_hundreds_of_bad_frames_over_a_terminal_do_no_harm() -> None:
    siege = Siege(HostBoard, 2)
    attack(siege, 600, 2)
    siege.board.close()
    print_counts("host program", siege.counts)
    assert siege.counts["recovered"] >= 2


def test_a_sanitised_build_finds_nothing_wrong_under_attack(tmp_path: Path) -> None:
    flags = "-O1 -g -fsanitize=address,undefined -fno-sanitize-recover=all"
    make = ["make", "-s", "-C", str(ROOT / "firmware" / "boards" / "host")]
    subprocess.run([*make, f"BUILD={tmp_path}", f"CFLAGS={flags}"], check=True)
    siege = Siege(lambda: HostBoard(tmp_path / "fdvv-host"), 5)
    attack(siege, 600, 2)
    siege.board.close()
    print_counts("sanitised", siege.counts)
    assert siege.counts["recovered"] >= 2


@pytest.mark.slow
@campaign("seed", range(10, 20), part=1)
def test_a_long_siege_does_no_harm(seed: int) -> None:
    siege = Siege(LibraryBoard, seed)
    attack(siege, 50_000)
    print_counts(f"seed {seed}", siege.counts)


def test_a_cable_pulled_after_any_byte_of_an_upload_leaves_the_old_program() -> None:
    siege = Siege(LibraryBoard, 3)
    old, new = PROGRAMS
    for frame in siege.session(old):
        siege.exchange(frame, 10)
    stream = b"".join(siege.session(new)[:-3])  # all but activate, arm and disarm
    for count in range(len(stream) + 1):
        for part in (stream[i : min(i + 64, count)] for i in range(0, count, 64)):
            siege.exchange(part, 2)
        siege.run(20)
        siege.port.unplug()
        siege.run(1)
        siege.port.reopen()
        siege.decoder.reset()
        assert isinstance(siege.board, LibraryBoard)
        assert siege.board.program() == old
        siege.counts["pulls"] += 1
    siege.recover()
    print_counts("pulled cables", siege.counts)
    assert siege.counts["pulls"] == len(stream) + 1


@pytest.mark.parametrize("make", [LibraryBoard, HostBoard])
def test_a_host_that_dies_at_any_time_leaves_no_force_behind(make: Callable[[], Board]) -> None:
    siege = Siege(make, 4)
    timeout_ticks = BASE.host_timeout_ms * 1000 // BASE.tick_us
    for _ in range(12):
        frames = siege.session(siege.random.choice(PROGRAMS), cut=True)
        for frame in frames:
            siege.exchange(frame, 10)
        assert siege.port.outputs.duty_q15 > 0
        for _ in range(siege.random.randrange(4)):
            siege.exchange(siege.request(Message.PING, bytes(4)), siege.random.randrange(1, 300))
        # the last thing heard of it is a piece of a frame
        siege.exchange(siege.request(Message.PING, bytes(4))[: siege.random.randrange(1, 8)], 1)
        siege.run(timeout_ticks + 8)
        assert (siege.port.outputs.duty_q15, siege.port.outputs.mode) == (0, Mode.FAULT)
        siege.counts["deaths"] += 1
        siege.recover()
    siege.board.close()
    print_counts(make.__name__, siege.counts)
