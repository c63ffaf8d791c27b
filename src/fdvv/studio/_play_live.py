"""A trial on a simulated button, at real pace: the hand on the page leads the finger."""

from __future__ import annotations

import logging
import time
from contextlib import suppress

from fdvv.errors import DeviceError
from fdvv.studio import _messages_play as m
from fdvv.studio._contract import Tell
from fdvv.studio._played_trial import PlayedTrial
from fdvv.workflow import (
    ClockSource,
    KeyHand,
    LiveEventKind,
    LiveFrame,
    LivePress,
    LiveRun,
    PressSubject,
    PressTimes,
    RoundTiming,
)

log = logging.getLogger("fdvv.studio")
CLOCK = time.monotonic
LONGEST_s = 5.0
"""No hold lasts longer, whatever a page says."""
LET_GO_cN = 1.0
"""A finger that pushes no harder has let go."""
DOWN = (LiveEventKind.ACTUATION, LiveEventKind.LEVEL)


class LiveTrial:
    """A trial under the finger.

    Parameters
    ----------
    played : the trial, its rounds and its task. subject : its button, on its rig. tell : to the page.
    """

    def __init__(self, played: PlayedTrial, subject: PressSubject, tell: Tell) -> None:
        self.played, self._tell = played, tell
        self._times, self._hand = PressTimes(), KeyHand.of(subject)
        self._faulted, self._pressed_s = False, (0.0, 0.0)
        self._came_ms: list[tuple[float, float]] = []
        press = LivePress(subject, seed=played.seed)
        self.run = LiveRun(press, self._show, log.warning, self._over, CLOCK)

    def down(self, at_ms: float) -> None:
        """Have the finger go down; at_ms : when the hand did."""
        self._came_ms = [*self._came_ms[-9:], (at_ms, 1e3 * CLOCK())]
        self.run.ask(lambda press: self._press(press, at_ms / 1e3))

    def up(self, at_ms: float) -> None:
        """Have it let go, after as long as the hand held: a shorter way this time cuts no press short."""
        self.run.ask(lambda press: self._release(press, at_ms / 1e3))

    def here(self) -> None:
        """Go on: somebody looks."""
        self.run.here()

    def close(self) -> None:
        """Put the button away."""
        self.run.close()
        self.played.close()

    def _press(self, press: LivePress, hand_s: float) -> None:
        self._pressed_s = press.time_s, hand_s
        self._times.led(press.time_s, hand_s)
        self._hand.down(press)

    def _release(self, press: LivePress, hand_s: float) -> None:
        pressed_s, since_s = self._pressed_s
        if press.time_s < pressed_s + min(hand_s - since_s, LONGEST_s):
            self.run.ask(lambda later: self._release(later, hand_s))
        else:
            self._hand.up(press)

    def _show(self, seen: LiveFrame) -> None:
        for event in seen.events:
            if event.kind in DOWN:
                self._times.activated(event.t_s)
            elif event.kind is LiveEventKind.VIBRATION:
                at_ms = 1e3 * (event.t_s + seen.zero_s)
                self._tell(m.PlayClick(event.number, at_ms, event.velocity_mm_s))
            elif event.kind is LiveEventKind.FAULT:
                self._faulted = True
        if self._faulted and seen.columns.force_cN[-1] <= LET_GO_cN:
            self.run.ask(self._clear)

    def _clear(self, press: LivePress) -> None:
        """Go on after a fault, once its cause is gone; a hard stop after the key went down costs no press."""
        with suppress(DeviceError):
            press.clear_fault()
            self._faulted = False

    def _over(self, reason: str) -> None:
        self._tell(m.PlayOver(reason))

    def keep(self, ask: m.PlayRound) -> m.PlayKept:
        """Bring a round to the disk, and score the trial after the last one."""
        timing = RoundTiming(
            ClockSource.PAGE,
            ask.display.ms,
            ask.display.error_ms,
            ask.input.ms,
            ask.input.error_ms,
            ask.clock_ms,
            ask.clock_error_ms,
            self._transport_ms(ask),
            ask.frame_ms,
            ask.hand,
        )
        found = self._times.between(ask.start_ms / 1e3, ask.end_ms / 1e3)
        return self.played.over(ask, tuple(at_s - ask.input.ms / 1e3 for at_s in found), timing)

    def _transport_ms(self, ask: m.PlayRound) -> float | None:
        """Give how long the round's first press was on its way here."""
        for at_ms, came_ms in self._came_ms:
            if ask.start_ms <= at_ms <= ask.end_ms and ask.clock_ms is not None:
                return came_ms - ask.clock_ms - at_ms
        return None
