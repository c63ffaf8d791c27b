"""A person plays a task: one page, one trial, the button simulated at real pace or on the table beside it."""

from __future__ import annotations

from functools import singledispatchmethod
from typing import Any

from fdvv.errors import InputError, ModelError
from fdvv.studio import _messages_play as m
from fdvv.studio._contract import ChannelKind, Tell
from fdvv.studio._messages_press import ShakeSignal
from fdvv.studio._optimizations import Optimizations
from fdvv.studio._play_device import DeviceTrial, Table
from fdvv.studio._play_live import CLOCK, LiveTrial
from fdvv.studio._played_trial import PlayedTrial
from fdvv.studio._press_tell import shake_signal
from fdvv.studio._studio import Studio
from fdvv.studio._told import told as told_of
from fdvv.workflow import DeviceKey, model_subject


class PlayChannel:
    """What serves one page: nothing, or a trial."""

    def __init__(self, studio: Studio, tell: Tell) -> None:
        self._optimizations, self._tell = studio.part(Optimizations), tell
        self._table = Table(studio, lambda line: tell(m.PlayOver(line)))
        self._live: LiveTrial | DeviceTrial | None = None

    def receive(self, ask: Any) -> None:
        """Do what the page asks; without a trial most asks have come too late and do nothing."""
        self._do(ask)

    def close(self) -> None:
        """The page is gone."""
        self._put_away()
        self._table.clear()

    def _put_away(self) -> None:
        if self._live:
            self._live.close()
        self._live = None

    @singledispatchmethod
    def _do(self, ask: Any) -> None:
        raise TypeError(f"no such ask: {ask}")

    @_do.register
    def _(self, ask: m.PlayOpen) -> None:
        self._put_away()
        key = self._table.put(ask.device)
        played = self._optimizations.play(ask.run, ask.trial)
        try:
            self._live, told, signals = self._under(played, key)
        except (InputError, ModelError) as error:
            played.fail(told_of(error))
            raise
        except BaseException:
            played.close()
            raise
        self._tell(m.PlayReady(ask.run, ask.trial, played.attempt, played.task.rounds, told, signals))

    def _under(
        self, played: PlayedTrial, key: DeviceKey | None
    ) -> tuple[LiveTrial | DeviceTrial, str, list[ShakeSignal]]:
        """Put a trial's button under the hand: on the table, or simulated."""
        if key:
            return DeviceTrial(played, key), f"{key.device.info().name}, under your own finger", []
        subject = model_subject(played.model)
        signals = [shake_signal(signal) for signal in subject.signals]
        return LiveTrial(played, subject, self._tell), subject.told, signals

    @_do.register
    def _(self, ask: m.PlayPing) -> None:
        self._tell(m.PlayPong(ask.sent_ms, 1e3 * CLOCK()))
        if self._live:
            self._live.here()

    @_do.register
    def _(self, ask: m.PlayDown) -> None:
        if self._live:
            self._live.down(ask.at_ms)

    @_do.register
    def _(self, ask: m.PlayUp) -> None:
        if self._live:
            self._live.up(ask.at_ms)

    @_do.register
    def _(self, ask: m.PlayRound) -> None:
        if not self._live:
            return
        kept = self._live.keep(ask)
        if kept.finished:
            self._put_away()
        self._tell(kept)

    @_do.register
    def _(self, _ask: m.PlayClose) -> None:
        self._put_away()
        self._tell(m.PlayOver(""))


ASKS = (m.PlayOpen, m.PlayPing, m.PlayDown, m.PlayUp, m.PlayRound, m.PlayClose)
TELLS = (m.PlayReady, m.PlayPong, m.PlayClick, m.PlayKept, m.PlayOver)
CHANNEL = ChannelKind("play", ASKS, TELLS, PlayChannel)
