"""Look up what an order names, and collect copies of everything it works on."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path

from fdvv.errors import InputError
from fdvv.model.file import model_to_json
from fdvv.model.jnd_file import project_jnds
from fdvv.model.model import FDVVModel
from fdvv.model.noticeable import LITERATURE
from fdvv.twin.files import load_rig, rig_to_toml
from fdvv_studio.library.catalog import Catalog
from fdvv_studio.studio.devices import require_listed
from fdvv_studio.studio.jobs.check import check_order, lock_name
from fdvv_studio.studio.jobs.file import JobFolder, result_file
from fdvv_studio.studio.jobs.orders import CaptureOrder, Order, RigOrder, TuneOrder, kind_of


@dataclass(frozen=True)
class Inputs:
    """What a job begins with.

    title : for people. files : of the job's folder, by name.
    """

    title: str
    files: dict[str, str | bytes] = field(default_factory=dict)


def inputs_of(order: Order, catalog: Catalog, project: Path, devices: Sequence[str]) -> Inputs:
    """Check an order and collect what it needs. devices : that there are. InputError."""
    check_order(order)
    require_listed("device", order.device, devices, "choose one of the list")
    if isinstance(order, CaptureOrder):
        return Inputs(f"Capture {order.name} on {lock_name(order)}")
    model = catalog.model(order.button)
    if isinstance(order, TuneOrder) and not any(v.stroke == "press" for v in model.vibrations):
        reason = f"{model.name} has no vibration of the press to tune"
        raise InputError("button", "button", reason, "give it one in the editor first")
    title = f"{kind_of(order).capitalize()} {model.name} on {order.device}"
    return Inputs(title, _input_files(order, model, project))


def _input_files(order: RigOrder, model: FDVVModel, project: Path) -> dict[str, str | bytes]:
    """Copy the button, the simulated rig, what was learned before, and what people notice."""
    names = JobFolder(Path())
    files: dict[str, str | bytes] = {
        names.button.name: model_to_json(model),
        names.rig.name: rig_to_toml(load_rig(order.rig)),
    }
    learned = (("rig", "known_rig", names.known_rig), ("actuation", "actuation", names.actuation))
    for kind, attribute, copy in learned:
        if name := getattr(order, attribute, ""):
            files[copy.name] = result_file(project, kind, name).read_bytes()
    if project_jnds(project) is not LITERATURE:
        files[names.jnds.name] = (project / names.jnds.name).read_bytes()
    return files
