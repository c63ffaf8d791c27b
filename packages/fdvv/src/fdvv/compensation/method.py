"""The protocol of a compensation method, and the records it exchanges with a session."""

from __future__ import annotations

from dataclasses import asdict, dataclass, fields
from typing import TYPE_CHECKING, Any, Protocol, TypeVar

import numpy as np

from fdvv.errors import ModelError
from fdvv.model.curve import Stroke
from fdvv.model.press import Press
from fdvv.model.surface import ForceSurface
from fdvv.protocol.tables import ForceLoopGains
from fdvv.units import FloatArray

if TYPE_CHECKING:
    from fdvv.compensation.identification.rig_file import LearnedRig


@dataclass(frozen=True)
class Tuning:
    """Feed-forward of one rig, applied in every tick; ``Tuning()`` does nothing.

    With x, v, a estimated from the sensed displacement by a critically damped filter of third order
    (g-h-k, Benedict and Bordner 1962; Brookner 1998), a command is

        table(x + v lead + a lead^2 / 2) - drag (v + a brake_lead) - friction clip(v / friction_mm_s, -1, 1)

    Attributes
    ----------
    bandwidth_Hz : of the filter; 0 disables it: the table is read at the sensed displacement.
    lead_s : delay from the sensed position to the coil's force: position lag, computing, half a tick, and
        the coil's lag.
    brake_lead_s : the same without the coil's lag, which also delays the coil's own braking.
    drag_N_s_m : subtracted from the command, times speed.
    friction_cN : subtracted from the command in the direction of motion, in full above friction_mm_s.
    paced : use the table's row of the announced speed; else of the speed estimated during the press.
    loop : gains of the force loop; then the table is its target, and the rest renders only if the cell fails.
    """

    bandwidth_Hz: float = 0.0
    lead_s: float = 0.0
    brake_lead_s: float = 0.0
    drag_N_s_m: float = 0.0
    friction_cN: float = 0.0
    friction_mm_s: float = 10.0
    paced: bool = False
    loop: ForceLoopGains | None = None

    def __post_init__(self) -> None:
        numbers = [float(getattr(self, f.name)) for f in fields(self) if f.name != "loop"]
        if not np.isfinite(numbers).all() or min(numbers) < 0 or not self.friction_mm_s > 0:
            raise ModelError(
                f"a tuning needs finite numbers of at least 0, and friction_mm_s above 0, got {self}"
            )

    def to_dict(self) -> dict[str, Any]:
        """Return the fields as files hold them: without loop where there is none, as before it existed."""
        record = asdict(self)
        if self.loop is None:
            del record["loop"]
        return record

    def numbers(self) -> FloatArray:
        """Return all numbers in order, (7,), and those of the loop behind them."""
        own = [float(getattr(self, f.name)) for f in fields(self) if f.name != "loop"]
        return np.hstack([own, [] if self.loop is None else np.frombuffer(self.loop.pack(), "<f4")])


UNTUNED = Tuning()
"""No feed-forward."""
S = TypeVar("S")


LIFT_ratio = 0.25
"""Of the force limit, the most that holds up a cap at rest: the rest is the button's."""


@dataclass(frozen=True, eq=False)
class CompensationJob:
    """What a method is to learn.

    Attributes
    ----------
    target : intended force; its rows are the velocities, its grid the bins of the command tables.
    travel_mm : position of the bottom stop.
    force_limit_cN : largest command of either sign.
    full_duty_N : force of the motor at full duty; None if it is not known.
    """

    target: ForceSurface
    travel_mm: float
    force_limit_cN: float
    full_duty_N: float | None = None

    def at_most_cN(self, force_cN: float) -> float:
        """Return an auxiliary force (a lift, a hold), less on a rig whose limit is low."""
        return min(force_cN, LIFT_ratio * self.force_limit_cN)


