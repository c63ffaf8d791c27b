"""Messages of a task that is played now: the hand on the page, the button under test in the simulation.

Times in ms are on the page's clock (performance.now) unless the name says server.
"""

from __future__ import annotations

from typing import Annotated, Literal

from msgspec import Meta, Struct

from fdvv.studio._messages_press import ShakeSignal

Count = Annotated[int, Meta(ge=0, le=2**31)]
Time = Annotated[float, Meta(ge=0, le=1e12)]
Delay = Annotated[float, Meta(ge=0, le=1000)]
Hand = Literal["key", "mouse", "touch", "pen", "button"]


class PlayOpen(Struct, frozen=True, forbid_unknown_fields=True, tag="open"):
    """Begin a trial of a run, or begin it again: its rounds so far no longer count.

    device : that is pressed, one of optimize.devices; empty: a simulated button under the page's hand.
    """

    run: Count
    trial: Count
    device: Annotated[str, Meta(max_length=300)] = ""


class PlayPing(Struct, frozen=True, forbid_unknown_fields=True, tag="ping"):
    """Ask for the server's clock. sent_ms is told back."""

    sent_ms: Time


class PlayDown(Struct, frozen=True, forbid_unknown_fields=True, tag="down"):
    """The hand pressed: the simulated finger goes down. at_ms : of the browser's event."""

    at_ms: Time


class PlayUp(Struct, frozen=True, forbid_unknown_fields=True, tag="up"):
    """The hand let go."""

    at_ms: Time


class PlayDelay(Struct, frozen=True, forbid_unknown_fields=True):
    """A delay and how far it may be off."""

    ms: Delay
    error_ms: Delay


class PlayRound(Struct, frozen=True, forbid_unknown_fields=True, tag="round"):
    """A round is over: keep it.

    start_ms, end_ms : presses between count. target_ms : when the target was drawn.
    display : from drawing to light. input : from finger to the browser's event.
    clock_ms, clock_error_ms : the server's clock less the page's; None where it is not known yet.
    frame_ms : between two pictures. hand, input : of a device's key "button" and nothing: it tells its own.
    """

    number: Count
    start_ms: Time
    target_ms: Time
    end_ms: Time
    hand: Hand
    display: PlayDelay
    input: PlayDelay
    clock_ms: Annotated[float, Meta(ge=-1e15, le=1e15)] | None
    clock_error_ms: Delay | None
    frame_ms: Delay


class PlayClose(Struct, frozen=True, forbid_unknown_fields=True, tag="close"):
    """Put the button away; an unfinished trial's rounds are kept and do not count."""


class PlayReady(Struct, frozen=True, forbid_unknown_fields=True, tag="ready"):
    """The button is under the finger. attempt : how often this trial was begun. told : what is simulated."""

    run: int
    trial: int
    attempt: int
    rounds: int
    told: str
    signals: list[ShakeSignal]


class PlayPong(Struct, frozen=True, forbid_unknown_fields=True, tag="pong"):
    """The server's clock when it heard the question."""

    sent_ms: float
    server_ms: float


class PlayClick(Struct, frozen=True, forbid_unknown_fields=True, tag="click"):
    """A vibration starts at the cap. server_ms : when, on the server's clock."""

    slot: int
    server_ms: float
    velocity_mm_s: float


class PlayKept(Struct, frozen=True, forbid_unknown_fields=True, tag="kept"):
    """A round is on the disk.

    late_ms : of the key against the target, None if it did not go down. transport_ms : from hand to
    simulation, taken out; None without a press, and of a device.
    """

    number: int
    late_ms: float | None
    transport_ms: float | None
    finished: bool


class PlayOver(Struct, frozen=True, forbid_unknown_fields=True, tag="over"):
    """Nothing is under the finger any more. reason : one line, empty if it was asked for."""

    reason: str
