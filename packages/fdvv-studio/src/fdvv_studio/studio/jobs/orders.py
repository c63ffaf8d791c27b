"""Orders of jobs: on what is worked, and the settings of the use case; the same for page, file and worker."""

from __future__ import annotations

from typing import Annotated, Any, Literal, cast

from msgspec import Meta

from fdvv.bench.settings import CaptureSettings
from fdvv.rendering.settings import CompensateSettings, ProbeSettings, TuneSettings
from fdvv.settings import Settings, settings_of
from fdvv.twin.files import FIRST_RIG
from fdvv_studio.studio.contract import Message


class RigOrder(Message):
    """On what rig is worked.

    button : id of the model. name : of what comes out. device : one of those listed.
    rig : of a simulated one, by its shipped name.
    """

    button: str
    name: str
    device: str = "twin"
    rig: str = FIRST_RIG


class CompensateOrder(RigOrder, tag="compensate"):
    """Learn the actuation that makes a rig feel like a button, and judge it on fresh presses.

    settings : how it learns. known_rig : name of what a rig has taught before; empty to identify it.
    probe_presses : fresh presses per velocity that judge the result, and as many without compensation.
    """

    settings: CompensateSettings = CompensateSettings()
    known_rig: str = ""
    probe_presses: Annotated[int, Meta(ge=1, le=200)] = 5


class ProbeOrder(RigOrder, tag="probe"):
    """Judge a learned table on fresh presses.

    settings : how; its seed is another than what was learned with.
    actuation : name of a learned table; empty for the model's own force.
    """

    settings: ProbeSettings = ProbeSettings(seed=1)
    actuation: str = ""


class CaptureOrder(Message, tag="capture"):
    """Record a real button under guidance, and make a model of it.

    name : of the button that comes out. settings : the procedure.
    device : "twin" is the simulated bench. switch, participant : that is on it, and who presses; simulated.
    watch : show the cue in a person's time on the simulated bench too.
    """

    name: str
    device: str = "twin"
    switch: str = "mx-clear"
    participant: str = "typical"
    settings: CaptureSettings = CaptureSettings()
    watch: bool = False


class TuneOrder(RigOrder, tag="tune"):
    """Tune the vibration of a button's press with a person, or with a made-up observer.

    settings : what is tried, and how it is asked about.
    actuation : name of a learned table; empty for the model's own force.
    observer : who answers; nothing that the simulated one says is evidence of anything.
    """

    settings: TuneSettings = TuneSettings()
    actuation: str = ""
    observer: Literal["person", "simulated observer"] = "person"


KindName = Literal["compensate", "probe", "capture", "tune"]
Order = CompensateOrder | ProbeOrder | CaptureOrder | TuneOrder
SETTINGS: dict[str, type[Settings]] = {
    "compensate": CompensateSettings,
    "probe": ProbeSettings,
    "capture": CaptureSettings,
    "tune": TuneSettings,
}


def kind_of(order: Order) -> KindName:
    return cast(KindName, order.__struct_config__.tag)


def nest_settings(order: dict[str, Any]) -> dict[str, Any]:
    """Return an order of a job's file of version 1, in which the settings stood beside the rest.

    It stated the presses of the paper's law with every method, 0 comparisons for three each, and 0 presses
    that judge for one. What is no order comes back as it is.
    """
    if order.get("type") not in SETTINGS:
        return order
    names = {setting.name for setting in settings_of(SETTINGS[order["type"]])}
    settings = {name: value for name, value in order.items() if name in names}
    rest = {name: value for name, value in order.items() if name not in names}
    if order["type"] == "compensate" and settings.get("method") != "paper":
        settings.pop("presses", None)
    if rest.get("probe_presses") == 0:
        rest["probe_presses"] = 1
    if settings.get("comparisons") == 0:
        settings["comparisons"] = None
    return {**rest, "settings": settings}
