"""Capture benches: a simulated one, and one on a serial port with a person at it."""

from __future__ import annotations

import re
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from datetime import UTC, datetime
from typing import Protocol

import numpy as np

from fdvv.device.serial import SerialPort
from fdvv.device.wire import Port
from fdvv.errors import DeviceError, InputError, ModelError
from fdvv.recording.serial import SerialCapture
from fdvv.recording.types import Bench, Mark, Stage, Take
from fdvv.twin.button import ButtonPhysics
from fdvv.twin.capture.bench import CaptureBench
from fdvv.twin.capture.participant import PARTICIPANTS, LEAD_s
from fdvv.twin.capture.rig import CaptureRig
from fdvv.twin.capture.streams import BOARD
from fdvv.twin.files import load_button
from fdvv.twin.finger import Finger
from fdvv.twin.rig import ForceSensor

HEAD_s = 12.0
"""Time in which a bench must identify itself; boards that do not answer do so every ten seconds."""
BODY = 20
"""So many lines of samples in a row, and the head is over."""
SILENT_s = 1.0
"""A bench that writes nothing for so long is not running."""
CUE_PERIOD_s = 0.004
"""Time between two updates of the cue."""
AFTER_s = 0.8
"""Recorded after the cue, for a person who is late."""
ANCHOR_us = 20 * 60 * 1_000_000
"""The board's counter turns every 71.6 minutes; times so far apart leave no doubt how often it did."""
TURN_us = 2**32
ASK, BLINK = b"?\n", b"L\n"
"""What the host sends: write your head again; blink the light before a press."""
ANCHOR = "session"
MAGIC = "# fdvv-capture "
_TIME = re.compile(r"(?:[A-Z]{1,8}|!) (\d{1,10}) \S", re.ASCII)
BENCHES = {
    "twin": "a simulated bench with a simulated participant at a simulated button",
    "serial:PORT": "a bench on a serial port, with a person at it",
}
"""Benches that a word opens, and what each is."""


def show_nothing(_t_s: float) -> None:
    """Show nothing."""


@dataclass(frozen=True)
class Cue:
    """What leads a person through one take, on a time of its own that begins with the take.

    Attributes
    ----------
    length_s : from its begin until the person should be done.
    events : cues and their times, as ("cue contact", 1.5); they become marks of the take.
    show : called with the time, over and over; draws and beeps what is due by then.
    """

    length_s: float
    events: tuple[tuple[str, float], ...] = ()
    show: Callable[[float], None] = show_nothing


@dataclass(frozen=True)
class BenchInfo:
    """Who records.

    Attributes
    ----------
    name : kind of bench.
    simulated : its takes come from the twin.
    bench : what is known of its instruments.
    person : a word for who presses; for a simulated one, all that repeats the session.
    """

    name: str
    simulated: bool
    bench: Bench
    person: str = ""


class CaptureDevice(Protocol):
    """Records takes of one button that a person presses. Errors are DeviceError."""

    def facts(self) -> BenchInfo:
        """Return who this is and what is known of the instruments."""

    def take(self, number: int, stage: Stage, velocity_mm_s: float | None, cue: Cue) -> Take:
        """Record one take while the cue is shown; the take bears this number.

        The marks hold the cue's events on the clock of the force. A press that went wrong is a take too.
        Raises DeviceError if the bench fails or falls silent.
        """

    def close(self) -> None:
        """Let the bench go; a second time does nothing."""


