"""Check an order, and collect copies of everything it works on."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path

from fdvv.device.open import pressed_by_person
from fdvv.errors import InputError
from fdvv.library.catalog import Catalog
from fdvv.model.file import model_to_json
from fdvv.model.jnd_file import project_jnds
from fdvv.model.model import FDVVModel
from fdvv.model.noticeable import LITERATURE
from fdvv.rendering.rig_catalog import SHIPPED_RIGS
from fdvv.studio.devices import require_listed
from fdvv.studio.jobs.file import JobFolder, check_name, result_file
from fdvv.studio.jobs.orders import CaptureOrder, CompensateOrder, Order, RigOrder, TuneOrder, kind_of
from fdvv.twin.capture.participant import PARTICIPANTS
from fdvv.twin.files import button_names, current_rig_name, load_rig, rig_to_toml

RIGS = tuple(SHIPPED_RIGS)
"""Of simulated devices, the one to use first."""
SLOWEST_mm_s, FASTEST_mm_s, MOST_SPEEDS = 5.0, 500.0, 12
MOST = {
    "rounds": (0, 20),
    "presses": (1, 200),
    "probe_presses": (0, 100),
    "repeats": (0, 20),
    "comparisons": (0, 1000),
    "seed": (0, 2**31),
}
"""Least and most of what is counted."""
BENCH = "the capture bench "
"""Before the name of a simulated bench: it is no rig."""


@dataclass(frozen=True)
class Inputs:
    """What a job begins with.

    title : for people. device : that it uses, as the device locks name it. simulated : that device is.
    files : of the job's folder, by name.
    """

    title: str
    device: str
    simulated: bool
    files: dict[str, str | bytes] = field(default_factory=dict)


def inputs_of(order: Order, catalog: Catalog, project: Path, devices: Sequence[str]) -> Inputs:
    """Check an order and collect what it needs. devices : that there are. InputError."""
    check_name(order.name)
    _check_counts(order)
    _check_ratio("pace_ratio", order.pace_ratio, 0.05, 1.0)
    require_listed("device", order.device, devices, "choose one of the list")
    if isinstance(order, CaptureOrder):
        return _capture(order)
    model = catalog.model(order.button)
    check_speeds(order.velocities_mm_s)
    files = _shared_files(order, model, project)
    if isinstance(order, TuneOrder):
        _check_tuning(order, model)
    if isinstance(order, CompensateOrder):
        _check_learning(order)
    title = f"{kind_of(order).capitalize()} {model.name} on {order.device}"
    return Inputs(title, order.device, not pressed_by_person(order.device), files)


def check_speeds(speeds_mm_s: Sequence[float], slowest_mm_s: float = SLOWEST_mm_s) -> None:
    good = all(math.isfinite(v) and slowest_mm_s <= v <= FASTEST_mm_s for v in speeds_mm_s)
    if not good or not 0 < len(set(speeds_mm_s)) == len(speeds_mm_s) <= MOST_SPEEDS:
        speeds = ", ".join(f"{v:g}" for v in speeds_mm_s[:20]) or "none"
        remedy = f"give 1 to {MOST_SPEEDS} different ones of {slowest_mm_s:g} to {FASTEST_mm_s:g} mm/s"
        raise InputError("velocities", "velocities", f"cannot be {speeds} mm/s", remedy)


def _capture(order: CaptureOrder) -> Inputs:
    check_speeds(order.paces_mm_s, 20.0)
    simulated = order.device == "twin"
    if simulated:
        require_listed("switch", order.switch, button_names(), "choose one of the list")
        require_listed("participant", order.participant, PARTICIPANTS)
    elif not pressed_by_person(order.device):
        reason = f"{order.device} is no capture bench"
        raise InputError("device", "device", reason, "use the simulated bench, or one on a serial port")
    on = BENCH + order.device if simulated else order.device
    return Inputs(f"Capture {order.name} on {on}", on, simulated)


def _shared_files(order: RigOrder, model: FDVVModel, project: Path) -> dict[str, str | bytes]:
    """Copy the button, the simulated rig, what was learned before, and what people notice."""
    names = JobFolder(Path())
    rig = str(current_rig_name(order.rig))
    require_listed("rig", rig, RIGS)
    files: dict[str, str | bytes] = {
        names.button.name: model_to_json(model),
        names.rig.name: rig_to_toml(load_rig(rig)),
    }
    learned = (("rig", "known_rig", names.known_rig), ("actuation", "actuation", names.actuation))
    for kind, attribute, copy in learned:
        if name := getattr(order, attribute, ""):
            files[copy.name] = result_file(project, kind, name).read_bytes()
    if project_jnds(project) is not LITERATURE:
        files[names.jnds.name] = (project / names.jnds.name).read_bytes()
    return files


def _check_counts(order: Order) -> None:
    for name, (least, most) in MOST.items():
        value = getattr(order, name, least)
        if not least <= value <= most:
            raise InputError(name, name, f"cannot be {value}", f"give {least} to {most}")


def _check_learning(order: CompensateOrder) -> None:
    if order.method == "paper" and order.known_rig:
        reason = "belongs to the method rig-aware"
        raise InputError("known_rig", "known rig", reason, "choose that method, or no known rig")
    if not order.rounds and not order.known_rig:
        reason = "cannot be 0 where the rig is not known"
        raise InputError("rounds", "rounds", reason, "give 1 or more, or a known rig")


def _check_tuning(order: TuneOrder, model: FDVVModel) -> None:
    for name, least, most in (("frequency_ratios", 0.1, 10.0), ("gain_ratios", 0.05, 20.0)):
        ratios = getattr(order, name)
        if not 0 < len(ratios) <= 5:
            raise InputError(name, name, f"cannot be {len(ratios)} of them", "give 1 to 5")
        for ratio in ratios:
            _check_ratio(name, ratio, least, most)
    if order.asking == "rate" and order.repeats < 2:
        raise InputError("repeats", "repeats", f"cannot be {order.repeats}", "rate each at least twice")
    if order.observer != "person" and pressed_by_person(order.device):
        reason = "a person presses this device, and a simulated observer would answer for them"
        raise InputError("observer", "observer", reason, "answer yourself")
    if not any(v.stroke == "press" for v in model.vibrations):
        reason = f"{model.name} has no vibration of the press to tune"
        raise InputError("button", "button", reason, "give it one in the editor first")


def _check_ratio(name: str, value: float, least: float, most: float) -> None:
    if not (math.isfinite(value) and least <= value <= most):
        raise InputError(name, name.replace("_", " "), f"cannot be {value:g}", f"give {least:g} to {most:g}")
