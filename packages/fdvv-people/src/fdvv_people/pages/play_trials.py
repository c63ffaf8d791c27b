"""Trials that a person plays: on a button simulated in real time, or on a device beside the page."""

from __future__ import annotations

import logging
import time
from collections import deque
from collections.abc import Callable
from contextlib import suppress
from typing import Generic, Protocol, TypeVar

from fdvv.device.open import is_manual, open_device
from fdvv.errors import DeviceError, InputError
from fdvv.model.model import FDVVModel
from fdvv.program.program import Program
from fdvv_people.pages.played_trial import PlayDelay, RoundOver
from fdvv_people.task.rounds import ClockSource, RoundTiming
from fdvv_studio.live.binary_finger import BinaryFinger
from fdvv_studio.live.device_key import DeviceKey
from fdvv_studio.live.hand_moves import HandMove, HandMoves
from fdvv_studio.live.press import LiveEventKind, LivePress, PressTimes
from fdvv_studio.live.press_subject import PressSubject
from fdvv_studio.live.run import LiveFrame, LiveRun
from fdvv_studio.live.travel_key import TravelKey
from fdvv_studio.studio.contract import Message, Over, Tell
from fdvv_studio.studio.devices import DeviceLocks, available_devices, require_listed
from fdvv_studio.studio.studio import Studio

log = logging.getLogger("fdvv_studio.studio")
CLOCK = time.monotonic
LET_GO_cN = 1.0
"""A finger that pushes no harder has let go."""
DOWN = (LiveEventKind.ACTUATION, LiveEventKind.LEVEL)


A = TypeVar("A", bound=RoundOver, contravariant=True)
K = TypeVar("K", covariant=True)


class PlayedRounds(Protocol[A, K]):
    """A trial that keeps its rounds. seed : of everything random in its simulation."""

    seed: int

    def keep(self, ask: A, activations_s: tuple[float, ...], timing: RoundTiming) -> K:
        """Keep a round with what was pressed in it. InputError."""

    def close(self) -> None:
        """End this beginning of the trial."""


RoundAsk = TypeVar("RoundAsk", bound=RoundOver)
RoundKept = TypeVar("RoundKept")


class LiveTrial(Generic[RoundAsk, RoundKept]):
    """A trial under the finger.

    played : the trial, which keeps its rounds. subject : its button, on its rig. tell : to the page.
    finger : what presses; the one that presses to the bottom if None.
    """

    def __init__(
        self,
        played: PlayedRounds[RoundAsk, RoundKept],
        subject: PressSubject,
        tell: Tell,
        finger: BinaryFinger | None = None,
    ) -> None:
        self.played, self._tell = played, tell
        self._times, self._hand = PressTimes(), finger or BinaryFinger.of(subject)
        self._faulted, self._moves = False, HandMoves()
        down_mm, up_mm = subject.actuation_mm or 0.0, subject.reset_mm or 0.0
        self._key, self._by_travel = TravelKey(down_mm, min(down_mm, up_mm)), False
        self._came_ms = deque[tuple[float, float]](maxlen=10)  # a round has a handful of presses
        press = LivePress(subject, seed=played.seed)
        self._hand.up(press)
        self.run = LiveRun(press, self._show, log.warning, lambda reason: tell(Over(reason)), CLOCK)

    def down(self, at_ms: float) -> None:
        """Press the simulated finger down; at_ms : when the hand pressed."""
        self._came_ms.append((at_ms, 1e3 * CLOCK()))
        self._move(HandMove(True, at_ms / 1e3))

    def up(self, at_ms: float) -> None:
        """Release after as long as the hand held: less input latency this time shortens no press."""
        self._move(HandMove(False, at_ms / 1e3))

    def follow(self, at_ms: float, displacement_mm: float, velocity_mm_s: float) -> None:
        """Have the cap go where a key of the person's keyboard was at at_ms.

        It presses where the key reached the button's actuation, on the page's clock. The simulated cap is
        felt by nobody and counts for nothing, since its finger gives way and snaps; it is heard.
        """
        self._by_travel = True
        pressed_s = self._key.read(at_ms / 1e3, displacement_mm)
        if pressed_s is not None:
            self._times.note_press(pressed_s)
            self._came_ms.append((at_ms, 1e3 * CLOCK()))
        self.run.ask(lambda press: press.follow(displacement_mm, velocity_mm_s))

    def close(self) -> None:
        self.run.close()
        self.played.close()

    def _move(self, move: HandMove) -> None:
        def take(press: LivePress) -> None:
            self._moves.add(move, press.time_s)
            self._make(press)

        self.run.ask(take)

    def _make(self, press: LivePress) -> None:
        """Make the moves of the hand that are due, and look again while some wait."""
        while move := self._moves.due(press.time_s):
            if move.down:
                self._times.note_lead(press.time_s, move.hand_s)
                self._hand.down(press)
            else:
                self._hand.up(press)
        if self._moves:
            self.run.ask(self._make)

    def _show(self, seen: LiveFrame) -> None:
        for event in seen.events:
            if event.kind in DOWN and not self._by_travel:
                self._times.note_activation(event.t_s)
            elif event.kind is LiveEventKind.VIBRATION:
                at_ms = 1e3 * (event.t_s + seen.zero_s)
                self._tell(PlayClick(event.number, at_ms, event.velocity_mm_s))
            elif event.kind is LiveEventKind.FAULT:
                self._faulted = True
        if self._faulted and seen.columns.force_cN[-1] <= LET_GO_cN:
            self.run.ask(self._clear)

    def _clear(self, press: LivePress) -> None:
        """Continue after a fault once its cause is gone; a hard stop after the key went down costs none."""
        with suppress(DeviceError):
            press.clear_fault()
            self._faulted = False

    def keep(self, ask: RoundAsk) -> RoundKept:
        """Keep a round, the simulated finger's way to the key taken as it was."""
        timing = ask.timing(ClockSource.PAGE, ask.input, self._transport_ms(ask), ask.hand)
        found = self._times.between(ask.start_ms / 1e3, ask.end_ms / 1e3)
        return self.played.keep(ask, tuple(at_s - ask.input.ms / 1e3 for at_s in found), timing)

    def _transport_ms(self, ask: RoundOver) -> float | None:
        """Return the latency of the round's first press."""
        for at_ms, came_ms in self._came_ms:
            if ask.start_ms <= at_ms <= ask.end_ms and ask.clock_ms is not None:
                return came_ms - ask.clock_ms - at_ms
        return None