class SerialBench:
    """A bench that writes the text of docs/reference/capture-serial.md, and a person who follows the cue.

    Times run on from the first line that was heard, through all takes; takes after another start of the
    program are on a clock of their own. Raises DeviceError, and closes the line, if no bench answers.
    """

    def __init__(self, port: Port) -> None:
        self._port, self._rest, self._cut, self._clock = port, b"", True, ""
        self._capture = SerialCapture()
        try:
            self._feed(self._listen_for_head())
            self._capture.take(1)
            self._bench = self._capture.bench
        except BaseException as error:
            port.close()
            if isinstance(error, ModelError):
                raise DeviceError(f"{port.name}: {error}") from error
            raise

    def facts(self) -> BenchInfo:
        return BenchInfo(self._port.name, False, self._bench)

    def take(self, number: int, stage: Stage, velocity_mm_s: float | None, cue: Cue) -> Take:
        self._clock = self._clock or ("board" if number == 1 else f"board from take {number}")
        made = datetime.now(UTC).isoformat(timespec="seconds")
        self._drain()
        self._feed(self._anchors())
        known = len(self._capture.warnings)
        self._port.write(BLINK)
        self._feed(self._record_lines(cue))
        take = self._capture.take(number, stage, velocity_mm_s, made)
        if not any(stream.t_s.size for stream in take.streams):
            raise DeviceError(f"{self._port.name}: no sample came; check the board's program")
        begun_s = min(float(stream.t_s[0]) for stream in take.streams if stream.t_s.size)
        marks = [replace(mark, clock=self._clock) for mark in take.marks if mark.name != ANCHOR]
        marks += [Mark(name, self._clock, begun_s + t_s) for name, t_s in cue.events]
        streams = tuple(replace(stream, clock=self._clock) for stream in take.streams)
        remark = "; ".join(self._capture.warnings[known:])
        return replace(take, streams=streams, marks=tuple(marks), remark=remark)

    def close(self) -> None:
        self._port.close()

    def _listen_for_head(self) -> list[str]:
        """Listen until the head and some samples have come; give them."""
        self._port.write(ASK)
        until_s, lines, heard, body = self._port.now_s() + HEAD_s, list[str](), False, 0
        while self._port.now_s() < until_s:
            data = self._port.read(self._port.now_s() + CUE_PERIOD_s)
            heard |= bool(data)
            for line in self._lines(data):
                lines = [line] if line.startswith(MAGIC) else [*lines, line] if lines else []
                body = body + 1 if lines and _TIME.match(line) else 0
                if body == BODY:
                    return lines
        problem = "something else than a capture bench writes there" if heard else "no answer"
        remedy = "check the port's name, the cable and the board's program"
        raise DeviceError(f"{self._port.name}: {problem}; {remedy}")

    def _record_lines(self, cue: Cue) -> list[str]:
        begun_s = heard_s = self._port.now_s()
        lines: list[str] = []
        while (now_s := self._port.now_s()) < begun_s + cue.length_s + AFTER_s:
            cue.show(min(now_s - begun_s, cue.length_s))
            fresh = self._lines(self._port.read(now_s + CUE_PERIOD_s))
            heard_s = now_s if fresh else heard_s
            if now_s - heard_s > SILENT_s:
                raise DeviceError(f"{self._port.name}: the bench fell silent; check its power and its cable")
            lines += fresh
        return lines

    def _lines(self, data: bytes) -> list[str]:
        """Cut what came into whole lines; the last, which is not, waits, and one that was cut is left out."""
        *whole, self._rest = (self._rest + data).split(b"\n")
        if self._cut and whole:
            whole, self._cut = whole[1:], False
        return [text for line in whole if (text := line.decode("ascii", "replace").strip())]

    def _drain(self) -> None:
        until_s = self._port.now_s() + SILENT_s
        while self._port.now_s() < until_s and self._port.read(self._port.now_s()):
            pass
        self._rest, self._cut = b"", True

    def _feed(self, lines: Sequence[str]) -> None:
        """Hand lines on, and remember the last time among them and when it was heard."""
        for line in lines:
            if self._capture.feed(line) and (timed := _TIME.match(line)):
                self._last_us, self._last_s = int(timed[1]), self._port.now_s()

    def _anchors(self) -> list[str]:
        """Write events that lead the board's counter over the time in which nobody listened."""
        count = int((self._port.now_s() - self._last_s) * 1e6) // ANCHOR_us
        return [f"! {(self._last_us + i * ANCHOR_us) % TURN_us} {ANCHOR}" for i in range(1, count + 1)]


@dataclass(frozen=True)
class Pacing:
    """By which clock a cue is shown; a paced bench takes as long as a person would."""

    now_s: Callable[[], float] = time.monotonic
    sleep: Callable[[float], None] = time.sleep


class TwinBench:
    """A bench, a button and a participant, all simulated; a take depends on the seed and its number alone.

    Parameters
    ----------
    button : that is captured.
    participant : one of fdvv.twin.capture.participant.PARTICIPANTS.
    seed : of everything random.
    pacing : shows the cue in its own time; None: as fast as it can, without showing it.
    """

    def __init__(
        self, button: ButtonPhysics, participant: str = "typical", seed: int = 0, pacing: Pacing | None = None
    ) -> None:
        if participant not in PARTICIPANTS:
            raise ModelError(f"participant must be one of {', '.join(PARTICIPANTS)}, got {participant!r}")
        person, random = PARTICIPANTS[participant], np.random.default_rng(seed)
        self._bench = CaptureBench(button, CaptureRig(), Finger(), ForceSensor(), person, random)
        self._person, self._pacing = f"simulated, {participant}, seed {seed}", pacing

    def facts(self) -> BenchInfo:
        return BenchInfo("twin", True, self._bench.facts(), self._person)

    def take(self, number: int, stage: Stage, velocity_mm_s: float | None, cue: Cue) -> Take:
        if self._pacing:
            _show(cue, self._pacing)
        try:
            made = self._bench.take(number, stage, velocity_mm_s)
        except ModelError as error:
            raise DeviceError(f"twin: {error}") from error
        if stage is not Stage.PRESS:
            return made.take
        # the simulated finger sets out at the cue of contact
        contact_s = dict(cue.events).get("cue contact", 0.0)
        begun_s = made.truth.begin_s + LEAD_s - contact_s
        cues = [Mark(name, BOARD, round(begun_s + t_s, 6)) for name, t_s in cue.events]
        return replace(made.take, marks=(*made.take.marks, *cues))

    def close(self) -> None:
        """Do nothing: there is no line."""


def _show(cue: Cue, pacing: Pacing) -> None:
    begun_s = pacing.now_s()
    while (t_s := pacing.now_s() - begun_s) < cue.length_s:
        cue.show(t_s)
        pacing.sleep(CUE_PERIOD_s)
    cue.show(cue.length_s)


def open_bench(
    spec: str, button: str, participant: str = "typical", seed: int = 0, paced: bool = False
) -> CaptureDevice:
    """Open the capture bench that spec names (BENCHES).

    button : a shipped real button or a TOML file of one, participant, seed, paced : of the simulated bench.
    Raises InputError on an unknown name, DeviceError if the bench cannot be opened.
    """
    kind, _, where = spec.partition(":")
    if kind == "serial" and where:
        return SerialBench(SerialPort(where))
    if spec == "twin":
        return TwinBench(load_button(button), participant, seed, Pacing() if paced else None)
    raise InputError("--device", spec, "names no capture bench", f"use one of {', '.join(BENCHES)}")
