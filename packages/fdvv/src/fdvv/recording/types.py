"""What a bench wrote down: streams of samples, each on the clock of the instrument that took them."""

from __future__ import annotations

from dataclasses import dataclass, field, fields
from enum import StrEnum

import numpy as np

from fdvv.errors import ModelError
from fdvv.io.columns import Packed, PackedFloats, unpack_fields
from fdvv.units import FloatArray


class Quantity(StrEnum):
    """What a stream holds, each in one unit.

    MARKER is the place of one optical marker; DISPLACEMENT that of the cap, from whatever sensor; SOUND what
    a microphone or an accelerometer gives; LIGHT how much of a frame's exposure the light was on, 0 to 1 or
    in the camera's own measure; COUNTS a converter whose scale nobody stated.
    """

    FORCE = "force"
    MARKER = "marker"
    DISPLACEMENT = "displacement"
    SOUND = "sound"
    ACCELERATION = "acceleration"
    LIGHT = "light"
    CONTACT = "contact"
    COUNTS = "counts"


UNITS = {
    Quantity.FORCE: "cN",
    Quantity.MARKER: "mm",
    Quantity.DISPLACEMENT: "mm",
    Quantity.SOUND: "V",
    Quantity.ACCELERATION: "m/s2",
    Quantity.LIGHT: "1",
    Quantity.CONTACT: "1",
    Quantity.COUNTS: "count",
}
"""The unit of Stream.values."""


@dataclass(frozen=True, eq=False)
class Stream:
    """One sensor's samples as they were recorded, and what they mean.

    Attributes
    ----------
    name : unique within its take, as "force" or "left".
    quantity : what it holds; UNITS gives the unit of values.
    clock : name of the clock that t_s is on.
    t_s : (n,) strictly rising.
    raw : (n,) or, for a marker with three axes, (n, 3); whole numbers of a converter or floats; NaN where
        nothing was seen. Never changed after the recording.
    scale, zero : values are scale * (raw - zero): the calibration, which may be corrected later.
    """

    name: str
    quantity: Quantity
    clock: str
    t_s: PackedFloats
    raw: Packed
    scale: float = 1.0
    zero: float = 0.0

    def __post_init__(self) -> None:
        unpack_fields(self, "t_s", "raw")
        object.__setattr__(self, "quantity", Quantity(self.quantity))
        object.__setattr__(self, "scale", float(self.scale))
        object.__setattr__(self, "zero", float(self.zero))
        if self.raw.ndim not in (1, 2) or self.raw.shape[0] != self.t_s.size or self.t_s.ndim != 1:
            raise ModelError(
                f"stream {self.name!r} needs one row for each time, got {self.raw.shape} for {self.t_s.shape}"
            )
        if self.raw.dtype.kind not in "iuf":
            raise ModelError(f"stream {self.name!r} must hold numbers, got {self.raw.dtype}")
        if not np.isfinite(self.t_s).all() or np.any(np.diff(self.t_s) <= 0):
            raise ModelError(f"the times of stream {self.name!r} must rise strictly")
        if not (np.isfinite(self.scale) and self.scale and np.isfinite(self.zero)):
            raise ModelError(f"stream {self.name!r} needs a finite scale other than 0 and a finite zero")

    @property
    def values(self) -> FloatArray:
        """Return the samples in the unit of the quantity, in the shape of raw."""
        return self.scale * (np.asarray(self.raw, dtype=np.float64) - self.zero)

    @property
    def rate_Hz(self) -> float:
        """Return the median rate; NaN for fewer than two samples."""
        return float(1 / np.median(np.diff(self.t_s))) if self.t_s.size > 1 else float("nan")


@dataclass(frozen=True)
class Mark:
    """Something that happened at one moment: "light on", "light off", "closed", "open", "beep".

    Attributes
    ----------
    name : what happened.
    clock : of t_s.
    t_s : when.
    """

    name: str
    clock: str
    t_s: float

    def __post_init__(self) -> None:
        object.__setattr__(self, "t_s", float(self.t_s))
        if not np.isfinite(self.t_s):
            raise ModelError(f"mark {self.name!r} needs a finite time, got {self.t_s}")


class Stage(StrEnum):
    """What a take is for: presses at a velocity, a slow probe, the empty bench, or nothing known."""

    PRESS = "press"
    PROBE = "probe"
    REST = "rest"
    UNKNOWN = "unknown"


