"""What the page asks of a device that is held open, and what it is told."""

from __future__ import annotations

import msgspec


class DeviceAsk(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """Do something with the device that is connected: disconnect, stop, arm, test, clear its fault."""


class DeviceConnect(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """Connect a device of the list. rig, seed : of a simulated one."""

    device: str
    rig: str = "default"
    seed: int = 0


class DeviceUpload(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """Make a button the device's program.

    actuation : name of a table that was learned for it; empty: its own force.
    """

    button: str
    actuation: str = ""
    velocities_mm_s: tuple[float, ...] = (50.0, 100.0, 150.0, 200.0)


class DevicePress(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """Have the simulated person press once."""

    velocity_mm_s: float


class DeviceFact(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """Something to know of a device."""

    name: str
    value: str


class DeviceFacts(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """All that is to know of a device."""

    facts: tuple[DeviceFact, ...]


class PartVerdict(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """How a part of a device did in its test of itself."""

    part: str
    verdict: str
    value: int


class SelfTest(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """The test of all parts; note says why there is none."""

    parts: tuple[PartVerdict, ...]
    note: str


class DeviceStanding(msgspec.Struct, frozen=True, forbid_unknown_fields=True, tag="standing"):
    """What is connected, and how it is.

    Attributes
    ----------
    device : as listed; empty if none is connected. name : as it calls itself.
    streams : it tells of every tick; else only presses are shown.
    programmed : name of the button that is its program; empty if it has none. travel_mm : of that.
    fault : why it fell to zero force; empty if it has not.
    missing_ticks, late_ticks, missing_frames, lost_records : since something was last done with it.
    """

    device: str = ""
    name: str = ""
    simulated: bool = False
    streams: bool = False
    person: bool = False
    force_sensor: bool = False
    tick_s: float = 0.0
    mode: str = ""
    programmed: str = ""
    travel_mm: float | None = None
    fault: str = ""
    missing_ticks: int = 0
    late_ticks: int = 0
    missing_frames: int = 0
    lost_records: int = 0


class WatchScope(msgspec.Struct, frozen=True, forbid_unknown_fields=True, tag="watch_scope"):
    """Be told of ticks, the least and the most of every bin_s, and of the device's standing."""

    bin_s: float


class ScopeTold(msgspec.Struct, frozen=True, forbid_unknown_fields=True, tag="scope"):
    """Bins of ticks, every column (m,); a bin begins at bin * bin_s on the device's clock.

    Attributes
    ----------
    bin : numbers of the bins; those without a tick are not among them.
    force_low_cN, force_high_cN : None where there is no sensor.
    state : of the program. cut : the command was cut to a limit. ticks : told in the bin.
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


class PressSeen(msgspec.Struct, frozen=True, forbid_unknown_fields=True, tag="press_seen"):
    """Force over displacement of a press that was made, and what its button asks for.

    Attributes
    ----------
    displacement_mm : (n,) the grid of all columns. felt_* : None where the stroke was not.
    """

    velocity_mm_s: float
    simulated: bool
    displacement_mm: tuple[float, ...]
    felt_press_cN: tuple[float | None, ...]
    felt_release_cN: tuple[float | None, ...]
    intended_press_cN: tuple[float, ...]
    intended_release_cN: tuple[float, ...]
