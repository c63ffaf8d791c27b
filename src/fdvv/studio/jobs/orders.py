"""Orders of jobs; the same records for the page, the job's file and the worker."""

from __future__ import annotations

from typing import Literal, cast

from fdvv.studio.contract import Message
from fdvv.twin.files import FIRST_RIG


class RigOrder(Message):
    """What every order of work on a rig says; see CompensateOrder."""

    button: str
    name: str
    device: str = "twin"
    rig: str = FIRST_RIG
    seed: int = 0
    velocities_mm_s: tuple[float, ...] = (50.0, 100.0, 150.0, 200.0)
    pace_ratio: float = 0.35


class CompensateOrder(RigOrder, tag="compensate"):
    """Learn the actuation that makes a rig feel like a button, and judge it on fresh presses.

    button : id of the model. name : of what comes out.
    device : one of those listed. rig : of a simulated one, by its shipped name.
    rounds : presses per velocity once the rig is known; with the paper's law runs averaged.
    presses : per round and velocity, with the paper's law.
    known_rig : name of what a rig has taught before; empty to identify it.
    pace_ratio : part by which a press may miss its speed.
    probe_presses : fresh presses per velocity that judge the result, and as many without compensation;
        0, as in older jobs, is 1.
    """

    method: Literal["rig-aware", "paper"] = "rig-aware"
    rounds: int = 3
    presses: int = 12
    known_rig: str = ""
    probe_presses: int = 5


def judging_presses(order: CompensateOrder) -> int:
    """Return how many presses per velocity judge the result: a rendering is never left without a figure."""
    return max(1, order.probe_presses)


class ProbeOrder(RigOrder, tag="probe"):
    """Judge a learned table on fresh presses.

    actuation : name of a learned table; empty for the model's own force.
    presses : per velocity. seed : another than what was learned with. The rest is as in CompensateOrder.
    """

    actuation: str = ""
    seed: int = 1
    presses: int = 10


class CaptureOrder(Message, tag="capture"):
    """Record a real button under guidance, and make a model of it.

    name : of the button that comes out.
    device : "twin" is the simulated bench. switch, participant : that is on it, and who presses; simulated.
    presses : of each pace. probe : a slow probe first. shuffled : paces mixed.
    repeats : how often a bad press is asked for again.
    watch : show the cue in a person's time on the simulated bench too.
    """

    name: str
    device: str = "twin"
    switch: str = "mx-clear"
    participant: str = "typical"
    seed: int = 0
    paces_mm_s: tuple[float, ...] = (50.0, 100.0, 150.0, 200.0)
    presses: int = 15
    probe: bool = True
    shuffled: bool = False
    repeats: int = 3
    pace_ratio: float = 0.35
    watch: bool = False


class TuneOrder(RigOrder, tag="tune"):
    """Tune the vibration of a button's press with a person, or with a made-up observer.

    name : of the button that comes out. actuation : name of a learned table; empty for the model's own force.
    observer : who answers; nothing that the simulated one says is evidence of anything.
    asking : two after another, or one by itself from 1 to 7.
    comparisons : per velocity at most, 0 for three each; repeats : of each rating.
    frequency_ratios, gain_ratios : of the measured vibration, what is tried.
    """

    actuation: str = ""
    observer: Literal["person", "simulated observer"] = "person"
    asking: Literal["compare", "rate"] = "compare"
    comparisons: int = 0
    repeats: int = 3
    frequency_ratios: tuple[float, ...] = (1.0,)
    gain_ratios: tuple[float, ...] = (1.0, 2.0)


KindName = Literal["compensate", "probe", "capture", "tune"]
Order = CompensateOrder | ProbeOrder | CaptureOrder | TuneOrder


def kind_of(order: Order) -> KindName:
    return cast(KindName, order.__struct_config__.tag)