@dataclass(frozen=True, eq=False)
class Trial:
    """The next press: upload surface with this tuning, and have it pressed once at velocity_mm_s.

    pace_ratio : largest relative deviation of the speed; None: that of the session.
    vibrating : the model's vibrations are played in this press.
    """

    surface: ForceSurface
    velocity_mm_s: float
    tuning: Tuning = UNTUNED
    pace_ratio: float | None = None
    vibrating: bool = False


if TYPE_CHECKING:
    Error = float
else:  # as a file holds it; NaN where it is not known
    Error = float | None


@dataclass(frozen=True)
class CurveOutcome:
    """Result of one curve, as the rig measured it while it learned (not the force on the finger).

    Attributes
    ----------
    error_cN : error_k of every press used, in order.
    mean_error_cN, max_error_cN : of |target - rendered| over the bins, for the table that is returned; NaN if
        not known.
    explanation : for people.
    """

    stroke: Stroke
    velocity_mm_s: float
    error_cN: tuple[float, ...]
    mean_error_cN: Error
    max_error_cN: Error
    explanation: str

    def __post_init__(self) -> None:
        for name in ("mean_error_cN", "max_error_cN"):
            if getattr(self, name) is None:
                object.__setattr__(self, name, float("nan"))


@dataclass(frozen=True, eq=False)
class Outcome:
    """What a method learned.

    Attributes
    ----------
    surface : the actuation, one row per velocity of the job.
    tuning : of the controller while it renders the surface.
    curves : one per stroke and velocity.
    presses : learned from.
    complete : the method finished; if not, the sentence gives the reason.
    """

    surface: ForceSurface
    curves: tuple[CurveOutcome, ...]
    presses: int
    complete: bool
    sentence: str
    tuning: Tuning = UNTUNED


@dataclass(frozen=True)
class PressCount:
    """Presses learned from, and presses needed in total.

    wanted : presses needed per velocity, in the order of the target's rows; empty if unknown.
    """

    made: int
    total: int
    wanted: tuple[int, ...] = ()


class TrialSource(Protocol[S]):
    """What a session presses: call trial, press and step until trial returns None."""

    def trial(self, state: S) -> Trial | None:
        """Return the next press; None when finished."""
        ...

    def step(self, press: Press, state: S) -> S:
        """Use the press of the last trial, which ``judge_press`` accepted.

        Raises ModelError with the reason if nothing can be learned from it; the press is then repeated.
        """
        ...

    def count(self, state: S) -> PressCount:
        """Return the number of presses made and needed."""
        ...

    def explain(self, state: S) -> str:
        """Return in a few words what the last press changed; empty if there is nothing."""
        ...


class Method(TrialSource[S], Protocol[S]):
    """Settings of a method, whose state begins with init.

    Attributes
    ----------
    name : with its additions, for records.
    bin_mm : step of the tables it learns.
    learned_rig : from an earlier job, which is then not identified; None for methods that learn tables only.
    """

    @property
    def name(self) -> str: ...

    @property
    def learned_rig(self) -> LearnedRig | None: ...

    @property
    def bin_mm(self) -> float: ...

    def init(self, job: CompensationJob) -> S: ...

    def done(self, state: S) -> Outcome:
        """Return what has been learned so far; valid at any time."""
        ...

    def rig_after(self, state: S) -> LearnedRig | None:
        """Return the rig, for other buttons; None for methods that learn tables only."""
        ...


def error_cN(target_cN: FloatArray, measured_cN: FloatArray, alpha: float = 0.7) -> float:
    """Return error_k = alpha * mean|d| + (1 - alpha) * max|d|, d = target - measured (the paper's eq. 3).

    target_cN, measured_cN : (n,) on one grid; NaN bins were not visited and do not count.
    Raises ModelError if no bin counts.
    """
    deviation = np.abs(target_cN - measured_cN)
    deviation = deviation[np.isfinite(deviation)]
    if not deviation.size:
        raise ModelError("no bin holds both a target and a measured force")
    return float(alpha * deviation.mean() + (1 - alpha) * deviation.max())