@dataclass(frozen=True, eq=False)
class Take:
    """One stretch of recording: a press, or as many as there are in a file.

    Attributes
    ----------
    number : counts the takes of a recording from 1.
    streams : names differ.
    marks : in any order.
    stage : what it is for.
    velocity_mm_s : the requested velocity; None if none was.
    made : when, as ISO 8601, empty if unknown.
    remark : what was said of it when it was made, empty if nothing.
    """

    number: int
    streams: tuple[Stream, ...]
    marks: tuple[Mark, ...] = ()
    stage: Stage = Stage.UNKNOWN
    velocity_mm_s: float | None = None
    made: str = ""
    remark: str = ""

    def __post_init__(self) -> None:
        object.__setattr__(self, "stage", Stage(self.stage))
        object.__setattr__(self, "streams", tuple(self.streams))
        object.__setattr__(self, "marks", tuple(self.marks))
        names = [stream.name for stream in self.streams]
        if len(set(names)) != len(names):
            raise ModelError(f"the streams of a take need different names, got {names}")
        if self.number < 1:
            raise ModelError(f"takes are counted from 1, got {self.number}")
        if self.velocity_mm_s is not None:
            object.__setattr__(self, "velocity_mm_s", float(self.velocity_mm_s))
            if not 0 < self.velocity_mm_s < np.inf:
                raise ModelError(f"velocity_mm_s must be finite and above 0, got {self.velocity_mm_s}")

    def of(self, quantity: Quantity | str) -> tuple[Stream, ...]:
        """Return the streams of one quantity, in order; empty if there is none."""
        return tuple(stream for stream in self.streams if stream.quantity is Quantity(quantity))

    def times_s(self, name: str) -> FloatArray:
        """Return the times of the marks of one name, rising."""
        return np.sort(np.array([mark.t_s for mark in self.marks if mark.name == name]))


@dataclass(frozen=True)
class Bench:
    """What is known of the instruments and can be corrected for; 0 where there is nothing to correct.

    Attributes
    ----------
    force_filter_ms : time constant of the RC filter before the force sensor's converter.
    sound_filter_ms : the same for the microphone.
    force_play_cN : by how much the force sensor reads more on the way back than on the way there.
    tip_mass_g : what the force sensor accelerates with the cap: cone and plunger.
    sound_V_s_m : what the microphone gives per speed of the cap; 0 if nobody calibrated it, and then sound
        shows when and how a vibration rings, but not how strongly.
    exposure_ms : over which a camera averages a frame; frames are stamped at its start.
    clocks_go_on : the clocks run through all takes, so that one alignment serves them all.
    """

    force_filter_ms: float = 0.0
    sound_filter_ms: float = 0.0
    force_play_cN: float = 0.0
    tip_mass_g: float = 0.0
    sound_V_s_m: float = 0.0
    exposure_ms: float = 0.0
    clocks_go_on: bool = True

    def __post_init__(self) -> None:
        for f in fields(self):
            value = getattr(self, f.name)
            if not isinstance(value, bool) and not (np.isfinite(value) and value >= 0):
                raise ModelError(f"{f.name} must be at least 0, got {value}")


@dataclass(frozen=True)
class Source:
    """A file that a recording was read from.

    Attributes
    ----------
    name, sha256, format : of the file.
    """

    name: str
    sha256: str
    format: str


@dataclass(frozen=True, eq=False)
class Recording:
    """Everything that was recorded of one button.

    Attributes
    ----------
    name : of the button, as a model would be called.
    takes : in the order they were made, numbered from 1.
    bench : what is known of the instruments.
    sources : files it was read from; empty for one made live.
    licence : of the data.
    person : a word for who pressed, never a name.
    simulated : it comes from the twin.
    warnings : what was repaired or is missing, one sentence each.
    """

    name: str
    takes: tuple[Take, ...] = ()
    bench: Bench = field(default_factory=Bench)
    sources: tuple[Source, ...] = ()
    licence: str = ""
    person: str = ""
    simulated: bool = False
    warnings: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        for label in ("takes", "sources", "warnings"):
            object.__setattr__(self, label, tuple(getattr(self, label)))
        if not self.name or self.name != self.name.strip():
            raise ModelError(f"name must be text without spaces at its ends, got {self.name!r}")
        if [take.number for take in self.takes] != list(range(1, len(self.takes) + 1)):
            raise ModelError("the takes of a recording must be numbered from 1 in order")

    def __repr__(self) -> str:
        return f"Recording({self.name!r}, {len(self.takes)} takes)"
