"""A pointing task played now: the hand on the page, the button under test simulated or on a device.

Times in ms are on the page's clock (performance.now) unless the name says server.
"""

from __future__ import annotations

from typing import Annotated

from msgspec import Meta, field

from fdvv.errors import InputError, ModelError
from fdvv_people.pages.optimizations import Optimizations
from fdvv_people.pages.play_trials import CLOCK, DeviceTrial, LiveTrial, PlayClick, Table
from fdvv_people.pages.played_trial import Count, PlayedTrial, PlayKept, PlayRound, Time
from fdvv_studio.live.device_key import DeviceKey
from fdvv_studio.live.press_subject import model_subject
from fdvv_studio.studio.api.press import Depth, Speed
from fdvv_studio.studio.api.press_frames import ShakeSignal
from fdvv_studio.studio.contract import ChannelKind, Message, Over, Tell, error_line, message_of
from fdvv_studio.studio.studio import Studio


class PlayOpen(Message, tag="open"):
    """Begin a trial of a run, or begin it again: its rounds so far no longer count.

    device : that is pressed, one of optimize.devices; empty: a simulated button under the page's hand.
    """

    run: Count
    trial: Count
    device: Annotated[str, Meta(max_length=300)] = ""


class PlayPing(Message, tag="ping"):
    """Ask for the server's clock. sent_ms is returned."""

    sent_ms: Time


class PlayDown(Message, tag="down"):
    """The hand pressed: the simulated finger goes down. at_ms : of the browser's event."""

    at_ms: Time


class PlayUp(Message, tag="up"):
    """The hand let go."""

    at_ms: Time


class PlayFollow(Message, tag="follow"):
    """A key of the person's keyboard is so deep, and so fast: the simulated cap goes along.

    displacement_mm : 0 at rest, positive down. at_ms : of the report.
    """

    at_ms: Time
    displacement_mm: Depth
    velocity_mm_s: Speed


class PlayClose(Message, tag="close"):
    """Put the button away; an unfinished trial's rounds are kept and do not count."""


class PlayReady(Message, tag="ready"):
    """The button is under the finger. attempt : how often this trial was begun. about : what is simulated."""

    run: int
    trial: int
    attempt: int
    rounds: int
    about: str = field(name="told")
    signals: list[ShakeSignal]


class PlayPong(Message, tag="pong"):
    """The server's clock when it heard the question."""

    sent_ms: float
    server_ms: float


PlayTrial = LiveTrial[PlayRound, PlayKept] | DeviceTrial[PlayRound, PlayKept]


class PlayChannel:
    """What serves one page: nothing, or a trial."""

    def __init__(self, studio: Studio, tell: Tell) -> None:
        self._optimizations, self._tell = studio.part(Optimizations), tell
        self._table = Table(studio, lambda line: tell(Over(line)))
        self._live: PlayTrial | None = None

    def receive(self, ask: Message) -> None:
        """Do what the page asks; without a trial most asks have come too late and do nothing."""
        live = self._live
        match ask:
            case PlayOpen():
                self._open(ask)
            case PlayPing():
                self._tell(PlayPong(ask.sent_ms, 1e3 * CLOCK()))
                # a device renders whether or not a page is looked at
                if isinstance(live, LiveTrial):
                    live.run.here()
            case PlayDown() if isinstance(live, LiveTrial):
                live.down(ask.at_ms)
            case PlayUp() if isinstance(live, LiveTrial):
                live.up(ask.at_ms)
            case PlayFollow() if isinstance(live, LiveTrial):
                live.follow(ask.at_ms, ask.displacement_mm, ask.velocity_mm_s)
            case PlayRound() if live:
                kept = live.keep(ask)
                if kept.finished:
                    self._put_away()
                self._tell(kept)
            case PlayClose():
                self._put_away()
                self._tell(Over(""))

    def close(self) -> None:
        self._put_away()
        self._table.clear()

    def _put_away(self) -> None:
        if self._live:
            self._live.close()
        self._live = None

    def _open(self, ask: PlayOpen) -> None:
        self._put_away()
        key = self._table.put(ask.device)
        played = self._optimizations.play(ask.run, ask.trial)
        try:
            self._live, about, signals = self._under(played, key)
        except (InputError, ModelError) as error:
            played.fail(error_line(error))
            raise
        except BaseException:
            played.close()
            raise
        self._tell(PlayReady(ask.run, ask.trial, played.attempt, played.task.rounds, about, signals))

    def _under(self, played: PlayedTrial, key: DeviceKey | None) -> tuple[PlayTrial, str, list[ShakeSignal]]:
        """Put a trial's button under the hand: on the table, or simulated."""
        if key:
            about = f"{key.device.info().name}, under your own finger"
            return DeviceTrial(played, key, played.model), about, []
        subject = model_subject(played.model)
        signals = [message_of(ShakeSignal, signal) for signal in subject.signals]
        return LiveTrial(played, subject, self._tell), subject.description, signals


ASKS = (PlayOpen, PlayPing, PlayDown, PlayUp, PlayFollow, PlayRound, PlayClose)
TELLS = (PlayReady, PlayPong, PlayClick, PlayKept, Over)
CHANNEL = ChannelKind("play", ASKS, TELLS, PlayChannel)
