"""What a client asks of `fdvv serve`, by call; what it gets is in answers.py.

docs/reference/serve-messages.md is their table. A field that is not listed is refused; JSON has no numbers
that are not finite.
"""

from __future__ import annotations

from typing import Annotated, Any, Literal

from msgspec import Meta

from fdvv.twin.files import FIRST_RIG
from fdvv_people.optimize.problem import Answer
from fdvv_people.optimize.run.settings import Budget, Retest
from fdvv_people.optimize.space import Parameter
from fdvv_studio.studio.contract import Message

PROTOCOL = 1
"""Changes where a client of an earlier one would be wrong; a new call or optional field leaves it."""
RESERVED = r"(?!(?i:con|prn|aux|nul|com\d|lpt\d)\Z)"
"""Names that are devices on Windows."""
Name = Annotated[str, Meta(pattern=rf"^{RESERVED}[A-Za-z0-9][A-Za-z0-9_-]{{0,59}}\Z")]
"""Of a run: what makes a folder on every system, and no path."""
Text = Annotated[str, Meta(max_length=500)]
Number = Annotated[int, Meta(ge=0, le=2**53)]
Button = str | dict[str, Any]
"""A built-in's name, the id of one in the project (own:NAME), or a model as its file says."""


class Request(Message, tag_field="call", kw_only=True):
    """What a client asks. id : its own, returned with the answer."""

    id: Number


class Hello(Request, tag="hello"):
    """The first message. token : of this server. protocol : that the client speaks."""

    token: Text
    protocol: int = PROTOCOL


class Clock(Request, tag="clock"):
    """Ask for the host's clock, to which host_s of events belongs."""


class BeginRun(Request, tag="optimize.begin"):
    """Begin a run.

    run : its name, a new one. parameters : of the client's own design; or button, which is varied in `vary`
    within `bounds`, else as far as real buttons go; within : a shipped rig that must be able to render it.
    start : own design that is tried first; a button is tried as it is. engine, seed, budget : of the search;
    a pair engine compares designs. objective, goal : what is scored. error : standard error of every score,
    where it is known. retest : pairs of blind trials that end the run.
    """

    run: Name
    parameters: tuple[Parameter, ...] = ()
    button: Button | None = None
    vary: tuple[str, ...] = ("FDV",)
    bounds: dict[str, tuple[float, float]] | None = None
    within: str | None = None
    start: dict[str, float] | None = None
    engine: str = "gp"
    seed: Number = 0
    budget: Budget = 30
    objective: Annotated[str, Meta(min_length=1, max_length=60)] = "score"
    goal: Literal["minimise", "maximise"] = "minimise"
    error: Annotated[float, Meta(ge=0)] | None = None
    retest: Retest = 0


class OfRun(Request, kw_only=True):
    """A request about a run."""

    run: Name


class ResumeRun(OfRun, tag="optimize.resume"):
    """Continue a run of an earlier connection, or of a server that was killed."""


class AskDesign(OfRun, tag="optimize.ask"):
    """Ask for the design to try next: the same one until its outcome is known."""


class TellOutcome(OfRun, tag="optimize.tell"):
    """Report a trial. outcome done needs a score; error : its standard error. reason : of the others."""

    trial: Number
    outcome: Literal["done", "failed", "abandoned"] = "done"
    score: float | None = None
    error: Annotated[float, Meta(ge=0)] | None = None
    reason: Text = ""


class BestOfRun(OfRun, tag="optimize.best"):
    """Ask for the recommended design, with its interval."""


class AskPair(OfRun, tag="optimize.compare"):
    """Ask for the two designs to compare next: the same ones until they are compared."""


class TellAnswer(OfRun, tag="optimize.prefer"):
    """Report which of two was preferred."""

    pair: Number
    answer: Answer


class OpenDevice(Request, tag="device.open"):
    """Open a device and own it. rig, seed : of a simulated one."""

    device: str
    rig: str = FIRST_RIG
    seed: Number = 0


class DeviceFacts(Request, tag="device.info"):
    """Ask who the device is and how it is."""


class Upload(Request, tag="device.upload"):
    """Make a button, or a program, what the device renders.

    button : as of a run, with the table of the project that was learned for it in `actuation`. program : a
    shipped one's name, one of the project (own:NAME), or a program as its file says.
    """

    button: Button | None = None
    actuation: str = ""
    program: Button | None = None


class Arm(Request, tag="device.arm"):
    """Have it render from now on; a person presses it."""


class Stop(Request, tag="device.stop"):
    """Fall to zero force at once; waits behind no other call."""


class ClearFault(Request, tag="device.clear_fault"):
    """Clear a fault whose cause is gone."""


class Press(Request, tag="device.press"):
    """Have the simulated person of a simulated device press once."""

    velocity_mm_s: float = 100.0


class Watch(Request, tag="device.watch"):
    """Send telemetry in so many bins a second, each with its least and largest; 0 ends it."""

    rate_Hz: Annotated[float, Meta(ge=0, le=2000)]


class CloseDevice(Request, tag="device.close"):
    """Fall to zero force and close the device."""


RUN_REQUESTS = (BeginRun, ResumeRun, AskDesign, TellOutcome, BestOfRun, AskPair, TellAnswer)
DEVICE_REQUESTS = (OpenDevice, DeviceFacts, Upload, Arm, Stop, ClearFault, Press, Watch, CloseDevice)
REQUESTS = (Hello, Clock, *RUN_REQUESTS, *DEVICE_REQUESTS)
