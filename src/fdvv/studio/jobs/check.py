"""Check an order, wherever it comes from: the page, or a project's file that anyone may have written."""

from __future__ import annotations

import math
import re
from collections.abc import Sequence

from fdvv.device.open import pressed_by_person
from fdvv.errors import InputError
from fdvv.rendering.rig_catalog import SHIPPED_RIGS
from fdvv.studio.devices import may_be_listed, require_listed
from fdvv.studio.jobs.orders import CaptureOrder, CompensateOrder, Order, RigOrder, TuneOrder, kind_of
from fdvv.twin.capture.participant import PARTICIPANTS
from fdvv.twin.files import button_names, current_rig_name

RIGS = tuple(SHIPPED_RIGS)
"""Of simulated devices, the one to use first."""
SLOWEST_mm_s, FASTEST_mm_s, MOST_SPEEDS = 5.0, 500.0, 12
LARGEST_COUNT = 2**31
MOST = {
    "rounds": (0, 20),
    "presses": (1, 200),
    "probe_presses": (0, 100),
    "repeats": (0, 20),
    "comparisons": (0, 1000),
    "seed": (0, LARGEST_COUNT),
}
"""Least and most of what is counted."""
NAME = re.compile(r"[^\W_][\w .+()-]{0,79}")
"""Of what comes out: it becomes part of a file's name."""
LONGEST_WORD = 255
BENCH = "the capture bench "
"""Before the name of a simulated bench: it is no rig."""


def check_order(order: Order) -> None:
    """Check all that an order says by itself; what it names may still not be there. InputError."""
    check_name(order.name)
    _check_device(order)
    for name, (least, most) in MOST.items():
        check_count(name, getattr(order, name, least), least, most)
    _check_ratio("pace_ratio", order.pace_ratio, 0.05, 1.0)
    if isinstance(order, CaptureOrder):
        _check_capture(order)
    else:
        _check_rig_order(order)


def simulates(order: Order) -> bool:
    """Return whether the device of an order is simulated."""
    return order.device == "twin" if isinstance(order, CaptureOrder) else not pressed_by_person(order.device)


def lock_name(order: Order) -> str:
    """Return the device of an order as the device locks name it."""
    bench = isinstance(order, CaptureOrder) and simulates(order)
    return BENCH + order.device if bench else order.device


def check_name(name: str) -> None:
    """Refuse a name that is not valid in a file's name. InputError."""
    if not NAME.fullmatch(name) or name.endswith((".", " ")):
        reason = f"cannot be {name[:80]!r}"
        raise InputError("name", "name", reason, "use letters, digits, spaces and . + - ( ), 80 at most")


def check_count(name: str, value: int, least: int = 0, most: int = LARGEST_COUNT) -> None:
    """Refuse a count beyond its bounds. InputError."""
    if not least <= value <= most:
        raise InputError(name, name, f"cannot be {str(value)[:20]}", f"give {least} to {most}")


def check_speeds(speeds_mm_s: Sequence[float], slowest_mm_s: float = SLOWEST_mm_s) -> None:
    good = all(math.isfinite(v) and slowest_mm_s <= v <= FASTEST_mm_s for v in speeds_mm_s)
    if not good or not 0 < len(set(speeds_mm_s)) == len(speeds_mm_s) <= MOST_SPEEDS:
        speeds = ", ".join(f"{v:g}" for v in speeds_mm_s[:20]) or "none"
        remedy = f"give 1 to {MOST_SPEEDS} different ones of {slowest_mm_s:g} to {FASTEST_mm_s:g} mm/s"
        raise InputError("velocities", "velocities", f"cannot be {speeds} mm/s", remedy)


def _check_device(order: Order) -> None:
    """Refuse a device that a file defines: opening it runs that file, which is for a typed command alone."""
    if not may_be_listed(order.device):
        reason = f"there is no {order.device[:80]!r} in the studio"
        remedy = "choose one of its list; only a command that you type runs a device's file"
        raise InputError("device", "device", reason, f"{remedy}: fdvv {kind_of(order)} --device SPEC")


def _check_capture(order: CaptureOrder) -> None:
    check_speeds(order.paces_mm_s, 20.0)
    if simulates(order):
        require_listed("switch", order.switch, button_names(), "choose one of the list")
        require_listed("participant", order.participant, PARTICIPANTS)
    elif not pressed_by_person(order.device):
        reason = f"{order.device} is no capture bench"
        raise InputError("device", "device", reason, "use the simulated bench, or one on a serial port")


def _check_rig_order(order: RigOrder) -> None:
    for name in ("button", "known_rig", "actuation"):
        _check_word(name, getattr(order, name, ""))
    require_listed("rig", str(current_rig_name(order.rig)), RIGS)
    check_speeds(order.velocities_mm_s)
    if isinstance(order, TuneOrder):
        _check_tuning(order)
    if isinstance(order, CompensateOrder):
        _check_learning(order)


def _check_word(what: str, word: str) -> None:
    """Refuse what no file of a project's folders is called; the word itself is never joined to a path."""
    if len(word) > LONGEST_WORD or not word.isprintable() or set(word) & set("/\\"):
        raise InputError(what, word[:80], "there is none of this name in the project", "choose another")


def _check_learning(order: CompensateOrder) -> None:
    if order.method == "paper" and order.known_rig:
        reason = "belongs to the method rig-aware"
        raise InputError("known_rig", "known rig", reason, "choose that method, or no known rig")
    if not order.rounds and not order.known_rig:
        reason = "cannot be 0 where the rig is not known"
        raise InputError("rounds", "rounds", reason, "give 1 or more, or a known rig")


def _check_tuning(order: TuneOrder) -> None:
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


def _check_ratio(name: str, value: float, least: float, most: float) -> None:
    if not (math.isfinite(value) and least <= value <= most):
        raise InputError(name, name.replace("_", " "), f"cannot be {value:g}", f"give {least:g} to {most:g}")