class PlayClick(Message, tag="click"):
    """A vibration starts at the cap. server_ms : when, on the server's clock."""

    slot: int
    server_ms: float
    velocity_mm_s: float


HOLDER = "the pointing task"


def pressed_devices() -> tuple[tuple[str, str], ...]:
    return tuple((name, about) for name, about in available_devices()[0] if is_manual(name))


class Table:
    """The table beside one page: the device on it is open from its first trial until the page goes.

    failed : called with one line when the device fell to zero force or is gone, from a thread of the device.
    """

    def __init__(self, studio: Studio, failed: Callable[[str], None]) -> None:
        self._locks, self._failed = studio.part(DeviceLocks), failed
        self._name = ""
        self._key: DeviceKey | None = None

    def put(self, name: str) -> DeviceKey | None:
        """Return the key of a listed device, opened if it is not; None and a clear table if name is empty.

        Raises InputError on one that is not listed or in use, DeviceError.
        """
        if self._key and (name != self._name or self._key.problem):
            self.clear()
        if name and not self._key:
            self._open(name)
        return self._key

    def clear(self) -> None:
        key, name = self._key, self._name
        self._name, self._key = "", None
        if key:
            key.close()
            self._locks.release(name)

    def _open(self, name: str) -> None:
        require_listed("device", name, dict(pressed_devices()), "choose one of the list")
        with self._locks.hold(name, HOLDER):
            self._key = DeviceKey(open_device(name), self._failed)
        self._name = name


class DeviceTrial(Generic[RoundAsk, RoundKept]):
    """A trial on a device: the page leads no finger and shows nothing but the bullet.

    played : the trial, which keeps its rounds. key : of the device. button : that it renders.

    Raises InputError, ModelError on a button that the device cannot hold, DeviceError.
    """

    def __init__(
        self, played: PlayedRounds[RoundAsk, RoundKept], key: DeviceKey, button: FDVVModel | Program
    ) -> None:
        self._played, self._key = played, key
        key.render(button)

    def keep(self, ask: RoundAsk) -> RoundKept:
        """Keep a round, its presses on the device's own clock.

        Raises DeviceError where the device or its line failed, InputError where the clocks are not joined.
        """
        if ask.clock_ms is None:
            reason = "the page's clock is not yet joined with the studio's"
            raise InputError("round", f"round {ask.number}", reason, "wait a second and play the trial again")
        # the key tells its own times, so that nothing lies between finger and event but the clocks' error
        timing = ask.timing(ClockSource.KEY, PlayDelay(0.0, self._key.clock_error_ms), None, "button")
        start_s, end_s = (1e-3 * (at_ms + ask.clock_ms) for at_ms in (ask.start_ms, ask.end_ms))
        pressed_s = self._key.pressed_s(start_s, end_s)
        return self._played.keep(ask, tuple(at_s - 1e-3 * ask.clock_ms for at_s in pressed_s), timing)

    def close(self) -> None:
        self._key.rest()
        self._played.close()
