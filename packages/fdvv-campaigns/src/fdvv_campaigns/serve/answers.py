"""What `fdvv serve` answers, and its events; docs/reference/serve-messages.md is their table."""

from __future__ import annotations

from typing import Any, Literal

from fdvv_people.optimize.space import Parameter
from fdvv_studio.studio.contract import Message

PressKind = Literal["down", "actuation", "level", "reset", "up"]


class Welcome(Message):
    """What there is. runs : names of those that can be resumed."""

    protocol: int
    fdvv: str
    host_s: float
    engines: tuple[str, ...]
    pair_engines: tuple[str, ...]
    buttons: tuple[str, ...]
    programs: tuple[str, ...]
    devices: tuple[str, ...]
    rigs: tuple[str, ...]
    runs: tuple[str, ...]


class HostClock(Message):
    """The host's monotonic clock, s."""

    host_s: float


class RunStatus(Message):
    """A run. compares : whether designs are compared. left : may still be asked. done : have a result."""

    run: str
    engine: str
    compares: bool
    parameters: tuple[Parameter, ...]
    objective: str
    goal: str
    budget: int
    left: int
    done: int
    finished: bool


class Suggestion(Message):
    """A design to try; trial None once the run is finished. model : of a button space."""

    trial: int | None
    design: dict[str, float]
    model: dict[str, Any] | None
    left: int
    finished: bool


class Pair(Message):
    """Two designs to compare; pair None once the run is finished."""

    pair: int | None
    first: dict[str, float]
    second: dict[str, float]
    first_model: dict[str, Any] | None
    second_model: dict[str, Any] | None
    left: int
    finished: bool


class RetestFound(Message):
    """How much better the recommended design was than the first, in pairs of blind trials, 95 % interval."""

    pairs: int
    difference: float
    low: float
    high: float
    chance: float


class Best(Message):
    """The recommended design. mean, low, high : what is expected of it, with the 95 % interval of that."""

    design: dict[str, float]
    mean: float
    low: float
    high: float
    chance: float | None
    count: int
    model: dict[str, Any] | None
    retest: RetestFound | None


class DeviceIs(Message):
    """A device and how it is; see DeviceStatus of the studio. device is empty if none is open."""

    device: str
    name: str
    simulated: bool
    person: bool
    streams: bool
    mode: str
    programmed: str
    travel_mm: float | None
    tick_s: float
    fault: str
    loop: str


class DeviceInformation(DeviceIs):
    """That, and the device's limits."""

    force_limit_cN: float
    travel_limit_mm: float


class Event(Message, tag_field="event"):
    """What a client gets unasked."""


class StatusEvent(DeviceIs, tag_field="event", tag="device.status"):
    """The device changed."""


class FaultEvent(Event, tag="device.fault"):
    """The device fell to zero force. gone : it is no longer there."""

    fault: str
    gone: bool


class PressEvent(Event, tag="device.press"):
    """Something of a press.

    kind : down and up of the cap; actuation, reset and level of the key. device_s : on the clock of ticks.
    host_s : on the host's monotonic clock; of a simulated device when the server saw it. level : of the key.
    displacement_mm : of the cap, with down and up.
    """

    kind: PressKind
    device_s: float
    host_s: float
    level: int
    simulated: bool
    displacement_mm: float | None = None


class TelemetryEvent(Event, tag="device.telemetry"):
    """Bins of ticks, every column (m,); one begins at bin * bin_s on the device's clock.

    Force is null where there is no sensor. state : of the program. cut : the command was cut to a limit.
    ticks : how many are in the bin.
    """

    bin_s: float
    bin: tuple[int, ...]
    displacement_low_mm: tuple[float, ...]
    displacement_high_mm: tuple[float, ...]
    force_low_cN: tuple[float | None, ...]
    force_high_cN: tuple[float | None, ...]
    commanded_low_cN: tuple[float, ...]
    commanded_high_cN: tuple[float, ...]
    state: tuple[int, ...]
    cut: tuple[bool, ...]
    ticks: tuple[int, ...]


EVENTS = (StatusEvent, FaultEvent, PressEvent, TelemetryEvent)


class Refusal(Message):
    """Why a call was refused: of what, where in it, why, and what to do."""

    source: str
    place: str
    reason: str
    remedy: str


class Result(Message):
    """The answer of a call."""

    id: int
    result: Any


class Failure(Message):
    """The answer of a call that was refused; id None where it could not be read."""

    id: int | None
    error: Refusal
